# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of a file as arrays, the same for every format; the bounding box of finite coordinates in
blocks.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..files import refuse_non_finite
from ..mesh import Surface, first_at_equal_position
from ..numerics import Array, Index, Mask, NDArray, segment_starts

CORNERS_PER_BLOCK = 1 << 18  # corners of polygons that are cut into triangles at a time

Box = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A mesh of a file, not repaired.

    points: (n, 3). corners: (k,) vertices of all faces, one face after another. sides: (m,) the
    number of corners of each face. edges: (e, 2) edges beside faces. values: (n,) numbers of the
    vertices, by the name of their property.
    """

    name: str
    points: NDArray[np.floating]
    corners: NDArray[np.integer]
    sides: NDArray[np.integer]
    edges: NDArray[np.integer] = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    values: Mapping[str, NDArray[np.float32]] = field(default_factory=dict)

    def surface(self) -> Surface:
        """Return the faces as a surface of triangles, quads, and the triangles of larger
        polygons.
        """
        starts = segment_starts(self.sides)
        triangles: list[NDArray[np.integer]] = [np.zeros((0, 3), np.int32)]
        triangle_faces = [np.zeros(0, np.int32)]
        quads = np.zeros((0, 4), np.int32)
        quad_faces = np.zeros(0, np.int32)
        for count in np.unique(self.sides).tolist():
            faces = np.flatnonzero(self.sides == count).astype(np.int32)
            corners = self.corners[starts[faces, None] + np.arange(count)].astype(np.int32)
            if count == 4:
                quads = corners
                quad_faces = faces
            else:
                triangles.append(polygon_triangles(self.points, corners))
                triangle_faces.append(np.repeat(faces, count - 2))
        return Surface(
            self.points,
            np.concatenate(triangles),
            quads,
            np.concatenate(triangle_faces),
            quad_faces,
            self.corners.astype(np.int32),
        )


def name_of_file(path: Path) -> str:
    """Return the name of a file's one mesh, as Blender gives it: without the last suffix."""
    return path.stem.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


