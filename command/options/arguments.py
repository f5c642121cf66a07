# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of `measure`, and checks of their combination: invalid ones end with exit code 2.

Standard library only: the process that supervises others may have neither numpy nor Blender.
Options that need these are checked in `checks.py`, by the process that measures.
"""

import argparse
import functools
import os
import pkgutil
import re
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NoReturn

from ...core import robots, scans
from ..supervisor import listing, processes
from .measure_parser import DEFAULT_ORDER, measure_parser

TARGETS = ("output", "fourier", "write_baseline")  # options whose files are written

# These options change no number: two runs that differ in these alone have the same records.
_OF_RUNS = {
    *(
        "command",
        "files",
        "format",
        "output",
        "force",
        "jobs",
        "timeout",
        "memory_mb",
        "range",
        "part",
        "manifest",
    ),
    *("resume", "retry_failed", "no_supervisor", "blender", "errors_exit_0", "words"),
}
_ROOT = __name__.removesuffix(".command.options.arguments")
ONE_FILE = "argument --format: {} takes one FILE, as a robot is one file"
ONE_OBJECT = "argument --fourier: takes one object of one FILE"
NEEDS_BLENDER = "{} Blender: add --blender PATH, or install the bpy module"
RIM = "rim"
_OF_POLYGONS = ("wall", "print", "below", "against", "float", "thumbnails")
_OF_OBJECTS = ("polynomial", "density_from", "fourier", "flat", "pose", "signature")


def parse(argv: list[str], file_needed: bool = False) -> argparse.Namespace:
    """Parse the options of `measure`, and keep the words for children. file_needed: True if no file
    can be open.

    Raises SystemExit(2) after a message on the standard error, or HelpRequested.
    """
    parser = measure_parser()
    options = parser.parse_intermixed_args(join_negative_values(name_frames(argv)))
    options.words = argv
    options.resume |= options.retry_failed
    if options.format in robots.FORMATS:
        options.frame = "object"  # frame of the links
    if options.surface_moments and options.order is None:
        options.order = DEFAULT_ORDER
    for is_wrong, reason in (*_rules(options, file_needed), *_fourier_rules(options)):
        if is_wrong:
            fail(reason)
    return options


def _rules(options: argparse.Namespace, file_needed: bool) -> Iterator[tuple[bool, str]]:
    """Yield faults of the options: whether each is there, and its message. file_needed: as of
    `parse`.
    """
    has_files = bool(options.files or options.manifest)
    yield file_needed and not has_files, "a FILE is needed"
    robot_format = robots.FORMATS.get(options.format)
    if robot_format is not None:
        yield len(options.files) > 1, ONE_FILE.format(options.format)
        bone_text = "--links bone takes what the bones' settings say, and no --{}"
        for name in ("kind", "thickness", "wall", "overlap"):
            is_given = getattr(options, name) is not None
            yield options.links == "bone" and is_given, bone_text.format(name)
        binary_text = "argument --output: {} is written as text. Use .gltf, .usd or .usda"
        suffix = "" if options.output is None else options.output.suffix.lower()
        yield suffix in robot_format.binary_suffixes, binary_text.format(options.format)
    alone_text = "argument --{}: applies to FILEs that are measured by other processes"
    is_alone = options.no_supervisor or not has_files
    for name in ("jobs", "memory_mb", "timeout", "blender", "resume"):
        yield is_alone and bool(getattr(options, name)), alone_text.format(name.replace("_", "-"))
    is_stored = options.write or options.asset_metadata
    axes = [axis for axis, _ in options.positions or ()]
    yield from (
        (
            options.part is not None and options.manifest is None,
            "argument --part: needs the --manifest whose part it is",
        ),
        (
            options.at_frame is not None and is_stored,
            "argument --at-frame: a file keeps only results at its own frame",
        ),
        (
            options.resume and options.output is None,
            "argument --resume: needs the --output of the run to go on with",
        ),
        (
            options.gz is not None and options.float is None,
            "argument --gz: needs --float LIQUID",
        ),
        (
            options.label is not None and options.threshold is not None,
            "arguments --label and --threshold exclude each other",
        ),
        (
            options.label_table is not None and options.label is None,
            "argument --label-table: needs --label N or --label all",
        ),
        (
            len({*axes}) < len(axes),
            "--positions names an axis twice: {}".format(", ".join(axes)),
        ),
    )


def _fourier_rules(options: argparse.Namespace) -> Iterator[tuple[bool, str]]:
    if options.fourier is None:
        for name in ("q", "grid", "qmax"):
            is_given = getattr(options, name) is not None
            yield is_given, "argument --{}: needs --fourier OUT.npz".format(name)
        return
    paths = [path for path in (options.fourier, options.output, options.q) if path is not None]
    files = [*map(os.path.realpath, paths)]
    twice = [path for path, file in zip(paths, files) if files.count(file) > 1]
    yield from (
        (
            (options.q is None) == (options.grid is None),
            "argument --fourier: needs either --q Q.npy, or --grid N and --qmax Q",
        ),
        (
            (options.grid is None) != (options.qmax is None),
            "arguments --grid and --qmax must be used together",
        ),
        (len(options.files) > 1 or len(options.object or ()) > 1, ONE_OBJECT),
        (bool(twice), "argument --fourier: {} is used twice".format(*twice[:1] or [""])),
    )


def fail(reason: str) -> NoReturn:
    """Print the reason with the usage to the standard error, and raise SystemExit(2)."""
    measure_parser().error(reason)


def words(names: Iterable[str]) -> list[str]:
    """Return the options as they are written, such as “--unit-scale”."""
    return ["--" + name.replace("_", "-") for name in names]


def of_numbers(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options that influence records by name, as JSON would return them. The format does
    for robots, whose text is in the documents.
    """
    names = _defaults().keys() - _OF_RUNS | (
        {"format"} if options.format in robots.FORMATS else set()
    )
    return {name: _as_json(getattr(options, name)) for name in sorted(names)}


