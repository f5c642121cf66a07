# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of a body with the frame and the name of its reading."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..measurement.body import Body
from ..measurement.builder import measure_body
from ..measurement.measurement import Measurement
from ..measurement.settings import Settings, fingerprint
from .reading import Reading


def measure_reading(reading: Reading, body: Body, settings: Settings, transform: str = "") -> Measurement:
    """Return the results of measuring a body, or raise MeasureError if it has no mass or unknown moments.

    transform: the key of the object's transform in the fingerprint.
    """
    settings = replace(settings, varying=body.density_key)
    digested = [moments for moments in (body.volume, body.area, body.mass, body.length) if moments is not None]
    geometry = b"".join([moments.raw.tobytes() for moments in digested])
    return measure_body(
        body,
        settings,
        findings=tuple(reading.findings),
        name=reading.name,
        type=reading.type,
        rotation=np.asarray(reading.rotation, np.float64),
        location=np.asarray(reading.location, np.float64) * settings.unit,
        fingerprint=fingerprint(geometry, transform, settings.digest),
    )
