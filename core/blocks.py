# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `polyhedron`: triangles and pairs of triangles, a block at a time, in scratch that is made once.

A face is a base a-c with a corner b on one side, and perhaps a corner d on the other: the triangles a, b, c and
a, c, d. With their determinants v and w, u = v + w, q = a + c and Z = u q + 2 (v b + w d),

    H = u (a a' + c c') + 2 (v b b' + w d d')
    120 ∫ x x'     = H + (q Z' + Z q') / 2
    288 ∫ x x' x'' = q H + the same for the other two orders of the indices, but for the third moments about q / 2.

Those are, of one triangle with e = c - a and f = 2 b - q, v / 2880 (f (f f' + e e') + the other two orders), of the
order of an edge cubed. They are added on request. No sum cancels what it holds: all its weights are positive.

Corners are gathered by component, so that every numpy call runs along contiguous rows. A call costs as much as ten
thousand additions, memory beyond the cache twice as much as within: hence blocks, few calls, and results written over
rows that are no longer needed. Products are summed over slices of their rows, not along them: einsum then multiplies
and adds in one pass, into rows that stay in the cache.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import flipped_quads

SLICES = 16  # of a row that einsum adds up
CHUNK = 512  # columns that share one bound of their edges; a multiple of SLICES
FLIP_MARGIN = 1e-6  # float32 may decide a quad's diagonal otherwise where float64 sees a cosine below this
FLOAT32_OVERFLOW = 1e9  # edges from which the fourth powers in that decision leave the range of float32
TRIPLES = [(i, j, k) for i in range(3) for j in range(i, 3) for k in range(j, 3)]
# Where, in a table of x, y, z times x, y, z and in one of x, y, z times xx, xy, xz, yy, yz, zz, the terms of the
# symmetric products stand: two of each xx, xy, ... and three of each xxx, xxy, ...
SQUARE = np.array([[3 * i + j, 3 * j + i] for i in range(3) for j in range(i, 3)])
TENSOR = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
CUBE = np.array([[6 * i + TENSOR[j, k], 6 * j + TENSOR[i, k], 6 * k + TENSOR[i, j]] for i, j, k in TRIPLES])


@dataclass(frozen=True, eq=False)
class Rows:
    """What one block adds.

    sums, areas: (20,) Σ weight, 48, 120 and 2880 ∫ of the monomials of first to third order in the order of
    `moments.monomials`, over the cones, and over their faces as if they were cones of unit height.
    edges: (3, corners - 1, chunks) the largest components of b-a, c-a (and d-a) in each chunk of faces.
    sizes: (2, corners - 2, chunks) Σ |determinant| and Σ doubled area. counts: (chunks,) faces.
    """

    sums: NDArray[np.float64]
    areas: NDArray[np.float64] | None
    edges: NDArray[np.float64]
    sizes: NDArray[np.float64]
    counts: NDArray[np.int64]


