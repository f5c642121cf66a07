# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `polyhedron`: triangles and pairs of triangles, a block at a time, in scratch that is made once.

A face of three or four corners is the fan of its first corner: the triangles 0, 1, 2 and perhaps 0, 2, 3. A pair has
five edges where two triangles have six, and so five midpoints.

Corners are gathered by component, so that every numpy call runs along contiguous rows. A call costs as much as ten
thousand additions, memory beyond the cache twice as much as within: hence blocks, few calls, and results written over
rows that are no longer needed. Products are summed over a few slices of their rows, not along them, so that einsum
multiplies and adds in one pass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import flipped_quads

SLICES = 8  # of a row that einsum adds up
CHUNK = 256  # columns that share one bound of their edges; a multiple of SLICES
FLIP_MARGIN = 1e-6  # float32 may decide a quad's diagonal otherwise where float64 sees a cosine below this
FLOAT32_OVERFLOW = 1e9  # edges from which the fourth powers in that decision leave the range of float32
EXACT = np.array([25.0, 25.0, 25.0, -27.0])[:, None]  # 48 times the weights of the exact rule's nodes


@dataclass(frozen=True, eq=False)
class Rows:
    """What one block adds.

    sums, areas: (20,) Σ weight node^α to order 3 (see `power_sums`). The weights are the determinants or the doubled
    areas of the triangles, the nodes those of the rule; order 0 is the sum of the determinants or doubled areas alone.
    edges: (3, corners - 1, chunks) the largest components of the fans' edges in each chunk of faces.
    sizes: (2, corners - 2, chunks) Σ |determinant| and Σ doubled area. counts: (chunks,) faces.
    """

    sums: NDArray[np.float64]
    areas: NDArray[np.float64] | None
    edges: NDArray[np.float64]
    sizes: NDArray[np.float64]
    counts: NDArray[np.int64]


def power_sums(weights: NDArray, nodes: NDArray, work: NDArray, products: NDArray) -> NDArray[np.float64]:
    """(20,) Σ w x^p y^q z^r for 1 ≤ p+q+r ≤ 3, in the order of `moments.monomials`, and zero for order 0.

    weights: (n, k) or (1, k). nodes: (3, n, k), k a multiple of SLICES. work: (3, n, k), products: (6, n, k).
    """
    total = np.zeros(20)
    np.multiply(nodes, weights, out=work)
    np.add.reduce(work.reshape(3, -1), axis=1, out=total[1:4])
    np.multiply(nodes, work[0], out=products[:3])
    np.multiply(nodes[1:], work[1], out=products[3:5])
    np.multiply(nodes[2], work[2], out=products[5])
    np.add.reduce(products.reshape(6, -1), axis=1, out=total[4:10])
    slices = SLICES * nodes.shape[1]
    x, y, z = nodes.reshape(3, slices, -1)
    products, cubes = products.reshape(6, slices, -1), work.reshape(3 * slices, -1)[:10]
    np.einsum("pjk,jk->pk", products, x, out=cubes[:6])
    np.einsum("pjk,jk->pk", products[3:], y, out=cubes[6:9])
    np.einsum("jk,jk->k", products[5], z, out=cubes[9])
    np.add.reduce(cubes, axis=1, out=total[10:])
    return total


