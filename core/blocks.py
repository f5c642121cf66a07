# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `polyhedron`: fans of triangles, a block of faces at a time, in scratch memory that is made once.

A face of c corners is the fan of its first corner, triangles (0, i, i+1). Corners are gathered by component, so that
every numpy call runs along contiguous rows. A call costs as much as a thousand additions, memory beyond the cache
twice as much as within: hence blocks, few calls, and results written over rows that are no longer needed. Products are
summed over rows of a fixed number of slices, not along them: einsum then multiplies and adds in one pass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import flipped_quads

SLICES = 8  # rows of a block that einsum adds up
CHUNK = 256  # columns that share one bound of their edges
FLIP_MARGIN = 1e-6  # float32 may decide a quad's diagonal otherwise where float64 sees a cosine below this
FLOAT32_OVERFLOW = 1e9  # edges from which the fourth powers in that decision leave the range of float32


@dataclass(frozen=True, eq=False)
class Rows:
    """What one block adds.

    sums, areas: (20,) Σ weight node^α to order 3 (see `power_sums`). The weights are the determinants or the doubled
    areas of the triangles, the nodes the sums of their corners or those of the exact rule.
    edges: (3, corners - 1, chunks) the largest components of the fans' edges in each chunk of faces.
    sizes: (2, corners - 2, chunks) Σ |determinant| and Σ doubled area. counts: (chunks,) faces.
    """

    sums: NDArray[np.float64]
    areas: NDArray[np.float64]
    edges: NDArray[np.float64]
    sizes: NDArray[np.float64]
    counts: NDArray[np.int64]


NOTHING = np.zeros(20)
RULE = np.array([25.0, 25.0, 25.0, -27.0])[:, None]  # 48 times the weights of the exact rule's nodes


def power_sums(weights: NDArray, nodes: NDArray, work: NDArray, products: NDArray, *,
               lowest: int = 0) -> NDArray[np.float64]:
    """(20,) Σ w x^p y^q z^r for p+q+r ≤ 3, in the order of `moments.monomials`.

    weights: (k,). nodes: (3, k), k a multiple of SLICES. work: (3, k) and products: (6, k) scratch. lowest: 2 leaves
    zeros in the orders below.
    """
    total = np.zeros(20)
    np.multiply(nodes, weights, out=work)
    if lowest == 0:
        total[0] = np.add.reduce(weights)
        np.add.reduce(work, axis=1, out=total[1:4])
    np.multiply(nodes, work[0], out=products[:3])
    np.multiply(nodes[1:], work[1], out=products[3:5])
    np.multiply(nodes[2], work[2], out=products[5])
    np.add.reduce(products, axis=1, out=total[4:10])
    x, y, z = nodes.reshape(3, SLICES, -1)
    products = products.reshape(6, SLICES, -1)
    cubes = work.reshape(3 * SLICES, -1)[:10]
    np.einsum("pjk,jk->pk", products, x, out=cubes[:6])
    np.einsum("pjk,jk->pk", products[3:], y, out=cubes[6:9])
    np.einsum("jk,jk->k", products[5], z, out=cubes[9])
    np.add.reduce(cubes, axis=1, out=total[10:])
    return total


