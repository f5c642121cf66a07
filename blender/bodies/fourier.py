# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of an object, which is read and repaired as for a measurement, or of a flat
one.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import bpy
import numpy as np

from ...core import bodies, flat, measurement, mesh, moments
from ...core.fourier import (
    APPROXIMATE,
    FOURIER_OF_OPEN_SURFACE,
    FOURIER_RTOL,
    BodyTransform,
    FrequencyGrid,
    RegionTransform,
    Spectrum,
)
from ...core.numerics import Array, NDArray
from ...core.verdict import Finding, Procedure, ReadError, finding
from ..read import objects, visibility
from ..read.findings import DISPLAY_MESH_MEASURED
from ..settings.density import density_field
from ..settings.options import MeasureOptions, object_settings
from .findings import (
    FOURIER_APPROXIMATE,
    FOURIER_NO_EXTENT,
    FOURIER_OF_UNIFORM_DENSITY,
)
from .flat.region import area_findings, flat_region
from .mesh import mesh_body


@dataclass(frozen=True)
class ObjectTransform:
    """An object's transform, in SI units: `steps` does the work, `result` gives the outcome.

    findings: as in `Measurement`. factor: the thickness of a shell, else 1. arrays: of a flat
    object, stored beside the spectrum: `axes` of its plane, x and y as rows, and the `origin` of x
    and y, in the world.
    """

    name: str
    transform: BodyTransform | RegionTransform
    findings: tuple[Finding, ...]
    factor: float = 1.0
    arrays: dict[str, Array] | None = None

    def steps(self) -> Generator[float, None, None]:
        """Do the work and yield the fraction done, or raise MeasureError."""
        with bodies.name_subject(self.name):
            yield from self.transform.steps()

    def result(self) -> tuple[Spectrum, tuple[Finding, ...]]:
        """Return the spectrum, and a finding for each decision that was taken."""
        spectrum = self.transform.result().scale(self.factor)
        findings = self.findings
        if spectrum.method == APPROXIMATE:
            findings += (finding(FOURIER_APPROXIMATE, share=FOURIER_RTOL),)
        return spectrum, findings


def object_transform(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    options: MeasureOptions,
    q: NDArray | FrequencyGrid | Callable[[float], FrequencyGrid],
    *,
    frame: str = "world",
    area: bool = False,
) -> ObjectTransform:
    """Return the transform of one evaluated object.

    q: rad/m, (M, 3) or a grid, along the axes of the frame, "world" or "object"; or a function that
    makes a grid from the body's largest extent in m. area: ∫ exp(-i q·x) dA over its faces, in m²;
    else of its body, in m³: ∫ exp(-i q·x) dV of a solid, and thickness times ∫ exp(-i q·x) dA of a
    shell. Raises MeasureError if there is no transform.
    """
    resolved = object_settings(obj, depsgraph.scene, options)
    unit = resolved.unit
    reading = objects.read_object(obj, depsgraph)
    shell = resolved.kind == "shell"
    is_sheet = shell and not area  # its transform is that of its area, times the thickness
    with bodies.name_subject(obj.name):
        body = mesh_body(
            reading, unit, shell=shell, union=resolved.overlap == "union", threads=resolved.threads
        )
        if is_sheet and resolved.wall != "thin":
            raise ReadError(measurement.WALL_UNSUPPORTED, quantity="The Fourier transform")
        if is_sheet and not resolved.thickness > 0.0:
            raise ReadError(measurement.ZERO_QUANTITY, quantity="thickness")
        if area or is_sheet:
            parts = [(part.surface, bodies.to_si(part.matrices, unit)) for part in reading.parts]
            measure = moments.Measure.AREA
            total = body.area.total
        else:
            if resolved.kind == "wire":
                raise ReadError(bodies.WIRE_UNSUPPORTED, quantity="The Fourier transform")
            if body.method.procedure == Procedure.OPEN:
                raise ReadError(FOURIER_OF_OPEN_SURFACE)
            parts = [(solid.repaired_surface, matrices) for solid, matrices in body.solids]
            measure = moments.Measure.VOLUME
            total = body.volume.total
        if frame == "object":
            axes = reading.rotation.T  # the rows are the object's axes in the world
            to_frame = moments.affine_matrices(axes, -axes @ reading.location * unit)
            parts = [(surface, to_frame @ matrices) for surface, matrices in parts]
        frequencies = q(_extent(parts)) if callable(q) else q
        transform = BodyTransform(parts, frequencies, measure, total, resolved.threads)
        varies = not area and density_field(obj.body_moments) is not None
    factor = resolved.thickness if is_sheet else 1.0
    findings = [*reading.findings, *body.findings]
    if reading.has_patches or (obj.type == "CURVE" and shell and visibility.shows_flat_region(obj)):
        findings.append(finding(DISPLAY_MESH_MEASURED, cause="a Fourier transform needs polygons"))
    if varies:
        findings.append(finding(FOURIER_OF_UNIFORM_DENSITY))
    return ObjectTransform(obj.name, transform, tuple(findings), factor)


def flat_transform(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    q: NDArray | FrequencyGrid | Callable[[float], FrequencyGrid],
    *,
    frame: str = "world",
    unit: float | None = None,
) -> ObjectTransform:
    """Return the transform ∫ exp(-i q·x) dA, in m², of the polygons that Blender draws of a flat
    object.

    `q` is (M, 2) or a grid, rad/m along the plane's x and y, or a function that makes a grid from
    the region's largest extent, m. x and y are counted from the foot of the origin of `frame`,
    "world" or "object". `unit` is in meters per Blender unit. Raise MeasureError if the object is
    not flat, has outlines that cross, or encloses nothing.
    """
    region = flat_region(obj, depsgraph, selected=False, exact=False, unit=unit)
    findings = (*region.findings, *area_findings(region, region.moments(1).total))
    plane = region.plane
    # The foot is a (3,) point in the plane's axes, relative to the plane's origin.
    foot = flat.foot(plane, np.zeros(3) if frame == "world" else region.location)
    origin = plane.origin + plane.axes @ foot
    frequencies = q(float(np.ptp(region.used, axis=0).max())) if callable(q) else q
    transform = RegionTransform(
        region.points - foot[:2], region.edges, frequencies, region.rounded, region.stored
    )
    return ObjectTransform(
        obj.name, transform, findings, arrays={"axes": plane.axes[:, :2].T, "origin": origin}
    )


def _extent(parts: list[tuple[mesh.Surface, NDArray]]) -> float:
    """Return the longest side, in m, of the box around all parts, or raise ReadError if it is 0.
    parts: surfaces with their (k, 4, 4) maps to m.
    """
    low = np.full(3, np.inf)
    high = np.full(3, -np.inf)
    for surface, matrices in parts:
        center, extent = moments.placed_boxes(surface.box, matrices)
        low = np.minimum(low, (center - extent).min(axis=0))
        high = np.maximum(high, (center + extent).max(axis=0))
    size = float((high - low).max())
    if not 0.0 < size < np.inf:
        raise ReadError(FOURIER_NO_EXTENT)
    return size
