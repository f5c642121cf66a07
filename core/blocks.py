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

Where no areas are wanted, the determinants share a product: with m = (c-a) x a, v = (b-a)·m and w = (a-d)·m.

Corners are gathered by component, so that every numpy call runs along contiguous rows. A call costs as much as some
thousand additions, and threads gain only where calls are long: hence long blocks, few calls, results written over rows
that are no longer needed, and whatever is done to a few numbers only is done once, for all blocks. Products are summed
over slices of their rows, not along them: einsum then multiplies and adds in one pass, into rows that stay in the
cache.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import flipped_quads

SLICES = 32  # of a row that einsum adds up
CHUNK = 1024  # columns at most that share one bound of their edges
GAP = 8  # numbers between rows: numpy < 2 leaves its vector loop where output ends at input's start
FLIP_MARGIN = 1e-6  # float32 may decide a quad's diagonal otherwise where float64 sees a cosine below this
FLOAT32_OVERFLOW = 1e9  # edges from which the fourth powers in that decision leave the range of float32
NO_VERTEX = "a face names a vertex that does not exist"
TRIPLES = [(i, j, k) for i in range(3) for j in range(i, 3) for k in range(j, 3)]
TENSOR = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
# Where, in a table of x, y, z times xx, xy, xz, yy, yz, zz, x, y, z, the terms of the symmetric products stand: two of
# each xx, xy, ... and three of each xxx, xxy, ...
SQUARE = np.array([[9 * i + 6 + j, 9 * j + 6 + i] for i in range(3) for j in range(i, 3)]).T
CUBE = np.array([[9 * i + TENSOR[j, k], 9 * j + TENSOR[i, k], 9 * k + TENSOR[i, j]] for i, j, k in TRIPLES]).T


@dataclass(frozen=True, eq=False)
class Rows:
    """What some blocks add.

    sums, areas: (20,) Σ weight, 48, 120 and 2880 ∫ of the monomials of first to third order in the order of
    `moments.monomials`, over the cones, and over their faces as if they were cones of unit height.
    side, base: (3, n) the largest components of b-a (or d-a) and c-a in each chunk of triangles. sizes: (2, n)
    Σ |determinant| and Σ doubled area. counts: (n,) triangles. blocks: how many there were.
    """

    sums: NDArray[np.float64]
    areas: NDArray[np.float64] | None
    side: NDArray[np.float64]
    base: NDArray[np.float64]
    sizes: NDArray[np.float64]
    counts: NDArray[np.integer]
    blocks: int = 1


def together(parts: Sequence[Rows]) -> Rows:
    """Several as one."""
    sums, areas, *columns = zip(*((part.sums, part.areas, part.side, part.base, part.sizes, part.counts)
                                  for part in parts))
    return Rows(sum(sums), None if areas[0] is None else sum(areas),
                *(np.concatenate(column, axis=-1) for column in columns), sum(part.blocks for part in parts))


