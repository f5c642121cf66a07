# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Options for information missing in files, and findings about missing and unused ones."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator

from ...core.measurement.measurement import Measurement
from ...core.verdict.finding import Finding, finding
from ..files.files import UNITLESS, file_suffix
from ..findings import (
    ARRAY_OPTIONS_UNUSED,
    THICKNESS_OPTION_UNUSED,
    THRESHOLD_OPTION_UNUSED,
    UNIT_ASSUMED,
    UNIT_SCALE_OPTION_UNUSED,
)

OF_ARRAYS = ("spacing", "origin", "spline_order", "density_scale", "positions")


def is_unitless(path: str | None) -> bool:
    return path is not None and file_suffix(path) in UNITLESS


def unit_findings(path: str | None, scale: float | None) -> Iterator[Finding]:
    """Yield a finding if the file's unit was assumed, or the option for it was unused."""
    unitless = is_unitless(path)
    if unitless and scale is None:
        yield finding(UNIT_ASSUMED)
    elif not unitless and scale is not None:
        yield finding(UNIT_SCALE_OPTION_UNUSED)


def unused_array_options(options: Namespace) -> Iterator[Finding]:
    """Yield a finding about given options that apply to arrays only, for a file that is no array."""
    given = [name for name in OF_ARRAYS if getattr(options, name) is not None]
    if given:
        yield finding(ARRAY_OPTIONS_UNUSED, options=["--" + name.replace("_", "-") for name in given])


def unused_options(options: Namespace, measurement: Measurement) -> Iterator[Finding]:
    """Yield findings about given options that apply to other kinds of bodies only."""
    if options.thickness is not None and measurement.kind != "shell":
        yield finding(THICKNESS_OPTION_UNUSED)
    if options.threshold is not None and measurement.type not in ("ARRAY", "VOLUME"):
        yield finding(THRESHOLD_OPTION_UNUSED)
