# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caps for many small surfaces at once, the same as one by one, if they need no other repair.

The conditions: every edge has one face, or two that agree; at each boundary vertex one side arrives and one leaves;
every loop has an area; no vertices touch that a repair would weld.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface_stack import Connections, SurfaceStack, TriangleStack
from ..mesh.welding import may_have_neighbor
from ..moments.moments import Moments, U, sum_moments
from ..polyhedron.third_order import MAX_SMALL_TRIANGLES
from ..polyhedron.third_order_small import small_moments
from .boundary_loops import OwnedLoops, has_distinct_vertices, side_ends


@dataclass(frozen=True, eq=False)
class StackCaps:
    """The caps of n surfaces; `is_capped`: (n,) mask of the surfaces that have any.

    `triangles`, `part`: t triangles of all surfaces, each surface's caps last, and the component of each.
    `cap_counts`: (n,) triangles that are caps. `counts`: (n, 3) holes with flat and with curved caps, and the caps'
    area.
    `edges`: (k, 2) sorted pairs of the surfaces' own vertices along the holes, by surface, `edge_counts` each.
    """

    is_capped: NDArray[np.bool_]
    triangles: TriangleStack
    part: NDArray[np.intp]
    cap_counts: NDArray[np.intp]
    counts: NDArray[np.float64]
    edges: NDArray[np.intp]
    edge_counts: NDArray[np.intp]

    def add_to(self, volume: Moments) -> Moments:
        """Return the volume moments of the surfaces with their caps, about the same points."""
        rows = np.flatnonzero(self.is_capped)
        stack, counts, center = self.triangles.some(rows), self.cap_counts[rows], volume.about[rows]
        low, high = stack.box
        first_cap = stack.first_triangle + stack.triangle_counts - counts
        is_cap = np.arange(len(stack.triangles)) >= np.repeat(first_cap, stack.triangle_counts)
        caps, _, _ = small_moments(
            stack.points,
            stack.triangles[is_cap],
            counts,
            center,
            np.maximum(high - center, center - low) * (1.0 + 4.0 * U),
            stack.coordinate_error,
            area=True,
            area_moments=False,
        )
        total = sum_moments([volume.at(rows), caps])
        changed = {name: getattr(volume, name).copy() for name in ("raw", "rounding_error", "input_error")}
        for name, values in changed.items():
            values[rows] = getattr(total, name)
        return replace(volume, **changed)

    def edges_of(self, i: int) -> NDArray[np.intp]:
        """Return the (k, 2) edges along the holes of one surface."""
        stop = self._edge_stops[i]
        return self.edges[stop - self.edge_counts[i] : stop]

    @cached_property
    def _edge_stops(self) -> NDArray[np.intp]:
        return np.cumsum(self.edge_counts)


def cap_stack(
    stack: SurfaceStack, links: Connections, usable: NDArray[np.bool_], tolerance: NDArray[np.float64]
) -> StackCaps | None:
    """Cap `usable` surfaces that need nothing but caps; None if there are none. tolerance: (n,) distances of touch."""
    can = usable & links.is_open
    start, stop = links.open_sides
    owner, total = stack.point_owners, len(stack.points)
    leaving, arriving = np.bincount(start, minlength=total), np.bincount(stop, minlength=total)
    can &= np.logical_and.reduceat((leaving <= 1) & (leaving == arriving), stack.first_point)
    for chosen, reach in ((start, tolerance), (np.flatnonzero(can[owner]), np.zeros(len(can)))):
        of = owner[chosen]
        can[of[may_have_neighbor(stack.points[chosen], reach[of], of)]] = False
    if not can.any():
        return None
    onto = np.full(total, -1)
    onto[start] = stop
    begins, ends = side_ends(stack.triangles, np.arange(stack.triangles.size))
    is_side = onto[begins] == ends
    side_counts = np.add.reduceat(is_side, 3 * stack.first_triangle, dtype=np.intp)
    sides = np.repeat(can, 3 * stack.triangle_counts)
    key = np.sort(begins[sides] * total + ends[sides])
    can[owner[key[1:][key[1:] == key[:-1]] // total]] = False  # diagonals may run along edges
    can &= side_counts + stack.triangle_counts <= MAX_SMALL_TRIANGLES
    can &= np.logical_and.reduceat(has_distinct_vertices(stack.triangles), stack.first_triangle)
    side = np.flatnonzero(is_side)
    while can.any():
        side = side[can[owner[begins[side]]]]
        start, stop = begins[side], ends[side]
        found = OwnedLoops.of_sides(stack.points, start, stop, owner[start])
        bad = ~found.loops.complete | ~found.loops.has_area(tolerance[found.owner])
        if not bad.any():
            return _capped(stack, links.component[stack.triangle_faces], can, tolerance, side, found)
        can[found.owner[bad]] = False
    return None


def _capped(
    stack: SurfaceStack,
    part: NDArray[np.intp],
    is_capped: NDArray[np.bool_],
    tolerance: NDArray[np.float64],
    side: NDArray[np.intp],
    found: OwnedLoops,
) -> StackCaps:
    """Add the caps of loops to their surfaces. part: (t,) components of triangles; side: (r,) sides of the loops."""
    count, owner, (apexes, caps, kept) = len(stack), stack.point_owners, found.cones()
    body = owner[found.start]
    cap_counts = np.bincount(body[kept], minlength=count)
    point_order = np.concatenate([owner, found.owner]).argsort(kind="stable")
    bodies = np.concatenate([np.repeat(np.arange(count), stack.triangle_counts), body[kept]])
    order = bodies.argsort(kind="stable")
    triangles = TriangleStack(
        np.concatenate([stack.points, apexes])[point_order],
        point_order.argsort()[np.concatenate([stack.triangles, caps])[order]],
        stack.point_counts + np.bincount(found.owner, minlength=count),
        stack.triangle_counts + cap_counts,
    )
    edges = np.sort(np.stack([found.start, found.stop], axis=1), axis=1) - stack.first_point[body][:, None]
    return StackCaps(
        is_capped,
        triangles,
        np.concatenate([part, part[side[kept] // 3]])[order],
        cap_counts,
        found.count_caps(tolerance, is_capped),
        edges[np.lexsort((edges[:, 1], edges[:, 0], body))],
        np.bincount(body, minlength=count),
    )
