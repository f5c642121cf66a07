# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The first steps of a repair, of open parts only: vertices at equal positions are welded, copies
of faces left out.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..mesh import (
    Edges,
    Surface,
    face_of_each,
    find_edges,
    first_at_equal_position,
    first_at_near_position,
    normals,
    ring_sizes,
    same_vertices_groups,
    vertex_tolerance,
)
from ..numerics import Array, Index, Integers, Mask, connected_components, first_occurrence
from ..verdict import NEGLIGIBLE, MeshHealth, finding
from .boundary_loops import distinct_vertex_pairs, has_distinct_vertices, side_ends
from .findings import DUPLICATE_FACES_COUNTED, DUPLICATE_FACES_IGNORED, VERTICES_WELDED
from .repaired_mesh import UNKNOWN, OpenParts, RepairedMesh, RepairState, copy_with


def split_into_triangles(surface: Surface, tolerance: float) -> RepairedMesh:
    """Cut a surface, whose vertices all belong to faces, into triangles, and find the parts that
    welding may touch. tolerance: as in `RepairState`.
    """
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
        state=RepairState(triangles, tolerance, edges or UNKNOWN, open_parts=open_parts),
    )


def weld_patches(mesh: RepairedMesh) -> RepairedMesh:
    """Weld the open parts whose faces are all copies of faces of closed parts onto these."""
    parts = mesh.state.open_parts
    if parts is None or parts.are_all:
        return mesh
    open_triangles = mesh.triangles[parts.rows]
    open_vertices = _unique_sorted(open_triangles, len(mesh.points))
    closed = _closed_near(mesh, parts, open_vertices)
    if not len(closed):
        return mesh
    fixed = np.setdiff1d(mesh.triangles[closed], open_vertices)
    vertices = np.concatenate([fixed, open_vertices])  # the first of a cluster is a fixed one
    rows = np.concatenate([closed, parts.rows])
    reach = vertex_tolerance(mesh.points, mesh.triangles[rows], vertices, mesh.state.tolerance)
    onto = np.arange(len(mesh.points))
    onto[vertices] = vertices[first_at_near_position(mesh.points[vertices], reach)]
    onto[fixed] = fixed  # though a fixed vertex may be near another one
    triangles = np.concatenate([mesh.triangles[closed], onto[open_triangles]])
    group = same_vertices_groups(triangles, mesh.face[rows])
    is_copy = np.isin(group[len(closed) :], group[: len(closed)])
    part, number = connected_components(
        len(open_triangles), *find_edges(open_triangles).adjacency()
    )
    is_patch = np.bincount(part, ~is_copy, number)[part] == 0.0
    if not is_patch.any():
        return mesh
    patch = open_triangles[is_patch]
    moved = mesh.points[patch].astype(np.float64) - mesh.points[onto[patch]]
    size = np.linalg.norm(np.ptp(mesh.points, axis=0))
    share = float(np.linalg.norm(moved, axis=2).max() / size)
    welded = mesh.triangles.copy()
    welded[parts.rows[is_patch]] = onto[patch]
    mesh = copy_with(mesh, triangles=welded).with_findings(finding(VERTICES_WELDED, share=share))
    open_parts = None
    if not is_patch.all():
        vertices = np.intersect1d(parts.vertices, open_triangles[~is_patch])
        open_parts = copy_with(parts, rows=parts.rows[~is_patch], vertices=vertices)
    return mesh.with_report(welded=True).with_state(edges=UNKNOWN, open_parts=open_parts)


def _closed_near(mesh: RepairedMesh, parts: OpenParts, open_vertices: Index) -> Index:
    """Return the (k,) triangles of closed parts, with three different vertices, that are within the
    box of the open vertices.
    """
    tolerance = mesh.state.tolerance
    places = mesh.points[open_vertices]
    low, high = places.min(axis=0), places.max(axis=0)
    is_near = ((mesh.points >= low - tolerance) & (mesh.points <= high + tolerance)).all(axis=1)
    is_candidate = is_near[mesh.triangles].all(axis=1) & has_distinct_vertices(mesh.triangles)
    is_candidate[parts.rows] = False
    return np.flatnonzero(is_candidate)


def weld_equal_positions(mesh: RepairedMesh) -> RepairedMesh:
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
    open_parts = None
    if np.any(edges.count % 2):
        vertices = _unique_sorted(onto[parts.vertices], len(mesh.points))
        open_parts = copy_with(parts, rows=rows, vertices=vertices)
    return mesh.with_state(
        edges=edges if parts.are_all and len(rows) else UNKNOWN, open_parts=open_parts
    )


