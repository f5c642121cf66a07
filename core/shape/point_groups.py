# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The finite groups that a surface of triangles may have, by its corners, with proof on their triangles.

A corner farthest from the center is a corner in every triangulation, and a symmetry takes it to another such corner. So
it does with a corner farthest from the line through the first. Two pairs of them fix a rotation, and a rotation with a
mirror: whatever moments show, every symmetry is a candidate.

A candidate holds if the images of all triangles are near the surface. The distance from one triangle is convex: an
image is near if its corners are near one triangle. Other images are cut along the edges of the triangles beside them. A
candidate is refuted by a point whose image is far from the surface. The candidates between leave a choice of groups.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..mesh.point_triangle import triangle_distances
from ..mesh.surface_tree import SurfaceTree
from ..numerics.arrays import cross_rows, lengths
from .symmetries import Symmetry, axis_rotation

MAX_CORNERS = 4096  # farthest corners that are compared with each other
MAX_CANDIDATES = 1 << 17
PAIRS_PER_BLOCK = 1 << 22  # pairs of corners compared at once
SKEW = np.array([0.5377, 0.6213, 0.5699])  # corners are sorted along this direction, across no usual edge
MAX_TRIES = 64  # corners of nearly equal height along it that are compared
FIRST_IMAGES = 12  # images of corners that refute most candidates
FIRST_SAMPLES = 64  # corners that refute most of the others
ROUND_SAMPLES = 500  # corners that are turned about an axis
MAX_PROVED = 4096  # triangles between other corners that are proved; of more, evenly many (all corners are compared)
MAX_PIECES = 1 << 16  # of triangles, looked at in all rounds of cutting
PIECES_PER_TRIANGLE = 64  # so many at most: if proof takes more, the misfit is that of the tolerance
CLEAR_PRODUCT = 2e-3  # 3 - trace: a product of operations is the operation nearest to it


