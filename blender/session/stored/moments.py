# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, kept in memory, and their display in a panel and on the clipboard.

The last few objects' moments are kept while the file is open; their keys show when they are out of
date.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from bpy.types import Context, Depsgraph, Object, Scene
from numpy.typing import NDArray

from ....core.flat.polygon import plane_positions
from ....core.flat.section import foot
from ....core.flat.section_properties import Plane
from ....core.inertia.findings import MOMENTS_OVERFLOW
from ....core.inertia.plain_body import Reference
from ....core.measurement.plain_text import visible
from ....core.moments.complex_form import Invariant, flusser_invariants, hu_invariants, normalize
from ....core.moments.moments import Measure, Moments, monomial_count, monomials
from ....core.polyhedron.n_dimensions import multi_indices
from ....core.verdict.finding import Finding, MeasureError, ReadError
from ...bodies.flat.flat import area_findings, clearer_refusal, flat_region
from ...bodies.measure_object import THREADS, measure_object
from ...read.fingerprint import matrix_hash, settings_hash
from ...settings.options import MeasureOptions
from ...write.units import number
from .. import memory
from ..findings import INVARIANTS_ORDER, MASS_MOMENTS_UNKNOWN, MOMENTS_OF_AREA_ONLY
from ..tracking import staleness, stamps
from ..tracking.stamps import Kind, Stamp
from .reference import ReferenceChoice

MAX_SHOWN_ORDER = 4  # the highest order whose moments a panel shows one by one
HU_ORDER = 3  # order of Hu's invariants
ZERO_DISPLAY_RTOL = 1e-12  # relative to the largest moment of a degree: shown as 0
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True, eq=False)
class FlatMoments:
    """The moments of a flat shape, SI, along the axes of its plane about the plane's origin."""

    moments: Moments
    plane: Plane


@dataclass(frozen=True, eq=False)
class ComputedMoments:
    """One object's moments, SI, world axes.

    volume: for a shell, area times thickness; None for flat shapes, like `area`. mass: None if the
    moments of the mass are not known to this order. rotation, location: the object frame. flat: the
    moments of a flat shape. not_flat: the reason if there are none.
    """

    name: str
    volume: Moments | None
    area: Moments | None
    mass: Moments | None
    rotation: NDArray[np.float64]
    location: NDArray[np.float64]
    flat: FlatMoments | None = None
    not_flat: Finding | None = None

    @property
    def order(self) -> int:
        return self.known.order

    @property
    def known(self) -> Moments:
        """The moments of the volume, or of the flat shape if there is no volume."""
        if self.volume is not None:
            return self.volume
        assert self.flat is not None
        return self.flat.moments

    @property
    def center(self) -> NDArray[np.float64]:
        """The (3,) center of the volume, or of the flat shape, in the world."""
        if self.volume is not None:
            return self.volume.center
        assert self.flat is not None
        return self.flat.plane.origin + self.flat.plane.axes @ self.flat.moments.center


@dataclass(frozen=True)
class Degree:
    """The moments of one degree in a panel: rows of (label, text, exact value), and their unit."""

    degree: int
    unit: str
    rows: tuple[tuple[str, str, str], ...]


Display = tuple[
    tuple[Degree, ...], Finding | None
]  # a panel's degrees, and the reason if there are none


def compute_moments(
    context: Context, obj: Object, order: int
) -> tuple[ComputedMoments | None, tuple[Finding, ...]]:
    """Return the moments of a body, a flat shape or both (None for a wire), and findings."""
    depsgraph = context.evaluated_depsgraph_get()
    region = None
    flat = None
    not_flat = None
    try:
        region = flat_region(obj, depsgraph)
        flat = FlatMoments(region.moments(order), region.plane)
    except MeasureError as error:
        not_flat = error
    try:
        measurement = measure_object(
            obj, depsgraph, MeasureOptions(order=order, surface=True, threads=THREADS)
        )
    except MeasureError as refusal:
        if not_flat is not None:
            raise clearer_refusal(refusal, not_flat) from None
        measurement = None
    if measurement is None or measurement.length is not None:
        if region is None or flat is None:
            return None, ()
        computed = ComputedMoments(
            obj.name, None, None, None, region.rotation, region.location, flat
        )
        return computed, (*region.findings, *area_findings(region, flat.moments.total))
    area = measurement.area_moments.truncate(order)
    volume = measurement.volume_moments or replace(
        area * measurement.thickness, measure=Measure.VOLUME
    )
    known = volume.truncate(order), area, measurement.moments_of_mass(order)
    place = measurement.rotation, measurement.location
    return ComputedMoments(
        obj.name, *known, *place, flat, not_flat and not_flat.finding
    ), measurement.findings


