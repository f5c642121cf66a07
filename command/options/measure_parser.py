# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of `measure`, with their help.

They are a public contract; unknown options end with exit code 2.

Standard library only, as the process that supervises others may have neither numpy nor Blender.
"""

import argparse
from pathlib import Path
from typing import Any

from ...core.measurement import FRAMES
from ...core.robots import FORMATS as ROBOT_FORMATS
from ..parser import COMMANDS, Parser, choice, flag, value
from . import option_types as types

DEFAULT_ORDER = 2  # For --surface-moments without --order: the order that inertia needs.
DEFAULT_TIMEOUT = 1800.0  # seconds for one file

_EPILOG = """\
FILE is .blend, .stl, .obj, .ply, .glb, .gltf, .usd, .usda, .usdc, .usdz, .fbx, .3mf, .step, .stp,
.igs or .iges, or an array or scan of densities: .npy, .npz, .nrrd, .nhdr, .nii, .nii.gz, or .raw if
called NAME_XxYxZ_TYPE.raw; or a folder, whose files of these kinds are measured, those in its
folders too. Without one, the file that Blender has open is measured. All numbers are SI: kilograms
and meters.
Files are measured by child processes, so that none of them can end the others: what crashes, hangs
or takes too much memory has a record that says so.
Other commands take the place of `measure`: --help without a command lists them.
BODY_MOMENTS_LIMITS in the environment changes what an array or scan may ask for, such as
samples=2e10,unpacked_bytes=1e10,entries=5000,header_bytes=1e7.
exit code: 0 all measured, 1 something is listed under errors or the result cannot be written,
2 wrong usage, 3 interrupted (--resume goes on), 70 a fault of the program"""


_ROBOTS = ", ".join(ROBOT_FORMATS) + ": "
_OPTIONS: dict[str, dict[str, Any]] = {
    "--object": value(
        str,
        "NAME",
        "only this object; repeatable (every measurable object that the file renders; lights, "
        "cameras, empties that instance nothing and curves that show no surface are left out "
        "unless they are named)",
        action="append",
    ),
    "--all": flag(
        "also what is not rendered, and what is only an operand of Boolean modifiers, "
        "displayed as wire or bounds (left out, and listed in left_out)"
    ),
    "--kind": choice(("solid", "shell", "printed", "wire"), "(each object's setting, or solid)"),
    "--flat": flag(
        "what is flat and has no volume (faces, 2D curves, text) is measured as a shape in "
        "its plane, under flat"
    ),
    "--wall": choice(
        ("thin", "inward", "outward", "centered"),
        "of a shell: without or with real thickness, to which side of the surface (each "
        "object's setting)",
    ),
    "--thickness": value(types.positive, "T", "of a shell, in meters (each object's setting)"),
    "--print": value(
        types.print_settings,
        "NAME=VALUE,...",
        "with --kind printed: walls, line_width (m), top, bottom (layers), layer_height (m), "
        "infill (percent), price (of a spool), spool (kg) (each object's setting, or "
        "walls=2,line_width=0.00042,top=4,bottom=4,layer_height=0.0002,infill=15)",
    ),
    "--density": value(types.positive, "D", "kg/m³ (each object's setting, or 1000)"),
    "--mass": value(types.positive, "M", "kg, for each object"),
    "--material": value(str, "NAME", "the density of a material of the panel's list"),
    "--polynomial": value(
        str, "TEXT", "density as a polynomial in x, y, z in meters along the object's axes"
    ),
    "--density-from": value(
        types.source,
        "SOURCE",
        "value, materials, attribute:NAME (of a shell's vertices), or volume:NAME (a Volume "
        "object)",
    ),
    "--overlap": choice(
        ("signed", "union"),
        "overlapping or nested outward shells: counted as often as they cover a place, or "
        "once (signed, with a warning)",
    ),
    "--unit-scale": value(
        types.positive,
        "S",
        "meters per unit in files that carry no unit: .stl, .obj, .ply, arrays (1)",
    ),
    "--spacing": value(
        types.spacing, "X,Y,Z", "arrays: how far samples are apart (the header's, or 1)"
    ),
    "--origin": value(
        types.triple, "X,Y,Z", "arrays: where the first sample stands (the header's, or 0)"
    ),
    "--positions": value(
        types.positions,
        "AXIS=FILE.npy",
        "arrays: where the samples stand along x, y or z, ascending, where they are not "
        "equally far apart; repeatable (in place of the spacing and the origin of that axis)",
        action="append",
    ),
    "--spline-order": value(
        types.spline_order,
        "K",
        "arrays: the samples are the coefficients of a spline of this order: 1 voxels, 2 "
        "trilinear, 4 cubic (1)",
    ),
    "--density-scale": value(types.positive, "S", "arrays: kg/m³ where a sample is 1 (1)"),
    "--threshold": value(
        types.number,
        "T",
        "arrays, scans and Volume objects: the body in which values are at least T, filled "
        "with --density or --material, or with the values' own density (all of the grid)",
    ),
    "--label": value(
        types.label,
        "N|all",
        "arrays and scans that are label maps: a record for label N, or for each label but 0, "
        "filled with --density, --material or the densities of --label-table. Volume objects: "
        "label N, or all labels but 0 as one body (all of the grid)",
    ),
    "--label-table": value(
        Path,
        "FILE",
        "with --label: names, colors and densities in kg/m³ of all its labels: .csv with "
        "columns label, name, density, r, g, b, or .txt as ITK-SNAP or FreeSurfer write it "
        "(the header's names)",
    ),
    "--stream": choice(
        ("auto", "always", "never"),
        ".stl and .ply: in blocks, without importing or repairing them; auto: where an import "
        "may take more memory than one file may (auto)",
        default="auto",
    ),
    "--allow-outside": flag(
        "arrays: the header may name a file of samples outside of its own folder (refused)"
    ),
    "--frame": choice(FRAMES, "of centers, tensors, axes and moments (world)", default="world"),
    "--at-frame": value(
        types.scene_frame,
        "N",
        "the frame of an animation to measure; --frame N is the same (the frame that a .blend "
        "was saved at, the first one of an imported file)",
    ),
    "--about": value(
        types.about,
        "POINT",
        "add inertia_about, and take moments about this point: center (of mass), origin (the "
        "object's), world, or X,Y,Z in the frame (moments about the frame's origin)",
    ),
    "--order": value(
        types.order, "N", "add volume moments up to this order, at most {}".format(types.MAX_ORDER)
    ),
    "--surface-moments": flag("add area moments too (up to --order, or {})".format(DEFAULT_ORDER)),
    "--fourier": value(
        Path,
        "OUT.npz",
        "write the Fourier transform of the one object: q, and F = ∫exp(-i q·x)dV in m³, in "
        "the frame",
    ),
    "--q": value(
        Path, "Q.npy", "at these wave vectors: rows of 3 numbers, with --flat 2, in rad/m"
    ),
    "--grid": value(
        types.frequencies,
        "N",
        "or on a grid of N³ of them, with --flat N²: (j - h) Q / h along each axis, h = N // "
        "2, j from 0 to N - 1",
    ),
    "--qmax": value(types.positive, "Q", "the largest along each axis of the grid, in rad/m"),
    "--below": value(
        types.number,
        "Z",
        "add the part of each solid below this height, in meters, and its cut face",
    ),
    "--against": value(
        types.against,
        "Z|OBJECT|rim",
        "add cut and fill of each open surface against a height, against an object's plane or "
        "surface, or against the plane through its rim",
    ),
    "--float": value(
        types.liquid,
        "LIQUID",
        "add where each body floats: in a liquid of the panel's list, such as Water or “Sea "
        "Water”, or of a density in kg/m³",
    ),
    "--gz": value(
        types.heel_angles,
        "A:B:STEP",
        "with --float, add righting arms at these angles of heel, in degrees",
    ),
    "--pose": flag("add the pose that is the body's own, and its symmetry"),
    "--signature": flag("add the numbers by which `similar` finds the shape again"),
    "--thumbnails": flag("add a small picture of each body with its principal axes, for `report`"),
    "--format": value(
        types.format_name, "{" + ",".join(types.FORMATS) + "}", "(json)", default="json"
    ),
    "--inertial-only": flag(
        _ROBOTS + "the links with their inertials alone, without geometry, places and joints"
    ),
    "--links": choice(
        ("object", "collection", "bone"),
        _ROBOTS + "what is one rigid body (object)",
        default="object",
    ),
    "--no-meshes": flag(
        _ROBOTS
        + "leave geometry out (with --output: meshes in a folder beside it, of usd and gltf in "
        "the file itself)"
    ),
    "--collision": choice(
        ("visual", "none"),
        _ROBOTS + "links collide as they look, or not at all (visual)",
        default="visual",
    ),
    "--fixed-base": flag(
        _ROBOTS + "fix links without a parent to the world (passive rigid bodies alone)"
    ),
    "--merge-fixed": flag(
        _ROBOTS + "put links on fixed joints into their parents; needed frames stay without mass"
    ),
    "--mesh-format": choice(
        ("obj", "stl"), _ROBOTS + "the files of meshes, besides usd and gltf (stl)", default="stl"
    ),
    "--output": value(Path, "PATH", "(standard output)"),
    "--force": flag(
        "--output, its meshes and --fourier may replace any file that is not read (only "
        "results of body_moments; an older result at --output is kept as PATH.old)"
    ),
    "--write": flag(
        "store the results on the objects and save the .blend file, unless something else has "
        "saved it meanwhile"
    ),
    "--asset-metadata": choice(
        ("copy", "file"),
        "put mass, volume, center and more into the metadata of the objects and collections "
        "that are assets, and save copies beside the files, as NAME.body_moments.blend, or "
        "the files themselves",
    ),
    "--manifest": value(Path, "LIST", "measure the files of a list that `manifest` has made"),
    "--range": value(
        types.file_range, "A:B", "of the files, only numbers A to B - 1, counted from 0"
    ),
    "--part": value(
        types.count, "K", "of the list, only part K, counted from 1 (`manifest --parts N`)"
    ),
    "--jobs": value(types.count, "N", "how many processes measure files (one for each core)"),
    "--timeout": value(
        types.positive, "SECONDS", "how long one file may take ({:g})".format(DEFAULT_TIMEOUT)
    ),
    "--memory-mb": value(
        types.positive,
        "M",
        "how much memory one file may take (its part of 80 %% of this machine's)",
    ),
    "--resume": flag(
        "go on with an earlier run of the same --output: files that are recorded in its "
        "journal and unchanged are not measured again"
    ),
    "--retry-failed": flag("as --resume, and measure again what failed"),
    "--errors-exit-0": flag(
        "exit with 0 where something is listed under errors too: for engines that give up a "
        "job for a bad file"
    ),
    "--blender": value(str, "PATH", "the Blender that measures (this one, or the bpy module)"),
    "--no-supervisor": flag("measure in this process, which a damaged file may end"),
}
# At most one of these.
_ONE_OF = {"--density", "--mass", "--material", "--polynomial", "--density-from"}


def measure_parser() -> Parser:
    parser = Parser(
        prog="body_moments",
        usage="body_moments measure [options] [FILE ...]",
        description=COMMANDS["measure"],
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("command", type=types.command, metavar="measure")
    parser.add_argument("files", nargs="*", metavar="FILE")
    group = parser.add_mutually_exclusive_group()
    for name, settings in _OPTIONS.items():
        (group if name in _ONE_OF else parser).add_argument(name, **settings)
    return parser