def weld_near_positions(mesh: RepairedMesh) -> RepairedMesh:
    """Weld vertices along open edges that are nearer than the tolerance, and near compared with
    their triangles.
    """
    parts = mesh.state.open_parts
    if parts is None:
        return mesh
    vertices = parts.vertices
    reach = vertex_tolerance(
        mesh.points, mesh.triangles[parts.rows], vertices, mesh.state.tolerance
    )
    same = first_at_near_position(mesh.points[vertices], reach)
    if np.array_equal(same, np.arange(len(same))):
        return mesh
    place = mesh.points[vertices].astype(np.float64)
    moved = float(np.linalg.norm(place - place[same], axis=1).max())
    mesh, _ = _weld(mesh, parts.rows, vertices, same)
    return copy_with(mesh, max_displacement=moved, topology_changed=True).with_state(
        edges=UNKNOWN, open_parts=None
    )


def drop_collapsed_triangles(mesh: RepairedMesh) -> RepairedMesh:
    """Leave out triangles that use a vertex twice, and find the edges of the others, unless an
    earlier step has: `RepairState.edges` are numbered as if the left out triangles did not exist.
    """
    edges = mesh.state.edges
    proper = has_distinct_vertices(mesh.triangles)
    if not proper.all():
        mesh = mesh.with_rows(np.flatnonzero(proper))
    if edges is UNKNOWN and len(mesh.triangles):
        edges = find_edges(mesh.triangles)
    return mesh.with_state(edges=edges)