class _Scratch:
    """Contiguous rows for blocks of one shape, carved out of one buffer; some share memory when their times differ.

    First index: (c, k), then single: (3, c, k) in float32, later weighted: (3, c, k), later heavy: (6, c-2, k).
    corners: (3, c, k). weights: (2, c-2, k), the determinants and the doubled areas.
    First edges: (3, c-1, k), normals and spare: (3, f, k) where f is c-2 or, unless there is to be a normal of each
    triangle, 1; later table: (13, k), the tensors' six rows and those of two vectors and a number, and middle: (3, k).
    On request tips: (3, c-2, k), local: (6, c-2, k).
    """

    def __init__(self, buffer: NDArray, count: int, k: int, each: bool, exact: bool):
        fans = count - 2
        position = -(buffer.ctypes.data // 8) % 8  # aligned to 64 bytes

        def rows(number: float, width: int = k) -> NDArray[np.float64]:
            nonlocal position
            start, position = position, position + int(number * width) + GAP
            return buffer[start:position - GAP]

        self.corners, self.weights = rows(3 * count).reshape(3, count, k), rows(2 * fans).reshape(2, fans, k)
        start = position
        self.index = rows(count).view(np.intp).reshape(count, k)
        self.single = rows(1.5 * count).view(np.float32).reshape(3, count, k)
        position = start
        room = rows(3 * count)
        self.weighted, self.heavy = room.reshape(3, count, k), room[:6 * fans * k].reshape(6, fans, k)
        start = position
        self.edges = rows(3 * count - 3).reshape(3, count - 1, k)
        crosses = fans if each else 1
        self.normals, self.spare = (rows(3 * crosses).reshape(3, crosses, k) for _ in range(2))
        end, position = position, start
        self.table, self.middle = rows(13).reshape(13, k), rows(3).reshape(3, k)
        position = max(position, end)
        if exact:
            self.tips, self.local = rows(3 * fans).reshape(3, fans, k), rows(6 * fans).reshape(6, fans, k)
        self.apex, self.base, self.sides = self.corners[:, :1], self.edges[:, 1:2], self.edges[:, ::2]

    @staticmethod
    def numbers(count: int, each: bool, exact: bool) -> int:
        """How many numbers it holds for a face of `count` corners."""
        fans = count - 2
        phases = max(3 * count - 3 + 6 * (fans if each else 1), 16)
        return 6 * count + 2 * fans + phases + (9 * fans if exact else 0)


class Faces:
    """The loop body for blocks of faces.

    points: (n, 3) contiguous float32 or float64. center: (3,) the reference point. area: whether doubled areas are
    wanted, shell: also their moments. exact: whether the third order is.
    """

    def __init__(self, points: NDArray, center: NDArray, *, area: bool, shell: bool, exact: bool):
        self.points, self.flat, self.center = points, points.reshape(-1), center[:, None, None]
        self.area, self.shell, self.exact = area, shell, exact
        self.buffer = np.empty(0)
        self.scratch: dict[tuple[int, int, bool], _Scratch] = {}
        self.flipped: list[NDArray] = []
        self.sums: list[list[NDArray]] = []
        self.edges: list[NDArray] = []
        self.sizes: list[NDArray] = []
        self.counts: list[NDArray] = []

    numbers = _Scratch.numbers

    def block(self, faces: Sequence[NDArray], quads: bool = False) -> None:
        """Add some faces.

        faces: the vertices a, b, c and perhaps d, (k,) each. quads: leave those out that Blender cuts along the other
        diagonal, and append them to `flipped`, turned by one corner; otherwise the first diagonal is taken.
        ValueError where an index names no point.
        """
        count, k = len(faces), len(faces[0])
        chunks = -(-k // CHUNK)
        width = -(-k // (chunks * SLICES)) * SLICES
        each = self.area or quads
        own = self._shaped(count, chunks * width, each)
        for row, corner in zip(own.index, faces):
            row[:k] = corner
        own.index[:, k:] = faces[0][0]  # filled up with faces that are a point
        if own.index.view(np.uintp).max() >= len(self.points):  # where a negative index is a large one
            raise ValueError(NO_VERTEX)
        self._gather(own)
        np.subtract(own.corners[:, 1:3], own.apex, out=own.edges[:, :2])
        if count == 4:
            np.subtract(own.corners[:, 0], own.corners[:, 3], out=own.edges[:, 2])
        np.subtract(own.corners, self.center, out=own.corners)
        edges = own.edges.reshape(3, count - 1, chunks, width)
        largest = np.maximum.reduce(edges, axis=3)
        np.maximum(largest, -np.minimum.reduce(edges, axis=3), out=largest)

        weights = own.weights[:1 + self.area]
        if each:
            _cross(own.sides, own.base, own.normals, own.spare)
            flipped = self._flipped(own, largest, k) if quads else ()
            np.einsum("dfk,dk->fk", own.normals, own.apex[:, 0], out=weights[0])
            if self.area:
                np.einsum("dfk,dfk->fk", own.normals, own.normals, out=weights[1])
                np.sqrt(weights[1], out=weights[1])
            if len(flipped):
                weights[:, :, flipped] = 0.0
        else:
            _cross(own.base, own.apex, own.normals, own.spare)
            np.einsum("dfk,dk->fk", own.sides, own.normals[:, 0], out=weights[0])
        sizes = np.abs(weights, out=own.spare.reshape(-1)[:weights.size].reshape(weights.shape))
        self.edges.append(largest)
        self.sizes.append(np.add.reduce(sizes.reshape(*weights.shape[:2], chunks, width), axis=3))
        self.counts.append(np.minimum(k - width * np.arange(chunks), width))
        if self.exact:
            self._prepare(own)
        np.add(own.corners[:, 0], own.corners[:, 2], out=own.middle)
        self.sums.append([self._summed(own, row) for row in weights[:1 + self.shell]])

    def rows(self) -> Rows:
        """What all blocks together add."""
        raw = np.add.reduce(np.array(self.sums))
        fans = [(edges[:, 2 * i], edges[:, 1], sizes[:, i], counts) for edges, sizes, counts in
                zip(self.edges, self.sizes, self.counts) for i in range(sizes.shape[1])]
        side, base, sizes, counts = (np.concatenate(column, axis=-1) for column in zip(*fans))
        if not self.area:
            sizes = np.concatenate([sizes, np.zeros_like(sizes)])
        return Rows(self._assembled(raw[0]), self._assembled(raw[1]) if self.shell else None, side, base, sizes,
                    counts, len(self.counts))

    def _shaped(self, *shape: int) -> _Scratch:
        if shape not in self.scratch:
            count, k, each = shape
            needed = _Scratch.numbers(count, each, self.exact) * k + 12 * GAP
            self.scratch.clear()
            if len(self.buffer) < needed:
                self.buffer = np.empty(0)  # never two of them
                self.buffer = np.empty(needed)
            self.scratch[shape] = _Scratch(self.buffer, *shape, self.exact)
        return self.scratch[shape]

    def _gather(self, own: _Scratch) -> None:
        """The corners' coordinates, in float64. `index` is multiplied by 3."""
        single = self.points.dtype == np.float32
        target = own.single if single else own.corners
        np.multiply(own.index, 3, out=own.index)
        for axis in range(3):  # the indices have been checked: "wrap" is the mode that costs least
            self.flat[axis:].take(own.index, out=target[axis], mode="wrap")
        if single:
            own.corners[...] = target

    def _flipped(self, own: _Scratch, largest: NDArray, k: int) -> NDArray[np.intp]:
        """Those of the first k columns whose quads Blender cuts along their other diagonal, once they are appended to
        `flipped`.

        They are those whose two normals face away from each other in float32. That can differ from float64 only where
        the product is within float32's rounding of zero.
        """
        cosine = np.einsum("dk,dk->k", own.normals[:, 0], own.normals[:, 1], out=own.weights[1, 0])
        cosine[k:] = np.inf
        if self.points.dtype == np.float32:
            length = np.sqrt((largest ** 2).sum(axis=0))
            margin = FLIP_MARGIN * length[0] * length[1] ** 2 * length[2]
            least = np.minimum.reduce(cosine.reshape(len(margin), -1), axis=1)
            if length.max() < FLOAT32_OVERFLOW and (least > margin).all():
                return own.index[0, :0]
            square = np.einsum("cik,cik->ik", own.edges, own.edges)
            limit = FLIP_MARGIN * square[1] * np.sqrt(square[0] * square[2])
            limit[square.max(axis=0) > FLOAT32_OVERFLOW ** 2] = np.inf
            suspects = np.flatnonzero(cosine <= limit)
        else:  # float32 sees coordinates that were rounded first: all are suspects
            suspects = np.arange(k)
        quads = own.index[:, suspects] // 3
        loose = self.points[quads.T].reshape(-1, 3)
        turn = flipped_quads(loose, np.arange(len(loose)).reshape(-1, 4))
        self.flipped.append(np.roll(quads[:, turn], -1, axis=0))
        return suspects[turn]

    def _prepare(self, own: _Scratch) -> None:
        """`tips`, the vectors f, and `local`, f f' + e e', of every triangle."""
        base, squares = own.base[:, 0], own.heavy[:, 0]
        np.multiply(own.sides, [[2.0], [-2.0]][:own.sides.shape[1]], out=own.tips)
        np.subtract(own.tips, own.base, out=own.tips)
        for vectors, tensors in ((own.tips, own.local), (base, squares)):
            np.multiply(vectors, vectors[0], out=tensors[:3])
            np.multiply(vectors[1:], vectors[1], out=tensors[3:5])
            np.multiply(vectors[2], vectors[2], out=tensors[5])
        np.add(own.local, squares[:, None], out=own.local)

    def _summed(self, own: _Scratch, weights: NDArray) -> NDArray[np.float64]:
        """The block's sums with these weights of its triangles, as `_assembled` takes them."""
        corners, weighted, table = own.corners, own.weighted, own.table
        both, half = table[9:12], table[12]
        if len(weights) == 2:
            np.add(weights[0], weights[1], out=half)
        np.multiply(half if len(weights) == 2 else weights[0], 0.5, out=half)
        np.multiply(corners[:, ::2], half, out=weighted[:, ::2])
        np.multiply(corners[:, 1::2], weights, out=weighted[:, 1::2])
        np.einsum("nk,dnk->dk", weighted[0], corners, out=table[:3])
        np.einsum("nk,dnk->dk", weighted[1], corners[1:], out=table[3:5])
        np.einsum("nk,nk->k", weighted[2], corners[2], out=table[5])
        np.add(weighted[:, 0], weighted[:, 2], out=both)
        np.add(both, weighted[:, 1], out=table[6:9])
        if len(weights) == 2:
            np.add(table[6:9], weighted[:, 3], out=table[6:9])
        parts = [np.add.reduce(table, axis=1), _products(own.middle, table[:9])]
        if self.exact:
            np.multiply(own.local, weights, out=own.heavy)
            parts.append(_products(own.tips.reshape(3, -1), own.heavy.reshape(6, -1)))
        return np.concatenate(parts, axis=None)

    def _assembled(self, raw: NDArray) -> NDArray[np.float64]:
        """(20,) `Rows.sums` from the sums of the table's rows and their products with the middles."""
        mixed = 0.5 * np.add.reduce(raw[13:40].take(SQUARE))
        third = 10.0 * np.add.reduce(raw[13:40].take(CUBE))
        total = 2.0 * np.concatenate([raw[12:13], raw[6:9] + raw[9:12], raw[:6] + mixed, third])
        if self.exact:
            total[10:] += np.add.reduce(raw[40:].take(CUBE - CUBE // 9 * 3))  # in a table without x, y, z
        return total


def _cross(first: NDArray, second: NDArray, out: NDArray, spare: NDArray) -> None:
    """(3, f, k) the cross products of (3, f, k) with (3, 1, k) rows of x, y and z."""
    np.multiply(first[1:], second[::-2], out=out[:2])  # y z', z x'
    np.multiply(first[0], second[1], out=out[2])
    np.multiply(first[::-2], second[1:], out=spare[:2])  # z y', x z'
    np.multiply(first[1], second[0], out=spare[2])
    np.subtract(out, spare, out=out)


def _products(vectors: NDArray, others: NDArray) -> NDArray[np.float64]:
    """(m, n) the scalar products of (m, k) rows with (n, k) rows."""
    return np.add.reduce(np.einsum("cjk,pjk->cpk", vectors.reshape(len(vectors), SLICES, -1),
                                   others.reshape(len(others), SLICES, -1)), axis=2)
