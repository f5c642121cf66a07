# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, kept in memory, and their display in a panel.

The last few objects' moments are kept while the file is open; their keys show when they are out of
date.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from bpy.types import Context, Depsgraph, Object, Scene

from ....core import inertia, verdict
from ....core.moments import Invariant
from ....core.moments.raw import Measure, Moments, monomial_count, monomials
from ... import bodies, write
from ...settings.options import MeasureOptions
from .. import memory
from ..tracking import staleness
from ..tracking.stamps import Kind
from .computed_moments import ComputedMoments, FlatMoments, in_frame, invariants
from .reference import ReferenceChoice

MAX_SHOWN_ORDER = 4  # the highest order whose moments a panel shows one by one
# Moments below this, relative to the largest one of a degree, are shown as 0: they are below the
# digits of any panel, and above the rounding of a sum, 1e-16.
ZERO_DISPLAY_RTOL = 1e-12
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Degree:
    """The moments of one degree in a panel: rows of (label, text, exact value), and their unit."""

    degree: int
    unit: str
    rows: tuple[tuple[str, str, str], ...]


# a panel's degrees, and the reason if there are none
Display = tuple[tuple[Degree, ...], verdict.Finding | None]


def compute_moments(
    context: Context, obj: Object, order: int
) -> tuple[ComputedMoments | None, tuple[verdict.Finding, ...]]:
    """Return the moments of a body, a flat shape or both, and findings; None and none for a wire.
    Raise MeasureError for an object that is neither.
    """
    depsgraph = context.evaluated_depsgraph_get()
    region = None
    flat = None
    not_flat = None
    try:
        region = bodies.flat.region.flat_region(obj, depsgraph)
        flat = FlatMoments(region.moments(order), region.plane)
    except verdict.MeasureError as error:
        not_flat = error
    try:
        measurement = bodies.measure_object.measure_object(
            obj,
            depsgraph,
            MeasureOptions(order=order, surface=True, threads=bodies.measure_body.THREADS),
        )
    except verdict.MeasureError as refusal:
        if not_flat is not None:
            raise bodies.flat.region.clearer_refusal(refusal, not_flat) from None
        measurement = None
    if measurement is None or measurement.length is not None:
        if region is None or flat is None:
            return None, ()
        computed = ComputedMoments(
            obj.name, None, None, None, region.rotation, region.location, flat
        )
        return computed, (
            *region.findings,
            *bodies.flat.region.area_findings(region, flat.moments.total),
        )
    area = measurement.area_moments.truncate(order)
    # A shell has the moments of its area, times the thickness.
    volume = measurement.volume_moments or replace(
        area * measurement.thickness, measure=Measure.VOLUME
    )
    computed = ComputedMoments(
        obj.name,
        volume.truncate(order),
        area,
        measurement.moments_of_mass(order),
        measurement.rotation,
        measurement.location,
        flat,
        not_flat and not_flat.finding,
    )
    return computed, measurement.findings


def cache_moments(obj: Object, computed: ComputedMoments, depsgraph: Depsgraph) -> None:
    """Cache an object's freshly computed moments."""
    memory.moments[obj] = computed
    staleness.carry(obj, Kind.MOMENTS, depsgraph)


def current_numbers(obj: Object, scene: Scene) -> Display:
    """Return the moments displayed by the scene's settings, and the reason if there are none."""
    settings = scene.body_moments
    computed = memory.moments.get(obj)
    if computed is None:
        return (), None
    of = settings.moments_of
    about = settings.moments_about
    order = min(computed.order, MAX_SHOWN_ORDER)
    try:
        if about == "INVARIANT":
            return tuple(_displayed_invariants(invariants(computed, of, order), order)), None
        reference = reference_of(obj, computed, scene) if about == "REFERENCE" else None
        return tuple(
            _displayed_degrees(
                in_frame(computed, of, about, settings.frame, order, reference), of, about
            )
        ), None
    except verdict.MeasureError as error:
        return (), error.finding


def reference_of(obj: Object, computed: ComputedMoments, scene: Scene) -> inertia.Reference:
    """Return the scene's chosen reference, or raise MeasureError if there is none."""
    return ReferenceChoice.from_settings(scene.body_moments_reference).resolve(
        obj, scene, computed.center.tolist()
    )


def _displayed_degrees(moments: Moments, of: str, about: str) -> Iterator[Degree]:
    """Yield the moments by degree, 0 for those within rounding; those of a flat shape have no z."""
    for degree in range(moments.order + 1):
        rows = np.arange(monomial_count(degree - 1), monomial_count(degree))
        if of == "FLAT":
            rows = rows[monomials(degree)[rows, 2] == 0]
        values = moments.raw[rows]
        noise = np.maximum(moments.rounding_error[rows], ZERO_DISPLAY_RTOL * np.abs(values).max())
        texts = [
            write.units.number(0.0 if abs(value) <= least else float(value))
            for value, least in zip(values, noise)
        ]
        cells = zip(
            map(label, monomials(degree)[rows].tolist()),
            texts,
            (repr(float(value)) for value in values),
        )
        yield Degree(degree, unit(of, about, degree), tuple(cells))


def _displayed_invariants(invariants: list[Invariant], order: int) -> Iterator[Degree]:
    """Yield the invariants by degree: Hu's as numbers, higher ones as real and imaginary parts."""
    for degree in range(2, order + 1):
        cells = []
        for invariant in invariants:
            if invariant.degree == degree:
                parts = (
                    (invariant.value.real, invariant.value.imag)
                    if invariant.is_complex
                    else (invariant.value.real,)
                )
                texts = [
                    write.units.number(0.0 if abs(part) <= invariant.rounding_error else part)
                    for part in parts
                ]
                text = " + ".join(texts).replace("+ −", "− ") + " i" * invariant.is_complex
                cells.append((invariant.name, text, " ".join(map(repr, parts))))
        yield Degree(degree, "", tuple(cells))


def label(powers: list[int]) -> str:
    """Return the label of a moment: x²z, or 1."""
    factors = [
        axis + str(power).translate(SUPERSCRIPTS) * (power > 1)
        for axis, power in zip("xyz", powers)
        if power
    ]
    return "".join(factors) or "1"


def unit(of: str, about: str, degree: int) -> str:
    """Return the unit of a moment: m⁵, or nothing for normalized ones."""
    if about in ("NORMALIZED", "INVARIANT"):
        return ""
    if of == "MASS":
        return "kg" + ("·m" + str(degree).translate(SUPERSCRIPTS) * (degree > 1) if degree else "")
    return "m" + str(degree + (3 if of == "VOLUME" else 2)).translate(SUPERSCRIPTS)
