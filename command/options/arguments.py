# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of `measure`, and checks of their combination: invalid ones end with exit code 2.

Standard library only: the process that supervises others may have neither numpy nor Blender. Options that need these
are checked in `checks.py`, by the process that measures.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, NoReturn

from ...core.robots.formats import FORMATS as ROBOT_FORMATS
from ...core.verdict.finding import finding
from ..findings import (
    ROBOT_ONE_FILE,
    USAGE_FILE_NEEDED,
    USAGE_FOURIER_ONE_OBJECT,
    USAGE_FOURIER_POINTS,
    USAGE_GRID_AND_QMAX,
    USAGE_LINKS_OF_BONES,
    USAGE_NEEDS_FOURIER,
    USAGE_NEEDS_SUPERVISOR,
    USAGE_PATH_TWICE,
    USAGE_POSITIONS_TWICE,
    USAGE_RESUME_OUTPUT,
    USAGE_TEXT_FORMAT,
)
from .measure_parser import DEFAULT_ORDER, measure_parser

TARGETS = ("output", "fourier")  # options whose files are written

# These options change no number: two runs that differ in these alone have the same records.
_OF_RUNS = {
    *("command", "files", "format", "output", "force", "forced", "jobs", "timeout", "memory_mb", "range", "manifest"),
    *("resume", "no_supervisor", "blender", "errors_exit_0"),
}
_PATHS = ("output", "fourier", "q", "manifest")
_TRIPLES = ("spacing", "origin", "about")


def parse(argv: list[str], file_needed: bool = False) -> argparse.Namespace:
    """Parse the options of `measure`; file_needed: no file can be open.

    Raises SystemExit(2) with a message on the standard error, or SystemExit(0) after --help.
    """
    parser = measure_parser()
    options = parser.parse_intermixed_args(join_negative_values(argv))
    has_files = bool(options.files or options.manifest)
    if file_needed and not has_files:
        fail(finding(USAGE_FILE_NEEDED))
    if options.format in ROBOT_FORMATS:
        if len(options.files) > 1:
            fail(finding(ROBOT_ONE_FILE, count=len(options.files)))
        options.frame = "object"  # frame of the links
        of_bodies = ("density", "mass", "material", "kind", "thickness", "wall", "overlap")
        given = [name for name in of_bodies if getattr(options, name) is not None]
        if options.links == "bone" and given:
            fail(finding(USAGE_LINKS_OF_BONES, option=given[0]))
        binary = ROBOT_FORMATS[options.format].binary_suffixes
        if options.output is not None and options.output.suffix.lower() in binary:
            fail(finding(USAGE_TEXT_FORMAT, format=options.format))
    if options.surface_moments and options.order is None:
        options.order = DEFAULT_ORDER
    if options.no_supervisor or not has_files:
        for name in ("jobs", "memory_mb", "timeout", "blender"):
            if getattr(options, name) is not None:
                fail(finding(USAGE_NEEDS_SUPERVISOR, option=name.replace("_", "-")))
        if options.resume:
            fail(finding(USAGE_NEEDS_SUPERVISOR, option="resume"))
    if options.resume and options.output is None:
        fail(finding(USAGE_RESUME_OUTPUT))
    _check_fourier(options)
    axes = [axis for axis, _ in options.positions or ()]
    if len(set(axes)) < len(axes):
        fail(finding(USAGE_POSITIONS_TWICE, axes=axes))
    options.forced = []
    return options


def fail(reason: object) -> NoReturn:
    """End as for any wrong usage: SystemExit(2), with a message on the standard error."""
    measure_parser().error(str(reason))


def as_record(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options as plain values for JSON, without the files, to be read by `from_record`."""
    kept = {name: value for name, value in vars(options).items() if name not in ("files", "manifest")}
    kept["forced"] = [str(path) for path in options.forced]
    return {name: str(value) if isinstance(value, Path) else value for name, value in kept.items()}


def from_record(record: dict[str, Any]) -> argparse.Namespace:
    """Return the options that `as_record` has made plain."""
    options = argparse.Namespace(**{**record, "files": [], "manifest": None})
    for name in _PATHS:
        if getattr(options, name) is not None:
            setattr(options, name, Path(getattr(options, name)))
    options.forced = [Path(path) for path in options.forced]
    for name in _TRIPLES:
        if isinstance(getattr(options, name), list):
            setattr(options, name, tuple(getattr(options, name)))
    return options


def of_numbers(options: argparse.Namespace) -> dict[str, Any]:
    """Return the options that change measurements."""
    more = {"format": options.format} if options.format in ROBOT_FORMATS else {}
    return {name: value for name, value in as_record(options).items() if name not in _OF_RUNS} | more


def _check_fourier(options: argparse.Namespace) -> None:
    """End with a message if the options of the transform do not go together."""
    target = options.fourier
    if target is None:
        for name in ("q", "grid", "qmax"):
            if getattr(options, name) is not None:
                fail(finding(USAGE_NEEDS_FOURIER, option=name))
        return
    if (options.q is None) == (options.grid is None):
        fail(finding(USAGE_FOURIER_POINTS))
    if (options.grid is None) != (options.qmax is None):
        fail(finding(USAGE_GRID_AND_QMAX))
    if len(options.files) > 1 or len(options.object or ()) > 1:
        fail(finding(USAGE_FOURIER_ONE_OBJECT))
    for first, second in ((target, options.q), (target, options.output), (options.output, options.q)):
        if first is not None and second is not None and first.resolve() == second.resolve():
            fail(finding(USAGE_PATH_TWICE, path=str(first)))


def join_negative_values(argv: list[str]) -> list[str]:
    """Join `--origin -1,2,3` into `--origin=-1,2,3`: the parser would take a value with a minus for an option."""
    joined: list[str] = []
    for word in argv:
        if joined and joined[-1] in {"--origin", "--spacing", "--about"} and word[:2].strip("0123456789.") == "-":
            joined[-1] += "=" + word
        else:
            joined.append(word)
    return joined