def _find_open_parts(
    surface: Surface, triangles: Index, face: Index
) -> tuple[Edges | None, OpenParts | None]:
    """Return the edges of the triangles that have three different vertices, None if they are not
    looked for; and the parts to weld, None if all are closed.
    """
    rows = np.flatnonzero(has_distinct_vertices(triangles))
    if not len(rows):
        return None, None
    count = len(surface.points)
    if len(triangles) * 3 == count:  # a soup: no edge has two triangles
        return None, OpenParts(rows, _unique_sorted(triangles[rows], count), True)
    # The halves of the quads are last, in pairs, unless a triangle is missing.
    edges = find_edges(triangles[rows], len(surface.quads) if len(rows) == len(triangles) else 0)
    odd = edges.count % 2 == 1
    if not odd.any():
        return edges, None
    vertices = _unique_sorted(np.concatenate(side_ends(triangles[rows], edges.first[odd])), count)
    part, number = connected_components(len(rows), *edges.adjacency())
    is_open = np.zeros(number, bool)
    is_open[part[edges.first[odd] // 3]] = True
    is_whole = ~is_open[part]
    if is_whole.any():  # A part closed only by copies of its own faces is a piece of another part.
        is_single = np.zeros(len(rows), bool)
        whole_face = face[rows[is_whole]]
        is_single[is_whole] = ~is_duplicated(
            same_vertices_groups(triangles[rows[is_whole]], whole_face), whole_face
        )
        is_open |= np.bincount(part, is_single) == 0
    return edges, OpenParts(rows[is_open[part]], vertices, bool(is_open.all()))


def _weld(
    mesh: RepairedMesh, rows: Index, vertices: Index, same: Index
) -> tuple[RepairedMesh, Index]:
    """Return the mesh with vertices replaced by `vertices[same]` in `rows`, and (n,) the new vertex
    of each vertex.
    """
    triangles = mesh.triangles.copy()
    onto = np.arange(len(mesh.points))
    onto[vertices] = vertices[same]
    triangles[rows] = onto[triangles[rows]]
    return copy_with(mesh, triangles=triangles).with_report(welded=True), onto


def _unique_sorted(values: Integers, width: int) -> Index:
    """Return the distinct values, sorted."""
    present = np.zeros(width, bool)
    present[values] = True
    return np.flatnonzero(present)


def drop_duplicate_faces(mesh: RepairedMesh) -> RepairedMesh:
    """Leave out faces on the same vertices as an earlier face, if one layer of them is meant.

    A region of copied faces is reduced to one layer if an odd number of other faces meets its
    boundary, so that one layer closes it. If an even number does, both layers belong: a wall
    between two boxes that touch, a two-sided fin. A region with no other faces at its boundary is
    reduced if its layers run the same way, or if one layer is closed: a two-sided body, which would
    cancel itself.
    """
    edges = mesh.state.edges
    face = mesh.face
    if edges.count.max() <= 2:  # copies fill the edges of their face: none has a neighbor
        return mesh
    # Sides of edges with more than two triangles, except pairs of one polygon's triangles, which
    # meet at its own diagonal.
    sides = np.flatnonzero((edges.count > 2)[edges.of_side])
    first = first_occurrence(edges.of_side[sides], face[sides // 3].astype(np.intp))
    sides = sides[np.bincount(first)[first] == 1]
    mesh = mesh.with_report(
        non_manifold_edges=len(np.unique(edges.of_side[sides])),
        elements={"non_manifold_edges": distinct_vertex_pairs(mesh.state.given, sides)},
    )
    group = same_vertices_groups(mesh.triangles, face)
    is_copy = group != face
    if not is_copy.any():
        return mesh
    copies = np.unique(face[is_copy])
    mesh = mesh.with_report(duplicate_faces=len(copies), elements={"duplicate_faces": copies})

    triangle_normals = normals(mesh.points, mesh.triangles)
    face_normals = np.stack([np.bincount(face, triangle_normals[:, k]) for k in range(3)], axis=1)
    area = np.linalg.norm(face_normals, axis=1)
    # Areas, negative for copies that run against the first of their faces.
    agreement = np.sign(np.einsum("ij,ij->i", face_normals[face], face_normals[group])) * area[face]
    reduced = _regions_of_one_layer(edges, is_copy, is_duplicated(group, face), agreement)
    left_out = is_copy & reduced
    ignored = np.unique(face[left_out])
    counted = np.unique(face[is_copy & ~reduced & (agreement > 0.0)])
    for code, faces in ((DUPLICATE_FACES_IGNORED, ignored), (DUPLICATE_FACES_COUNTED, counted)):
        if len(faces):
            slight = bool(area[faces].sum() < NEGLIGIBLE * area.sum())
            mesh = mesh.with_findings(finding(code, faces, slight=slight, count=len(faces)))
    if not len(ignored):
        return mesh
    mesh = copy_with(
        mesh.with_rows(np.flatnonzero(~left_out)), topology_changed=True, left_out=ignored
    )
    return mesh.with_state(edges=find_edges(mesh.triangles))


def copied_faces(surface: Surface) -> Integers:
    """Return the sorted (k,) mesh faces on the same vertices as an earlier one, which bound
    nothing.
    """
    triangles, face = surface.all_triangles()
    return np.unique(face[same_vertices_groups(triangles, face) != face])


def without_faces(surface: Surface, faces: Integers) -> Surface:
    """Return the surface without some mesh faces. The others keep their numbers."""
    quad_faces, triangle_faces = face_of_each(surface)
    quads = ~np.isin(quad_faces, faces)
    triangles = ~np.isin(triangle_faces, faces)
    sizes = ring_sizes(triangle_faces, quad_faces)
    corners = ~np.isin(np.repeat(np.arange(len(sizes)), sizes), faces)
    rings = surface.corner_vertices, surface.corner_edges
    vertices, edges = [
        ring[corners] if ring is not None and len(ring) == len(corners) else None for ring in rings
    ]
    return replace(
        surface,
        triangles=surface.triangles[triangles],
        quads=surface.quads[quads],
        triangle_faces=triangle_faces[triangles],
        quad_faces=quad_faces[quads],
        corner_vertices=vertices,
        corner_edges=edges,
    )


def is_duplicated(group: Integers, face: Integers) -> Mask:
    """Return an (m,) mask of triangles of faces on another face's vertices. group: from
    `same_vertices_groups`.
    """
    copied = np.zeros(int(face.max()) + 1, bool)
    copied[group[group != face]] = True
    return copied[group]


def _regions_of_one_layer(edges: Edges, is_copy: Mask, copied: Mask, agreement: Array) -> Mask:
    """Return an (m,) mask of triangles in regions to be reduced to one layer.

    is_copy: (m,) triangles of copies. copied: (m,) those, and those of the faces that they copy.
    agreement: (m,) areas of faces, negative for copies that run against the first of their group.
    """
    side = np.flatnonzero(np.repeat(copied, 3))
    edge = edges.of_side[side]
    triangle = side // 3
    any_triangle = np.empty(len(edges.count), np.intp)
    any_triangle[edge] = triangle  # the last one of several at an edge
    region, number = connected_components(len(copied), triangle, any_triangle[edge])
    region_of_side = region[triangle]
    other_count = np.bincount(edges.of_side, np.repeat(~copied, 3))[edge]
    # Each side with other faces beside it votes: 1 for one layer, -1 for both.
    vote = np.where(other_count % 2 == 1, 1, -1) * (other_count > 0)
    votes = np.bincount(region_of_side, vote, minlength=number)
    has_neighbors = np.bincount(region_of_side, other_count > 0, minlength=number) > 0
    is_parallel = np.bincount(region, agreement * is_copy) > 0
    first_layer = copied & ~is_copy
    is_open_side = np.bincount(edges.of_side, np.repeat(first_layer, 3))[edge] % 2 == 1
    is_closed = np.bincount(region_of_side, is_open_side, minlength=number) == 0
    return np.where(has_neighbors, votes > 0, is_parallel | is_closed)[region]
