# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of `measure`, with their help. They are a public contract; unknown options end with exit code 2.

Standard library only, as the process that supervises others may have neither numpy nor Blender.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.measurement.documents import FRAMES
from ...core.robots.formats import FORMATS as ROBOT_FORMATS
from ..parser import COMMANDS, Parser
from . import option_types as types
from .option_types import FORMATS

DEFAULT_ORDER = 2  # For --surface-moments without --order: the order that inertia needs.
DEFAULT_TIMEOUT = 1800.0  # seconds for one file

_EPILOG = """\
FILE is .blend, .stl, .obj, .ply, .glb, .gltf, .usd, .usda, .usdc, .usdz, .fbx, .3mf, .igs or .iges, or an
array or scan of densities: .npy, .npz, .nrrd, .nhdr, .nii, .nii.gz, or .raw if called NAME_XxYxZ_TYPE.raw;
or a folder, whose files of these kinds are measured, those in its folders too. Without one, the file
that Blender has open is measured. All numbers are SI: kilograms and meters.
Files are measured by child processes, so that none of them can end the others: what crashes, hangs
or takes too much memory has a record that says so.
Other commands take the place of `measure`: --help without a command lists them.
BODY_MOMENTS_LIMITS in the environment changes what an array or scan may ask for, such as
samples=2e10,unpacked_bytes=1e10,entries=5000,header_bytes=1e7.
exit code: 0 all measured, 1 something is listed under errors or the result cannot be written,
2 wrong usage, 3 interrupted (--resume goes on), 70 a fault of the program"""


