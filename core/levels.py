# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `recursion`: all moments of triangles and pairs of triangles, a block at a time.

Over the triangle a, b, c the mean of the monomial x^α of degree n is 2 α! / (n+2)! times the coefficient S_α of the
generating function 1 / ((1-a·ξ)(1-b·ξ)(1-c·ξ)). Each factor is one level of a recursion,

    C_α = (n! / α!) a^α,    D_α = C_α + Σ_i b_i D_{α-e_i},    S_α = D_α + Σ_i c_i S_{α-e_i},

of which only one degree is kept at a time. Two triangles that share the edge a-b share C and D. Of the last degree only
sums over faces are wanted, and those of S_α = C_α + Σ_i b_i D_{α-e_i} + Σ_i c_i S_{α-e_i} need no D and no S.

Rows are the monomials of one degree in the order of `moments.monomials`, columns are faces. Where each row finds its
predecessors is a table of indices, so that a level rises in three calls however many rows it has: fetch, multiply and
add, add. Long calls are also what lets threads run side by side. All sums are of positive terms if the coordinates are
positive, so a computed S_α is off by at most (6 n + 8) u S_α(|a|, |b|, |c|).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

from .affine import monomial_count, monomials, predecessors, rows_of
from .moments import U

CHUNK = 16  # faces that share one bound of their coordinates
LENGTH = 128  # products that einsum may add up in any order
ROUNDING = 9.0 * U  # of a determinant, and of a doubled area, relative to the sizes of their terms: see `polyhedron`
TINY = 1e-290  # more than underflow can lose of one face whose coordinates are at most about 1


