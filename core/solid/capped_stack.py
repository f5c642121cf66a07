# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Caps for many small surfaces at once, if they need no other repair.

The conditions: every edge has one face, or two that agree; at each boundary vertex one side arrives and one leaves;
every loop has an area; no vertices touch that a repair would weld. The caps are those of `cap_holes`, to the bit. Other
surfaces are repaired one by one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface_stack import Connections, SurfaceStack, TriangleStack
from ..mesh.welding import may_have_neighbor
from ..moments.moments import Moments, U, sum_moments
from ..numerics.arrays import segment_starts
from ..polyhedron.third_order import MAX_SMALL_TRIANGLES
from ..polyhedron.third_order_small import small_moments
from .boundary_loops import BoundaryLoops, find_loops, join_sides, side_ends
from .repaired_mesh import has_distinct_vertices


@dataclass(frozen=True, eq=False)
class StackCaps:
    """The caps of n surfaces.

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
        """Return the (k, 2) edges of one surface."""
        stop = self._edge_stops[i]
        return self.edges[stop - self.edge_counts[i] : stop]

    @cached_property
    def _edge_stops(self) -> NDArray[np.intp]:
        return np.cumsum(self.edge_counts)


def cap_stack(
    stack: SurfaceStack, links: Connections, usable: NDArray[np.bool_], tolerance: NDArray[np.float64]
) -> StackCaps | None:
    """Cap the `usable` surfaces of a stack that need nothing but caps. Points nearer than `tolerance`, (n,), touch."""
    can = usable & links.is_open
    start, stop = links.open_sides
    owner, total = stack.point_owners, len(stack.points)
    leaving, arriving = np.bincount(start, minlength=total), np.bincount(stop, minlength=total)
    can &= np.logical_and.reduceat((leaving <= 1) & (leaving == arriving), stack.first_point)
    for chosen, reach in ((start, tolerance), (np.flatnonzero(can[owner]), np.zeros(len(can)))):
        of = owner[chosen]
        can[of[may_have_neighbor(stack.points[chosen], reach[of], of)]] = False
    onto = np.full(total, -1)
    onto[start] = stop
    begins, ends = side_ends(stack.triangles, np.arange(stack.triangles.size))
    is_side = onto[begins] == ends
    found = np.add.reduceat(is_side, 3 * stack.first_triangle, dtype=np.intp)
    sides = np.repeat(can, 3 * stack.triangle_counts)
    key = np.sort(begins[sides] * total + ends[sides])
    can[owner[key[1:][key[1:] == key[:-1]] // total]] = False  # diagonals may run along edges
    can &= found + stack.triangle_counts <= MAX_SMALL_TRIANGLES
    can &= np.logical_and.reduceat(has_distinct_vertices(stack.triangles), stack.first_triangle)
    side = np.flatnonzero(is_side)
    while can.any():
        side = side[can[owner[begins[side]]]]
        start, stop = begins[side], ends[side]
        begin, end = stack.points[start].astype(np.float64), stack.points[stop].astype(np.float64)
        loops = find_loops(begin, end, join_sides(begin, end, start, stop, directed=True))
        of_loop = loops.of_each(owner[start])
        bad = ~loops.complete | ~loops.has_area(tolerance[of_loop])
        if not bad.any():
            part = _numbered_by_triangles(links.component[stack.triangle_faces])
            return _capped(stack, part, can, tolerance, (side // 3, start, stop), loops, of_loop)
        can[of_loop[bad]] = False
    return None


def _numbered_by_triangles(part: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return labels from 0 on, in the order of the first triangles that have them."""
    _, first, number = np.unique(part, return_index=True, return_inverse=True)
    return first.argsort().argsort()[number.ravel()]


def _capped(
    stack: SurfaceStack,
    part: NDArray[np.intp],
    is_capped: NDArray[np.bool_],
    tolerance: NDArray[np.float64],
    sides: tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]],
    loops: BoundaryLoops,
    of_loop: NDArray[np.intp],
) -> StackCaps:
    """Add the cones over their loops to the surfaces.

    part: (t,) the component of each triangle. sides: the triangle of each side, its start and its stop; of_loop: the
    surface of each loop.
    """
    triangle, start, stop = sides
    count, body = len(stack), stack.point_owners[start]
    loop_counts = np.bincount(of_loop, minlength=count)
    shift = segment_starts(loop_counts)
    start_moved, stop_moved = start + shift[body], stop + shift[body]
    ends = stack.first_point + stack.point_counts
    apex = loops.apexes(start_moved, ends[of_loop] + np.arange(len(of_loop)))
    caps = np.stack([stop_moved, start_moved, apex[loops.of_side]], axis=1)
    kept = has_distinct_vertices(caps)
    caps, cap_body, cap_part = caps[kept], body[kept], part[triangle[kept]]
    cap_counts, after = np.bincount(cap_body, minlength=count), (stack.first_triangle + stack.triangle_counts)[cap_body]
    moved = stack.triangles + np.repeat(shift, stack.triangle_counts)[:, None]
    triangles = TriangleStack(
        np.insert(stack.points, ends[of_loop], loops.centroid.astype(stack.points.dtype), axis=0),
        np.insert(moved, after, caps, axis=0),
        stack.point_counts + loop_counts,
        stack.triangle_counts + cap_counts,
    )
    of_part = loops.of_each(part[triangle])
    part_owner = np.zeros(int(part.max()) + 1, np.intp)
    part_owner[part] = np.repeat(np.arange(count), stack.triangle_counts)
    counts = [  # part by part, as of one body
        np.bincount(part_owner, np.bincount(of_part, column, len(part_owner)), minlength=count)
        for column in loops.caps(tolerance[of_loop])
    ]
    low, high = np.minimum(start, stop) - stack.first_point[body], np.maximum(start, stop) - stack.first_point[body]
    edges = np.stack([low, high], axis=1)[np.lexsort((high, low, body))]
    return StackCaps(
        is_capped,
        triangles,
        np.insert(part, after, cap_part),
        cap_counts,
        np.stack(counts, axis=1).astype(np.float64),
        edges,
        np.bincount(body, minlength=count),
    )
