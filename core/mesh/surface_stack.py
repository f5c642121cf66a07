# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many small surfaces as one: their arrays one after the other, so that numpy is called once for
all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numerics import (
    Array,
    Index,
    Mask,
    NDArray,
    as_unsigned,
    connected_components,
    segment_starts,
)
from .edges import ring_sizes
from .surface import HALVES, Surface, face_of_each, half_ulp, turned_quads

MAX_STACKED_COORDINATE = 2.0**127  # no sum of these is infinite in float32


@dataclass(frozen=True, eq=False)
class TriangleStack:
    """The triangles of n surfaces, with indices into their concatenated points; each surface has
    some.

    `points` are (p, 3), float32 or float64, `triangles` (t, 3), the counts (n,).
    """

    points: NDArray[np.floating]
    triangles: Index
    point_counts: Index
    triangle_counts: Index

    def __len__(self) -> int:
        return len(self.point_counts)

    def some(self, which: Index) -> TriangleStack:
        """Return the triangles of some of the surfaces, in ascending order."""
        if len(which) == len(self):
            return self
        is_owned_point, is_owned_triangle = self.owned(which)
        return TriangleStack(
            self.points[is_owned_point],
            (np.cumsum(is_owned_point) - 1)[self.triangles[is_owned_triangle]],
            self.point_counts[which],
            self.triangle_counts[which],
        )

    def owned(self, which: Index) -> tuple[Mask, Mask]:
        """Return masks of the points, (p,), and of the triangles, (t,), of some of the surfaces."""
        chosen = np.zeros(len(self), bool)
        chosen[which] = True
        return np.repeat(chosen, self.point_counts), np.repeat(chosen, self.triangle_counts)

    @cached_property
    def first_point(self) -> Index:
        """The (n,) indices of the surfaces' first points."""
        return segment_starts(self.point_counts)

    @cached_property
    def first_triangle(self) -> Index:
        """The (n,) indices of the surfaces' first triangles."""
        return segment_starts(self.triangle_counts)

    @cached_property
    def point_owners(self) -> Index:
        """The (p,) indices of the points' surfaces."""
        return np.repeat(np.arange(len(self)), self.point_counts)

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """The smallest and the largest coordinates of the surfaces, (n, 3) each."""
        rows = np.ascontiguousarray(self.points.T)
        starts = self.first_point
        low = np.minimum.reduceat(rows, starts, axis=1)
        high = np.maximum.reduceat(rows, starts, axis=1)
        return low.T.astype(np.float64), high.T.astype(np.float64)

    @cached_property
    def coordinate_error(self) -> Array:
        """The (n, 3) `Surface.coordinate_error` of each surface, which has no `displacement`."""
        low, high = self.box
        if self.points.dtype != np.float32:
            return np.zeros(low.shape)
        return half_ulp(np.maximum(high, -low))


