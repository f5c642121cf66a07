# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The finite groups that a surface of triangles may have, by its corners.

A corner farthest from the center is a corner in every triangulation, and a symmetry takes it to
another such corner. The same holds for a corner farthest from the line through the first. Two pairs
of such corners fix a rotation, and a rotation with a mirror. So every symmetry is a candidate,
whatever moments show.

A candidate holds if images of all corners are near the surface, and each crease lies on a crease
between such corners, or points of it and of the triangles lie on the surface. It is refuted by a
point whose image is far from the surface. Candidates that neither hold nor are refuted leave a
choice of groups.
"""

from functools import cached_property

import numpy as np

from ..mesh import Bvh, keep_used, tree_of_all
from ..numerics import Array, Index, Mask, NDArray, cross_rows, lengths, rotation_about, run_starts
from .symmetries import Symmetry

MAX_CORNERS = 4096  # farthest corners that are compared with each other
MAX_CANDIDATES = 1 << 17
PAIRS_PER_BLOCK = 1 << 22  # pairs of corners compared at once
# Corners are sorted along this unit vector, chosen across no usual edge.
SKEW = np.array([0.5377, 0.6213, 0.5699])
MAX_TRIES = 64  # corners of nearly equal height along SKEW that are compared
FIRST_IMAGES = 12  # images of so many corners refute most candidates
FIRST_SAMPLES = 64  # witnesses: so many corners refute most of the other candidates
SAMPLES = 128  # corners, farthest corners and triangles that are compared if the tolerance is large
MAX_BETWEEN = 2048  # triangles between other corners that are compared; of more, evenly many
# Weights of a triangle's corners for points between them; the first two are on its first side.
BETWEEN = np.array([[0.5, 0.5, 0.0], [0.7, 0.3, 0.0], [0.3, 0.3, 0.4]])
CLEAR_PRODUCT = 2e-3  # 3 - trace: a product of operations is the operation nearest to it


class PlacedTriangles:
    """Triangles about the center of a body, and the distances by which maps take them from
    themselves.

    Maps that take no point farther than `near` from the surface hold; maps that take one farther
    than `far` do not.
    """

    def __init__(self, points: NDArray, triangles: NDArray, near: float, far: float):
        self.points, self.triangles = keep_used(points, triangles)
        self.near = near
        self.far = far
        # Corners by their height along SKEW, in which `_match` searches.
        height = self.points @ SKEW
        self._order = np.argsort(height, kind="stable")
        self._height = height[self._order]
        # Corners that are compared first: a sample, and the last ones that refuted an operation.
        self._witnesses = np.arange(0, len(self.points), 1 + len(self.points) // FIRST_SAMPLES)

    @cached_property
    def _first(self) -> Index:
        """(n,) indices of the first corner, along SKEW, at the place of each corner."""
        return self._match(self.points)

    @cached_property
    def _tree(self) -> Bvh:
        """The triangles, for distances."""
        return tree_of_all(self.points, self.triangles)

    def _distances(self, points: NDArray, within: float) -> Array:
        """Return the distances of (k, 3) points from the surface, infinity beyond `within`."""
        return self._tree.distances(
            points - self._tree.origin, np.zeros(len(points), np.intp), within
        )

    @cached_property
    def _samples(self) -> Array:
        """(k, 3) points of the surface: the farthest corners, other corners, middles of
        triangles.
        """
        farthest = np.argsort(lengths(self.points)[:, 0], kind="stable")[-SAMPLES:]
        corners = self.points[:: 1 + len(self.points) // SAMPLES]
        triangles = self.triangles[:: 1 + len(self.triangles) // SAMPLES]
        middles = self.points[triangles].mean(axis=1)
        return np.concatenate([self.points[farthest], corners, middles])

    def holds(self, operation: NDArray, tolerance: float) -> bool:
        """Return whether images of a sample of the surface are within a tolerance of it."""
        images = self._samples @ operation.T
        return all(
            np.isfinite(self._distances(part, tolerance)).all() for part in (images[::10], images)
        )

    def groups(self) -> list[Array] | None:
        """Return the (k, 3, 3) operations of the group, then of larger possible ones; None if there
        are too many.

        These are the groups at tolerances that grow from near to far.
        """
        operations = self._candidates()
        if operations is None:
            return None
        misfits = np.full(len(operations), np.nan)  # NaN if not measured
        in_group = np.zeros(len(operations), bool)
        in_group[0] = True
        generators = []
        for i in range(1, len(operations)):
            if in_group[i] or not np.isnan(misfits[i]):
                continue
            misfits[i] = self._misfit(operations[i])
            if misfits[i] <= self.near:
                larger = _closed(operations, in_group, [*generators, i], misfits == np.inf)
                if larger is not None:
                    in_group = larger
                    generators.append(i)
            elif misfits[i] == np.inf:
                # A product with the group does not hold either, or this operation would.
                members = operations[in_group]
                products = (members[:, None] @ operations[i] @ members).reshape(-1, 3, 3)
                refuted = _nearest(products, operations)
                misfits[refuted[refuted >= 0]] = np.inf
        groups = [in_group]
        for i in np.argsort(misfits, kind="stable"):
            if misfits[i] < np.inf and not groups[-1][i]:
                larger = _closed(operations, groups[-1], [*generators, i], misfits == np.inf)
                if larger is not None:
                    groups.append(larger)
                    generators.append(i)
        return [operations[mask] for mask in groups]

    def turn_order(self, axis: NDArray) -> int:
        """Return the number of corners on the outermost ring about an axis if turns by one corner
        hold, or 1.
        """
        height = self.points @ axis
        radius = lengths(self.points - np.outer(height, axis))[:, 0]
        outer = radius.argmax()
        # Two corners of one ring may be off by `far` each.
        is_ring = (radius >= radius[outer] - 2.0 * self.far) & (
            np.abs(height - height[outer]) <= 2.0 * self.far
        )
        count = len(self._distinct(np.flatnonzero(is_ring)))
        return count if self._misfit(rotation_about(axis, 2.0 * np.pi / count)) <= self.near else 1

    def is_round(self, symmetry: Symmetry, tolerance: float) -> bool:
        """Return whether turns about the axes of revolution hold within the tolerance."""
        turns = [
            rotation_about(axis, angle)
            for axis in symmetry.revolution_axes
            for angle in (1.0, 0.1, 0.01)
        ]
        return all(self.holds(turn, tolerance) for turn in turns)

    def _candidates(self) -> Array | None:
        """Return (k, 3, 3) maps of corners to corners, the identity first, then by their angles;
        None if too many.
        """
        radius = lengths(self.points)[:, 0]
        # A corner and its image may be off by `far` each.
        outer = self._distinct(np.flatnonzero(radius >= radius.max() - 2.0 * self.far))
        if len(outer) > MAX_CORNERS:
            return None
        first = outer[0] / np.linalg.norm(outer[0])
        # An operation takes the first corner to an outer one, and a second corner, as far as
        # possible from the line through the first, to one at the same distances.
        partners = outer
        from_line = lengths(partners - np.outer(partners @ first, first))[:, 0]
        if from_line.max() <= 0.1 * radius.max():
            # All outer corners are near one line, and would not fix a turn about it.
            partners = self.points
            from_line = lengths(partners - np.outer(partners @ first, first))[:, 0]
        second = partners[from_line.argmax()]
        along = second @ first
        across = from_line.max()
        images = [np.eye(3)[None]]
        start = _frames(first[None], second[None])[0]
        step = max(1, PAIRS_PER_BLOCK // len(partners))
        squares = (partners**2).sum(axis=1)
        for begin in range(0, len(outer), step):
            directions = outer[begin : begin + step] / lengths(outer[begin : begin + step])
            height = directions @ partners.T
            from_directions = np.sqrt(np.maximum(squares - height**2, 0.0))
            # Both pairs have two corners, and each of these may be off by `far`.
            direction, partner = np.nonzero(
                (np.abs(height - along) <= 4.0 * self.far)
                & (np.abs(from_directions - across) <= 4.0 * self.far)
            )
            frames = _frames(directions[direction], partners[partner])
            images += [frames @ start.T, frames * [1.0, 1.0, -1.0] @ start.T]
            if sum(map(len, images)) > MAX_CANDIDATES:
                return None
        operations = np.concatenate(images)
        # The largest distance of a few corners' images; without operations that take one too far.
        worst = np.zeros(len(operations))
        for i in self._witnesses[:: max(1, len(self._witnesses) // FIRST_IMAGES)]:
            worst = np.maximum(worst, self._distances(operations @ self.points[i], self.far))
            operations = operations[np.isfinite(worst)]
            worst = worst[np.isfinite(worst)]
        worst[0] = -1.0  # the identity, which is kept
        # Rotations come first, and the smallest angles, by the largest traces.
        order = np.lexsort([-operations.trace(axis1=1, axis2=2), np.linalg.det(operations) <= 0.0])
        operations = operations[order]
        worst = worst[order]
        # Of operations that are equal up to noise (the trace of AᵀB is near 3), the one that fits
        # best.
        best = []
        remaining = np.arange(len(order))
        while len(remaining):
            products = np.einsum("nij,ij->n", operations[remaining], operations[remaining[0]])
            is_alike = products > 3.0 - CLEAR_PRODUCT
            alike = remaining[is_alike]
            best.append(alike[worst[alike].argmin()])
            remaining = remaining[~is_alike]
        return operations[best]

    def _distinct(self, rows: Index) -> Array:
        """Return the points of these rows, one for each set of coincident points."""
        return self.points[np.unique(self._first[rows])]

    def _misfit(self, operation: NDArray) -> float:
        """Return the largest distance of images of corners, and of points between them, from the
        surface; infinity if one is farther than `far`.

        A corner that refutes the operation becomes a witness: later calls compare it first.
        """
        witness_images = self.points[self._witnesses] @ operation.T
        match = self._match(witness_images)
        if self._farthest(self._witnesses, witness_images, match) == np.inf:
            return np.inf
        images = self.points @ operation.T
        match = self._match(images)
        level = self._farthest(np.arange(len(images)), images, match)
        if level > self.near:  # or infinite
            return level
        # If all corners fall on corners and all creases on creases, so do the triangles. Of other
        # creases and triangles, the images of points between the corners are compared.
        creases, codes = self._creases
        image_codes = self._edge_codes(np.where(match < 0, -1, self._first[match])[creases[:, :2]])
        is_crease = codes.take(np.searchsorted(codes, image_codes), mode="clip") == image_codes
        has_other_corner = (match[self.triangles] < 0).any(axis=1)
        compared = np.concatenate([creases[~is_crease], self.triangles[has_other_corner]])
        between = (BETWEEN @ images[compared[:: 1 + len(compared) // MAX_BETWEEN]]).reshape(-1, 3)
        return max(level, float(self._distances(between, self.far).max(initial=0.0)))

    def _farthest(self, corners: Index, images: NDArray, match: Index) -> float:
        """Return the largest distance of (k, 3) images of corners from the surface, 0 if they match
        corners; infinity if one is farther than `far`, whose corner becomes a witness.
        """
        unmatched = np.flatnonzero(match < 0)
        distances = self._distances(images[unmatched], self.far)
        if not np.isfinite(distances).all():
            witness = corners[unmatched[np.argmax(distances)]]
            self._witnesses = np.append(self._witnesses[-FIRST_SAMPLES:], witness)
        return float(distances.max(initial=0.0))

    def _match(self, images: NDArray) -> Index:
        """Return (n,) the corner within `near` of each of (n, 3) points, the first along SKEW; -1
        if there is none.
        """
        match = np.full(len(images), -1)
        height = images @ SKEW
        # For each image, the next corner in the order of heights that may be near.
        place = np.searchsorted(self._height, height - self.near)
        unmatched = np.arange(len(images))
        for _ in range(MAX_TRIES):
            unmatched = unmatched[place[unmatched] < len(self._order)]
            unmatched = unmatched[self._height[place[unmatched]] <= height[unmatched] + self.near]
            if not len(unmatched):
                break
            corner = self._order[place[unmatched]]
            is_near = lengths(self.points[corner] - images[unmatched])[:, 0] <= self.near
            match[unmatched[is_near]] = corner[is_near]
            unmatched = unmatched[~is_near]
            place[unmatched] += 1
        return match

    @cached_property
    def _creases(self) -> tuple[Index, NDArray[np.int64]]:
        """Creases: edges except those of exactly two triangles in one plane, on different sides.

        (k, 3) corners of a triangle at each crease, turned so that the crease is between the first
        two; and the (k,) sorted `_edge_codes` of all creases.
        """
        first_corners = self._first[self.triangles]
        count = len(self.triangles)
        code = np.concatenate([self._edge_codes(first_corners[:, [i, i - 1]]) for i in range(3)])
        order = np.argsort(code, kind="stable")
        # In the order of codes: edges that exactly two triangles share.
        starts = run_starts(code[order])
        pair = starts[np.diff(starts, append=len(code)) == 2]
        # Entry k of `code` is the edge between corners k // count and k // count - 1 of triangle
        # k % count.
        (side, triangle), (other_side, other) = (
            np.divmod(order[k], count) for k in (pair, pair + 1)
        )
        a, b, c = (self.points[self.triangles[triangle, (side + i) % 3]] for i in range(3))
        normal = cross_rows(b - a, c - a)
        normal /= np.maximum(lengths(normal), np.finfo(float).tiny)
        apex = self.points[self.triangles[other, (other_side + 1) % 3]]
        is_crease = np.ones(len(code), bool)
        # The edge from a to c is no crease if both triangles are in its plane, on either side.
        across = cross_rows(normal, c - a)
        sides = ((apex - a) * across).sum(axis=1) * ((b - a) * across).sum(axis=1)
        is_flat = (np.abs(((apex - a) * normal).sum(axis=1)) <= self.near / 4.0) & (sides <= 0.0)
        is_crease[order[pair[is_flat]]] = is_crease[order[pair[is_flat] + 1]] = False
        side, triangle = np.divmod(np.flatnonzero(is_crease), count)
        return (
            np.stack([self.triangles[triangle, side - i] for i in range(3)], axis=1),
            np.sort(code[is_crease]),
        )

    def _edge_codes(self, corners: Index) -> NDArray[np.int64]:
        """Return (k,) numbers of edges by (k, 2) numbers of corners, negative for edges with a
        corner -1.
        """
        low = np.minimum(*corners.T)
        high = np.maximum(*corners.T)
        return np.where(low < 0, -1, low * len(self.points) + high)


def _frames(first: NDArray, second: NDArray) -> Array:
    """Return (k, 3, 3) rotations with `first` as column 0, and `second` in the plane of columns 0
    and 1.
    """
    second = second - (second * first).sum(axis=1)[:, None] * first
    second = second / lengths(second)
    return np.stack([first, second, cross_rows(first, second)], axis=2)


def _nearest(products: NDArray, operations: NDArray) -> Index:
    """Return (k,) indices of the first operation that each product equals up to noise, -1 if there
    is none.
    """
    nearest = np.empty(len(products), np.intp)
    columns = operations.reshape(-1, 9).T
    step = max(1, PAIRS_PER_BLOCK // max(1, len(operations)))
    for begin in range(0, len(products), step):
        # The trace of AᵀB is 3 if and only if the orthogonal A and B are equal.
        traces = products[begin : begin + step].reshape(-1, 9) @ columns
        is_equal = traces.max(axis=1) > 3.0 - CLEAR_PRODUCT
        nearest[begin : begin + step] = np.where(is_equal, traces.argmax(axis=1), -1)
    return nearest


def _closed(operations: NDArray, mask: Mask, generators: list[int], refuted: Mask) -> Mask | None:
    """Return the mask of the group that generators and the masked group generate; None if an
    operation in it is refuted, or not among the operations.

    operations: (n, 3, 3). mask, refuted: (n,). The group grows by cosets of the masked group: each
    generator takes a coset to a coset.
    """
    members = operations[mask]
    cosets = [np.eye(3)]
    mask = mask.copy()
    for coset in cosets:  # by one operation of each; the list grows meanwhile
        for product in _nearest(operations[generators] @ coset, operations).tolist():
            if product < 0:
                return None
            if not mask[product]:
                coset_members = _nearest(operations[product] @ members, operations)
                if (coset_members < 0).any() or refuted[coset_members].any():
                    return None
                mask[coset_members] = True
                cosets.append(operations[product])
    return mask
