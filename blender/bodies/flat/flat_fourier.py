# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of a flat object in its own plane, of the polygons that Blender draws."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.flat.section import foot
from ....core.fourier.polygon import RegionTransform
from ....core.fourier.spectrum import Spectrum
from ....core.fourier.wave_vectors import FrequencyGrid
from ....core.verdict.finding import Finding
from .flat import area_findings, flat_region


@dataclass(frozen=True)
class FlatTransform:
    """A flat object's transform, in SI units: `steps` does the work, `result` gives the outcome.

    arrays: stored beside the spectrum: `axes` of the plane, x and y as rows, and the `origin` of x and y, in the world.
    """

    name: str
    transform: RegionTransform
    arrays: dict[str, NDArray[np.float64]]
    findings: tuple[Finding, ...]

    def steps(self) -> Iterator[float]:
        """Do the work; yield the fraction done."""
        return self.transform.steps()

    def result(self) -> tuple[Spectrum, tuple[Finding, ...]]:
        """Return the spectrum, and a finding for each decision that was taken."""
        return self.transform.result(), self.findings


def flat_transform(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    q: NDArray | FrequencyGrid | Callable[[float], FrequencyGrid],
    *,
    frame: str = "world",
    unit: float | None = None,
) -> FlatTransform:
    """Return the transform ∫ exp(-i q·x) dA of a flat object, in m².

    `q` is (M, 2) or a grid, rad/m along the plane's x and y, or a function that makes a grid from the region's largest
    extent, m. x and y are counted from the foot of the origin of `frame`, "world" or "object". `unit` is in meters per
    Blender unit. Raise MeasureError if the object is not flat, has outlines that cross, or encloses nothing.
    """
    region = flat_region(obj, depsgraph, selected=False, exact=False, unit=unit)
    findings = (*region.findings, *area_findings(region, region.moments(1).total))
    plane = region.plane
    at = foot(plane, np.zeros(3) if frame == "world" else region.location)
    origin = plane.origin + plane.axes @ at
    if callable(q):
        q = q(float(np.ptp(region.used, axis=0).max()))
    transform = RegionTransform(region.points - at[:2], region.edges, q, region.rounded, region.stored)
    return FlatTransform(obj.name, transform, {"axes": plane.axes[:, :2].T, "origin": origin}, findings)