def cache_moments(obj: Object, computed: ComputedMoments, depsgraph: Depsgraph) -> None:
    """Cache an object's freshly computed moments."""
    memory.moments[obj] = computed
    settings = settings_hash(obj, depsgraph.scene)
    stamp = stamps.carry(obj, Kind.MOMENTS, memory.state.updates, matrix_hash(obj), settings)
    staleness.mark_stamp(obj, stamp, depsgraph)


def computed_moments(obj: Object) -> ComputedMoments | None:
    """Return an object's computed moments; None if there are none."""
    return memory.moments.get(obj)


def stamp_of(obj: Object) -> Stamp | None:
    """Return the stamp of an object's computed moments."""
    return stamps.carried(obj, Kind.MOMENTS)


def current_numbers(obj: Object, scene: Scene) -> Display:
    """Return the moments displayed by the scene's settings, and the reason if there are none."""
    settings = scene.body_moments
    computed = computed_moments(obj)
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
    except MeasureError as error:
        return (), error.finding


def reference_of(obj: Object, computed: ComputedMoments, scene: Scene) -> Reference:
    """Return the scene's chosen reference, or raise MeasureError if there is none."""
    return ReferenceChoice.from_settings(scene.body_moments_reference).resolve(
        obj, scene, computed.center.tolist()
    )


def _displayed_degrees(moments: Moments, of: str, about: str) -> Iterator[Degree]:
    for degree in range(moments.order + 1):
        part = np.arange(monomial_count(degree - 1), monomial_count(degree))
        if of == "FLAT":
            part = part[monomials(degree)[part, 2] == 0]
        values = moments.raw[part]
        noise = np.maximum(moments.rounding_error[part], ZERO_DISPLAY_RTOL * np.abs(values).max())
        texts = [
            number(0.0 if abs(value) <= least else float(value))
            for value, least in zip(values, noise)
        ]
        cells = zip(
            map(label, monomials(degree)[part].tolist()),
            texts,
            (repr(float(value)) for value in values),
        )
        yield Degree(degree, unit(of, about, degree), tuple(cells))


def _displayed_invariants(found: list[Invariant], order: int) -> Iterator[Degree]:
    """Yield the invariants by degree: Hu's as numbers, higher ones as real and imaginary parts."""
    for degree in range(2, order + 1):
        rows = []
        for one in found:
            if one.degree == degree:
                parts = (one.value.real, one.value.imag) if one.is_complex else (one.value.real,)
                noise = one.rounding_error
                texts = [number(0.0 if abs(part) <= noise else part) for part in parts]
                text = " + ".join(texts).replace("+ −", "− ") + " i" * one.is_complex
                rows.append((one.name, text, " ".join(map(repr, parts))))
        yield Degree(degree, "", tuple(rows))


def invariants(computed: ComputedMoments, of: str, order: int) -> list[Invariant]:
    """Return Hu's seven invariants and, from fourth order on, Flusser's; MeasureError for bodies
    and lower orders.
    """
    if of != "FLAT":
        raise ReadError(MOMENTS_OF_AREA_ONLY)
    if order < HU_ORDER:
        raise ReadError(INVARIANTS_ORDER, order=HU_ORDER)
    moments = normalize(_select_moments(computed, of).truncate(order))
    with np.errstate(over="ignore", invalid="ignore"):
        found = [
            *hu_invariants(moments),
            *(one for one in flusser_invariants(moments) if one.degree > HU_ORDER),
        ]
    if not np.isfinite(
        [(abs(one.value), one.rounding_error, one.input_error) for one in found]
    ).all():
        raise ReadError(MOMENTS_OVERFLOW, order=order)
    return found


