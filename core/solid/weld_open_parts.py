# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The first steps of a repair: vertices of open parts with equal positions become one vertex in the mesh.

Parts closed by themselves are not touched.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.edges import Edges, find_edges
from ..mesh.surface import Surface
from ..mesh.welding import first_at_equal_position, first_at_near_position, same_vertices_groups, vertex_tolerance
from ..numerics.graph import connected_components
from ..verdict.health import MeshHealth
from .boundary_loops import has_distinct_vertices, side_ends
from .duplicate_faces import is_duplicated
from .repaired_mesh import UNKNOWN, OpenParts, RepairedMesh, RepairState, copy_with


def split_into_triangles(surface: Surface) -> RepairedMesh:
    """Cut a surface, whose vertices all belong to faces, into triangles, and find the parts that welding may touch."""
    triangles, face = surface.all_triangles()
    triangles, count = triangles.astype(np.intp), len(triangles)
    edges, open_parts = _find_open_parts(surface, triangles, np.asarray(face, np.intp))
    return RepairedMesh(
        surface.points,
        triangles,
        np.asarray(face, np.intp),
        flipped=np.zeros(count, bool),
        component=np.zeros(count, np.intp),
        number=0,
        open=np.zeros(0, bool),
        caps=np.zeros((0, 3)),
        report=MeshHealth(closed=False, components=0),
        state=RepairState(triangles, edges or UNKNOWN, open_parts=open_parts),
    )


def weld_equal_positions(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Weld the vertices of open parts that are at exactly the same place."""
    parts = mesh.state.open_parts
    if parts is None:
        return mesh
    vertices = _unique_sorted(mesh.triangles[parts.rows], len(mesh.points))
    same = first_at_equal_position(mesh.points[vertices])
    if np.array_equal(same, np.arange(len(same))):
        return mesh
    mesh, onto = _weld(mesh, parts.rows, vertices, same)
    rows = parts.rows[has_distinct_vertices(mesh.triangles[parts.rows])]
    edges = find_edges(mesh.triangles[rows])
    vertices = _unique_sorted(onto[parts.vertices], len(mesh.points))
    return mesh.with_state(
        edges=edges if parts.are_all and len(rows) else UNKNOWN,
        open_parts=copy_with(parts, rows=rows, vertices=vertices) if np.any(edges.count % 2) else None,
    )


def weld_near_positions(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Weld vertices along open edges that are nearer than the tolerance, and near compared with their triangles."""
    parts = mesh.state.open_parts
    if parts is None:
        return mesh
    vertices = parts.vertices
    reach = vertex_tolerance(mesh.points, mesh.triangles[parts.rows], vertices, tolerance)
    same = first_at_near_position(mesh.points[vertices], reach)
    if np.array_equal(same, np.arange(len(same))):
        return mesh
    place = mesh.points[vertices].astype(np.float64)
    moved = float(np.linalg.norm(place - place[same], axis=1).max())
    mesh, _ = _weld(mesh, parts.rows, vertices, same)
    return copy_with(mesh, max_displacement=moved, topology_changed=True).with_state(edges=UNKNOWN, open_parts=None)


def drop_collapsed_triangles(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Leave out triangles that use a vertex twice, and find the edges of the others."""
    edges, proper = mesh.state.edges, has_distinct_vertices(mesh.triangles)
    if not proper.all():
        mesh = mesh.with_rows(np.flatnonzero(proper))
    elif edges is not None:
        return mesh
    if edges is None and len(mesh.triangles):
        edges = find_edges(mesh.triangles)
    return mesh.with_state(edges=edges)


def _find_open_parts(
    surface: Surface, triangles: NDArray[np.intp], face: NDArray[np.intp]
) -> tuple[Edges | None, OpenParts | None]:
    """Return the edges of the triangles with three different vertices, if known, and the parts to weld."""
    rows = np.flatnonzero(has_distinct_vertices(triangles))
    if not len(rows):
        return None, None
    count = len(surface.points)
    if len(triangles) * 3 == count:  # a soup: no edge has two triangles
        return None, OpenParts(rows, _unique_sorted(triangles[rows], count), True)
    edges = find_edges(triangles[rows], len(surface.quads) if len(rows) == len(triangles) else 0)
    odd = edges.count % 2 == 1
    if not odd.any():
        return edges, None
    vertices = _unique_sorted(np.concatenate(side_ends(triangles[rows], edges.first[odd])), count)
    part, number = connected_components(len(rows), *edges.adjacency())
    is_open = np.zeros(number, bool)
    is_open[part[edges.first[odd] // 3]] = True
    whole = ~is_open[part]
    if whole.any():  # A part closed only by copies of its own faces is a piece of another part.
        single = np.zeros(len(rows), bool)
        whole_face = face[rows[whole]]
        single[whole] = ~is_duplicated(same_vertices_groups(triangles[rows[whole]], whole_face), whole_face)
        is_open |= np.bincount(part, single) == 0
    return edges, OpenParts(rows[is_open[part]], vertices, bool(is_open.all()))


def _weld(
    mesh: RepairedMesh, rows: NDArray[np.intp], vertices: NDArray[np.intp], same: NDArray[np.intp]
) -> tuple[RepairedMesh, NDArray[np.intp]]:
    """Return the mesh with vertices replaced by `vertices[same]` in `rows`, and (n,) the new vertex of each vertex."""
    triangles, onto = mesh.triangles.copy(), np.arange(len(mesh.points))
    onto[vertices] = vertices[same]
    triangles[rows] = onto[triangles[rows]]
    return copy_with(mesh, triangles=triangles).with_report(welded=True), onto


def _unique_sorted(values: NDArray[np.integer], width: int) -> NDArray[np.intp]:
    """Return the distinct values, sorted."""
    present = np.zeros(width, bool)
    present[values] = True
    return np.flatnonzero(present)
