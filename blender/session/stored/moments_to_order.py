# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All moments of an object to a chosen order, computed for the panel."""

from __future__ import annotations

from dataclasses import replace

from bpy.types import Context, Object

from ....core.moments.moments import Measure
from ....core.verdict.finding import Finding, MeasureError
from ...bodies.flat.flat import area_findings, clearer_refusal, flat_region
from ...bodies.measure_object import THREADS, measure_object
from ...settings.options import MeasureOptions
from .moments import ComputedMoments, FlatMoments


def compute_moments(context: Context, obj: Object, order: int) -> tuple[ComputedMoments | None, tuple[Finding, ...]]:
    """Return the moments of a body, of a flat shape, or of both, or None for a wire that bounds nothing.

    Raises MeasureError if the object is neither.
    """
    depsgraph = context.evaluated_depsgraph_get()
    region, flat, not_flat = None, None, None
    try:
        region = flat_region(obj, depsgraph)
        flat = FlatMoments(region.moments(order), region.plane)
    except MeasureError as error:
        not_flat = error
    try:
        measurement = measure_object(obj, depsgraph, MeasureOptions(order=order, surface=True, threads=THREADS))
    except MeasureError as refusal:
        if not_flat is not None:
            raise clearer_refusal(refusal, not_flat) from None
        measurement = None
    if measurement is None or measurement.length is not None:
        if region is None or flat is None:
            return None, ()
        computed = ComputedMoments(obj.name, None, None, None, region.rotation, region.location, flat)
        return computed, (*region.findings, *area_findings(region, flat.moments.total))
    area = measurement.area_moments.truncate(order)
    volume = (measurement.volume_moments or replace(area * measurement.thickness, measure=Measure.VOLUME)).truncate(
        order
    )
    mass = measurement.moments_of_mass(order)
    computed = ComputedMoments(
        obj.name,
        volume,
        area,
        mass,
        measurement.rotation,
        measurement.location,
        flat,
        not_flat and not_flat.finding,
    )
    return computed, measurement.findings
