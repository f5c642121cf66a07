# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A repair step: copies of faces are left out if the edges around them show that they are surplus."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..mesh.edges import Edges, face_of_each, find_edges, ring_sizes
from ..mesh.surface import Surface, normals
from ..mesh.welding import same_vertices_groups
from ..numerics.arrays import first_occurrence
from ..numerics.graph import connected_components
from ..verdict.finding import finding
from ..verdict.tolerances import NEGLIGIBLE
from .boundary_loops import distinct_vertex_pairs
from .findings import (
    DUPLICATE_FACES_COUNTED,
    DUPLICATE_FACES_IGNORED,
)
from .repaired_mesh import RepairedMesh, copy_with


def drop_duplicate_faces(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Leave out faces on the same vertices as an earlier face, if one layer of them is meant.

    A region of copied faces is reduced to one layer if an odd number of other faces meets its boundary, so that one
    layer closes it. If an even number does, both layers belong: a wall between two boxes that touch, a two-sided fin. A
    region with no other faces at its boundary is reduced if its layers run the same way, or if one layer is closed: a
    two-sided body, which would cancel itself.
    """
    edges, face = mesh.state.edges, mesh.face
    if edges.count.max() <= 2:  # copies of faces would have no others beside them
        return mesh
    sides = _non_manifold_sides(edges, face)
    mesh = mesh.with_report(
        non_manifold_edges=len(np.unique(edges.of_side[sides])),
        elements={"non_manifold_edges": distinct_vertex_pairs(mesh.state.given, sides)},
    )
    group = same_vertices_groups(mesh.triangles, face)
    later = group != face
    if not later.any():
        return mesh
    copies = np.unique(face[later])
    mesh = mesh.with_report(duplicate_faces=len(copies), elements={"duplicate_faces": copies})

    vector = normals(mesh.points, mesh.triangles)
    vector = np.stack([np.bincount(face, vector[:, k]) for k in range(3)], axis=1)  # Sum over each face.
    agree = np.sign(np.einsum("ij,ij->i", vector[face], vector[group])) * np.linalg.norm(vector[face], axis=1)
    reduced = _regions_of_one_layer(edges, later, is_duplicated(group, face), agree)
    left_out = later & reduced
    ignored, counted = np.unique(face[left_out]), np.unique(face[later & ~reduced & (agree > 0.0)])
    area = np.linalg.norm(vector, axis=1)
    for code, copies in ((DUPLICATE_FACES_IGNORED, ignored), (DUPLICATE_FACES_COUNTED, counted)):
        if len(copies):
            slight = bool(area[copies].sum() < NEGLIGIBLE * area.sum())
            mesh = mesh.with_findings(finding(code, copies, slight=slight, count=len(copies)))
    if not len(ignored):
        return mesh
    mesh = copy_with(mesh.with_rows(np.flatnonzero(~left_out)), topology_changed=True, left_out=ignored)
    return mesh.with_state(edges=find_edges(mesh.triangles))


def copied_faces(surface: Surface) -> NDArray[np.integer]:
    """Return the sorted (k,) mesh faces on the same vertices as an earlier one, which bound nothing."""
    triangles, face = surface.all_triangles()
    return np.unique(face[same_vertices_groups(triangles, face) != face])


def without_faces(surface: Surface, faces: NDArray[np.integer]) -> Surface:
    """Return the surface without some mesh faces. The others keep their numbers."""
    quad_faces, triangle_faces = face_of_each(surface)
    quads, triangles = ~np.isin(quad_faces, faces), ~np.isin(triangle_faces, faces)
    sizes = ring_sizes(triangle_faces, quad_faces)
    corners = ~np.isin(np.repeat(np.arange(len(sizes)), sizes), faces)
    rings = surface.corner_vertices, surface.corner_edges
    vertices, edges = [ring[corners] if ring is not None and len(ring) == len(corners) else None for ring in rings]
    return replace(
        surface,
        triangles=surface.triangles[triangles],
        quads=surface.quads[quads],
        triangle_faces=triangle_faces[triangles],
        quad_faces=quad_faces[quads],
        corner_vertices=vertices,
        corner_edges=edges,
    )


def is_duplicated(group: NDArray[np.integer], face: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Return an (m,) mask of triangles of faces on another face's vertices. group: from `same_vertices_groups`."""
    copied = np.zeros(int(face.max()) + 1, bool)
    copied[group[group != face]] = True
    return copied[group]


def _regions_of_one_layer(
    edges: Edges, later: NDArray[np.bool_], copied: NDArray[np.bool_], agree: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Return an (m,) mask of triangles in regions to be reduced to one layer; later, copied: masks; agree: signs."""
    side = np.flatnonzero(np.repeat(copied, 3))
    edge, owner = edges.of_side[side], side // 3
    meet = np.empty(len(edges.count), np.intp)
    meet[edge] = owner  # any triangle at the edge, the last write
    region, number = connected_components(len(copied), owner, meet[edge])
    single_count = np.bincount(edges.of_side, np.repeat(~copied, 3))[edge]
    vote = np.where(single_count % 2 == 1, 1, -1) * (single_count > 0)
    votes = np.bincount(region[owner], vote, minlength=number)
    has_neighbors = np.bincount(region[owner], single_count > 0, minlength=number) > 0
    parallel = np.bincount(region, agree * later)
    single = np.bincount(edges.of_side, np.repeat(copied & ~later, 3))[edge] % 2 == 1
    closed = np.bincount(region[owner], single, minlength=number) == 0
    return np.where(has_neighbors, votes > 0, (parallel > 0) | closed)[region]


def _non_manifold_sides(edges: Edges, face: NDArray[np.integer]) -> NDArray[np.intp]:
    """Return the sides on edges with more than two triangles, not counting both sides of a polygon's own diagonal."""
    sides = np.flatnonzero((edges.count > 2)[edges.of_side])
    first = first_occurrence(edges.of_side[sides], face[sides // 3].astype(np.intp))
    return sides[np.bincount(first)[first] == 1]
