# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options for information that files lack, and findings about assumed units and unused options."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterable, Iterator

from ...core.measurement.measurement import Measurement
from ...core.verdict.finding import Finding, finding
from ..files.suffixes import UNITLESS, file_suffix
from ..findings import OPTIONS_UNUSED, UNIT_ASSUMED
from .arguments import words

OF_ARRAYS = ("spacing", "origin", "spline_order", "density_scale", "positions")


def is_unitless(path: str | None) -> bool:
    return path is not None and file_suffix(path) in UNITLESS


def unused(names: Iterable[str]) -> Iterator[Finding]:
    """Yield a finding if there are unused options."""
    if options := words(names):
        yield finding(OPTIONS_UNUSED, options=options)


def file_findings(path: str | None, options: Namespace) -> Iterator[Finding]:
    """Yield findings if the unit of a mesh file was assumed, or options for other kinds of files are unused."""
    names = OF_ARRAYS if is_unitless(path) else (*OF_ARRAYS, "unit_scale")
    if is_unitless(path) and options.unit_scale is None:
        yield finding(UNIT_ASSUMED)
    yield from unused(name for name in names if getattr(options, name) is not None)


def body_findings(options: Namespace, measurement: Measurement) -> Iterator[Finding]:
    """Yield a finding if there are options for other kinds of bodies only."""
    applies = {"thickness": measurement.kind == "shell", "threshold": measurement.type in ("ARRAY", "VOLUME")}
    yield from unused(name for name in applies if getattr(options, name) is not None and not applies[name])
