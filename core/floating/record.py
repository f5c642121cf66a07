# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating bodies as entries of records."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..measurement import Body, Measurement
from ..numerics import Array, ArrayLike
from ..verdict import MeasureError
from .findings import FLOAT_UNAVAILABLE, FLOODED_OUTSIDE
from .flotation import STARTS, FloatingBody, Flotation, Tank, Vessel
from .hulls import Hull, are_inside, fill_hollows, find_hull
from .righting import righting_curve

CURVE = "angles", "arms", "trims", "energies", "stable_range", "capsize", "flooding"
MAX_HULLS = 4  # hulls with filled hollows that are kept beside the wet one, the last ones


def settle(
    bodies: Iterable[Body],
    mass: float,
    center: Array,
    density: float,
    up: ArrayLike,
    tanks: Iterable[tuple[Body, float, float]] = (),
    flooded: Iterable[Body] = (),
    center_error: ArrayLike = (0.0, 0.0),
) -> Flotation:
    """Return the position in which measured bodies rest as one, downhill from where they are.

    Parameters
    ----------
    bodies : iterable of Body
    mass : float
        Of all of them, kg.
    center : (3,) array
        Center of mass, m.
    density : float
        Of the liquid, kg/m³.
    up : (3,) array_like
        Unit vector against gravity.
    tanks : iterable of (Body, float, float)
        Tanks, each with the filled share of its volume and the density of its liquid.
    flooded : iterable of Body
        Spaces that the liquid around the body fills, too.
    center_error : (2,) array_like
        Bounds of the center of mass by rounding and by storing, m.

    Returns
    -------
    Flotation

    Raises
    ------
    MeasureError
        If it sinks, leaks, or does not rest.
    """
    wet = find_hull(bodies)
    spaces = [find_hull([space]) for space in flooded]
    liquids, tank_hulls = [], []
    for tank, fill, tank_density in tanks:
        hull = find_hull([tank])
        tank_hulls.append(hull)
        vessel = Vessel(hull.points, hull.triangles, 1.0, hull.displacement)
        liquids.append(Tank(replace(vessel, volume=fill * vessel.whole[0]), tank_density))

    start = np.asarray(up, np.float64)
    if spaces:
        are_inside(wet, spaces, tank_hulls)  # refuses those that overlap
    for space in spaces:
        if not any(_holds(fill_hollows(wet, way), space, False) for way in (start, *STARTS)):
            raise MeasureError(FLOAT_UNAVAILABLE, fault=FLOODED_OUTSIDE)
    fitted = _FittedBodies(
        wet, spaces, mass, center, density, tuple(liquids), np.asarray(center_error, np.float64)
    )
    return fitted(start).settle(start)


@dataclass(eq=False)
class _FittedBodies:
    """The floating bodies of a wet hull with its hollows filled in several ways.

    made: the last bodies with their hulls, that of the wet hull first. `settle` relies on equal
    bodies being the same object.
    """

    wet: Hull
    spaces: list[Hull]
    mass: float
    center: Array
    density: float
    liquids: tuple[Tank, ...]
    center_error: Array
    made: list[tuple[Hull, FloatingBody]] = field(default_factory=list)

    def __call__(self, up: Array | None) -> FloatingBody:
        """Return the body for a direction against gravity, with the hollows filled that are open
        upward, or for None with none filled; the same one for the same hull.
        """
        hull = self.wet if up is None else fill_hollows(self.wet, up)
        for other, body in self.made:
            has_triangles = np.array_equal(other.triangles, hull.triangles)
            if has_triangles and np.array_equal(other.points, hull.points):
                return body
        points, triangles = hull.points, hull.triangles
        for space in self.spaces:
            if not _holds(hull, space, True):  # it is in a flooded hollow
                continue
            triangles = np.concatenate([triangles, space.triangles[:, ::-1] + len(points)])
            points = np.concatenate([points, space.points])
        body = FloatingBody(
            points=points,
            triangles=triangles,
            mass=self.mass,
            center=self.center,
            density=self.density,
            openings=hull.openings,
            tanks=self.liquids,
            fitted=self,
            displacement=hull.displacement,
            center_error=self.center_error,
        )
        if len(self.made) > MAX_HULLS:
            # The oldest one, but for that of the wet hull.
            first_hull, _ = self.made[0]
            del self.made[int(first_hull is self.wet)]
        self.made.insert(0 if hull is self.wet else len(self.made), (hull, body))
        return body


def _holds(hull: Hull, space: Hull, through: bool) -> bool:
    """Return whether a flooded space lies in a hull; `through` if it goes through the surface, as
    through a lid.
    """
    try:
        return bool(are_inside(hull, [space], ())[0])
    except MeasureError:
        return through


def heel_and_trim(up: Array, axes: Array) -> tuple[float, float]:
    """Return the heel about the X axis and the trim about the Y axis of a (3, 3) frame, rad.

    up: (3,) unit vector against gravity.
    """
    x, y, z = up @ axes
    return float(np.arctan2(y, z)), float(-np.arcsin(np.clip(x, -1.0, 1.0)))


def float_record(
    rest: Flotation,
    measurement: Measurement,
    frame: str,
    angles: ArrayLike = (),
    rests: Iterable[Flotation] = (),
) -> dict[str, Any]:
    """Return the entry `floating` of an object's record.

    frame: "world" or "object", of the centers. angles: of heel, rad, for the righting arms. rests:
    all positions of rest.
    """
    axes, origin = measurement.rotation, measurement.location
    if frame == "world":
        axes, origin = np.eye(3), np.zeros(3)

    def height(point: Array) -> float:  # over the keel
        return float(rest.up @ point) - rest.keel

    heel, trim = heel_and_trim(rest.up, measurement.rotation)
    bounds = rest.error_bounds
    entry: dict[str, Any] = {
        "liquid_density": rest.body.density,
        "displacement": rest.displacement,
        "draught": rest.draught,
        "heel": heel,
        "trim": trim,
        "kb": height(rest.center_of_buoyancy),
        "kg": height(rest.center_of_gravity),
        "bm": rest.metacentric_radii,
        "gm": rest.metacentric_heights,
        "waterplane_area": rest.plane.area,
        "waterplane_moments": rest.waterplane_moments,
        "center_of_buoyancy": axes.T @ (rest.center_of_buoyancy - origin),
        "center_of_flotation": axes.T @ (rest.center_of_flotation - origin),
        "error_bound": {
            **{name: bound[0] for name, bound in bounds.items()},
            "input": {name: bound[1] for name, bound in bounds.items()},
        },
        "residual": rest.residual,
        "matrix": rest.matrix(),
        "rests": [
            {
                **dict(zip(("heel", "trim"), heel_and_trim(other.up, measurement.rotation))),
                "draught": other.draught,
                "gm": other.metacentric_heights,
                "energy": other.energy - rest.energy,
            }
            for other in rests
        ],
    }
    if np.size(angles):
        curve = righting_curve(rest, angles)
        entry["gz"] = {name: getattr(curve, name) for name in CURVE}
    return entry