class _Scratch:
    """Contiguous rows for blocks of one shape, carved out of one buffer; some share memory when their times differ.

    index: (c, k). corners, weighted: (3, c, k). weights: (c, k). edges: (3, c-1, k), later tensors: (6, k).
    normals and minus: (3, c-2, k), later local: (6, c-2, k). det, double: (c-2, k). middle, both, all: (3, k).
    """

    def __init__(self, buffer: NDArray, count: int, k: int, exact: bool):
        fans = count - 2
        position = -(buffer.ctypes.data // 8) % 8

        def rows(number: int) -> NDArray[np.float64]:
            # 64-byte aligned and 64 bytes apart: numpy < 2 leaves its vector loop where output ends at input's start
            nonlocal position
            start, position = position, position + number * k + 8
            return buffer[start:start + number * k]

        self.index = rows(count).view(np.intp).reshape(count, k)
        self.corners, self.weights = rows(3 * count).reshape(3, count, k), rows(count).reshape(count, k)
        self.det, self.double = rows(fans).reshape(fans, k), rows(fans).reshape(fans, k)
        self.middle, self.both, self.all = rows(3).reshape(3, k), rows(3).reshape(3, k), rows(3).reshape(3, k)
        room = rows(max(3 * count - 3, 6))
        self.edges = room[:3 * (count - 1) * k].reshape(3, count - 1, k)
        self.tensors = room[:6 * k].reshape(6, k)
        room = rows(3 * count)
        self.weighted, self.heavy = room.reshape(3, count, k), room[:6 * fans * k].reshape(6, fans, k)
        self.single = room.view(np.float32)[:3 * count * k].reshape(3, count, k)
        room = rows(6 * fans)
        self.normals, self.minus = room.reshape(2, 3, fans, k)
        self.local = room.reshape(6, fans, k)
        self.offsets = room[:count * k].view(np.intp).reshape(count, k)
        self.tips = rows(3 * fans).reshape(3, fans, k) if exact else None
        self.apex, self.first, self.second = self.corners[:, :1], self.edges[:, :-1], self.edges[:, 1:]
        self.chunk = min(k, CHUNK)

    def chunks(self, rows: NDArray) -> NDArray[np.float64]:
        """Rows (..., k) as (..., chunks, columns)."""
        return rows.reshape(*rows.shape[:-1], -1, self.chunk)


class Faces:
    """The loop body for blocks of up to `triangles` triangles.

    points: (n, 3) contiguous float32 or float64. center: (3,) the reference point. area: whether doubled areas are
    wanted, shell: also their moments. exact: whether the third order is.
    """

    def __init__(self, points: NDArray, center: NDArray, triangles: int, *, area: bool, shell: bool, exact: bool):
        self.points, self.flat, self.center = points, points.reshape(-1), center
        self.area, self.shell, self.exact = area, shell, exact
        self.buffer = np.empty(self.size(triangles + 2 * CHUNK) + 16 * 8)
        self.scratch: dict[tuple[int, int], _Scratch] = {}
        self.flipped: list[NDArray] = []

    @staticmethod
    def size(triangles: int) -> int:
        """The numbers that the scratch for so many triangles holds."""
        return 50 * triangles

    def block(self, faces: Sequence[NDArray], quads: bool = False) -> Rows:
        """The sums over some faces.

        faces: the vertices a, b, c and perhaps d, (k,) each. quads: leave those out that Blender cuts along the other
        diagonal, and append them to `flipped`, turned by one corner; otherwise the first diagonal is taken.
        """
        k = len(faces[0])
        own = self._shaped(len(faces), k)
        for row, corner in zip(own.index, faces):
            row[:k] = corner
            row[k:] = faces[0][0]  # filled up with faces that are a point
        self._gather(own)
        normals = own.normals
        np.subtract(own.corners[:, 1:], own.apex, out=own.edges)
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            np.multiply(own.first[y], own.second[z], out=normals[x])
            np.multiply(own.first[z], own.second[y], out=own.minus[x])
        np.subtract(normals, own.minus, out=normals)
        edges = own.chunks(own.edges)
        largest = np.maximum.reduce(edges, axis=3)
        np.maximum(largest, -np.minimum.reduce(edges, axis=3), out=largest)
        flipped = self._flipped(own, largest) if quads else ()

        np.subtract(own.corners, self.center[:, None, None], out=own.corners)
        np.einsum("cfk,ck->fk", normals, own.apex[:, 0], out=own.det)
        if self.area:
            np.multiply(normals, normals, out=normals)
            np.add(normals[0], normals[1], out=own.double)
            np.add(own.double, normals[2], out=own.double)
            np.sqrt(own.double, out=own.double)
        if len(flipped):
            own.det[:, flipped] = own.double[:, flipped] = 0.0
        sizes = np.zeros((2, len(own.det), largest.shape[2]))
        np.add.reduce(own.chunks(np.abs(own.det, out=own.minus[0])), axis=2, out=sizes[0])
        if self.area:
            np.add.reduce(own.chunks(own.double), axis=2, out=sizes[1])
        if self.exact:
            self._prepare(own)
        np.add(own.corners[:, 0], own.corners[:, 2], out=own.middle)
        sums = self._summed(own, own.det)
        areas = self._summed(own, own.double) if self.shell else None
        return Rows(sums, areas, largest, sizes, np.minimum(np.arange(k, 0, -own.chunk), own.chunk))

    def _shaped(self, count: int, k: int) -> _Scratch:
        unit = SLICES if k <= CHUNK else CHUNK
        k = -(-k // unit) * unit
        if (count, k) not in self.scratch:
            self.scratch = {(count, k): _Scratch(self.buffer, count, k, self.exact)}
        return self.scratch[count, k]

    def _gather(self, own: _Scratch) -> None:
        """The corners' coordinates, in float64."""
        single = self.points.dtype == np.float32
        target = own.single if single else own.corners
        np.multiply(own.index, 3, out=own.offsets)
        for axis in range(3):  # the indices have been checked: "wrap" is the mode that costs least
            self.flat[axis:].take(own.offsets, out=target[axis], mode="wrap")
        if single:
            own.corners[...] = target

    def _flipped(self, own: _Scratch, largest: NDArray) -> NDArray[np.intp]:
        """The columns of the quads that Blender cuts along their other diagonal, once they are appended to `flipped`.

        They are those whose two normals face away from each other in float32. That can differ from float64 only where
        the product is within float32's rounding of zero.
        """
        cosine = own.double[0]
        np.einsum("ck,ck->k", own.normals[:, 0], own.normals[:, 1], out=cosine)
        if self.points.dtype == np.float32:
            length = np.sqrt((largest ** 2).sum(axis=0))
            margin = FLIP_MARGIN * length[0] * length[1] ** 2 * length[2]
            if length.max() < FLOAT32_OVERFLOW and (np.minimum.reduce(own.chunks(cosine), axis=1) > margin).all():
                return own.index[0, :0]
            square = np.einsum("cik,cik->ik", own.edges, own.edges)
            limit = FLIP_MARGIN * square[1] * np.sqrt(square[0] * square[2])
            limit[square.max(axis=0) > FLOAT32_OVERFLOW ** 2] = np.inf
            suspects = np.flatnonzero(cosine <= limit)
        else:  # float32 sees coordinates that were rounded first: all are suspects
            suspects = np.arange(len(cosine))
        quads = own.index[:, suspects]
        loose = self.points[quads.T].reshape(-1, 3)
        turn = flipped_quads(loose, np.arange(len(loose)).reshape(-1, 4))
        self.flipped.append(np.roll(quads[:, turn], -1, axis=0))
        return suspects[turn]

    def _prepare(self, own: _Scratch) -> None:
        """`tips`, the vectors f, and `local`, f f' + e e', of every triangle."""
        base, squares = own.edges[:, 1], own.heavy[:, 0]
        np.add(own.edges[:, ::2], own.edges[:, ::2], out=own.tips)
        np.subtract(own.tips, base[:, None], out=own.tips)
        for vectors, tensors in ((own.tips, own.local), (base, squares)):
            np.multiply(vectors, vectors[0], out=tensors[:3])
            np.multiply(vectors[1:], vectors[1], out=tensors[3:5])
            np.multiply(vectors[2], vectors[2], out=tensors[5])
        np.add(own.local, squares[:, None], out=own.local)

    def _summed(self, own: _Scratch, weights: NDArray) -> NDArray[np.float64]:
        """(20,) the block's sums with these weights of its triangles."""
        total = np.empty(20)
        corners, weighted = own.corners, own.weighted
        total[0] = np.add.reduce(np.add.reduce(weights, axis=1))
        np.add(weights, weights, out=own.weights[1::2])
        if len(weights) == 2:
            np.add(weights[0], weights[1], out=own.weights[0])
        else:
            own.weights[0] = weights[0]
        own.weights[2] = own.weights[0]
        np.multiply(corners, own.weights, out=weighted)
        np.einsum("nk,dnk->dk", weighted[0], corners, out=own.tensors[:3])
        np.einsum("nk,dnk->dk", weighted[1], corners[1:], out=own.tensors[3:5])
        np.einsum("nk,nk->k", weighted[2], corners[2], out=own.tensors[5])
        np.add(weighted[:, 0], weighted[:, 2], out=own.both)
        np.add(own.both, weighted[:, 1], out=own.all)
        if len(weights) == 2:
            np.add(own.all, weighted[:, 3], out=own.all)
        total[1:4] = np.add.reduce(own.all, axis=1) + np.add.reduce(own.both, axis=1)
        mixed = _products(own.middle, own.all)
        total[4:10] = np.add.reduce(own.tensors, axis=1) + 0.5 * np.add.reduce(mixed.take(SQUARE), axis=1)
        third = 10.0 * _products(own.middle, own.tensors)
        if self.exact:
            np.multiply(own.local, weights, out=own.heavy)
            third += _products(own.tips.reshape(3, -1), own.heavy.reshape(6, -1))
        np.add.reduce(third.take(CUBE), axis=1, out=total[10:])
        return total


def _products(vectors: NDArray, others: NDArray) -> NDArray[np.float64]:
    """(m, n) the scalar products of (m, k) rows with (n, k) rows."""
    return np.add.reduce(np.einsum("cjk,pjk->cpk", vectors.reshape(len(vectors), SLICES, -1),
                                   others.reshape(len(others), SLICES, -1)), axis=2)
