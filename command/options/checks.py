# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks before a process measures: options with files as values, limits, and files that results would replace.

A failed check ends like wrong usage, with SystemExit(2) and a message.
"""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace

from ...blender.settings.limits import scan_limits
from ...core.verdict.finding import MeasureError
from ..parser import UsageError
from . import density as density_options
from . import targets
from .arguments import fail, files_of_options
from .waves import wave_vectors_of


def check(options: Namespace, opened: str | None) -> None:
    """Prepare a measurement and check output files, in a process that both measures and writes.

    opened: the file that this process has open, if any.
    """
    prepare(options)
    targets.check_targets(options, files_of_options(options, options.files, opened))


def prepare(options: Namespace) -> None:
    """Prepare a measurement: set `options.limits` of scans, and `options.waves`, the wave vectors of the transform."""
    try:
        density_options.check(options)
        options.limits = replace(scan_limits(), allow_outside=options.allow_outside)
    except (MeasureError, UsageError) as error:
        fail(str(error))
    try:
        options.waves = wave_vectors_of(options)
    except (MeasureError, UsageError) as error:
        fail("argument --{}: {}".format("grid" if options.q is None else "q", error))