def run_of(options: argparse.Namespace) -> dict[str, Any]:
    """Return the entry `run` of documents: the add-on's version and the given options that
    influence records.
    """
    given_options = {
        name: value for name, value in of_numbers(options).items() if value != _defaults()[name]
    }
    return {"addon": version(), "options": dict(zip(words(given_options), given_options.values()))}


@functools.cache
def _defaults() -> dict[str, Any]:
    return vars(measure_parser().parse_args(["measure"]))


def _as_json(value: Any) -> Any:
    """Return the value of an option as JSON would return it."""
    if isinstance(value, (list, tuple)):
        return [*map(_as_json, value)]
    return str(value) if isinstance(value, Path) else value


@functools.cache
def version() -> str:
    manifest = pkgutil.get_data(_ROOT, "blender_manifest.toml")
    return tomllib.loads(manifest.decode())["version"] if manifest else ""


def files_of_options(
    options: argparse.Namespace, files: Iterable[str], opened: str | None
) -> list[str | Path]:
    """Return the files that a run reads: measured files, the open file, and files that options
    name.
    """
    positions = (path for _, path in options.positions or ())
    paths_in_options = options.q, options.label_table
    return [path for path in (*files, opened, *paths_in_options, *positions) if path]


def name_frames(argv: list[str]) -> list[str]:
    """Return the words with `--at-frame` in place of each `--frame` that has a number: with a word,
    it names axes.
    """
    renamed = list(argv)
    for number, word in enumerate(argv):
        option, equals, value = word.partition("=")
        value = value if equals else "".join(argv[number + 1 : number + 2])
        if option == "--frame" and re.fullmatch(r"[+-]?\.?\d\S*", value):
            renamed[number] = "--at-frame" + word.removeprefix("--frame")
    return renamed


def join_negative_values(argv: list[str]) -> list[str]:
    """Join `--origin -1,2,3` into `--origin=-1,2,3`: the parser would take a value with a minus for
    an option.
    """
    joined: list[str] = []
    for word in argv:
        # A value is a minus, and a digit or a point.
        if (
            joined
            and joined[-1] in {"--origin", "--spacing", "--about", "--below", "--against"}
            and word[:2].strip("0123456789.") == "-"
        ):
            joined[-1] += "=" + word
        else:
            joined.append(word)
    return joined


def options_of_blender(options: argparse.Namespace, is_scan: bool) -> list[str]:
    """Return the given options for which a mesh, or a scan, has to be an object in Blender."""
    robot_option = ["format"] * (options.format in robots.FORMATS)
    if is_scan:
        return robot_option
    names_object = isinstance(options.against, str) and options.against != RIM
    return [
        *(name for name in _OF_OBJECTS if getattr(options, name)),
        *["against"] * names_object,
        *boolean_and_wire(options),
        *robot_option,
    ]


def options_of_polygons(options: argparse.Namespace) -> list[str]:
    """Return the given options for which a body of a CAD file has to be an object in Blender."""
    values = {name: getattr(options, name) for name in _OF_POLYGONS}
    return [
        *options_of_blender(options, False),
        *(name for name, value in values.items() if value not in (None, False, "thin")),
        *["kind"] * (options.kind == "printed"),
    ]


def boolean_and_wire(options: argparse.Namespace) -> list[str]:
    """Return the given ones of the options --overlap union and --kind wire."""
    return ["overlap"] * (options.overlap == "union") + ["kind"] * (options.kind == "wire")


def check_blender(options: argparse.Namespace, paths: Sequence[str]) -> None:
    """End with a message if a file or an option needs Blender, and there is none."""
    if processes.has_blender():
        return
    for path in paths:
        is_scan = bool(scans.scan_suffix(path))
        suffix = Path(path).suffix.lower()
        given_options = words(
            options_of_polygons(options)
            if suffix in listing.CAD
            else options_of_blender(options, is_scan)
        )
        if given_options or not (is_scan or suffix in (*listing.UNITLESS, *listing.CAD)):
            subject = ", ".join(given_options) if given_options else "“{}”".format(path)
            fail(NEEDS_BLENDER.format(subject + (" need" if len(given_options) > 1 else " needs")))
