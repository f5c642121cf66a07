# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of records about floating bodies."""

from argparse import Namespace
from collections.abc import Callable
from typing import Any

import numpy as np

from ...core.floating import Flotation, float_record
from ...core.measurement import Measurement
from ...core.verdict import Finding, MeasureError
from .entries import Contents, failure


def floating_entry(
    settle: Callable[[], Flotation],
    measurement: Measurement,
    options: Namespace,
    contents: Contents,
) -> tuple[dict[str, Any], tuple[Finding, ...]]:
    """Return the entry `floating` of a record, and findings; None, and an error, if the body does
    not float.

    settle: returns its position of rest. measurement: its axes are those of heel and trim.
    """
    try:
        rest = settle()
        angles = np.radians(options.gz or ())
        entry = float_record(rest, measurement, options.frame, angles, rest.body.find_rests([rest]))
        return {"floating": entry}, rest.findings
    except MeasureError as refusal:
        contents.errors.append(failure(measurement.name, refusal.finding))
        return {"floating": None}, ()