class PlacedTriangles:
    """Triangles about the center of a body, and how far maps take them from themselves.

    Maps that take no point farther than `near` from the surface hold, others that take one farther than `far` do not.
    """

    def __init__(self, points: NDArray, triangles: NDArray, near: float, far: float):
        is_used = np.zeros(len(points), bool)
        is_used[triangles] = True
        self.points, self.triangles = points[is_used], (np.cumsum(is_used) - 1)[triangles]
        self.near, self.far = near, far
        height = self.points @ SKEW
        self._order = np.argsort(height, kind="stable")
        self._height = height[self._order]
        self._first = self._match(self.points)
        self._sides, self._faces = self._face_keys(self._first)
        self._witnesses = np.arange(0, len(self.points), 1 + len(self.points) // FIRST_SAMPLES)

    @cached_property
    def _tree(self) -> SurfaceTree:
        return SurfaceTree(self.points, self.triangles)

    def groups(self) -> list[NDArray[np.float64]] | None:
        """Return the (k, 3, 3) operations of the group, then of larger possible ones; None if there are too many.

        They are the groups at tolerances that grow from near to far, from the largest one that holds without the noise
        of the corners that its operations were found by.
        """
        operations = self._candidates()
        if operations is None:
            return None
        levels = np.full(len(operations), np.nan)
        held = np.zeros(len(operations), bool)
        held[0], generators = True, []
        for i in range(1, len(operations)):
            if held[i] or not np.isnan(levels[i]):
                continue
            levels[i] = self._misfit(operations[i])
            if levels[i] <= self.near:
                trial = _closed(operations, held, [*generators, i], levels == np.inf)
                held, generators = (held, generators) if trial is None else (trial, [*generators, i])
            elif levels[i] == np.inf:
                own = operations[held]
                alike = _nearest((own[:, None] @ operations[i] @ own).reshape(-1, 3, 3), operations)
                levels[alike[alike >= 0]] = np.inf
        found = [(held, generators)]
        for i in np.argsort(levels, kind="stable"):
            if levels[i] < np.inf and not found[-1][0][i]:
                generators = [*found[-1][1], i]
                trial = _closed(operations, found[-1][0], generators, levels == np.inf)
                if trial is not None:
                    found.append((trial, generators))
        groups = [_exact_group(operations[mask]) for mask, _ in found]
        for last in range(len(groups) - 1, 0, -1):
            mask, generators = found[last]
            exact = groups[last][np.searchsorted(np.flatnonzero(mask), generators)]
            if all(self._misfit(each) <= self.near for each in exact):
                return groups[last:]
        return groups

    def turn_order(self, axis: NDArray) -> int:
        """Return the number of corners on the outermost ring about an axis if turns by one corner hold, or 1."""
        height = self.points @ axis
        radius = lengths(self.points - np.outer(height, axis))[:, 0]
        outer = radius.argmax()
        is_ring = (radius >= radius[outer] - 2.0 * self.far) & (np.abs(height - height[outer]) <= 2.0 * self.far)
        count = len(self._distinct(np.flatnonzero(is_ring)))
        return count if self._misfit(axis_rotation(axis, 2.0 * np.pi / count)) <= self.near else 1

    def is_round(self, found: Symmetry, tolerance: float) -> bool:
        """Return whether turns about the axes of revolution leave a sample of the corners within the tolerance."""
        points = self.points[:: 1 + len(self.points) // ROUND_SAMPLES]
        turns = [axis_rotation(axis, angle) for axis in found.revolution_axes for angle in (1.0, 0.1, 0.01)]
        return all(np.isfinite(self._tree.distance(points @ turn.T, tolerance)).all() for turn in turns)

    def _candidates(self) -> NDArray[np.float64] | None:
        """Return (k, 3, 3) maps of corners to corners, the identity first, then by their angles; None if too many."""
        radius = lengths(self.points)[:, 0]
        outer = self._distinct(np.flatnonzero(radius >= radius.max() - 2.0 * self.far))
        if len(outer) > MAX_CORNERS:
            return None
        first, partners = outer[0] / np.linalg.norm(outer[0]), outer
        across = lengths(partners - np.outer(partners @ first, first))[:, 0]
        if across.max() <= 0.1 * radius.max():  # all on one line
            partners = self.points
            across = lengths(partners - np.outer(partners @ first, first))[:, 0]
        second = partners[across.argmax()]
        along, across = second @ first, across.max()
        images = [np.eye(3)[None]]
        start = _frames(first[None], second[None])[0]
        step = max(1, PAIRS_PER_BLOCK // len(partners))
        squares = (partners**2).sum(axis=1)
        for begin in range(0, len(outer), step):
            ways = outer[begin : begin + step] / lengths(outer[begin : begin + step])
            height = ways @ partners.T
            apart = np.sqrt(np.maximum(squares - height**2, 0.0))
            way, partner = np.nonzero(
                (np.abs(height - along) <= 4.0 * self.far) & (np.abs(apart - across) <= 4.0 * self.far)
            )
            frames = _frames(ways[way], partners[partner])
            images += [frames @ start.T, frames * [1.0, 1.0, -1.0] @ start.T]
            if sum(map(len, images)) > MAX_CANDIDATES:
                return None
        operations = np.concatenate(images)
        worst = np.zeros(len(operations))
        for i in self._witnesses[:: max(1, len(self._witnesses) // FIRST_IMAGES)]:
            worst = np.maximum(worst, self._tree.distance(operations @ self.points[i], self.far))
            operations, worst = operations[np.isfinite(worst)], worst[np.isfinite(worst)]
        worst[0] = -1.0  # the identity
        proper = np.linalg.det(operations) > 0.0
        order = np.lexsort([-operations.trace(axis1=1, axis2=2), ~proper])
        operations, worst, kept, left = operations[order], worst[order], [], np.arange(len(order))
        while len(left):
            alike = np.einsum("nij,ij->n", operations[left], operations[left[0]]) > 3.0 - CLEAR_PRODUCT
            kept.append(left[alike][worst[left[alike]].argmin()])
            left = left[~alike]
        return operations[kept]

    def _distinct(self, rows: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the points of these rows, but one of those that lie together."""
        return self.points[np.unique(self._first[rows])]

    def _misfit(self, operation: NDArray) -> float:
        """Return a bound of the distances of images from the surface; infinity if one is far from it.

        Images whose proof is not complete count as a little more than near.
        """
        for rows in (self._witnesses, None):
            images = (self.points if rows is None else self.points[rows]) @ operation.T
            match = self._match(images)
            left = np.flatnonzero(match < 0)
            distances = self._tree.distance(images[left], self.far)
            if not np.isfinite(distances).all():
                worst = left[np.argmax(distances)]
                self._witnesses = np.append(self._witnesses[-FIRST_SAMPLES:], worst if rows is None else rows[worst])
                return np.inf
        level = float(distances.max(initial=0.0))
        if level > self.near:
            return level
        faces = self._face_keys(np.where(match < 0, -1, self._first[match]), self._sides)[1]
        new = (match[self.triangles] < 0).any(axis=1) | ~np.isin(faces, self._faces)
        rows = np.flatnonzero(new)
        return self._cover(images[self.triangles[rows[:: 1 + len(rows) // MAX_PROVED]]]) if len(rows) else 0.0

    def _match(self, images: NDArray) -> NDArray[np.intp]:
        """Return (n,) the first corner near each of (n, 3) points, -1 if there is none."""
        found, height = np.full(len(images), -1), images @ SKEW
        at, left = np.searchsorted(self._height, height - self.near), np.arange(len(images))
        for _ in range(MAX_TRIES):
            left = left[at[left] < len(self._order)]
            left = left[self._height[at[left]] <= height[left] + self.near]
            if not len(left):
                break
            corner = self._order[at[left]]
            is_near = lengths(self.points[corner] - images[left])[:, 0] <= self.near
            found[left[is_near]] = corner[is_near]
            left = left[~is_near]
            at[left] += 1
        return found

    def _face_keys(self, corner: NDArray[np.intp], sides: NDArray | None = None) -> tuple[NDArray, NDArray]:
        """Return the sorted sides of the triangles, and (m,) numbers of triangles by (n,) numbered corners."""
        low, middle, high = np.sort(corner[self.triangles], axis=1).T.astype(np.int64)
        side = low * len(corner) + middle
        sides = np.unique(side) if sides is None else sides
        at = np.minimum(np.searchsorted(sides, side), len(sides) - 1)
        return sides, np.where(sides[at] == side, at * len(corner) + high, -1)

    def _cover(self, pieces: NDArray) -> float:
        """Return 0 if (k, 3, 3) triangles are near the surface, infinity if a point is far, else more than near."""
        work, most = len(pieces), min(MAX_PIECES, PIECES_PER_TRIANGLE * len(self.triangles))
        while work <= most:
            middle = pieces.mean(axis=1)
            distance, face = self._tree.nearest(middle, self.far)
            worst = float(distance.max())
            if worst > self.near:
                return worst
            below = self._tree.corners(face)
            left = self._farthest(pieces, below) > self.near
            pieces, below = pieces[left], below[left]
            normals = [cross_rows(each[:, 1] - each[:, 0], each[:, 2] - each[:, 0]) for each in (pieces, below)]
            fat = [
                lengths(n)[:, 0] / (np.ptp(each, axis=1) ** 2).sum(axis=1) for n, each in zip(normals, (pieces, below))
            ]
            normal, outside = np.where((fat[0] > fat[1])[:, None], *normals), []
            for i in range(6):  # along three sides, then across three tips
                a, b, c = (below[:, (i + k) % 3] for k in range(3))
                out = cross_rows(b - a, normal) if i < 3 else _unit(a - b) + _unit(a - c)
                out *= np.sign(((a - c) * out).sum(axis=1))[:, None]
                height = ((pieces - a[:, None]) * _unit(out)[:, None]).sum(axis=2) - self.near / 2.0
                pieces, rows, cut = _split(pieces, height)
                below, normal = below[rows], normal[rows]
                outside.append(cut)
            rest = pieces[self._farthest(pieces, below) > self.near]
            pieces = np.concatenate([*outside, *_quarters(rest)])
            if not len(pieces):
                return 0.0
            work += len(pieces)
        return float(np.nextafter(self.near, np.inf))

    @staticmethod
    def _farthest(pieces: NDArray, below: NDArray) -> NDArray[np.float64]:
        """Return (k,) the largest distances of the corners of (k, 3, 3) triangles from another triangle each."""
        return np.max([triangle_distances(pieces[:, i], below) for i in range(3)], axis=0)


def _unit(vectors: NDArray) -> NDArray[np.float64]:
    """Return (k, 3) vectors of length 1, or zeros."""
    size = lengths(vectors)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)


def _frames(first: NDArray, second: NDArray) -> NDArray[np.float64]:
    """Return (k, 3, 3) rotations with a direction as first column, and the second one in the plane of two columns."""
    second = second - (second * first).sum(axis=1)[:, None] * first
    second = second / lengths(second)
    return np.stack([first, second, cross_rows(first, second)], axis=2)


def _nearest(products: NDArray, operations: NDArray) -> NDArray[np.intp]:
    """Return (k,) the first operation that each product is, but for noise; -1 if it is none."""
    found = np.empty(len(products), np.intp)
    flat, step = operations.reshape(-1, 9).T, max(1, PAIRS_PER_BLOCK // max(1, len(operations)))
    for begin in range(0, len(products), step):
        alike = products[begin : begin + step].reshape(-1, 9) @ flat
        best = alike.argmax(axis=1)
        found[begin : begin + step] = np.where(alike.max(axis=1) > 3.0 - CLEAR_PRODUCT, best, -1)
    return found


def _closed(
    operations: NDArray, mask: NDArray[np.bool_], generators: list[int], refuted: NDArray[np.bool_]
) -> NDArray[np.bool_] | None:
    """Return the mask of the group of all generators, of which the masked ones are a part; None if one is refuted.

    Coset by coset: a generator takes a coset of the masked group to a coset.
    """
    own, cosets, mask = operations[mask], [np.eye(3)], mask.copy()
    for coset in cosets:  # which grow
        for product in _nearest(operations[generators] @ coset, operations).tolist():
            if product < 0:
                return None
            if not mask[product]:
                members = _nearest(operations[product] @ own, operations)
                if (members < 0).any() or refuted[members].any():
                    return None
                mask[members] = True
                cosets.append(operations[product])
    return mask


def _exact_group(operations: NDArray) -> NDArray[np.float64]:
    """Return the operations of a group without their noise: each is the mean of all products that give it."""
    for _ in range(2 if len(operations) <= 128 else 0):
        products = operations[:, None] @ operations
        numbers = _nearest(products.reshape(-1, 3, 3), operations)
        sums = np.zeros_like(operations)
        np.add.at(sums, numbers, products.reshape(-1, 3, 3))
        u, _, v = np.linalg.svd(sums)
        operations = u @ v
    return operations


def _split(pieces: NDArray, height: NDArray) -> tuple[NDArray, NDArray[np.intp], NDArray]:
    """Cut (k, 3, 3) triangles where heights of their corners are zero: the lower ones, their rows, the upper ones."""
    above = height > 0.0
    count = above.sum(axis=1)
    lower, rows, upper = [pieces[count == 0]], [np.flatnonzero(count == 0)], [pieces[count == 3]]
    for lone in (1, 2):
        row = np.flatnonzero(count == lone)
        first = (above[row] if lone == 1 else ~above[row]).argmax(axis=1)
        order = (first[:, None] + np.arange(3)) % 3
        a, b, c = pieces[row[:, None], order].transpose(1, 0, 2)
        low, high, far = height[row[:, None], order].T[..., None]
        d, e = a + (b - a) * (low / (low - high)), a + (c - a) * (low / (low - far))
        tip = np.stack([a, d, e], axis=1)
        base = np.concatenate([np.stack([d, b, c], axis=1), np.stack([d, c, e], axis=1)])
        lower.append(base if lone == 1 else tip)
        rows.append(np.concatenate([row, row]) if lone == 1 else row)
        upper.append(tip if lone == 1 else base)
    return np.concatenate(lower), np.concatenate(rows), np.concatenate(upper)


def _quarters(pieces: NDArray) -> Iterator[NDArray]:
    """Yield four triangles that make up each of (k, 3, 3)."""
    middles = (pieces + np.roll(pieces, -1, axis=1)) / 2.0
    yield middles
    for i in range(3):
        yield np.stack([pieces[:, i], middles[:, i], middles[:, i - 1]], axis=1)
