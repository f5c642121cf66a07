# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that are not flat, and faces without area.

A face that is not flat has no volume under it until somebody chooses its diagonals. For a quad the
two choices differ by the tetrahedron of its corners, |(b-a)·((c-a)×(d-b))|/6. For a polygon, the
fans from its first and its second corner differ by tetrahedra that join the edge of these two
corners to each other edge. A face counts as not flat if its diagonals pass each other by more than
its coordinates' own errors and a millionth of its size, and it has an area.

The kernel of the moments hands these numbers to a `PlanarityAccumulator`, a block at a time; a
quad's normal is the sum of its triangles' normals. Faces that may have no area, and polygons, are
classified one by one.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numerics import (
    Array,
    Index,
    Mask,
    NDArray,
    cross,
    dot,
    segment_ranges,
    segment_starts,
    sums_by_index,
)
from .edges import ring_sizes
from .surface import Surface, face_of_each
from .surface_stack import SurfaceStack

FACES_PER_BLOCK = 1 << 14
PLANAR_RTOL = 1e-6  # relative to the square root of a face's area
ZERO_AREA_RTOL = 1e-12  # relative to a face's size, for float64 points
NO_FACES = np.empty(0, np.intp)
# corners (i, j) whose differences i - j are taken
QUAD = ((2, 0), (3, 1), (1, 0))
TRIANGLE = ((1, 0), (2, 0))


@dataclass(frozen=True, eq=False)
class Planarity:
    """Planarity of the faces of a surface.

    non_planar_count: faces that are not planar; volume_spread: the volume that the choice of their
    diagonals can change; degenerate_faces: (k,) the faces without area.
    """

    non_planar_count: int
    volume_spread: float
    degenerate_faces: NDArray[np.integer]


@dataclass(frozen=True, eq=False)
class _PlanarityPartial:
    """Results of one block: counts of faces and of surely non-planar ones, 6 times their spread,
    and undecided rows.
    """

    count: int
    non_planar_count: int
    volume_spread: float
    undecided: Index


class PlanarityAccumulator:
    """Planarity of a surface's quads, and of its polygons if it has the mesh's corners.

    Safe in threads.

    error: bound of the distance of points from their intended places (unit).
    """

    def __init__(self, surface: Surface, error: float):
        self.surface, self.error = surface, error
        low, high = surface.box
        self.extent = size = float((high - low).max())
        self.quads: dict[int, _PlanarityPartial] = {}
        self.triangles: dict[int, _PlanarityPartial] = {}
        # Faces classified one by one are scaled to about size 1, because sixth powers of small
        # lengths underflow.
        self.exponent = int(np.frexp(max(size, float(np.finfo(np.float32).tiny)))[1])

    @cached_property
    def degenerate_limit(self) -> float:
        """The largest length of the normal, for a quad the sum of its triangles' normals, of a face
        that may have no area. It is twice the limit, so that the kernel's rounding cannot decide.
        """
        longest = 3.0 * self.extent * self.extent  # no face is longer than √3 times the extent
        return float(2.0 * np.sqrt(_degenerate_limit(longest, self.error)))

    def add_quads(self, start: int, normals: NDArray, volume: NDArray) -> None:
        """Add the quads from row `start` on, by (k,) lengths of their normals and 6 times their
        corners' tetrahedra.
        """
        narrow = np.flatnonzero(normals <= self.degenerate_limit)
        # Six tetrahedra are the normal times the distance of the diagonals. Errors of the points
        # change this by 2 errors at most; 8 leaves a margin.
        limit = normals * (8.0 * self.error + PLANAR_RTOL * np.sqrt(normals))
        limit[narrow] = np.inf  # they are classified later
        bent = volume[volume > limit]
        self.quads[start] = _PlanarityPartial(
            len(volume), len(bent), float(np.add.reduce(bent)), start + narrow
        )

    def add_triangles(self, start: int, normals: NDArray) -> None:
        """Add the triangles from row `start` on, by the (k,) lengths of their normals."""
        narrow = np.flatnonzero(normals <= self.degenerate_limit)
        self.triangles[start] = _PlanarityPartial(len(normals), 0, 0.0, start + narrow)

    def planarity(self) -> Planarity:
        """Return the planarity from the kernel's reports, and from a pass over the faces that these
        leave undecided.
        """
        surface = self.surface
        quads = _merge_blocks(self.quads, len(surface.quads))
        volumes, is_degenerate = self._classify(surface.quads[quads.undecided], QUAD)
        non_planar_count = quads.non_planar_count + np.count_nonzero(volumes)
        scaled_spread = _sum_in_order(volumes)
        degenerate_quads = quads.undecided[is_degenerate]
        if surface.quad_faces is not None:
            degenerate_quads = surface.quad_faces[degenerate_quads]

        undecided = _merge_blocks(self.triangles, len(surface.triangles)).undecided
        _, is_degenerate = self._classify(surface.triangles[undecided], TRIANGLE)
        degenerate = undecided[is_degenerate]
        if surface.triangle_faces is not None:
            # A polygon is degenerate if all its triangles are.
            pieces = np.bincount(surface.triangle_faces)
            degenerate_pieces = np.bincount(
                surface.triangle_faces[degenerate], minlength=len(pieces)
            )
            degenerate = np.flatnonzero((degenerate_pieces == pieces) & (pieces > 0))
            polygon, corners = self._polygon_tetrahedra(np.flatnonzero(pieces > 1))
            volumes, _ = self._classify(corners, QUAD)
            non_planar_count += len(np.unique(polygon[volumes > 0.0]))
            scaled_spread += _sum_in_order(volumes)
        spread = quads.volume_spread + float(np.ldexp(scaled_spread, 3 * self.exponent))
        return Planarity(
            int(non_planar_count),
            spread / 6.0,
            np.sort(np.concatenate([degenerate_quads, degenerate])),
        )

    def _classify(self, corners: NDArray, pairs: tuple) -> tuple[Array, Mask]:
        """Return the results of `_classify_rows` for faces of the surface."""
        return _classify_rows(self.surface.points, corners, pairs, self.error, self.exponent)

    def _polygon_tetrahedra(self, polygons: Index) -> tuple[Index, NDArray[np.integer]]:
        """Return (m,) polygons, counted from 0, and (m, 4) corners of their tetrahedra. polygons:
        mesh faces of several triangles.
        """
        ring = self.surface.corner_vertices
        if ring is not None and len(polygons):
            quad_faces, triangle_faces = face_of_each(self.surface)
            sizes = ring_sizes(triangle_faces, quad_faces)
            if sizes.sum() == len(ring):
                return _tetrahedra(ring, segment_starts(sizes)[polygons], sizes[polygons])
        return NO_FACES, np.empty((0, 4), np.intp)