def measure_parser() -> argparse.ArgumentParser:
    """Return the parser of `measure`."""
    parser = Parser(
        prog="body_moments",
        usage="body_moments measure [options] [FILE ...]",
        description=COMMANDS["measure"],
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("command", type=types.command, metavar="measure")
    add("files", nargs="*", metavar="FILE")
    _add_settings(parser)
    _add_of_files(parser)
    _add_results(parser)
    _add_assets(parser)
    _add_supervision(parser)
    return parser


def _add_settings(parser: argparse.ArgumentParser) -> None:
    """Add options for the choice of objects and their material."""
    add = parser.add_argument
    add(
        "--object",
        action="append",
        metavar="NAME",
        help="only this object; repeatable (every measurable object that the file renders; lights, cameras, empties "
        "that instance nothing and curves that show no surface are left out unless they are named)",
    )
    add(
        "--all",
        action="store_true",
        help="also what is not rendered, and what is only an operand of Boolean modifiers, displayed as wire or "
        "bounds (left out, and listed in left_out)",
    )
    add("--kind", choices=("solid", "shell", "wire"), help="(each object's setting, or solid)")
    add(
        "--flat",
        action="store_true",
        help="what is flat and has no volume (faces, 2D curves, text) is measured as a shape in its plane, under flat",
    )
    add(
        "--wall",
        choices=("thin", "inward", "outward", "centered"),
        help="of a shell: without or with real thickness, to which side of the surface (each object's setting)",
    )
    add("--thickness", type=types.positive, metavar="T", help="of a shell, in meters (each object's setting)")
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--density", type=types.positive, metavar="D", help="kg/m³ (each object's setting, or 1000)")
    group.add_argument("--mass", type=types.positive, metavar="M", help="kg, for each object")
    group.add_argument("--material", metavar="NAME", help="the density of a material of the panel's list")
    group.add_argument(
        "--polynomial", metavar="TEXT", help="density as a polynomial in x, y, z in meters along the object's axes"
    )
    group.add_argument(
        "--density-from",
        type=types.source,
        metavar="SOURCE",
        help="value, materials, attribute:NAME (of a shell's vertices), or volume:NAME (a Volume object)",
    )
    add(
        "--overlap",
        choices=("signed", "union"),
        help="overlapping or nested outward shells: counted as often as they cover a place, or "
        "once (signed, with a warning)",
    )


def _add_of_files(parser: argparse.ArgumentParser) -> None:
    """Add options for information missing in files."""
    add = parser.add_argument
    add(
        "--unit-scale",
        type=types.positive,
        metavar="S",
        help="meters per unit in files that carry no unit: .stl, .obj, .ply, arrays (1)",
    )
    add(
        "--spacing",
        type=types.spacing,
        metavar="X,Y,Z",
        help="arrays: how far samples are apart (the header's, or 1)",
    )
    add(
        "--origin",
        type=types.triple,
        metavar="X,Y,Z",
        help="arrays: where the first sample stands (the header's, or 0)",
    )
    add(
        "--positions",
        type=types.positions,
        action="append",
        metavar="AXIS=FILE.npy",
        help="arrays: where the samples stand along x, y or z, ascending, where they are not equally far apart; "
        "repeatable (in place of the spacing and the origin of that axis)",
    )
    add(
        "--spline-order",
        type=types.spline_order,
        metavar="K",
        help="arrays: the samples are the coefficients of a spline of this order: 1 voxels, 2 trilinear, 4 cubic (1)",
    )
    add("--density-scale", type=types.positive, metavar="S", help="arrays: kg/m³ where a sample is 1 (1)")
    add(
        "--threshold",
        type=types.number,
        metavar="T",
        help="arrays, scans and Volume objects: the body in which values are at least T, filled with --density or "
        "--material, or with the values' own density (all of the grid)",
    )
    add(
        "--stream",
        choices=("auto", "always", "never"),
        default="auto",
        help=".stl and .ply: in blocks, without importing or repairing them; auto: where an import may take more "
        "memory than one file may (auto)",
    )
    add(
        "--allow-outside",
        action="store_true",
        help="arrays: the header may name a file of samples outside of its own folder (refused)",
    )


def _add_results(parser: argparse.ArgumentParser) -> None:
    """Add options for the contents of results and their output."""
    add = parser.add_argument
    add(
        "--frame",
        choices=FRAMES,
        default="world",
        help="of centers, tensors, axes and moments (world)",
    )
    add(
        "--about",
        type=types.about,
        metavar="POINT",
        help="add inertia_about, and take moments about this point: center (of mass), origin (the object's), world, or "
        "X,Y,Z in the frame (moments about the frame's origin)",
    )
    add(
        "--order",
        type=types.order,
        metavar="N",
        help="add volume moments up to this order, at most {}".format(types.MAX_ORDER),
    )
    add(
        "--surface-moments",
        action="store_true",
        help="add area moments too (up to --order, or {})".format(DEFAULT_ORDER),
    )
    add(
        "--fourier",
        type=Path,
        metavar="OUT.npz",
        help="write the Fourier transform of the one object: q, and F = ∫exp(-i q·x)dV in m³, in the frame",
    )
    add("--q", type=Path, metavar="Q.npy", help="at these wave vectors: rows of 3 numbers, with --flat 2, in rad/m")
    add(
        "--grid",
        type=types.frequencies,
        metavar="N",
        help="or on a grid of N³ of them, with --flat N²: (j - h) Q / h along each axis, h = N // 2, j from 0 to N - 1",
    )
    add("--qmax", type=types.positive, metavar="Q", help="the largest along each axis of the grid, in rad/m")
    add("--pose", action="store_true", help="add the pose that is the body's own, and its symmetry")
    add("--signature", action="store_true", help="add the numbers by which `similar` finds the shape again")
    add(
        "--thumbnails",
        action="store_true",
        help="add a small picture of each body with its principal axes, for `report`",
    )
    add(
        "--format",
        type=types.format_name,
        default="json",
        metavar="{" + ",".join(FORMATS) + "}",
        help="(json)",
    )
    add(
        "--inertial-only",
        action="store_true",
        help=", ".join(ROBOT_FORMATS) + ": the links with their inertials alone, without geometry, places and joints",
    )
    add(
        "--links",
        choices=("object", "collection", "bone"),
        default="object",
        help=", ".join(ROBOT_FORMATS) + ": what is one rigid body (object)",
    )
    add(
        "--no-meshes",
        action="store_true",
        help=", ".join(ROBOT_FORMATS) + ": leave geometry out (with --output: meshes in a folder beside it, of usd and "
        "gltf in the file itself)",
    )
    add(
        "--collision",
        choices=("visual", "none"),
        default="visual",
        help=", ".join(ROBOT_FORMATS) + ": links collide as they look, or not at all (visual)",
    )
    add(
        "--fixed-base",
        action="store_true",
        help=", ".join(ROBOT_FORMATS) + ": fix links without a parent to the world (passive rigid bodies alone)",
    )
    add("--output", type=Path, metavar="PATH", help="(standard output)")
    add(
        "--force",
        action="store_true",
        help="--output, its meshes and --fourier may replace any file that is not read (only results of body_moments; "
        "an older result at --output is kept as PATH.old)",
    )
    add(
        "--write",
        action="store_true",
        help="store the results on the objects and save the .blend file, unless something else has saved it meanwhile",
    )


def _add_assets(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--asset-metadata",
        choices=("copy", "file"),
        help="put mass, volume, center and more into the metadata of the objects and collections that are assets, and "
        "save copies beside the files, as NAME.body_moments.blend, or the files themselves",
    )


def _add_supervision(parser: argparse.ArgumentParser) -> None:
    """Add options for measuring many files."""
    add = parser.add_argument
    add("--manifest", type=Path, metavar="LIST", help="measure the files of a list that `manifest` has made")
    add("--range", type=types.file_range, metavar="A:B", help="of the files, only numbers A to B - 1, counted from 0")
    add("--part", type=types.count, metavar="K", help="of the list, only part K, counted from 1 (`manifest --parts N`)")
    add("--jobs", type=types.count, metavar="N", help="how many processes measure files (one for each core)")
    add(
        "--timeout",
        type=types.positive,
        metavar="SECONDS",
        help="how long one file may take ({:g})".format(DEFAULT_TIMEOUT),
    )
    add(
        "--memory-mb",
        type=types.positive,
        metavar="M",
        help="how much memory one file may take (its part of 80 %% of this machine's)",
    )
    add(
        "--resume",
        action="store_true",
        help="go on with an earlier run of the same --output: files that are recorded in its journal and unchanged "
        "are not measured again",
    )
    add("--retry-failed", action="store_true", help="as --resume, and measure again what failed")
    add(
        "--errors-exit-0",
        action="store_true",
        help="exit with 0 where something is listed under errors too: for engines that give up a job for a bad file",
    )
    add("--blender", metavar="PATH", help="the Blender that measures (this one, or the bpy module)")
    add(
        "--no-supervisor",
        action="store_true",
        help="measure in this process, which a damaged file may end",
    )
