# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks before a process measures: options with files as values, limits, and files that results would replace.

Each ends as wrong usage does, with SystemExit(2) and a message.
"""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace

import bpy

from ...blender.settings.limits import scan_limits
from ...core.verdict.finding import MeasureError, finding
from ..files import inputs
from ..findings import USAGE_VALUE
from ..measure import fourier
from . import density as density_options
from . import targets
from .arguments import fail


def check(options: Namespace) -> None:
    """All of it, for a process that measures and writes by itself."""
    targets.check_places(options)
    prepare(options)
    # Also the file that is open, whether or not it is measured, and that of the wave vectors.
    positions = (path for _, path in options.positions or ())
    read = [path for path in (*options.files, bpy.data.filepath, options.q, *positions) if path]
    replaced = targets.files_to_replace(options, read)
    # Opening what is measured takes its time, and only here does it matter what that reads.
    targets.check_dependencies(replaced, inputs.files_read(options.files) if replaced else ())


def prepare(options: Namespace) -> None:
    """Prepare a measurement: set `options.limits` of scans, and `options.waves`, the wave vectors of the transform."""
    try:
        density_options.check(options)
        options.limits = replace(scan_limits(), allow_outside=options.allow_outside)
    except MeasureError as error:
        fail(error)
    try:
        options.waves = fourier.wave_vectors_of(options)
    except MeasureError as error:
        name = "grid" if options.q is None else "q"
        fail(finding(USAGE_VALUE, option=name, cause=error.finding.as_record()))
