# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of a body that was read from an object: with its frame, fingerprint and accepted findings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.measurement.body import Body
from ...core.measurement.builder import measure_body
from ...core.measurement.measurement import Measurement
from ..read.fingerprint import fingerprint, transform_key
from ..read.reading import Reading
from ..settings.accepted import with_acceptance
from .request import Request


def measurement_of(reading: Reading, body: Body, request: Request) -> Measurement:
    """Return the results of measuring a body, or raise MeasureError if it has no mass or unknown moments."""
    settings = replace(request.settings, varying=body.density_key)
    digested = [moments for moments in (body.volume, body.area, body.mass, body.length) if moments is not None]
    geometry = b"".join([moments.raw.tobytes() for moments in digested])
    transform = "" if request.obj is None else transform_key(request.obj)
    measurement = measure_body(
        body,
        settings,
        findings=tuple(reading.findings),
        name=reading.name,
        type=reading.type,
        rotation=np.asarray(reading.rotation, np.float64),
        location=np.asarray(reading.location, np.float64) * settings.unit,
        fingerprint=fingerprint(geometry, transform, settings.digest),
    )
    accepted = request.accepted
    return replace(measurement, findings=with_acceptance(measurement.findings, accepted)) if accepted else measurement