class Polygons:
    """Faces that come in blocks of (n, k) corners, each with the (n,) places of its faces in the
    file.
    """

    def __init__(self) -> None:
        self._blocks: list[tuple[Index, NDArray[np.integer]]] = []
        self._count = 0

    def add(self, corners: NDArray[np.integer], numbers: Index | None = None) -> None:
        """Add (n, k) corners of faces. numbers: (n,) their places among all faces, by default
        behind the faces that were added before.
        """
        numbers = self._count + np.arange(len(corners)) if numbers is None else numbers
        self._blocks.append((numbers, corners))
        self._count = max(self._count, int(numbers.max(initial=-1)) + 1)

    def join(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return corners and sides of all faces, without repeated corners and without faces of two
        corners.
        """
        sides = np.zeros(self._count, np.int64)  # stays 0 for faces that were not added
        for numbers, corners in self._blocks:
            sides[numbers] = corners.shape[1]
        starts = segment_starts(sides)
        joined = np.empty(int(sides.sum()), np.int64)
        for numbers, corners in self._blocks:
            joined[starts[numbers, None] + np.arange(corners.shape[1])] = corners
        return without_repeats(joined, sides[sides > 0])


def without_repeats(
    corners: NDArray[np.int64], sides: NDArray[np.int64]
) -> tuple[NDArray, NDArray]:
    """Return corners and sides of faces (`FileMesh`) without corners that repeat the one before,
    and without the faces that this leaves with one or two corners.

    Each face has at least three corners.
    """
    starts = segment_starts(sides)
    before = np.arange(len(corners)) - 1
    before[starts] += sides  # The corner before a face's first one is its last one.
    keep = corners != corners[before]
    if keep.all():
        return corners, sides
    remaining_sides = np.add.reduceat(keep, starts)
    keep &= np.repeat(remaining_sides > 2, sides)
    return corners[keep], remaining_sides[remaining_sides > 2]


def merge_equal(points: NDArray[np.float32]) -> tuple[NDArray[np.float32], Index]:
    """Return the different points among (n, 3), in the order of their first places, and the (n,)
    index of each point among them.
    """
    points = points + np.float32(0.0)  # This turns -0.0 into 0.0, which equals it.
    first = first_at_equal_position(points)
    is_first = first == np.arange(len(points))
    return points[is_first], (np.cumsum(is_first) - 1)[first]


def box_of_blocks(blocks: Iterable[NDArray[np.floating]], element: str) -> Box:
    """Return the least and the largest coordinates, (3,) each, of (n, 3) or (n, 3, 3) blocks, zeros
    if they have no rows.

    FileError, with the number of the first row that is not finite. element: the name of a row.
    """
    low = np.full(3, np.inf)
    high = np.full(3, -np.inf)
    row_count = bad_count = first_bad = 0
    for block in blocks:
        if not len(block):
            continue
        least, largest = Surface(block.reshape(-1, 3)).box
        if np.isfinite([least, largest]).all():
            low = np.minimum(low, least)
            high = np.maximum(high, largest)
        else:
            is_bad = ~np.isfinite(block.reshape(len(block), -1))
            if not bad_count:
                first_bad = row_count + int(np.argmax(is_bad.any(axis=1)))
            bad_count += int(np.count_nonzero(is_bad))
        row_count += len(block)
    refuse_non_finite(bad_count, element, first_bad)
    return (low, high) if row_count else (np.zeros(3), np.zeros(3))


def strip_triangles(strip: NDArray[np.integer]) -> NDArray[np.integer]:
    """Return the (n, 3) triangles of strips: (m,) vertices, with -1 between two strips."""
    corners = np.stack([strip[:-2], strip[1:-1], strip[2:]], axis=1)
    after_separator = np.where(strip < 0, np.arange(1, len(strip) + 1), 0)
    strip_starts = np.maximum.accumulate(after_separator)[:-2]
    is_odd = (np.arange(len(corners)) - strip_starts) % 2 == 1
    corners[is_odd, :2] = corners[is_odd, 1::-1]  # Every other triangle of a strip is turned.
    return corners[(corners >= 0).all(axis=1)]


def polygon_surface(points: NDArray[np.floating], faces: NDArray[np.integer]) -> Surface:
    """Return a surface of (n, k) faces: triangles, quads, or the triangles of larger polygons."""
    if faces.shape[1] == 4:
        return Surface(points, quads=faces)
    return Surface(points, polygon_triangles(points, faces))


def polygon_triangles(
    points: NDArray[np.floating], faces: NDArray[np.integer]
) -> NDArray[np.integer]:
    """Return the (m, 3) triangles of (n, k) faces, one face after another."""
    return faces if faces.shape[1] == 3 else tessellate(points, faces).reshape(-1, 3)


def tessellate(points: NDArray[np.floating], polygons: NDArray[np.integer]) -> NDArray[np.integer]:
    """Return the (n, k - 2, 3) triangles of (n, k) polygons over (m, 3) points, as Blender draws
    them: ears are cut.

    D. Eberly, Triangulation by Ear Clipping. The search for the next ear begins one corner beyond
    the last one, and turns back if that corner is no ear.
    """
    count, sides = polygons.shape
    triangles = np.empty((count, sides - 2, 3), polygons.dtype)
    step = max(1, CORNERS_PER_BLOCK // sides)
    for start in range(0, count, step):
        block = polygons[start : start + step]
        ears = _Ears(_flatten(points[block].astype(np.float64))).cut()
        triangles[start : start + step] = block[np.arange(len(block))[:, None, None], ears]
    return triangles


def _flatten(corners: Array) -> Array:
    """Return the (n, k, 2) corners of (n, k, 3) polygons in the planes of their mean normals, so
    that each is counter-clockwise; zeros for a polygon without area.
    """
    from_first = corners - corners[:, :1]
    normal = np.cross(from_first, np.roll(from_first, -1, axis=1)).sum(axis=1)
    # The coordinate axis that is farthest from the normal is never parallel to it.
    axis = np.zeros_like(normal)
    axis[np.arange(len(normal)), np.abs(normal).argmin(axis=1)] = 1.0
    right = np.cross(axis, normal)
    # The smallest float keeps zero vectors zero.
    right /= np.maximum(np.linalg.norm(right, axis=1), np.finfo(float).tiny)[:, None]
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    up = np.cross(normal, right)
    return np.stack(
        [np.einsum("nki,ni->nk", from_first, direction) for direction in (right, up)], axis=2
    )


class _Ears:
    """Polygons of k corners, (n, k, 2), from which ears are cut, one from each at a time.

    before, after: (n, k) neighbors of the corners that are left. sign: (n, k) 1 for convex corners,
    0 for straight ones, -1 for concave ones.
    """

    def __init__(self, corners: Array) -> None:
        self._corners = corners
        self._count, self._sides = corners.shape[:2]
        self._polygons = np.arange(self._count)
        ring = np.arange(self._sides)
        self._before = np.roll(ring, 1)[None].repeat(self._count, 0)
        self._after = np.roll(ring, -1)[None].repeat(self._count, 0)
        self._is_left = np.ones((self._count, self._sides), bool)
        self._sign = np.stack(
            [self._signs(self._polygons, np.full(self._count, corner)) for corner in ring], axis=1
        )

    def cut(self) -> Index:
        """Return the (n, k - 2, 3) corners of the triangles, from 0 to k - 1."""
        polygons = self._polygons
        before = self._before
        after = self._after
        start = np.zeros(self._count, np.intp)
        is_backward = np.zeros(self._count, bool)
        triangles = np.empty((self._count, self._sides - 2, 3), np.intp)
        for k in range(self._sides - 3):
            ear = self._find_ears(start, is_backward, self._sides - k)
            previous = before[polygons, ear]
            following = after[polygons, ear]
            triangles[:, k] = np.stack([previous, ear, following], axis=1)
            after[polygons, previous] = following
            before[polygons, following] = previous
            self._is_left[polygons, ear] = False
            # The angles at both neighbors of the ear shrink, so that convex corners stay convex.
            for corner in (previous, following):
                sign = self._sign[polygons, corner]
                self._sign[polygons, corner] = np.where(
                    sign > 0, sign, self._signs(polygons, corner)
                )
            # The next search begins one corner beyond the ear's neighbor; if that corner is no
            # ear, one further on, in the other direction.
            start = np.where(is_backward, before[polygons, previous], after[polygons, following])
            turns_back = self._sign[polygons, start] <= 0
            beyond = np.where(is_backward, before[polygons, start], after[polygons, start])
            start = np.where(turns_back, beyond, start)
            is_backward ^= turns_back
        corner = self._is_left.argmax(axis=1)
        triangles[:, -1] = np.stack(
            [corner, after[polygons, corner], before[polygons, corner]], axis=1
        )
        return triangles

    def _find_ears(self, start: Index, is_backward: Mask, corners_left: int) -> Index:
        """Return the (n,) ears: convex corners, else straight ones, else those that are not
        concave, else any.

        start: (n,) the corners with which the search begins. is_backward: (n,) its direction.
        corners_left: the number of corners of each polygon.
        """
        ears = start.copy()  # the answer for polygons in which no pass finds an ear
        waiting = self._polygons  # the polygons without an ear so far
        for least_sign, largest_sign, is_checked in ((1, 1, True), (0, 0, True), (0, 1, False)):
            tip = start[waiting]
            for _ in range(corners_left):
                sign = self._sign[waiting, tip]
                is_ear = (sign >= least_sign) & (sign <= largest_sign)
                if is_checked:
                    candidates = np.flatnonzero(is_ear)
                    is_ear[candidates] = ~self._holds_corner(waiting[candidates], tip[candidates])
                ears[waiting[is_ear]] = tip[is_ear]
                waiting = waiting[~is_ear]
                tip = tip[~is_ear]
                if not len(waiting):
                    return ears
                tip = np.where(
                    is_backward[waiting], self._before[waiting, tip], self._after[waiting, tip]
                )
        return ears

    def _holds_corner(self, polygons: Index, tip: Index) -> Mask:
        """Return for each tip whether another corner that is not convex lies in the triangle of the
        tip and its neighbors, or on its edges.

        Convex corners need no test: if one lies in the triangle, so does one that is not convex.
        """
        ends = self._before[polygons, tip], tip, self._after[polygons, tip]
        others = self._is_left[polygons] & (self._sign[polygons] <= 0)
        for end in ends:
            others[np.arange(len(polygons)), end] = False
        row, corner = np.nonzero(others)
        point = self._corners[polygons[row], corner]
        a, b, c = (self._corners[polygons[row], end[row]] for end in ends)
        is_within = (
            (_area(a, b, point) >= 0.0) & (_area(b, c, point) >= 0.0) & (_area(c, a, point) >= 0.0)
        )
        return np.bincount(row[is_within], minlength=len(polygons)) > 0

    def _signs(self, polygons: Index, corner: Index) -> NDArray[np.int8]:
        """Return whether corners of polygons are convex (1), straight (0) or concave (-1)."""
        ends = self._before[polygons, corner], corner, self._after[polygons, corner]
        return np.sign(_area(*(self._corners[polygons, end] for end in ends))).astype(np.int8)


def _area(a: NDArray, b: NDArray, c: NDArray) -> Array:
    """Return twice the signed areas of (n, 2) triangles, positive if they are counter-clockwise."""
    return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
