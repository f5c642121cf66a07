# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of polygons with more than four corners, as Blender draws them: ears are cut off one after the other.

D. Eberly, Triangulation by Ear Clipping. The next ear is looked for one corner beyond the last one; where that corner
is no ear, the search turns back.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CORNERS_PER_BLOCK = 1 << 18


def tessellate(points: NDArray[np.floating], polygons: NDArray[np.integer]) -> NDArray[np.integer]:
    """Return the (n, k - 2, 3) triangles of (n, k) polygons over (m, 3) points."""
    count, sides = polygons.shape
    triangles = np.empty((count, sides - 2, 3), polygons.dtype)
    step = max(1, CORNERS_PER_BLOCK // sides)
    for start in range(0, count, step):
        block = polygons[start : start + step]
        ears = _Ears(_flatten(points[block].astype(np.float64))).cut()
        triangles[start : start + step] = block[np.arange(len(block))[:, None, None], ears]
    return triangles


def _flatten(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (n, k, 2) corners of (n, k, 3) polygons seen against their normals, stretched by any factor."""
    about = corners - corners[:, :1]
    normal = np.cross(about, np.roll(about, -1, axis=1)).sum(axis=1)
    least = np.zeros_like(normal)
    least[np.arange(len(normal)), np.abs(normal).argmin(axis=1)] = 1.0
    right = np.cross(least, normal)
    right /= np.maximum(np.linalg.norm(right, axis=1), np.finfo(float).tiny)[:, None]
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    return np.stack([np.einsum("nki,ni->nk", about, axis) for axis in (right, np.cross(normal, right))], axis=2)


class _Ears:
    """Polygons of k corners, (n, k, 2), that are cut at the same time.

    before, after: (n, k) neighbors of the corners that are left. turn: (n, k) their signs, 1 for convex corners.
    """

    def __init__(self, corners: NDArray[np.float64]) -> None:
        self._corners = corners
        self._count, self._sides = corners.shape[:2]
        self._every = np.arange(self._count)
        ring = np.arange(self._sides)
        self._before, self._after = (np.roll(ring, way)[None].repeat(self._count, 0) for way in (1, -1))
        self._is_left = np.ones((self._count, self._sides), bool)
        self._turn = np.stack([self._signs(self._every, self._every * 0 + corner) for corner in ring], axis=1)

    def cut(self) -> NDArray[np.intp]:
        """Return the (n, k - 2, 3) corners of the triangles, from 0 to k - 1."""
        every, before, after = self._every, self._before, self._after
        start, is_backward = np.zeros(self._count, np.intp), np.zeros(self._count, bool)
        triangles = np.empty((self._count, self._sides - 2, 3), np.intp)
        for k in range(self._sides - 3):
            ear = self._find(start, is_backward, self._sides - k)
            first, last = before[every, ear], after[every, ear]
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

    def _find(self, start: NDArray[np.intp], is_backward: NDArray[np.bool_], left: int) -> NDArray[np.intp]:
        """Return the (n,) ears: convex corners, else straight ones, else those that are not concave, else any."""
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
                at = np.where(is_backward[waiting], self._before[waiting, at], self._after[waiting, at])
        return found

    def _holds_corner(self, which: NDArray[np.intp], tip: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return whether another corner that is not convex lies in the triangle at a corner, or on its edges."""
        ends = self._before[which, tip], tip, self._after[which, tip]
        others = self._is_left[which] & (self._turn[which] <= 0)
        for end in ends:
            others[np.arange(len(which)), end] = False
        row, corner = np.nonzero(others)
        point = self._corners[which[row], corner]
        a, b, c = (self._corners[which[row], end[row]] for end in ends)
        is_within = (_area(a, b, point) >= 0.0) & (_area(b, c, point) >= 0.0) & (_area(c, a, point) >= 0.0)
        return np.bincount(row[is_within], minlength=len(which)) > 0

    def _signs(self, which: NDArray[np.intp], corner: NDArray[np.intp]) -> NDArray[np.int8]:
        ends = self._before[which, corner], corner, self._after[which, corner]
        return np.sign(_area(*(self._corners[which, end] for end in ends))).astype(np.int8)


def _area(a: NDArray, b: NDArray, c: NDArray) -> NDArray[np.float64]:
    """Return twice the signed areas of (n, 2) triangles, positive if they are counter-clockwise."""
    return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