@dataclass(frozen=True, eq=False)
class SurfaceStack(TriangleStack):
    """The arrays of n surfaces, by `from_surfaces`.

    Faces are the meshes' own, numbered on from surface to surface.

    `triangles`: (t, 3) all faces, quads cut as drawn; of each surface first its triangles, then its
    quads. `triangle_faces`, `quad_faces`: the face of each triangle, (t,), and of each of the (q,
    4) quads. `corner_vertices`, `corner_edges`: (c,) the meshes' corners and the edges that start
    there.
    """

    triangle_faces: Index
    quads: Index
    quad_faces: Index
    corner_vertices: Index
    corner_edges: Index
    corner_counts: Index
    face_counts: Index
    edge_counts: Index

    @staticmethod
    def takes(surfaces: Sequence[Surface], most: int) -> Mask:
        """Return an (n,) mask of the surfaces that can be stacked: with at most `most` triangles,
        the first one's type of numbers, moderate coordinates, existing vertices, and the mesh's own
        edges or faces of one size.
        """
        candidates = [
            i
            for i, surface in enumerate(surfaces)
            if surface.displacement is None
            and surface.points.dtype == surfaces[0].points.dtype
            and 0 < surface.triangle_count <= most
            and _has_rings(surface)
        ]
        fits = np.zeros(len(surfaces), bool)
        if candidates:
            fits[candidates] = _are_in_range([surfaces[i] for i in candidates])
        return fits

    @classmethod
    def from_surfaces(cls, surfaces: Sequence[Surface]) -> SurfaceStack:
        """Stack surfaces that it `takes`, at least one."""
        rings = [_rings(surface) for surface in surfaces]
        point_counts, corner_counts, loose_counts, quad_counts = np.array(
            [
                [len(surface.points), len(ring[0]), len(surface.triangles), len(surface.quads)]
                for surface, ring in zip(surfaces, rings)
            ]
        ).T
        bodies = np.arange(len(surfaces))
        of_triangle, of_quad, of_corner = (
            bodies.repeat(counts) for counts in (loose_counts, quad_counts, corner_counts)
        )
        points = np.concatenate([surface.points for surface in surfaces])
        triangles = np.concatenate([surface.triangles for surface in surfaces]).astype(np.intp)
        quads = np.concatenate([surface.quads for surface in surfaces]).astype(np.intp)
        quad_faces, triangle_faces = (
            np.concatenate(faces).astype(np.intp)
            for faces in zip(*[face_of_each(surface) for surface in surfaces])
        )
        corners, edges = (np.concatenate(each).astype(np.intp) for each in zip(*rings))
        edge_counts = np.maximum.reduceat(edges, segment_starts(corner_counts)) + 1
        face_counts = np.zeros(len(surfaces), np.intp)
        np.maximum.at(face_counts, of_triangle, triangle_faces + 1)
        np.maximum.at(face_counts, of_quad, quad_faces + 1)
        # The numbers go on from surface to surface.
        first_point = segment_starts(point_counts)
        first_face = segment_starts(face_counts)
        triangles += first_point[of_triangle][:, None]
        quads += first_point[of_quad][:, None]
        triangle_faces += first_face[of_triangle]
        quad_faces += first_face[of_quad]
        corners += first_point[of_corner]
        edges += segment_starts(edge_counts)[of_corner]
        if len(quads):
            order = np.concatenate([of_triangle, of_quad.repeat(2)]).argsort(kind="stable")
            halves = turned_quads(points, quads).take(HALVES, 1).reshape(-1, 3)
            triangles = np.concatenate([triangles, halves])[order]
            triangle_faces = np.concatenate([triangle_faces, quad_faces.repeat(2)])[order]
        return cls(
            points=points,
            triangles=triangles,
            point_counts=point_counts,
            triangle_counts=loose_counts + 2 * quad_counts,
            triangle_faces=triangle_faces,
            quads=quads,
            quad_faces=quad_faces,
            corner_vertices=corners,
            corner_edges=edges,
            corner_counts=corner_counts,
            face_counts=face_counts,
            edge_counts=edge_counts,
        )

    @cached_property
    def first_face(self) -> Index:
        """The (n,) indices of the surfaces' first faces."""
        return segment_starts(self.face_counts)

    @cached_property
    def face_sizes(self) -> Index:
        """The (f,) corner counts of faces, found from their triangles and quads; 0 for faces
        without any.
        """
        return ring_sizes(self.triangle_faces, self.quad_faces, int(self.face_counts.sum()))

    def uses_all_points(self) -> Mask:
        """Return an (n,) mask of the surfaces with all points used as corners of faces."""
        used = np.zeros(len(self.points), bool)
        used[self.triangles] = True
        return np.logical_and.reduceat(used, self.first_point)

    def connections(self) -> Connections:
        """Find the connections of the faces, by the meshes' own edges."""
        sizes = self.face_sizes
        starts = self.corner_vertices
        edges = self.corner_edges
        fits = np.add.reduceat(sizes, self.first_face) == self.corner_counts
        fits &= np.minimum.reduceat(sizes, self.first_face) > 0
        # If the corners of a surface do not fit its faces, its rings are unknown: they are left
        # out.
        if not fits.all():
            sizes = np.where(np.repeat(fits, self.face_counts), sizes, 0)
            known = np.repeat(fits, self.corner_counts)
            starts, edges = starts[known], edges[known]
        face = np.repeat(np.arange(len(sizes)), sizes)
        ring_sizes_known = sizes[sizes > 0]
        ring_ends = np.cumsum(ring_sizes_known)
        stops = np.concatenate([starts[1:], starts[:1]])
        if len(ring_ends):
            stops[ring_ends - 1] = starts[ring_ends - ring_sizes_known]
        # The corner from which each edge is run downward, and upward: -1 for none, and of several
        # the last one, so that the count of sides is then too small.
        edge_count = int(self.edge_counts.sum())
        corner = np.full(2 * edge_count, -1)
        corner[edges + edge_count * (starts < stops)] = np.arange(len(starts))
        down, up = corner.reshape(2, edge_count)
        has_down, has_up = down >= 0, up >= 0
        linked = has_down & has_up
        down, up = down[linked], up[linked]
        first_edge = segment_starts(self.edge_counts)
        pairs = np.add.reduceat(linked, first_edge, dtype=np.intp)
        single = np.add.reduceat(has_down ^ has_up, first_edge, dtype=np.intp)
        oriented = fits & (2 * pairs + single == self.corner_counts)
        wrong = (starts[down] != stops[up]) | (stops[down] != starts[up])
        if wrong.any():  # the two corners of an edge name different vertices
            oriented[self.point_owners[starts[down[wrong]]]] = False
        component, _ = connected_components(len(sizes), face[down], face[up])
        # Components are numbered by their first faces, so those of a surface follow each other.
        last = np.maximum.reduceat(component, self.first_face)
        is_open = oriented & (single > 0)
        sides = np.empty((2, 0), np.intp)
        if is_open.any():
            alone = np.ones(len(starts), bool)
            alone[down] = alone[up] = False
            sides = np.stack([starts[alone], stops[alone]])
            sides = sides[:, is_open[self.point_owners[sides[0]]]]
        return Connections(
            is_closed=oriented & (single == 0),
            is_open=is_open,
            component_counts=np.diff(last, prepend=-1),
            component=component,
            open_sides=sides,
        )


