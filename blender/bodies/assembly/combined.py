# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several bodies as one: the results of an assembly, of a bone's part, of a whole character."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ....core.measurement.measurement import Measurement
from ....core.moments.exponents import KNOWN_ORDER
from ....core.moments.moments import Measure, Moments, monomial_count
from ....core.verdict.finding import Finding, finding
from ....core.verdict.health import MeshHealth
from ....core.verdict.method import Method, Verdict
from ..findings import DENSITY_FROM_MEMBERS
from .given import properties_of


def combined_measurement(
    *,
    name: str,
    type: str,
    kind: str,
    mass: Moments,
    volume: tuple[float, float],
    area: tuple[float, float],
    inputs: tuple[float, float],
    rotation: NDArray[np.float64],
    location: NDArray[np.float64],
    fingerprint: str,
    findings: Sequence[Finding],
    method: Method = Method(Verdict.ASSEMBLY),  # noqa: B008 frozen
    density_from: Finding = finding(DENSITY_FROM_MEMBERS),  # noqa: B008 frozen
    health: MeshHealth | None = None,
) -> Measurement:
    """Return the results of bodies whose mass moments have been added: `mass`, kg to third order, SI, world axes.

    `volume`, m³, and `area`, m², come with the bounds of their rounding; `inputs` bound the effect of float32
    coordinates on both. `rotation` (3, 3) and `location` (3,), m, are the frame in which the results are stored.
    Raise MeasureError if no mass is certain, or if the second moments are impossible for a body.
    """
    properties = properties_of(mass, rotation)
    nothing = np.zeros(monomial_count(KNOWN_ORDER) - 1)
    rounding, moved = properties.rounding_error, properties.input_error
    return Measurement(
        name=name,
        type=type,
        kind=kind,
        method=method,
        density=mass.total / volume[0] if volume[0] > 0.0 else 0.0,
        thickness=0.0,
        volume=volume[0],
        area=area[0],
        mass_properties=properties,
        volume_moments=Moments(np.r_[volume[0], nothing], mass.about, Measure.VOLUME),
        area_moments=Moments(np.r_[area[0], nothing], mass.about, Measure.AREA),
        mass_moments=(mass, 1.0),
        health=health or MeshHealth(closed=False, components=0),
        findings=tuple(findings),
        rotation=rotation,
        location=location,
        error_bound={
            "volume": volume[1],
            "area": area[1],
            "center_of_mass": rounding["center"],
            "inertia": rounding["inertia"],
            "input": {
                "volume": inputs[0],
                "area": inputs[1],
                "center_of_mass": moved["center"],
                "inertia": moved["inertia"],
            },
        },
        fingerprint=fingerprint,
        density_from=density_from,
    )
