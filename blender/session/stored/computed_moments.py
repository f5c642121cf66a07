# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An object's moments to a chosen order: those of a kind, in a frame, as invariants or as CSV."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ....core import inertia, measurement, numerics, polyhedron, verdict
from ....core.flat import Plane, foot, plane_positions
from ....core.moments import Invariant, flusser_invariants, hu_invariants, normalize
from ....core.moments.raw import Moments, monomials
from ..findings import (
    INVARIANTS_ORDER,
    MASS_MOMENTS_UNKNOWN,
    MOMENTS_OF_AREA_ONLY,
    MOMENTS_UNAVAILABLE,
)

HU_ORDER = 3  # order of Hu's invariants


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
    rotation: numerics.Array
    location: numerics.Array
    flat: FlatMoments | None = None
    not_flat: verdict.Finding | None = None

    @property
    def order(self) -> int:
        return self.volume_or_flat.order

    @property
    def volume_or_flat(self) -> Moments:
        """The moments of the volume, or of the flat shape if there is no volume."""
        if self.volume is not None:
            return self.volume
        assert self.flat is not None
        return self.flat.moments

    @property
    def center(self) -> numerics.Array:
        """The (3,) center of the volume, or of the flat shape, in the world."""
        if self.volume is not None:
            return self.volume.center
        assert self.flat is not None
        return self.flat.plane.origin + self.flat.plane.axes @ self.flat.moments.center


def invariants(computed: ComputedMoments, of: str, order: int) -> list[Invariant]:
    """Return Hu's seven invariants and, from fourth order on, Flusser's; MeasureError for bodies
    and lower orders.
    """
    if of != "FLAT":
        raise verdict.ReadError(MOMENTS_UNAVAILABLE, fault=MOMENTS_OF_AREA_ONLY)
    if order < HU_ORDER:
        raise verdict.ReadError(MOMENTS_UNAVAILABLE, fault=INVARIANTS_ORDER)
    moments = normalize(_select_moments(computed, of).truncate(order))
    with np.errstate(over="ignore", invalid="ignore"):
        results = [
            *hu_invariants(moments),
            *(
                invariant
                for invariant in flusser_invariants(moments)
                if invariant.degree > HU_ORDER
            ),
        ]
    if not np.isfinite(
        [
            (abs(invariant.value), invariant.rounding_error, invariant.input_error)
            for invariant in results
        ]
    ).all():
        raise verdict.ReadError(inertia.MOMENTS_OVERFLOW, order=order)
    return results


def in_frame(
    computed: ComputedMoments,
    of: str,
    about: str,
    frame: str,
    order: int,
    reference: inertia.Reference | None = None,
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
        raise verdict.ReadError(inertia.MOMENTS_OVERFLOW, order=order)
    return moments


def _select_moments(computed: ComputedMoments, of: str) -> Moments:
    """Return the moments of "VOLUME", "SURFACE", "MASS" or "FLAT", in the world or along the plane
    of a flat shape; raise ReadError if there are none.
    """
    moments = {
        "VOLUME": computed.volume,
        "SURFACE": computed.area,
        "MASS": computed.mass,
        "FLAT": None if computed.flat is None else computed.flat.moments,
    }[of]
    if moments is None:
        if of == "FLAT":
            assert computed.not_flat is not None
            raise verdict.ReadError(computed.not_flat)
        if computed.volume is None:  # a flat shape alone
            raise verdict.ReadError(MOMENTS_UNAVAILABLE, fault=MOMENTS_OF_AREA_ONLY)
        raise verdict.ReadError(MOMENTS_UNAVAILABLE, fault=MASS_MOMENTS_UNKNOWN)
    return moments


def _in_plane(
    computed: ComputedMoments,
    about: str,
    frame: str,
    order: int,
    reference: inertia.Reference | None,
) -> Moments:
    """Return moments along the axes of the plane: normalized, about the center, or about the foot,
    in the plane, of the origin of a frame or reference.
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
    """Return moments along the axes of a frame, as `in_frame` without a reference."""
    moments = _select_moments(computed, of).truncate(order)
    origin = np.zeros(3) if frame == "WORLD" else computed.location
    if about != "ORIGIN":
        origin = moments.center
    if frame == "OBJECT":
        moments = moments.in_frame(computed.rotation, origin)
    if about == "NORMALIZED":
        return normalize(moments, "gyration" if of == "MASS" else "size")
    return moments if frame == "OBJECT" else moments.about_point(origin)


def as_csv(
    computed: ComputedMoments,
    of: str,
    about: str,
    frame: str,
    reference: inertia.Reference | None = None,
) -> str:
    """Return all moments as CSV: a comment that describes them, and a row for each with its
    bounds.
    """
    bounds = ["rounding", "float32"]
    if of == "FLAT" and about == "INVARIANT":
        heading = "invariants of the flat shape, from central moments, scaled to an area of 1"
        columns = ["invariant", "real", "imaginary", *bounds]
        table_rows = [
            [
                invariant.name,
                invariant.value.real,
                invariant.value.imag,
                invariant.rounding_error,
                invariant.input_error,
            ]
            for invariant in invariants(computed, of, computed.order)
        ]
    else:
        moments = in_frame(computed, of, about, frame, computed.order, reference)
        values = np.stack([moments.raw, moments.rounding_error, moments.input_error], axis=1)
        if of == "FLAT":
            heading = _flat_heading(computed, about, frame)
            columns = ["p", "q"]
            powers = polyhedron.multi_indices(2, moments.order)
            values = values[plane_positions(moments.order)]
        else:
            heading = _heading(of, about, frame)
            columns = ["p", "q", "r"]
            powers = monomials(computed.order)
        columns = [*columns, "moment", *bounds]
        table_rows = [[*which, *row] for which, row in zip(powers.tolist(), values.tolist())]
    # A separator in the name would begin another cell.
    title = re.sub("[,;]", " ", measurement.visible(computed.name))
    lines = measurement.table(columns, (dict(zip(columns, row)) for row in table_rows))
    return "".join(["# {:s}: {:s}\n".format(title, heading), *lines])


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
