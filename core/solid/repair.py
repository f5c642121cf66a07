# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain of steps that repair, on a copy, a surface that its mesh does not prove closed.

Each step takes a `RepairedMesh` and gives another one, with its findings added. No step touches parts that are closed
by themselves.
"""

from __future__ import annotations

from collections.abc import Callable

from ..mesh.surface import Surface
from .duplicate_faces import drop_duplicate_faces
from .hole_caps import (
    cap_holes,
    close_gaps,
    find_t_junctions,
    find_unclosable_components,
    orient_faces,
    report_closedness,
    turn_faces,
)
from .repaired_mesh import UNKNOWN, RepairedMesh, copy_with
from .weld_open_parts import drop_collapsed_triangles, split_into_triangles, weld_equal_positions, weld_near_positions

STEPS: tuple[Callable[[RepairedMesh, float], RepairedMesh], ...] = (
    weld_equal_positions,  # in parts with odd edges: one face, or three
    weld_near_positions,  # along the edges that are then still odd
    drop_collapsed_triangles,
    drop_duplicate_faces,
    find_t_junctions,
    orient_faces,
    find_unclosable_components,
    close_gaps,
    cap_holes,
    turn_faces,
    report_closedness,
)


def repair_surface(surface: Surface, tolerance: float, weld_near: bool = True) -> RepairedMesh:
    """Repair a surface, whose vertices all belong to faces, on a copy. The steps end if no triangle is left.

    tolerance: positions nearer than this (unit) count as equal at open edges, and loops narrower than this have no
    area.
    """
    mesh = split_into_triangles(surface)
    for step in STEPS:
        if len(mesh.triangles) and (weld_near or step is not weld_near_positions):
            mesh = step(mesh, tolerance)
    return copy_with(mesh, state=UNKNOWN)