class _Scratch:
    """Contiguous rows for blocks of one shape, carved out of one buffer; some share memory when their times differ.

    corners: (3, c, k), edges: (3, c-1, k), plus and minus: (3, c-2, k), det and double: (c-2, k), index: (c, k).
    """

    def __init__(self, buffer: NDArray, count: int, k: int, exact: bool):
        fans = count - 2
        columns = fans * k
        position = -(buffer.ctypes.data // 8) % 8

        def rows(number: int) -> NDArray[np.float64]:
            # 64-byte aligned and 64 bytes apart: numpy < 2 leaves its vector loop where output ends at input's start
            nonlocal position
            start, position = position, position + number * k + 8
            return buffer[start:start + number * k]

        self.index = rows(count).view(np.intp).reshape(count, k)
        self.corners = rows(3 * count).reshape(3, count, k)
        self.det, self.double = rows(fans).reshape(fans, k), rows(fans).reshape(fans, k)
        room = rows(6 * fans)  # products need as much as the edges do, and the float32 corners
        self.products = room.reshape(6, columns)
        self.edges = room[:3 * (count - 1) * k].reshape(3, count - 1, k)
        self.single = room.view(np.float32)[:3 * count * k].reshape(3, count, k)
        self.nodes, self.work = rows(3 * fans).reshape(3, columns), rows(3 * fans).reshape(3, columns)
        self.plus, self.minus = self.nodes.reshape(3, fans, k), self.work.reshape(3, fans, k)
        self.offsets = self.nodes.reshape(-1)[:count * k].view(np.intp).reshape(count, k)
        self.first, self.second, self.apex = self.edges[:, :-1], self.edges[:, 1:], self.corners[:, :1]
        self.starts = np.arange(0, k, CHUNK)
        self.counts = np.minimum(self.starts + CHUNK, k) - self.starts
        if exact:
            self.spread, self.spread_weight = rows(12 * fans).reshape(3, fans, 4, k), rows(4 * fans).reshape(fans, 4, k)
            self.spread_work, self.spread_products = rows(12 * fans).reshape(3, -1), rows(24 * fans).reshape(6, -1)
        else:
            self.weight = rows(2).view(np.complex128)
            self.weight.imag = 1.0

    @staticmethod
    def size(triangles: int, exact: bool) -> int:
        """The buffer that blocks of up to that many triangles need."""
        return (28 + 52 * exact) * (triangles + 2 * SLICES) + 16 * 8


class Fans:
    """The loop body for blocks of up to `triangles` triangles.

    points: (n, 3) contiguous float32 or float64. center: (3,) the reference point. weights: (n,) complex, to which
    every corner of a face adds its triangles' determinants and, as imaginary part, one; area_weights: (n,) the same
    for doubled areas; either may be None. area: whether doubled areas are wanted, shell: also their `power_sums`.
    exact: whether the nodes are those of the exact rule.
    """

    def __init__(self, points: NDArray, center: NDArray, triangles: int, *, weights: NDArray | None,
                 area_weights: NDArray | None, area: bool, shell: bool, exact: bool):
        self.points, self.flat, self.center = points, points.reshape(-1), center
        self.weights, self.area_weights = weights, area_weights
        self.area, self.shell, self.exact = area, shell, exact
        self.buffer = np.empty(_Scratch.size(triangles, exact))
        self.scratch: dict[tuple[int, int], _Scratch] = {}
        self.flipped: list[NDArray] = []

    def block(self, faces: Sequence[NDArray], quads: bool = False) -> Rows:
        """The sums over some faces.

        faces: the vertices of their first, second, third and perhaps fourth corners, (k,) each. quads: leave those out
        that Blender cuts along the other diagonal, and append them to `flipped`, turned by one corner; otherwise the
        first diagonal is taken.
        """
        own = self._scratch(len(faces), len(faces[0]))
        for row, corner in zip(own.index, faces):
            row[:len(corner)] = corner
            row[len(corner):] = faces[0][0]  # up to a multiple of SLICES: faces that are a point
        self._gather(own)
        edges, det, double, apex = own.edges, own.det, own.double, own.apex
        np.subtract(own.corners[:, 1:], apex, out=edges)
        normals = own.plus
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            np.multiply(own.first[y], own.second[z], out=own.plus[x])
            np.multiply(own.first[z], own.second[y], out=own.minus[x])
        np.subtract(own.plus, own.minus, out=normals)
        largest = np.maximum.reduceat(edges, own.starts, axis=2)
        np.maximum(largest, -np.minimum.reduceat(edges, own.starts, axis=2), out=largest)
        flipped = self._flipped(own, largest) if quads else ()

        np.subtract(apex, self.center[:, None, None], out=apex)
        np.einsum("cfk,ck->fk", normals, apex[:, 0], out=det)
        if self.area:
            np.multiply(normals, normals, out=normals)
            np.add(normals[0], normals[1], out=double)
            np.add(double, normals[2], out=double)
            np.sqrt(double, out=double)
        if len(flipped):
            det[:, flipped] = double[:, flipped] = 0.0
        sizes = np.zeros((2, len(det), len(own.starts)))
        np.add.reduceat(np.abs(det, out=own.minus[0]), own.starts, axis=1, out=sizes[0])
        if self.area:
            np.add.reduceat(double, own.starts, axis=1, out=sizes[1])
        if self.weights is not None:
            self._scatter(own)
        np.add(own.first, own.second, out=own.plus)
        np.multiply(apex, 3.0, out=own.minus[:, :1])
        np.add(own.plus, own.minus[:, :1], out=own.plus)  # the nodes: three times the centroids
        shell = NOTHING
        if self.exact:
            self._spread(own)
            sums = self._exact(own, det)
            shell = self._exact(own, double) if self.shell else NOTHING
        else:
            sums = power_sums(det.reshape(-1), own.nodes, own.work, own.products)
            shell = power_sums(double.reshape(-1), own.nodes, own.work, own.products) if self.shell else NOTHING
        return Rows(sums, shell, largest, sizes, own.counts)

    def _scratch(self, count: int, k: int) -> _Scratch:
        k = -(-k // SLICES) * SLICES
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
        cosine = own.det[0]
        np.einsum("ck,ck->k", own.plus[:, 0], own.plus[:, 1], out=cosine)
        if self.points.dtype == np.float32:
            length = np.sqrt((largest ** 2).sum(axis=0))
            margin = FLIP_MARGIN * length[0] * length[1] ** 2 * length[2]
            near = np.minimum.reduceat(cosine, own.starts) <= margin
            if not near.any() and length.max() < FLOAT32_OVERFLOW:
                return own.starts[:0]
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

    def _scatter(self, own: _Scratch) -> None:
        """Add each triangle's weights to its corners."""
        corners = (((0, 1, 2), (0,)),) if len(own.det) == 1 else (((0, 2), (0, 1)), ((1,), (0,)), ((3,), (1,)))
        for ends, fans in corners:
            own.weight.real[...] = own.det[0] + own.det[1] if len(fans) == 2 else own.det[fans[0]]
            for corner in ends:
                np.add.at(self.weights, own.index[corner], own.weight)
            if self.area_weights is not None:
                weight = own.double[0] + own.double[1] if len(fans) == 2 else own.double[fans[0]]
                for corner in ends:
                    np.add.at(self.area_weights, own.index[corner], weight)

    def _spread(self, own: _Scratch) -> None:
        """The nodes of the exact rule, fifteen times as far out as they are: 3 (s + 2 corner) and 5 s, s being the sums
        of the corners."""
        np.multiply(own.plus, 5.0, out=own.spread[:, :, 3])
        np.multiply(own.apex, 6.0, out=own.apex)
        np.multiply(own.plus, 3.0, out=own.plus)
        np.add(own.plus, own.apex, out=own.spread[:, :, 0])
        np.multiply(own.edges, 6.0, out=own.edges)
        np.add(own.spread[:, :, 0], own.first, out=own.spread[:, :, 1])
        np.add(own.spread[:, :, 0], own.second, out=own.spread[:, :, 2])

    def _exact(self, own: _Scratch, weights: NDArray) -> NDArray[np.float64]:
        """The power sums over those nodes, 48 times what they are, and Σ weight as it is."""
        np.multiply(weights[:, None], RULE, out=own.spread_weight)
        nodes, weight = own.spread.reshape(3, -1), own.spread_weight.reshape(-1)
        sums = power_sums(weight, nodes, own.spread_work, own.spread_products)
        sums[0] = np.add.reduce(weights, axis=None)
        return sums