def in_frame(
    computed: ComputedMoments,
    of: str,
    about: str,
    frame: str,
    order: int,
    reference: Reference | None = None,
) -> Moments:
    """Return the moments in a frame or about a reference.

    frame: "WORLD" or "OBJECT". about: the frame's "ORIGIN", the body's "CENTER", or "NORMALIZED"
    (`normalize` by size, for a mass by gyration). reference: replaces both, with its origin and
    axes. Raises MeasureError if there are no such moments, or they leave the range of numbers.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        if of == "FLAT":
            moments = _in_plane(computed, about, frame, order, reference)
        elif reference is None:
            moments = _in_frame(computed, of, about, frame, order)
        else:
            moments = _select_moments(computed, of).truncate(order)
            moments = moments.in_frame(np.transpose(reference.axes), reference.origin)
    if not np.isfinite([moments.raw, moments.rounding_error, moments.input_error]).all():
        raise ReadError(MOMENTS_OVERFLOW, order=order)
    return moments


def _select_moments(computed: ComputedMoments, of: str) -> Moments:
    flat = None if computed.flat is None else computed.flat.moments
    moments = {
        "VOLUME": computed.volume,
        "SURFACE": computed.area,
        "MASS": computed.mass,
        "FLAT": flat,
    }[of]
    if moments is None:
        if of == "FLAT":
            assert computed.not_flat is not None
            raise ReadError(computed.not_flat)
        if computed.volume is None:
            raise ReadError(MOMENTS_OF_AREA_ONLY)
        raise ReadError(MASS_MOMENTS_UNKNOWN, order=computed.order)
    return moments


def _in_plane(
    computed: ComputedMoments, about: str, frame: str, order: int, reference: Reference | None
) -> Moments:
    """Return moments along the axes of the plane: normalized, about the center, or about the foot
    of an origin.
    """
    moments = _select_moments(computed, "FLAT").truncate(order)
    flat = computed.flat
    if about == "NORMALIZED":
        return normalize(moments)
    if about == "CENTER":
        return moments.about_center()
    origin = np.zeros(3) if frame == "WORLD" else computed.location
    assert flat is not None
    return moments.about_point(foot(flat.plane, origin if reference is None else reference.origin))


def _in_frame(computed: ComputedMoments, of: str, about: str, frame: str, order: int) -> Moments:
    moments = _select_moments(computed, of).truncate(order)
    origin = np.zeros(3) if frame == "WORLD" else computed.location
    if about != "ORIGIN":
        origin = moments.center
    if frame == "OBJECT":
        moments = moments.in_frame(computed.rotation, origin)
    if about == "NORMALIZED":
        return normalize(moments, "gyration" if of == "MASS" else "size")
    return moments if frame == "OBJECT" else moments.about_point(origin)


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


def as_csv(
    computed: ComputedMoments, of: str, about: str, frame: str, reference: Reference | None = None
) -> str:
    """Return all moments as CSV: a comment that describes them, and a row for each with its
    bounds.
    """
    bounds = ["rounding", "float32"]
    if of == "FLAT" and about == "INVARIANT":
        heading = "invariants of the flat shape, from central moments, scaled to an area of 1"
        columns = ["invariant", "real", "imaginary", *bounds]
        found = invariants(computed, of, computed.order)
        rows = [
            [one.name, one.value.real, one.value.imag, one.rounding_error, one.input_error]
            for one in found
        ]
    else:
        moments = in_frame(computed, of, about, frame, computed.order, reference)
        values = np.stack([moments.raw, moments.rounding_error, moments.input_error], axis=1)
        if of == "FLAT":
            heading = _flat_heading(computed, about, frame)
            columns = ["p", "q"]
            powers = multi_indices(2, moments.order)
            values = values[plane_positions(moments.order)]
        else:
            heading = _heading(of, about, frame)
            columns = ["p", "q", "r"]
            powers = monomials(computed.order)
        columns = [*columns, "moment", *bounds]
        rows = [[*which, *row] for which, row in zip(powers.tolist(), values.tolist())]
    text = io.StringIO()
    title = re.sub("[,;]", " ", visible(computed.name))  # otherwise the rest would be another cell
    text.write("# {:s}: {:s}\n".format(title, heading))
    csv.writer(text, lineterminator="\n").writerows([columns, *rows])
    return text.getvalue()


def _heading(of: str, about: str, frame: str) -> str:
    return "{:s} moments, {:s} frame, {:s}".format(
        of.lower(),
        "reference" if about == "REFERENCE" else frame.lower(),
        {
            "ORIGIN": "about the frame's origin, in SI units",
            "CENTER": "about the center, in SI units",
            "REFERENCE": "about its origin, in SI units",
            "NORMALIZED": "central, of the body scaled to a {:s} of 1".format(
                "mass and a radius of gyration" if of == "MASS" else of.lower()
            ),
        }[about],
    )


def _flat_heading(computed: ComputedMoments, about: str, frame: str) -> str:
    assert computed.flat is not None
    x, y, normal = (" ".join(map(repr, axis)) for axis in computed.flat.plane.axes.T.tolist())
    heading = "area moments of the flat shape, along x = ({:s}) and y = ({:s}), front ({:s}), {:s}"
    return heading.format(
        x,
        y,
        normal,
        {
            "ORIGIN": "about the foot of the {:s} frame's origin, in SI units".format(
                frame.lower()
            ),
            "CENTER": "about the centroid, in SI units",
            "REFERENCE": "about the foot of the reference's origin, in SI units",
            "NORMALIZED": "central, of the shape scaled to an area of 1",
        }[about],
    )