class _Scratch:
    """Contiguous rows for blocks of one shape, carved out of one buffer; some share memory when their times differ.

    index: (c, k). corners: (3, c, k), edges: (3, c-1, k), normals, minus: (3, c-2, k), later all products: (6, n, k).
    det, double: (c-2, k). nodes, work: (3, n, k), weights: (n, k), n the number of nodes of a face.
    """

    def __init__(self, buffer: NDArray, count: int, k: int, exact: bool):
        fans = count - 2
        number = _nodes(count, exact)
        position = -(buffer.ctypes.data // 8) % 8

        def rows(*shape: int) -> NDArray[np.float64]:
            # 64-byte aligned and 64 bytes apart: numpy < 2 leaves its vector loop where output ends at input's start
            nonlocal position
            size = k
            for length in shape:
                size *= length
            start, position = position, position + size + 8
            return buffer[start:start + size].reshape(*shape, k)

        self.index = rows(count).view(np.intp)
        self.nodes, self.work = rows(3, number), rows(3, number)
        self.weights, self.double = rows(number if exact or fans == 2 else 1), rows(fans)
        self.det = rows(fans) if exact else self.weights[:4:2]
        start = position
        self.corners, self.edges = rows(3, count), rows(3, count - 1)
        self.normals, self.minus = rows(3, fans), rows(3, fans)
        position = start
        self.products = rows(6, number)
        self.apex, self.first, self.second = self.corners[:, :1], self.edges[:, :-1], self.edges[:, 1:]
        self.offsets = self.normals.reshape(-1)[:count * k].view(np.intp).reshape(count, k)
        self.single = self.edges.reshape(-1).view(np.float32)[:3 * count * k].reshape(3, count, k)
        self.chunk = min(k, CHUNK)

    def chunks(self, rows: NDArray) -> NDArray[np.float64]:
        """Rows (..., k) as (..., chunks, columns)."""
        return rows.reshape(*rows.shape[:-1], -1, self.chunk)


def _nodes(count: int, exact: bool) -> int:
    return 4 * (count - 2) if exact else 2 * count - 3


class Faces:
    """The loop body for blocks of up to `triangles` triangles.

    points: (n, 3) contiguous float32 or float64. center: (3,) the reference point. area: whether doubled areas are
    wanted, shell: also their power sums. exact: whether the nodes are those of the rule for third order.
    """

    def __init__(self, points: NDArray, center: NDArray, triangles: int, *, area: bool, shell: bool, exact: bool):
        self.points, self.flat, self.center = points, points.reshape(-1), center
        self.area, self.shell, self.exact = area, shell, exact
        self.buffer = np.empty(self.size(triangles + 2 * CHUNK, exact) + 16 * 10)
        self.scratch: dict[tuple[int, int], _Scratch] = {}
        self.flipped: list[NDArray] = []

    @staticmethod
    def size(triangles: int, exact: bool) -> int:
        """The numbers that the scratch for so many triangles holds."""
        return (61 if exact else 46) * triangles

    def block(self, faces: Sequence[NDArray], quads: bool = False) -> Rows:
        """The sums over some faces.

        faces: the vertices of their first, second, third and perhaps fourth corners, (k,) each. quads: leave those out
        that Blender cuts along the other diagonal, and append them to `flipped`, turned by one corner; otherwise the
        first diagonal is taken.
        """
        k = len(faces[0])
        own = self._shaped(len(faces), k)
        for row, corner in zip(own.index, faces):
            row[:len(corner)] = corner
            row[len(corner):] = faces[0][0]  # filled up with faces that are a point
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
        sizes = np.zeros((2, *largest.shape[1:]))[:, 1:]
        np.add.reduce(own.chunks(np.abs(own.det, out=own.minus[0])), axis=2, out=sizes[0])
        if self.area:
            np.add.reduce(own.chunks(own.double), axis=2, out=sizes[1])
        (self._exact_nodes if self.exact else self._midpoints)(own)
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

    def _midpoints(self, own: _Scratch) -> None:
        """The nodes of the plain rule, twice as far out as they are: those of edges 0-1, 1-2, ... and the diagonal."""
        corners, nodes, count = own.corners, own.nodes, len(own.index)
        np.add(corners[:, :-1], corners[:, 1:], out=nodes[:, :count - 1])
        np.add(corners[:, -1], corners[:, 0], out=nodes[:, count - 1])
        if count == 4:
            np.add(corners[:, 0], corners[:, 2], out=nodes[:, 4])

    def _exact_nodes(self, own: _Scratch) -> None:
        """The nodes of the exact rule, fifteen times as far out as they are: for each triangle 3 (s + 2 corner) and
        last 5 s, s being the sum of its corners."""
        corners, nodes = own.corners, own.nodes
        np.add(corners[:, 1:-1], corners[:, 2:], out=nodes[:, 3::4])
        np.add(nodes[:, 3::4], own.apex, out=nodes[:, 3::4])
        np.multiply(corners, 6.0, out=corners)
        for node, corner in ((2, corners[:, 2:]), (1, corners[:, 1:-1]), (0, own.apex)):
            np.multiply(nodes[:, 3::4], 3.0, out=nodes[:, node::4])
            np.add(nodes[:, node::4], corner, out=nodes[:, node::4])
        np.multiply(nodes[:, 3::4], 5.0, out=nodes[:, 3::4])

    def _summed(self, own: _Scratch, weights: NDArray) -> NDArray[np.float64]:
        """(20,) the power sums over the nodes with the weights of the triangles, and the weights' own sum."""
        fans, k = weights.shape
        total = np.add.reduce(np.add.reduce(weights, axis=1))
        if self.exact:
            np.multiply(weights[:, None], EXACT, out=own.weights.reshape(fans, 4, k))
        else:
            if weights is not own.det:
                own.det[...] = weights
            if fans == 2:  # of the midpoints the first two belong to the first triangle, the next two to the second
                own.weights[1:4:2] = weights
                np.add(weights[0], weights[1], out=own.weights[4])
        sums = power_sums(own.weights, own.nodes, own.work, own.products)
        sums[0] = total
        return sums
