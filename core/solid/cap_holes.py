# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes are capped: each boundary loop that has an area by the cone to its centroid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .boundary_loops import BoundaryLoops, find_loops, join_sides, vertex_pairs
from .repaired_mesh import RepairedMesh


def cap_holes(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Cap the boundary loops that have an area, each by the cone to its centroid."""
    side = mesh.state.uncapped_sides
    if not len(side):
        return mesh
    owner, (start, stop) = side // 3, mesh.oriented_ends(side)
    begin, end = mesh.points[start].astype(np.float64), mesh.points[stop].astype(np.float64)
    component = mesh.component[owner]
    meet = [component * len(mesh.points) + vertex for vertex in (start, stop)]
    loops = find_loops(begin, end, join_sides(begin, end, *meet, directed=True))
    of_loop = loops.of_each(component)
    is_open = mesh.open.copy()
    is_open[of_loop[~loops.complete]] = True
    # In the points' own type: a cap's apex then carries the same coordinate error as every vertex.
    return replace(
        mesh,
        points=np.concatenate([mesh.points, loops.centroid.astype(mesh.points.dtype)]),
        open=is_open,
        caps=_count_caps(loops, of_loop, is_open, tolerance),
        capped_edges=vertex_pairs(mesh.state.given, side),
        capped_component=component,
    ).with_caps(loops.cones(start, stop, len(mesh.points)), owner)


def _count_caps(
    loops: BoundaryLoops, of_loop: NDArray[np.intp], is_open: NDArray[np.bool_], tolerance: float
) -> NDArray[np.float64]:
    """Return (c, 3) numbers of flat and curved caps, and their area, by component. of_loop: (l,); is_open: (c,)."""
    hole = loops.has_area(tolerance) & ~is_open[of_loop]
    counts = [np.bincount(of_loop, column * hole, minlength=len(is_open)) for column in loops.caps(tolerance)]
    return np.stack(counts, axis=1).astype(np.float64, copy=False)