@dataclass(frozen=True, eq=False)
class StackPlanarity:
    """`Planarity` of each of n surfaces, and whether it has faces without area."""

    non_planar_counts: Index
    volume_spread: Array
    has_degenerate: Mask


def stack_planarity(stack: SurfaceStack) -> StackPlanarity:
    """Classify the faces of a stack one by one, as `PlanarityAccumulator` does for undecided
    faces.
    """
    count = len(stack.face_counts)
    face_count = int(stack.face_counts.sum())
    low, high = stack.box
    exponent = np.frexp(np.maximum((high - low).max(axis=1), float(np.finfo(np.float32).tiny)))[1]
    error = np.sqrt(np.add.reduce(stack.coordinate_error**2, axis=1))
    face_owner = np.repeat(np.arange(count), stack.face_counts)

    def classify(corners: NDArray, faces: NDArray, pairs: tuple) -> tuple[NDArray, NDArray]:
        """Return the results of `_classify_rows`. faces: (m,) the mesh face of each row."""
        owner = face_owner[faces]
        return _classify_rows(stack.points, corners, pairs, error[owner], exponent[owner])

    sizes = stack.face_sizes
    non_planar = np.zeros(face_count, bool)
    degenerate = np.zeros(face_count, bool)
    scaled_spread = np.zeros(count)
    is_quad = np.zeros(face_count, bool)
    is_quad[stack.quad_faces] = True
    if len(stack.quads):
        volumes, is_degenerate = classify(stack.quads, stack.quad_faces, QUAD)
        non_planar[stack.quad_faces] = volumes > 0.0
        degenerate[stack.quad_faces] = is_degenerate
        scaled_spread += np.bincount(face_owner[stack.quad_faces], volumes, count)
    # the halves of quads are among the triangles
    rows = np.flatnonzero(~is_quad[stack.triangle_faces]) if len(stack.quads) else slice(None)
    faces = stack.triangle_faces[rows]
    if len(faces):
        _, is_degenerate = classify(stack.triangles[rows], faces, TRIANGLE)
        pieces = np.bincount(faces, minlength=face_count)
        degenerate_pieces = np.bincount(faces[is_degenerate], minlength=face_count)
        degenerate |= (degenerate_pieces > 0) & (degenerate_pieces == pieces)
    polygons = np.flatnonzero((sizes > 3) & ~is_quad)
    if len(polygons):
        # A body may have corners that its faces do not account for: they shift those of later
        # bodies.
        first_corner = segment_starts(stack.corner_counts) - segment_starts(sizes)[stack.first_face]
        begin = (segment_starts(sizes) + first_corner[face_owner])[polygons]
        row, corners = _tetrahedra(stack.corner_vertices, begin, sizes[polygons])
        faces = polygons[row]
        volumes, _ = classify(corners, faces, QUAD)
        non_planar[faces[volumes > 0.0]] = True
        scaled_spread += np.bincount(face_owner[faces], volumes, count)
    return StackPlanarity(
        np.add.reduceat(non_planar, stack.first_face, dtype=np.intp),
        np.ldexp(scaled_spread, 3 * exponent) / 6.0,
        np.logical_or.reduceat(degenerate, stack.first_face),
    )


