# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make It Stand: the least change of a print's infill and walls that brings its center of mass over
its base, or onto the plumb line of a point.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from bpy.types import Context, Object

from ...core.bodies import print_body
from ...core.numerics import Array, shortest_decimal
from ...core.statics import ground_axes, infill_range, largest_margin
from ...core.verdict import MeasureError
from ..bodies import mesh
from ..bodies.request import Request
from ..scene.rigid_world import down

MAX_WALLS = 12


class PrintBalance(NamedTuple):
    """Walls and infill in percent; the margin that they give, in Blender units; whether that is as
    large as it has to be.
    """

    walls: int
    infill: float
    margin: float
    suffices: bool


def balance_print(
    context: Context,
    obj: Object,
    corners: Array | None,
    margin: float,
    point: tuple[float, ...] | None = None,
) -> PrintBalance | None:
    """Return the nearest walls and infill with the center inside a polygon by a margin, else those
    with the largest margin; None if the polygon is none.

    corners: (k, 3) of the base in the world, counterclockwise from above; None if unknown. margin:
    in Blender units. point: the center has to be above or below it within the margin, in place of
    the base. The walls stay if the infill alone suffices. Raises MeasureError.
    """
    axes = ground_axes(down(context.scene))[:, :2]
    if point is not None:
        turn = np.pi / 4.0 * np.arange(8)
        ring = np.column_stack([np.cos(turn), np.sin(turn)])
        corners, margin = point + margin * ring @ axes.T, 0.0
    if corners is None or len(corners) < 3:
        return None
    request = Request.resolve(obj, context.evaluated_depsgraph_get())
    settings = replace(request.settings, kind="printed", mass=None, density=1.0)
    made = mesh.mesh_body(
        request.surfaces,
        settings.unit,
        shell=False,
        union=settings.overlap == "union",
        threads=settings.threads,
    )
    middle = corners.mean(axis=0)
    flat = (corners - middle) @ axes
    about = middle * settings.unit

    def placed(infill: float, walls: int) -> Array:
        """Return the mass and its first moments along the ground, in Blender units."""
        printed = settings.printed._replace(infill=infill, walls=walls)
        mass = print_body(made, replace(settings, printed=printed)).mass
        first = mass.about_point(about).raw[1:4] if mass is not None else np.zeros(3)
        total = 0.0 if mass is None else mass.total
        return np.array([total, *(first @ axes / settings.unit)])

    now = settings.printed
    best = None
    for walls in sorted(range(1, MAX_WALLS + 1), key=lambda count: abs(count - now.walls)):
        try:
            empty, full = placed(0.0, walls), placed(100.0, walls)
        except MeasureError:
            if walls == now.walls:
                raise
            continue  # thicker than the part
        allowed = infill_range(flat, empty, full - empty, margin)
        if allowed is not None:
            low, high = (100.0 * share for share in allowed)
            infill = float(np.clip(now.infill, low, high))
            return PrintBalance(walls, _shorten(infill, low, high), margin, True)
        reached, share = largest_margin(flat, empty, full - empty)
        if best is None or reached > best.margin:
            best = PrintBalance(walls, 100.0 * share, reached, False)
    return best


def _shorten(infill: float, low: float, high: float) -> float:
    """Return the infill with few decimals, within its range."""
    for step in (1.0, 0.1, 0.01):
        for rounded in (np.ceil(infill / step), np.floor(infill / step)):
            if low <= rounded * step <= high:
                return shortest_decimal(float(rounded * step))
    return infill