def _rings(surface: Surface) -> tuple[NDArray[np.integer], NDArray[np.integer]]:
    """Return a mesh's corners and edges, numbered by vertices if it has none of its own."""
    if surface.corner_vertices is not None and surface.corner_edges is not None:
        return surface.corner_vertices, surface.corner_edges
    faces = surface.triangles if len(surface.triangles) else surface.quads
    ends = np.array([faces, faces.take(np.arange(1, faces.shape[1] + 1), 1, mode="wrap")]).reshape(
        2, -1
    )
    keys = np.minimum(*ends).astype(np.intp) * len(surface.points) + np.maximum(*ends)
    return faces.ravel(), np.unique(keys, return_inverse=True)[1].ravel()


def _has_rings(surface: Surface) -> bool:
    """Return whether the corners and edges of a mesh are known, or its faces all of one size."""
    corners, edges = surface.corner_vertices, surface.corner_edges
    if corners is not None or edges is not None:
        return corners is not None and edges is not None and 0 < len(corners) == len(edges)
    is_numbered = surface.triangle_faces is not None or surface.quad_faces is not None
    return not is_numbered and not (len(surface.triangles) and len(surface.quads))


def _are_in_range(surfaces: Sequence[Surface]) -> Mask:
    """Return an (n,) mask of the surfaces with moderate coordinates, existing vertices, and edges
    with numbers below twice the number of corners.
    """
    point_counts = np.array([len(surface.points) for surface in surfaces])
    owner = np.repeat(np.arange(len(surfaces)), point_counts)
    is_moderate = np.abs(np.concatenate([surface.points for surface in surfaces])) < (
        MAX_STACKED_COORDINATE
    )
    in_range = np.ones(len(surfaces), bool)
    in_range[owner[~is_moderate.all(axis=1)]] = False
    for name in ("triangles", "quads", "corner_vertices", "corner_edges"):
        arrays = [getattr(surface, name) for surface in surfaces]
        which = [k for k, array in enumerate(arrays) if array is not None and len(array)]
        if which:
            flat = [arrays[k].ravel() for k in which]
            sizes = np.array([len(each) for each in flat])
            largest = np.maximum.reduceat(as_unsigned(np.concatenate(flat)), segment_starts(sizes))
            limit = 2 * sizes if name == "corner_edges" else point_counts[which]
            in_range[which] &= largest < limit
    return in_range


@dataclass(frozen=True, eq=False)
class Connections:
    """Connections of the faces of n surfaces, by their meshes' own edges.

    `is_closed`: every edge with faces has two, which run oppositely; `is_open`: or some have one
    face. `component_counts`: (n,); meaningless unless closed or open. `component`: (f,) of each
    face, by first face. `open_sides`: (2, k) start and end vertices of the sides with no other
    side, for the open surfaces.
    """

    is_closed: Mask
    is_open: Mask
    component_counts: Index
    component: Index
    open_sides: Index
