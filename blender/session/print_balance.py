# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make It Stand: the least change of a print's infill and walls, or the least pocket of ballast,
that brings its center of mass over its base, or onto the plumb line of a point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
from bpy.types import Context, Object

from ...core import bodies, measurement, numerics, statics, verdict
from ..bodies import mesh
from ..bodies.request import Request
from ..scene.rigid_world import down
from ..settings.options import MeasureOptions

MAX_WALLS = 12
COARSE, FINE = 21, 7  # places of a pocket along each axis, at first and around the best of them
ZOOMS = 14
# the largest pocket's radius as a share of the room's, lest it reaches out by rounding
FILLED = 0.999
SHARES = np.linspace(0.0, 1.0, 33)  # shares of the largest pocket, for the largest margin


class PrintBalance(NamedTuple):
    """A change of a print.

    walls: their number. infill: in percent. margin: the margin that they give, in Blender units.
    suffices: whether it is as large as it has to be. pocket: of ballast, if any.
    """

    walls: int
    infill: float
    margin: float
    suffices: bool
    pocket: measurement.Pocket | None = None


def balance_print(
    context: Context,
    obj: Object,
    corners: numerics.Array | None,
    margin: float,
    point: tuple[float, ...] | None = None,
    change: str = "WALLS",
    ballast: float = 0.0,
) -> PrintBalance | None:
    """Return the nearest walls and infill, or the least pocket, with the center inside a polygon by
    a margin, else those with the largest margin; None if the polygon has fewer than 3 corners.

    corners: (k, 3) of the base in the world, counterclockwise from above; None if unknown. margin:
    in Blender units. point: (3,) in the world: the center has to be above or below it within the
    margin, in place of the base. change: "INFILL", "WALLS" (they stay if the infill alone
    suffices), or "BALLAST". ballast: its density, kg/m³. Raises MeasureError.
    """
    axes = statics.ground_axes(down(context.scene))[:, :2]
    if point is not None:
        # An octagon whose corners have the distance `margin` from the point lies within it.
        angles = np.pi / 4.0 * np.arange(8)
        ring = np.column_stack([np.cos(angles), np.sin(angles)])
        corners = point + margin * ring @ axes.T
        margin = 0.0
    if corners is None or len(corners) < 3:
        return None
    request = Request.resolve(
        obj, context.evaluated_depsgraph_get(), MeasureOptions(kind="printed")
    )
    settings = request.settings
    if change != "BALLAST" and settings.printed.pocket is None:
        # The center of one material does not depend on its density.
        settings = replace(settings, mass=None, density=1.0)
    to_body = bodies.to_si([request.surfaces.matrix], settings.unit)[0]
    printed_body = mesh.mesh_body(
        request.surfaces,
        settings.unit,
        shell=False,
        union=settings.overlap == "union",
        threads=settings.threads,
    )
    # The moments are about the middle of the polygon: far from the origin no digits are lost.
    middle = corners.mean(axis=0)
    flat_corners = (corners - middle) @ axes
    middle_si = middle * settings.unit

    def moments_with(**values: Any) -> numerics.Array:
        """Return the (3,) mass, kg, and its first moments about the middle along the ground, in kg
        times Blender units, with other values of the print's settings.
        """
        printed = settings.printed._replace(**values)
        mass = bodies.print_body(printed_body, replace(settings, printed=printed), to_body).mass
        if mass is None:
            return np.zeros(3)
        first = mass.about_point(middle_si).raw[1:4]
        return np.array([mass.total, *(first @ axes / settings.unit)])

    def with_distance(best: PrintBalance) -> PrintBalance:
        """Return a result with the distance of its center from the plumb line as its margin, if it
        is too far from one. The middle of the polygon is on this line.
        """
        if best.suffices or point is None:
            return best
        mass = moments_with(infill=best.infill, walls=best.walls, pocket=best.pocket)
        return best._replace(margin=float(np.hypot(*mass[1:] / mass[0])))

    now = settings.printed
    if change == "BALLAST":
        if settings.mass is not None:
            # raises the refusal of pockets in prints of a given mass
            moments_with(pocket=measurement.Pocket((0.0, 0.0, 0.0), 0.0, 0.0))
        mass = moments_with(pocket=None)
        excess = ballast - now.infill / 100.0 * (settings.density or 0.0)
        cores, outsides = bodies.find_cores(printed_body, now)
        room = bodies.PocketRoom([core.surface for core in cores], outsides, now.line_width)
        center, radius, reached = _place_pocket(
            room,
            lambda places: (places / settings.unit - middle) @ axes,
            flat_corners,
            mass,
            margin,
            excess,
            None if point is None else middle_si,
            axes,
        )
        local = np.linalg.solve(to_body, [*center, 1.0])[:3]
        pocket = measurement.Pocket(tuple(local.tolist()), radius, ballast) if radius else None
        return with_distance(
            PrintBalance(now.walls, now.infill, reached, reached >= margin, pocket)
        )
    best = None
    nearest = sorted(range(1, MAX_WALLS + 1), key=lambda count: abs(count - now.walls))
    for walls in nearest if change == "WALLS" else [now.walls]:
        try:
            empty, full = (moments_with(infill=infill, walls=walls) for infill in (0.0, 100.0))
        except verdict.MeasureError:
            if walls == now.walls:
                raise
            continue  # thicker than the part
        if (allowed := statics.infill_range(flat_corners, empty, full - empty, margin)) is not None:
            low, high = (100.0 * share for share in allowed)
            infill = float(np.clip(now.infill, low, high))
            return PrintBalance(walls, _shorten(infill, low, high), margin, True)
        reached, share = statics.largest_margin(flat_corners, empty, full - empty)
        if best is None or reached > best.margin:
            best = PrintBalance(walls, 100.0 * share, reached, False, now.pocket)
    return best and with_distance(best)


