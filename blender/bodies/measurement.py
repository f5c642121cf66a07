# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of a body that was read from an object: with its transform and accepted findings."""

from __future__ import annotations

from dataclasses import replace

from ...core.bodies.measure import measure_reading
from ...core.bodies.reading import Reading
from ...core.measurement.body import Body
from ...core.measurement.measurement import Measurement
from ..read.fingerprint import transform_key
from ..settings.accepted import with_acceptance
from .request import Request


def measurement_of(reading: Reading, body: Body, request: Request) -> Measurement:
    """Return the results of measuring a body, or raise MeasureError if it has no mass or unknown moments."""
    transform = "" if request.obj is None else transform_key(request.obj)
    measurement = measure_reading(reading, body, request.settings, transform)
    accepted = request.accepted
    return replace(measurement, findings=with_acceptance(measurement.findings, accepted)) if accepted else measurement
