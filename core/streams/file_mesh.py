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
from ..numerics import Array, Index, Mask, NDArray

CORNERS_PER_BLOCK = 1 << 18

Box = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A mesh of a file, not repaired.

    points: (n, 3). corners: (k,) vertices of all faces, one face after another. sides: (m,) the
    number of corners of each face. edges: (e, 2) edges beside faces. values: (n,) numbers of the
    vertices, by name.
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
        starts = np.cumsum(self.sides) - self.sides
        faces = np.arange(len(self.sides))
        triangles: list[NDArray[np.integer]] = [np.zeros((0, 3), np.int32)]
        owners = [faces[:0]]
        quads = np.zeros((0, 4), np.int32)
        quad_faces = faces[:0]
        for count in np.unique(self.sides).tolist():
            these = faces[self.sides == count]
            corners = self.corners[starts[these, None] + np.arange(count)].astype(np.int32)
            if count == 4:
                quads, quad_faces = corners, these
                continue
            cut = tessellate(self.points, corners) if count > 3 else corners[:, None]
            triangles.append(cut.reshape(-1, 3))
            owners.append(np.repeat(these, count - 2))
        return Surface(
            self.points,
            np.concatenate(triangles),
            quads,
            np.concatenate(owners).astype(np.int32),
            quad_faces.astype(np.int32),
            self.corners.astype(np.int32),
        )


def name_of_file(path: Path) -> str:
    """Return the name of a file's one mesh, as Blender gives it: without the last suffix."""
    return path.stem.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


