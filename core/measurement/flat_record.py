# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The record of a flat shape, an entry of a document's `flat`, in SI units; x and y are the axes of its plane."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..flat.regions import plane_positions
from ..flat.section import foot
from ..flat.section_properties import Plane
from ..moments.complex_form import Invariant
from ..moments.exponents import monomial_index
from ..moments.moments import Moments, U
from ..polyhedron.n_dimensions import multi_indices
from ..verdict.finding import Finding
from .documents import plain
from .record import described

_FIRST, _SECOND = ((1, 0, 0), (0, 1, 0)), ((2, 0, 0), (0, 2, 0), (1, 1, 0))
SHIFT_ROUNDINGS = 16.0  # Rounding of the shift from plane to frame, in u of the distance.


def flat_record(
    name: str,
    kind: str,
    plane: Plane,
    moments: Moments,
    findings: Iterable[Finding],
    *,
    order: int | None = None,
    invariants: Sequence[Invariant] = (),
    more: dict[str, Any] | None = None,
    about: str | Sequence[float] | None = None,
    frame: tuple[str, NDArray[np.float64], NDArray[np.float64]] = ("world", np.eye(3), np.zeros(3)),
) -> dict[str, Any]:
    """Return one shape's record.

    kind: the object's type. moments: about the centroid, along the plane's axes, to second order at least.
    order: adds `moments`, about the projection of the frame's origin or of the point `about` (as in `record`) on the
    plane. frame: its name, and the object frame's axes and origin. more: further entries.
    """
    axes, location = (np.eye(3), np.zeros(3)) if frame[0] == "world" else frame[1:]

    def to_frame(point: NDArray) -> NDArray[np.float64]:
        return axes.T @ (point - location)

    centroid = plane.origin + plane.axes @ moments.center
    central = moments.about_center()
    entry = {
        "name": name,
        "type": kind,
        "area": moments.total,
        "centroid": to_frame(centroid),
        "plane": {
            "origin": to_frame(plane.origin),
            **{key: axes.T @ axis for key, axis in zip(("x", "y", "normal"), plane.axes.T)},
        },
        "second_moments": {"xx": central[2, 0, 0], "yy": central[0, 2, 0], "xy": central[1, 1, 0]},
    }
    if order is not None:
        point = _point(about, centroid, axes, location, frame[2])
        placed = moments.truncate(order).about_point(foot(plane, point))
        entry["moments"] = {
            "order": order,
            "about": placed.about[:2],
            "area": _by_powers(placed.raw, order),
            "error": {"area": _by_powers(placed.rounding_error, order)},
            "input": {"area": _by_powers(placed.input_error, order)},
        }
    if invariants:
        entry["invariants"] = [
            {
                "name": one.name,
                "real": one.value.real,
                "imaginary": one.value.imag,
                "error": one.rounding_error,
                "input": one.input_error,
            }
            for one in invariants
        ]
    entry |= more or {}
    rounding = _bounds(central, central.rounding_error, U * float(np.linalg.norm(centroid)))
    entry["error_bound"] = {**rounding, "input": _bounds(central, central.input_error, 0.0)}
    return plain(entry) | described(findings)


def _bounds(central: Moments, bounds: NDArray[np.float64], shift: float) -> dict[str, float]:
    """Return bounds of area, centroid coordinates and second moments. bounds: of the central moments."""
    first, second = (
        float(np.linalg.norm([bounds[monomial_index(*row)] for row in rows])) for rows in (_FIRST, _SECOND)
    )
    return {
        "area": float(bounds[0]),
        "centroid": first / abs(central.total) + SHIFT_ROUNDINGS * shift,
        "second_moments": second,
    }


def _point(
    about: str | Sequence[float] | None, centroid: NDArray, axes: NDArray, location: NDArray, own: NDArray
) -> NDArray[np.float64]:
    """Return the (3,) world position of the point `about`, not yet on the plane. own: the object's origin."""
    if about == "center":
        return centroid
    if about in ("origin", "world"):
        return own if about == "origin" else np.zeros(3)
    return location + axes @ (np.zeros(3) if about is None else np.asarray(about, np.float64))


def _by_powers(values: NDArray[np.float64], order: int) -> dict[str, float]:
    """Return moments in a dict, with the exponents of x and y as keys "p,q"."""
    powers, positions = multi_indices(2, order).tolist(), plane_positions(order)
    return {"{},{}".format(p, q): value for (p, q), value in zip(powers, values[positions].tolist())}