def _place_pocket(
    room: bodies.PocketRoom,
    to_flat: Callable[[numerics.Array], numerics.Array],
    corners: numerics.Array,
    mass: numerics.Array,
    margin: float,
    excess: float,
    point: numerics.Array | None,
    axes: numerics.Array,
) -> tuple[numerics.Array, float, float]:
    """Return center and radius, m, of the least pocket that gives the margin, and the margin; else
    those of the pocket with the largest margin.

    to_flat: from (k, 3) places in m to (k, 2) along the ground, in the units of `corners`, (c, 2).
    mass: (3,), with its first moments. excess: density of the ballast less that of the infill,
    kg/m³. point: (3,) in m; the pocket is on the plane of its plumb line and the center of mass.
    axes: (3, 2) along the ground. The search refines a grid around its best place.
    """
    frame = np.column_stack([axes, np.cross(axes[:, 0], axes[:, 1])])
    if point is not None:
        along = mass[1:] / max(float(np.hypot(*mass[1:])), np.finfo(float).tiny)
        frame[:, :2] = axes @ np.column_stack([along, [-along[1], along[0]]])
    box = np.array(np.meshgrid(*zip(room.low, room.high))).reshape(3, -1).T @ frame
    low, high = box.min(axis=0), box.max(axis=0)
    if point is not None:
        low[1] = high[1] = point @ frame[:, 1]
    middle, half = (low + high) / 2.0, (high - low) / 2.0  # of the grid, along `frame`
    mass_of_unit_ball = abs(excess) * 4.0 / 3.0 * np.pi
    sign = 1.0 if excess >= 0.0 else -1.0
    best_pocket = middle, 0.0, -np.inf  # its center, radius and margin
    for zoom in range(ZOOMS):
        ticks = np.linspace(-1.0, 1.0, FINE if zoom else COARSE)
        steps = [ticks * size if size > 0.0 else np.zeros(1) for size in half]
        grid = middle + np.array(np.meshgrid(*steps)).reshape(3, -1).T
        places = grid @ frame.T
        flat = to_flat(places)
        largest = FILLED * room.radii(places)
        least = np.cbrt(
            statics.least_ballast(corners, mass, flat, margin, sign) / (mass_of_unit_ball or 1.0)
        )
        fits = (least <= largest) & (mass_of_unit_ball > 0.0)
        # Each grid has the best place of the one before, so that a pocket that fits is never lost.
        if fits.any():
            at = int(np.where(fits, least, np.inf).argmin())
            best_pocket = places[at], float(least[at]), margin
        else:
            added = sign * mass_of_unit_ball * SHARES[:, None] * largest**3
            margins = np.array(
                [statics.ballast_margins(corners, mass, flat, added_mass) for added_mass in added]
            )
            share, at = np.unravel_index(margins.argmax(), margins.shape)
            radius = float(np.cbrt(SHARES[share]) * largest[at])
            best_pocket = max(
                best_pocket, (places[at], radius, float(margins[share, at])), key=itemgetter(2)
            )
        middle = grid[at]
        # The next grid reaches to the neighbors of the best place and farther, in case it is off:
        # 1.2 times the step 2 half / 20 of the coarse grid, 1.5 times the step 2 half / 6 later.
        half = half * (0.5 if zoom else 2.5 / COARSE)
    return best_pocket


def _shorten(infill: float, low: float, high: float) -> float:
    """Return the infill in percent with the fewest decimals, two at most, that are within its
    range; unchanged if none are.
    """
    for step in (1.0, 0.1, 0.01):
        for rounded in (np.ceil(infill / step), np.floor(infill / step)):
            if low <= rounded * step <= high:
                return numerics.shortest_decimal(float(rounded * step))
    return infill