def _classify_rows(
    points: NDArray, corners: NDArray, pairs: tuple, error: float | NDArray, exponent: int | NDArray
) -> tuple[Array, Mask]:
    """Return (m,) 6 times the scaled tetrahedra of faces' corners, 0 if flat, and a mask of faces
    without area.

    The first numbers are empty for triangles. pairs: QUAD or TRIANGLE. error, exponent: one number,
    or (m,) numbers; faces are scaled by 2^-exponent.
    """
    volumes = [np.empty(0)]
    degenerate = [np.empty(0, bool)]
    for start in range(0, len(corners), FACES_PER_BLOCK):
        part = slice(start, start + FACES_PER_BLOCK)
        scale = -(exponent[part] if isinstance(exponent, np.ndarray) else exponent)
        off = np.ldexp(error[part] if isinstance(error, np.ndarray) else error, scale)
        coordinates = points[corners[part].astype(np.intp, copy=False)].T
        coordinates = np.ldexp(coordinates.astype(np.float64, order="C"), scale)
        first, second, *third = [coordinates[:, i] - coordinates[:, j] for i, j in pairs]
        across = cross(first, second)
        vectors = np.array([first, second, across])
        squares = np.add.reduce(vectors * vectors, axis=1)
        is_degenerate = squares[2] <= _degenerate_limit(np.maximum(squares[0], squares[1]), off)
        degenerate.append(is_degenerate)
        if third:
            volume = np.abs(dot(third[0], across))
            normal = np.sqrt(squares[2])
            is_flat = volume <= normal * (8.0 * off + PLANAR_RTOL * np.sqrt(normal))
            volume[is_flat | is_degenerate] = 0.0
            volumes.append(volume)
    return np.concatenate(volumes), np.concatenate(degenerate)


def _tetrahedra(
    ring: NDArray[np.integer], begin: NDArray[np.integer], sizes: NDArray[np.integer]
) -> tuple[Index, NDArray[np.integer]]:
    """Return (m,) polygons and (m, 4) corners of the tetrahedra of polygons that stand in `ring`
    from `begin` on.
    """
    steps = sizes - 3
    row = np.repeat(np.arange(len(sizes)), steps)
    at = begin[row] + 2 + segment_ranges(steps)
    return row, np.stack([ring[begin[row]], ring[begin[row] + 1], ring[at], ring[at + 1]], axis=1)


def _sum_in_order(volumes: Array) -> float:
    """Return the sum, added one by one as in a stack of bodies; `np.add.reduce` adds in another
    order.
    """
    return float(sums_by_index(np.zeros(len(volumes), np.intp), volumes, 1)[0])


def _merge_blocks(blocks: dict[int, _PlanarityPartial], count: int) -> _PlanarityPartial:
    """Merge the partial results of `count` rows in the order of the rows; if some are missing, all
    are undecided.
    """
    partials = [blocks[start] for start in sorted(blocks)]
    if sum([block.count for block in partials]) != count:
        return _PlanarityPartial(count, 0, 0.0, np.arange(count))
    return _PlanarityPartial(
        count,
        sum([block.non_planar_count for block in partials]),
        sum([block.volume_spread for block in partials]),
        np.concatenate([NO_FACES, *[block.undecided for block in partials]]),
    )


def _degenerate_limit(longest: NDArray | float, error: float | NDArray) -> NDArray | float:
    """Return the largest squared normal of a face without area, from its squared longest edge or
    diagonal.
    """
    return longest * (error * error + ZERO_AREA_RTOL * ZERO_AREA_RTOL * longest)
