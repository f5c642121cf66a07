# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the command line. They are a public contract: an unknown or impossible one ends
with exit code 2.
"""

from __future__ import annotations

import argparse
import math
import os
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import bpy

from ...core.density.spline_tables import MAX_ORDER as MAX_SPLINE_ORDER
from ...core.polyhedron import MAX_ORDER
from ...core.verdict.finding import MeasureError, finding
from ..settings.limits import scan_limits
from ..write.documents import FORMATS, FRAMES, ROBOT_FORMATS
from . import fourier, inputs, output, results
from .parser import Parser

DEFAULT_ORDER = 2  # with --surface-moments alone: all that inertia needs

_EPILOG = """\
FILE is .blend, .stl, .obj, .ply, .glb, .gltf, .usd, .usda, .usdc, .usdz or .fbx, or an array or
scan of densities: .npy, .npz, .nrrd, .nhdr, .nii, .nii.gz, or .raw if called NAME_XxYxZ_TYPE.raw.
Without one, the file that Blender has open is measured. All numbers are SI: kilograms and meters.
`similar LIBRARY --to NAME` in the place of `measure` compares bodies measured with --signature.
BODY_MOMENTS_LIMITS in the environment changes what an array or scan may ask for, such as
samples=2e10,unpacked_bytes=1e10,entries=5000,header_bytes=1e7.
exit code: 0 all measured, 1 something is listed under errors or the result cannot be written,
2 wrong usage, 3 interrupted, 70 a fault of the program"""


def parse(argv: list[str], file_needed: bool = False) -> argparse.Namespace:
    """The options of `measure`; file_needed: where no file can be open.

    Raises SystemExit(2) with a message on the standard error, or SystemExit(0) after --help.
    """
    parser = _parser()
    options = parser.parse_intermixed_args(_join_negative_values(argv))
    if file_needed and not options.files:
        parser.error(str(finding("usage_file_needed")))
    if options.format in ROBOT_FORMATS:
        if len(options.files) > 1:
            parser.error(str(finding("robot_one_file", count=len(options.files))))
        options.frame = "object"  # of the links
    if options.meshes and (options.output is None or output.is_stdout(options.output)):
        parser.error(str(finding("usage_meshes_need_output")))
    if options.surface_moments and options.order is None:
        options.order = DEFAULT_ORDER
    try:
        options.limits = replace(scan_limits(), allow_outside=options.allow_outside)
        for name in ("output", "fourier"):
            _check_target(name, getattr(options, name), parser)
        fourier.check(options, parser)
        _keep_files(options, parser)
    except MeasureError as error:
        parser.error(str(error))
    except OSError as error:  # a name that is too long, a folder that may not be entered
        parser.error(str(finding("usage_path", path=str(error.filename), error=error.strerror)))
    return options


def _check_target(option: str, target: Path | None, parser: argparse.ArgumentParser) -> None:
    """Ends with a message where no file can be written, while nothing is measured yet."""
    if target is None or output.is_stdout(target):
        return
    if not target.parent.is_dir():
        parser.error(str(finding("usage_folder_missing", option=option, folder=str(target.parent))))
    if target.is_dir():
        parser.error(str(finding("usage_is_folder", option=option, path=str(target))))
    with suppress(FileNotFoundError):
        os.stat(target)
    folder = Path(os.path.realpath(target)).parent
    if not (target.exists() and not target.is_file() or os.access(folder, os.W_OK)):
        parser.error(str(finding("usage_folder_read_only", option=option, folder=str(folder))))


def _join_negative_values(argv: list[str]) -> list[str]:
    """With `--origin -1,2,3` as `--origin=-1,2,3`: the parser would take what begins with a minus for an option."""
    joined: list[str] = []
    for word in argv:
        if joined and joined[-1] in {"--origin", "--spacing"} and word[:2].strip("0123456789.") == "-":
            joined[-1] += "=" + word
        else:
            joined.append(word)
    return joined


def _keep_files(options: argparse.Namespace, parser: argparse.ArgumentParser) -> None:
    """Ends with a message where a result would be written over a file that is read, or, without --force, over one that
    is not a result of ours. `options.forced`: those of the targets that --force is about.
    """
    options.forced = []
    # Also the file that is open, whether or not it is measured, and that of the wave vectors.
    read = [path for path in (*options.files, bpy.data.filepath, options.q) if path and os.path.exists(path)]
    replaced = []
    for name in ("output", "fourier"):
        target = getattr(options, name)
        if target is None or not target.exists() or output.is_stdout(target):
            continue
        if any(os.path.samefile(path, target) for path in read):
            parser.error(str(finding("usage_overwrites_input", option=name, path=str(target))))
        try:
            if results.replaceable(target, name):
                continue
            empty = results.is_empty(target)
        except OSError as error:
            parser.error(str(finding("usage_not_replaceable", option=name, path=str(target), error=error.strerror)))
        if not (empty or options.force):
            parser.error(str(finding("usage_foreign_file", option=name, path=str(target))))
        replaced.append((target, name))
        if not empty:
            options.forced.append(target)
    # Opening what is measured takes its time, and only here does it matter what that reads.
    for path in inputs.files_read(options.files) if replaced else ():
        for target, name in replaced:
            if target.samefile(path):
                parser.error(str(finding("usage_overwrites_dependency", option=name, path=str(target))))


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="body_moments",
        usage="body_moments measure [options] [FILE ...]",
        description="Exact mass properties of the objects in files.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("command", choices=("measure",), metavar="measure")
    add("files", nargs="*", metavar="FILE")
    _add_settings(parser)
    _add_of_files(parser)
    _add_results(parser)
    return parser


def _add_settings(parser: argparse.ArgumentParser) -> None:
    """Which objects, and what they are made of."""
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
    add("--kind", choices=("solid", "shell"), help="(each object's setting, or solid)")
    add(
        "--thickness",
        type=_positive,
        metavar="T",
        help="of a shell, in meters (each object's setting)",
    )
    group = parser.add_mutually_exclusive_group()
    group.add_argument("--density", type=_positive, metavar="D", help="kg/m³ (each object's setting, or 1000)")
    group.add_argument("--mass", type=_positive, metavar="M", help="kg, for each object")
    add(
        "--overlap",
        choices=("signed", "union"),
        help="overlapping or nested outward shells: counted as often as they cover a place, or "
        "once (signed, with a warning)",
    )


def _add_of_files(parser: argparse.ArgumentParser) -> None:
    """What files do not say about themselves."""
    add = parser.add_argument
    add(
        "--unit-scale",
        type=_positive,
        metavar="S",
        help="meters per unit in files that carry no unit: .stl, .obj, .ply, arrays (1)",
    )
    add(
        "--spacing",
        type=_spacing,
        metavar="X,Y,Z",
        help="arrays: how far samples are apart (the header's, or 1)",
    )
    add(
        "--origin",
        type=_triple,
        metavar="X,Y,Z",
        help="arrays: where the first sample stands (the header's, or 0)",
    )
    add(
        "--spline-order",
        type=_spline_order,
        metavar="K",
        help="arrays: the samples are the coefficients of a spline of this order: 1 voxels, 2 trilinear, 4 cubic (1)",
    )
    add(
        "--density-scale",
        type=_positive,
        metavar="S",
        help="arrays: kg/m³ where a sample is 1 (1)",
    )
    add(
        "--allow-outside",
        action="store_true",
        help="arrays: the header may name a file of samples outside of its own folder (refused)",
    )


def _add_results(parser: argparse.ArgumentParser) -> None:
    """What is reported, and where it goes."""
    add = parser.add_argument
    add(
        "--frame",
        choices=FRAMES,
        default="world",
        help="of centers, tensors, axes and moments (world)",
    )
    add(
        "--order",
        type=_order,
        metavar="N",
        help="add volume moments up to this order, at most {}, about the frame's origin".format(MAX_ORDER),
    )
    add(
        "--surface-moments",
        action="store_true",
        help="add area moments too (up to --order, or {})".format(DEFAULT_ORDER),
    )
    fourier.add_options(parser, _positive)
    add(
        "--pose",
        action="store_true",
        help="add the pose that is the body's own, and its symmetry",
    )
    add(
        "--signature",
        action="store_true",
        help="add the numbers by which `similar` finds the shape again",
    )
    add(
        "--format",
        type=_format,
        default="json",
        metavar="{" + ",".join(FORMATS) + "}",
        help="(json)",
    )
    add(
        "--inertial-only",
        action="store_true",
        help="urdf, sdf, mjcf, usd: the links with their inertials alone, without geometry, places and joints",
    )
    add(
        "--meshes",
        action="store_true",
        help="urdf, sdf, mjcf: write the meshes that the file names, in a folder beside --output",
    )
    add("--output", type=Path, metavar="PATH", help="(standard output)")
    add(
        "--force",
        action="store_true",
        help="--output and --fourier may replace any file that is not read (only results of body_moments)",
    )
    add(
        "--write",
        action="store_true",
        help="store the results on the objects and save the .blend file, unless something else has saved it meanwhile",
    )


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (0.0 < value < math.inf):
        raise argparse.ArgumentTypeError(str(finding("usage_not_positive", text=text)))
    return value


def _triple(text: str) -> tuple[float, ...]:
    try:
        values = tuple(float(word) for word in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise argparse.ArgumentTypeError(str(finding("usage_not_triple", text=text)))
    return values


def _spacing(text: str) -> tuple[float, ...]:
    values = _triple(text)
    if min(values) <= 0.0:
        raise argparse.ArgumentTypeError(str(finding("usage_not_positive_triple", text=text)))
    return values


def _spline_order(text: str) -> int:
    if text not in {str(order) for order in range(1, MAX_SPLINE_ORDER + 1)}:
        raise argparse.ArgumentTypeError(str(finding("usage_spline_order", text=text, limit=MAX_SPLINE_ORDER)))
    return int(text)


def _order(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = -1
    if value < 0:
        raise argparse.ArgumentTypeError(str(finding("usage_order", text=text, limit=MAX_ORDER)))
    if value > MAX_ORDER:
        raise argparse.ArgumentTypeError(str(finding("usage_order_too_high", text=text, limit=MAX_ORDER)))
    return value


def _format(text: str) -> str:
    if text not in FORMATS:
        raise argparse.ArgumentTypeError(str(finding("usage_format_unknown", text=text, formats=", ".join(FORMATS))))
    return text