class Polygons:
    """Faces that come in blocks of (n, k) corners."""

    def __init__(self) -> None:
        self._blocks: list[tuple[Index, NDArray[np.integer]]] = []
        self._count = 0

    def add(self, corners: NDArray[np.integer], rows: Index | None = None) -> None:
        """Add faces. rows: (n,) their places among all faces, by default behind the others."""
        rows = self._count + np.arange(len(corners)) if rows is None else rows
        self._blocks.append((rows, corners))
        self._count = max(self._count, int(rows.max(initial=-1)) + 1)

    def join(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return corners and sides of all faces, without repeated corners and without faces of two
        corners.
        """
        sides = np.zeros(self._count, np.int64)
        for rows, corners in self._blocks:
            sides[rows] = corners.shape[1]
        starts = np.cumsum(sides) - sides
        joined = np.empty(int(sides.sum()), np.int64)
        for rows, corners in self._blocks:
            joined[starts[rows, None] + np.arange(corners.shape[1])] = corners
        return without_repeats(joined, sides[sides > 0])


def without_repeats(
    corners: NDArray[np.int64], sides: NDArray[np.int64]
) -> tuple[NDArray, NDArray]:
    starts = np.cumsum(sides) - sides
    before = np.arange(len(corners)) - 1
    before[starts] += sides
    keep = corners != corners[before]
    if keep.all():
        return corners, sides
    left = np.add.reduceat(keep, starts)
    keep &= np.repeat(left > 2, sides)
    return corners[keep], left[left > 2]


def merge_equal(points: NDArray[np.float32]) -> tuple[NDArray[np.float32], Index]:
    """Return the different points of (n, 3), in the order of their first places, and the (n,) index
    of each point.
    """
    points = points + np.float32(0.0)  # -0.0 equals 0.0
    first = first_at_equal_position(points)
    is_first = first == np.arange(len(points))
    return points[is_first], (np.cumsum(is_first) - 1)[first]


def box_of_blocks(blocks: Iterable[NDArray[np.floating]], element: str) -> Box:
    """Return the least and the largest coordinates of (n, 3) or (n, 3, 3) blocks, zeros if there
    are none.
    """
    low = np.full(3, np.inf)
    high = np.full(3, -np.inf)
    rows = bad = first = 0
    for block in blocks:
        least, largest = Surface(block.reshape(-1, 3)).box if len(block) else (low, high)
        if np.isfinite([least, largest]).all() or not len(block):
            low = np.minimum(low, least)
            high = np.maximum(high, largest)
        else:
            wrong = ~np.isfinite(block.reshape(len(block), -1))
            first = first if bad else rows + int(np.argmax(wrong.any(axis=1)))
            bad += int(np.count_nonzero(wrong))
        rows += len(block)
    refuse_non_finite(bad, element, first)
    return (low, high) if rows else (np.zeros(3), np.zeros(3))


def strip_triangles(strip: NDArray[np.integer]) -> NDArray[np.integer]:
    """Return the (n, 3) triangles of strips of vertices, which -1 separates."""
    corners = np.stack([strip[:-2], strip[1:-1], strip[2:]], axis=1)
    begins = np.maximum.accumulate(np.where(strip < 0, np.arange(1, len(strip) + 1), 0))[:-2]
    is_odd = (np.arange(len(corners)) - begins) % 2 == 1
    corners[is_odd, :2] = corners[is_odd, 1::-1]
    return corners[(corners >= 0).all(axis=1)]


def polygon_surface(points: NDArray[np.floating], faces: NDArray[np.integer]) -> Surface:
    """Return a surface of (n, k) faces: triangles, quads, or the triangles of larger polygons."""
    if faces.shape[1] == 4:
        return Surface(points, quads=faces)
    return Surface(
        points, faces if faces.shape[1] == 3 else tessellate(points, faces).reshape(-1, 3)
    )


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
    """Return the (n, k, 2) corners of (n, k, 3) polygons seen against their normals, stretched by
    any factor.
    """
    about = corners - corners[:, :1]
    normal = np.cross(about, np.roll(about, -1, axis=1)).sum(axis=1)
    least = np.zeros_like(normal)
    least[np.arange(len(normal)), np.abs(normal).argmin(axis=1)] = 1.0
    right = np.cross(least, normal)
    right /= np.maximum(np.linalg.norm(right, axis=1), np.finfo(float).tiny)[:, None]
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    return np.stack(
        [np.einsum("nki,ni->nk", about, axis) for axis in (right, np.cross(normal, right))], axis=2
    )


class _Ears:
    """Polygons of k corners, (n, k, 2), that are cut at the same time.

    before, after: (n, k) neighbors of the corners that are left. turn: (n, k) their signs, 1 for
    convex corners.
    """

    def __init__(self, corners: Array) -> None:
        self._corners = corners
        self._count, self._sides = corners.shape[:2]
        self._every = np.arange(self._count)
        ring = np.arange(self._sides)
        self._before, self._after = (
            np.roll(ring, way)[None].repeat(self._count, 0) for way in (1, -1)
        )
        self._is_left = np.ones((self._count, self._sides), bool)
        self._turn = np.stack(
            [self._signs(self._every, self._every * 0 + corner) for corner in ring], axis=1
        )

    def cut(self) -> Index:
        """Return the (n, k - 2, 3) corners of the triangles, from 0 to k - 1."""
        every = self._every
        before = self._before
        after = self._after
        start = np.zeros(self._count, np.intp)
        is_backward = np.zeros(self._count, bool)
        triangles = np.empty((self._count, self._sides - 2, 3), np.intp)
        for k in range(self._sides - 3):
            ear = self._find(start, is_backward, self._sides - k)
            first = before[every, ear]
            last = after[every, ear]
            triangles[:, k] = np.stack([first, ear, last], axis=1)
            after[every, first], before[every, last] = last, first
            self._is_left[every, ear] = False
            for corner in (first, last):  # A convex corner stays convex.
                turn = self._turn[every, corner]
                self._turn[every, corner] = np.where(turn > 0, turn, self._signs(every, corner))
            start = np.where(is_backward, before[every, first], after[every, last])
            turns_back = self._turn[every, start] <= 0
            beyond = np.where(is_backward, before[every, start], after[every, start])
            start = np.where(turns_back, beyond, start)
            is_backward ^= turns_back
        corner = self._is_left.argmax(axis=1)
        triangles[:, -1] = np.stack([corner, after[every, corner], before[every, corner]], axis=1)
        return triangles

    def _find(self, start: Index, is_backward: Mask, left: int) -> Index:
        """Return the (n,) ears: convex corners, else straight ones, else those that are not
        concave, else any.
        """
        found = start.copy()
        waiting = self._every
        for least, most, is_checked in ((1, 1, True), (0, 0, True), (0, 1, False)):
            at = start[waiting]
            for _ in range(left):
                turn = self._turn[waiting, at]
                is_ear = (turn >= least) & (turn <= most)
                if is_checked:
                    tried = np.flatnonzero(is_ear)
                    is_ear[tried] = ~self._holds_corner(waiting[tried], at[tried])
                found[waiting[is_ear]] = at[is_ear]
                waiting, at = waiting[~is_ear], at[~is_ear]
                if not len(waiting):
                    return found
                at = np.where(
                    is_backward[waiting], self._before[waiting, at], self._after[waiting, at]
                )
        return found

    def _holds_corner(self, which: Index, tip: Index) -> Mask:
        """Return whether another corner that is not convex lies in the triangle at a corner, or on
        its edges.
        """
        ends = self._before[which, tip], tip, self._after[which, tip]
        others = self._is_left[which] & (self._turn[which] <= 0)
        for end in ends:
            others[np.arange(len(which)), end] = False
        row, corner = np.nonzero(others)
        point = self._corners[which[row], corner]
        a, b, c = (self._corners[which[row], end[row]] for end in ends)
        is_within = (
            (_area(a, b, point) >= 0.0) & (_area(b, c, point) >= 0.0) & (_area(c, a, point) >= 0.0)
        )
        return np.bincount(row[is_within], minlength=len(which)) > 0

    def _signs(self, which: Index, corner: Index) -> NDArray[np.int8]:
        ends = self._before[which, corner], corner, self._after[which, corner]
        return np.sign(_area(*(self._corners[which, end] for end in ends))).astype(np.int8)


def _area(a: NDArray, b: NDArray, c: NDArray) -> Array:
    """Return twice the signed areas of (n, 2) triangles, positive if they are counter-clockwise."""
    return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
