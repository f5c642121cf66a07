# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of records about floating bodies."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...core.floating import FLOAT_UNAVAILABLE, NO_GRAVITY, float_record, settle
from ...core.measurement import Body, Measurement
from ...core.verdict import Finding, MeasureError
from .entries import Contents, failure

UP = (0.0, 0.0, 1.0)


def floating_entry(
    body: Body,
    measurement: Measurement,
    options: Namespace,
    contents: Contents,
    up: ArrayLike | None = UP,
) -> tuple[dict[str, Any], tuple[Finding, ...]]:
    """Return the entry `floating` of a record, and findings; None, and an error, if the body does
    not float.

    up: against gravity; None without any.
    """
    properties = measurement.mass_properties
    try:
        if up is None:
            raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_GRAVITY)
        rest = settle([body], properties.mass, properties.center, options.float, up)
        angles = np.radians(options.gz or ())
        entry = float_record(rest, measurement, options.frame, angles, rest.body.find_rests([rest]))
        return {"floating": entry}, rest.findings
    except MeasureError as refusal:
        contents.errors.append(failure(measurement.name, refusal.finding))
        return {"floating": None}, ()