@lru_cache
def multinomials(degree: int) -> NDArray[np.float64]:
    """(rows, 1) n! / α!, exact to degree 30."""
    return np.array([[factorial(degree) // (factorial(p) * factorial(q) * factorial(r))]
                     for p, q, r in monomials(degree)[-rows_of(degree):].tolist()], np.float64)


@dataclass(frozen=True, eq=False)
class Sums:
    """What some blocks of faces add, in the unit in which their coordinates are at most about 1.

    sums: (blocks, weights, K) Σ over faces of determinant S_α, and of doubled area S_α.
    sizes: (sets, K) Σ weight reach^α over chunks, for the weights |determinant| with its rounding, that rounding alone,
        the volume that moving every vertex by its half ulp sweeps; and with areas: doubled area with its rounding, that
        alone, and the area that moving the vertices adds.
    faces: how many.
    """

    sums: NDArray[np.float64]
    sizes: NDArray[np.float64]
    faces: int


class _Scratch:
    """Contiguous rows for blocks of `count` corners and k columns, carved out of one buffer.

    corners: (3, c, k), edges: (3, c-1, k), both over `vectors`. weights: (w, f, k) of the f = c-2 triangles. powers:
    (R, k). first: (1, R+1, k) and second: (f, R+1, k), D and S of one degree, their last row zero. fetched: (f 3 R k).
    """

    def __init__(self, buffer: NDArray, count: int, k: int, order: int, weights: int):
        fans, rows = count - 2, rows_of(order)
        position = -(buffer.ctypes.data // 8) % 8

        def carve(*shape: int) -> NDArray[np.float64]:
            # 64-byte aligned and 64 bytes apart: numpy < 2 leaves its vector loop where output ends at input's start
            nonlocal position
            start, size = position, int(np.prod(shape))
            position = start + -(-size // 8) * 8 + 8
            return buffer[start:start + size].reshape(shape)

        self.k, self.fans = k, fans
        self.index = carve(count, k).view(np.intp)
        self.offsets = carve(count, k).view(np.intp)
        self.vectors = carve(3, 2 * count - 1, k)
        self.corners, self.edges = self.vectors[:, :count], self.vectors[:, count:]
        self.normals, self.minus = carve(3, fans, k), carve(3, fans, k)
        self.weights = carve(weights, fans, k)
        self.both = carve(weights, k)
        self.powers, self.first, self.second = carve(rows, k), carve(1, rows + 1, k), carve(fans, rows + 1, k)
        self.heavy = carve(fans, 3 * weights, k)
        self.fetched = carve(fans * 3 * rows * k)
        self.first[:, -1] = self.second[:, -1] = 0.0

    @staticmethod
    def numbers(count: int, order: int, weights: int) -> int:
        """How many numbers a column takes."""
        fans, rows = count - 2, rows_of(order)
        return (2 * count + 3 * (2 * count - 1) + 6 * fans + (fans + 1) * weights + rows + (rows + 1) * (fans + 1)
                + 3 * fans * weights + 3 * fans * rows)


class Levels:
    """The loop body, with its scratch. Not to be shared by threads.

    order: of the moments. area: whether sums weighted with doubled areas are wanted beside the volume's.
    """

    def __init__(self, order: int, area: bool):
        self.order, self.weights = order, 2 if area else 1
        self.buffer: NDArray = np.empty(0)
        self.scratch: dict[tuple[int, int], _Scratch] = {}

    def run(self, points: NDArray, center: NDArray, scale: float, half_ulp: NDArray,
            blocks: Sequence[Sequence[NDArray]]) -> Sums:
        """The sums over blocks of faces.

        points: (n, 3) contiguous float32 or float64. center: (3,) what is subtracted. scale: a power of two by which
        they are multiplied then. half_ulp: (3,) before that. blocks: for each, the vertices a, b, c (and d) of its
        faces, (k,) each, checked: triangles a, b, c and a, c, d.
        """
        sums, largest, sizes = [], [], []
        for faces in blocks:
            own = self._shaped(len(faces), len(faces[0]))
            self._gather(own, points, faces, center, scale)
            reach, weights = self._weigh(own, half_ulp * scale)
            sums.append(self._summed(own))
            largest.append(reach)
            sizes.append(weights)
        reach, weights = np.concatenate(largest, axis=1), np.concatenate(sizes, axis=1)
        return Sums(np.array(sums), self._sizes(reach, weights), sum(len(faces[0]) for faces in blocks))

    def _shaped(self, count: int, k: int) -> _Scratch:
        k = -(-k // CHUNK) * CHUNK
        if (count, k) not in self.scratch:
            needed = k * _Scratch.numbers(count, self.order, self.weights) + 16 * 16
            if len(self.buffer) < needed:
                self.buffer = np.empty(needed)
            self.scratch = {(count, k): _Scratch(self.buffer, count, k, self.order, self.weights)}
        return self.scratch[count, k]

    def _gather(self, own: _Scratch, points: NDArray, faces: Sequence[NDArray], center: NDArray, scale: float) -> None:
        """The corners' coordinates and the edges from the first corner. Neighbours, CHUNK of them, stand below each
        other in the (CHUNK, columns) that a row is."""
        k, flat = len(faces[0]), points.reshape(-1)
        for row, corner in zip(own.index, faces):
            filled = np.full(own.k, faces[0][0], np.intp)  # filled up with faces that are a point
            filled[:k] = corner
            row.reshape(CHUNK, -1)[...] = filled.reshape(-1, CHUNK).T
        np.multiply(own.index, 3, out=own.offsets)
        for axis in range(3):
            own.corners[axis] = flat[axis:].take(own.offsets, mode="wrap")
        np.subtract(own.corners[:, 1:], own.corners[:, :1], out=own.edges)
        np.subtract(own.corners, center[:, None, None], out=own.corners)
        if scale != 1.0:
            np.multiply(own.vectors, scale, out=own.vectors)

    def _weigh(self, own: _Scratch, half_ulp: NDArray) -> tuple[NDArray, NDArray]:
        """Determinants and doubled areas; (3, m) the reach of each chunk, (3 or 6, m) the weights of `Sums.sizes`."""
        normals, edges = own.normals, own.edges
        first, second = edges[:, :-1], edges[:, 1:]
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            np.multiply(first[y], second[z], out=normals[x])
            np.multiply(first[z], second[y], out=own.minus[x])
        np.subtract(normals, own.minus, out=normals)
        np.einsum("cfk,ck->fk", normals, own.corners[:, 0], out=own.weights[0])
        if self.weights == 2:
            np.multiply(normals, normals, out=normals)
            np.add(normals[0], normals[1], out=normals[0])
            np.add(normals[0], normals[2], out=normals[0])
            np.sqrt(normals[0], out=own.weights[1])
        absolute = np.abs(own.vectors, out=own.fetched[:own.vectors.size].reshape(own.vectors.shape))
        chunked = absolute.reshape(*absolute.shape[:2], CHUNK, -1)
        tops = np.maximum.reduce(chunked, axis=2)  # (3, 2c-1, m)
        corners = own.corners.shape[1]
        reach = tops[:, :corners].max(axis=1) * (1.0 + 4.0 * U) + half_ulp[:, None]
        (a, b, c), (x, y, z) = tops[:, corners:-1], tops[:, corners + 1:]
        tau = CHUNK * np.array([b * z + c * y, c * x + a * z, a * y + b * x]).sum(axis=1)  # all faces of the chunk
        sizes = np.add.reduce(np.abs(own.weights, out=own.minus[:self.weights]).reshape(
            self.weights, own.fans, CHUNK, -1), axis=(1, 2)) * (1.0 + 1e-9)
        rounding = ROUNDING * np.array([(reach * tau).sum(axis=0), tau.sum(axis=0)])
        step = np.linalg.norm(half_ulp)
        lengths = np.sqrt((tops[:, corners:] ** 2).sum(axis=0))
        double = sizes[1] + rounding[1] if self.weights == 2 else np.sqrt((tau ** 2).sum(axis=0))
        added = step * CHUNK * ((lengths[:-1] + lengths[1:]).sum(axis=0) + 2.0 * own.fans * step)
        rows = [sizes[0] + rounding[0], rounding[0], step * (double / 2.0 + added)]
        if self.weights == 2:
            rows += [double, rounding[1], added]
        return reach, np.array(rows)

    def _summed(self, own: _Scratch) -> NDArray[np.float64]:
        """(w, K) the block's sums."""
        total = np.empty((self.weights, monomial_count(self.order)))
        first, middle, others = own.corners[:, 0], own.corners[:, 2 if own.fans == 2 else 1], own.corners[:, 1::2]
        if own.fans == 1:
            others = own.corners[:, 2:]
        np.add.reduce(own.weights, axis=1, out=own.both)
        total[:, 0] = _dots(own.both, np.ones((1, own.k)))[:, 0]
        own.powers[0] = own.first[:, 0] = own.second[:, 0] = 1.0
        for degree in range(1, self.order):
            self._raise_powers(own.powers, degree, first)
            rows, known = rows_of(degree), monomial_count(degree - 1)
            grown = own.fetched[:rows * own.k].reshape(rows, own.k)
            self._raise(own, own.first, degree, middle[:, None])
            np.multiply(own.powers[:rows], multinomials(degree), out=grown)
            np.add(own.first[0, :rows], grown, out=own.first[0, :rows])
            self._raise(own, own.second, degree, others)
            np.add(own.second[:, :rows], own.first[:, :rows], out=own.second[:, :rows])
            part = sum(_dots(own.weights[:, f], own.second[f, :rows]) for f in range(own.fans))
            total[:, known:known + rows] = part
        if self.order:
            self._last(own, first, middle, others, total[:, monomial_count(self.order - 1):])
        return total

    def _raise(self, own: _Scratch, level: NDArray, degree: int, vectors: NDArray) -> None:
        """Σ_i v_i L_{α-e_i} in place of a level L, (f, R+1, k), one degree lower. vectors: (3, f, k)."""
        fans, rows = len(level), rows_of(degree)
        fetched = own.fetched[:fans * 3 * rows * own.k].reshape(fans, 3, rows, own.k)
        np.take(level, predecessors(degree, level.shape[1] - 1), axis=1, out=fetched, mode="clip")
        np.einsum("fdrk,dfk->frk", fetched, vectors, out=level[:, :rows])

    @staticmethod
    def _raise_powers(powers: NDArray, degree: int, vector: NDArray) -> None:
        """Row by row, x^α of one degree in place of those of the degree below: those without x from the last ones."""
        rows = rows_of(degree - 1)
        np.multiply(powers[rows - degree:rows], vector[1], out=powers[rows:rows + degree])
        np.multiply(powers[rows - 1], vector[2], out=powers[rows + degree])
        np.multiply(powers[:rows], vector[0], out=powers[:rows])

    def _last(self, own: _Scratch, first: NDArray, middle: NDArray, others: NDArray, total: NDArray) -> None:
        """The sums of the last degree into `total`, (w, rows)."""
        degree, weights = self.order, self.weights
        rows, below = rows_of(degree), rows_of(degree - 1)
        places = predecessors(degree, below)
        np.multiply(own.weights.transpose(1, 0, 2)[:, None], others.transpose(1, 0, 2)[:, :, None],
                    out=own.heavy.reshape(own.fans, 3, weights, own.k))
        sums = sum(_dots(own.heavy[f], own.second[f, :below]) for f in range(own.fans))
        heavy = own.heavy[0]
        np.multiply(own.both[None], middle[:, None], out=heavy.reshape(3, weights, own.k))
        sums = sums + _dots(heavy, own.first[0, :below])
        sums = np.concatenate([sums.reshape(3, weights, below), np.zeros((3, weights, 1))], axis=2)
        self._raise_powers(own.powers, degree, first)
        total[...] = _dots(own.both, own.powers[:rows]) * multinomials(degree)[:, 0]
        for axis in range(3):
            total += sums[axis].take(places[axis], axis=1)

    def _sizes(self, reach: NDArray, weights: NDArray) -> NDArray[np.float64]:
        """(sets, K) Σ weight reach^α over chunks. reach: (3, m), weights: (sets, m)."""
        sets, m = weights.shape
        powers = np.empty((rows_of(self.order), sets, m))
        vector = np.broadcast_to(reach[:, None], (3, sets, m))
        powers[0] = weights
        found = [np.add.reduce(powers[:1], axis=2)]
        for degree in range(1, self.order + 1):
            self._raise_powers(powers, degree, vector)
            found.append(np.add.reduce(powers[:rows_of(degree)], axis=2))
        return np.concatenate(found).T


def _dots(weights: NDArray, rows: NDArray) -> NDArray[np.float64]:
    """(w, r) the scalar products of (w, k) with (r, k), no more than LENGTH products in any order and then pairs of
    sums."""
    k = rows.shape[1]
    whole = k // LENGTH * LENGTH
    if not whole:
        return np.einsum("wk,rk->wr", weights, rows)
    found = np.add.reduce(np.einsum("wjk,rjk->wrj", weights[:, :whole].reshape(len(weights), -1, LENGTH),
                                    rows[:, :whole].reshape(len(rows), -1, LENGTH)), axis=2)
    if whole < k:
        found += np.einsum("wk,rk->wr", weights[:, whole:], rows[:, whole:])
    return found
