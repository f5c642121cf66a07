# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `polyhedron`: triangles and pairs of triangles, a block at a time, in scratch that is made once.

A face is a base edge a-c with one further corner b, or with two, b and d on either side of it: the triangles a, b, c and
a, c, d. With q = a + c, e = c - a, p = q + 2b, r = q + 2d and determinants v, w, the second moments

    v (Σ over a, b, c of (s s' + corner corner')) + the same of a, c, d = 1/2 (2(v+w) q q' + (v+w) e e' + v p p' + w r r')

so that two triangles with a common edge need four vectors instead of six. Faces that follow each other lie together.
A few of them, a run, give moments of order 0 to 2 at no more cost than their total; those, shifted, give the third
order but for the third moments about the run's own middle, which its size bounds.

Corners are gathered by component, so that every numpy call runs along contiguous rows. A call costs as much as a
thousand additions, memory beyond the cache twice as much as within: hence blocks, few calls, and results written over
rows that are no longer needed. The products are summed over the rows of a block, not along them: einsum multiplies and
adds in one pass into a row that stays in the cache.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod

import numpy as np
from numpy.typing import NDArray

from .surface import flipped_quads

RUN = {3: 8, 4: 4}  # faces in a run, by their corners: eight triangles
FLUSH = 8192  # runs that are shifted at a time
CHUNK = 1024  # columns that share one bound of their edges
FLIP_MARGIN = 1e-6  # float32 may decide a quad's diagonal otherwise where float64 sees a cosine below this
FLOAT32_OVERFLOW = 1e9  # edges from which the fourth powers in that decision leave the range of float32


@dataclass(eq=False)
class Sums:
    """What the faces of one thread add up to.

    volume, area: (20,) Σ weight · mean over the triangle of each monomial of order 0 to 3, about the reference point;
    the weights are determinants or doubled areas. rest, area_rest: (10,) what bounds the error of the third order.
    size, double: Σ |determinant|, Σ doubled area. tau: (3,) bounds Σ |e_y e'_z| + |e_z e'_y| and so on.
    edges: bounds the sum of the lengths of each triangle's two edges. count: triangles, as bounded. parts: summands.
    """

    volume: NDArray[np.float64]
    area: NDArray[np.float64]
    rest: NDArray[np.float64]
    area_rest: NDArray[np.float64]
    size: float
    double: float
    tau: NDArray[np.float64]
    edges: float
    count: int
    parts: int

    @classmethod
    def nothing(cls) -> Sums:
        return cls(np.zeros(20), np.zeros(20), np.zeros(10), np.zeros(10), 0.0, 0.0, np.zeros(3), 0.0, 0, 0)

    def add(self, other: Sums) -> None:
        for name, value in vars(other).items():
            setattr(self, name, getattr(self, name) + value)


class _Scratch:
    """Contiguous rows for blocks of one shape, carved out of one buffer; some share memory when their times differ.

    index: (c, k). corners: (3, c, k), later the weighted vectors. vectors: (3, c, k), q, p (and r), e. weights: (c, k).
    sides: (3, c-2, k), b - a (and d - a). plus, minus: (3, c-2, k), the products of the normals; plus ends as normals.
    double: (c-2, k).
    """

    def __init__(self, buffer: NDArray, count: int, k: int, exact: bool):
        fans = count - 2
        self._buffer, self._position = buffer, -(buffer.ctypes.data // 8) % 8
        self.index = self._rows(count, k).view(np.intp)
        self.corners, self.vectors, self.weights = self._rows(3, count, k), self._rows(3, count, k), self._rows(count, k)
        self.plus, self.minus = self._rows(3, fans, k), self._rows(3, fans, k)
        self.sides, self.double = self._rows(3, fans, k), self._rows(fans, k)
        self.apex, self.base = self.corners[:, :1], self.vectors[:, -1:]
        self.det = self.weights[1:-1]
        self.offsets = self.weights.reshape(-1).view(np.intp).reshape(self.index.shape)
        self.single = self.vectors.reshape(-1).view(np.float32)[:self.corners.size].reshape(self.corners.shape)
        self.starts = np.arange(0, k, CHUNK)
        self.counts = np.diff(self.starts, append=k)
        if exact:
            columns = fans * k
            self.spread, self.spread_weight = self._rows(3, fans, 4, k), self._rows(fans, 4, k)
            self.work, self.products = self._rows(3, 4 * columns), self._rows(6, 4 * columns)

    def _rows(self, *shape: int) -> NDArray[np.float64]:
        # 64-byte aligned, and 64 bytes apart: numpy < 2 leaves its vector loop where an output ends at an input's start
        start, size = self._position, prod(shape)
        self._position += -(-size // 8) * 8 + 8
        return self._buffer[start:start + size].reshape(shape)

    @staticmethod
    def size(triangles: int, exact: bool) -> int:
        """The buffer that blocks of up to that many triangles need."""
        return (34 + 52 * exact) * triangles + 16 * 16


class Faces:
    """The loop body, for blocks of up to `triangles` triangles, and what it has added up.

    points: (n, 3) contiguous float32 or float64. center: (3,) the reference point. area: whether doubled areas are
    wanted, shell: also their moments. exact: whether the third order is exact.
    """

    def __init__(self, points: NDArray, center: NDArray, triangles: int, *, area: bool, shell: bool, exact: bool):
        self.points, self.flat, self.center = points, points.reshape(-1), center
        self.area, self.shell, self.exact = area, shell, exact
        self.buffer = np.empty(_Scratch.size(triangles, exact))
        self.scratch: dict[tuple[int, int], _Scratch] = {}
        self.runs = np.empty((27 if shell else 17, 0 if exact else max(FLUSH, triangles)))
        self.filled, self.reach = 0, np.zeros(3)
        self.flipped: list[NDArray] = []
        self.sums = Sums.nothing()

    def add(self, corners: Sequence[NDArray], quads: bool = False) -> None:
        """Add faces: the vertices of their first, second, third and perhaps fourth corners, (k,) each.

        quads: leave those out that Blender cuts along the other diagonal, and keep them in `flipped`, turned by one
        corner; otherwise the first diagonal is taken.
        """
        run = 1 if self.exact else RUN[len(corners)]
        whole = len(corners[0]) // run * run
        if whole:
            self._block([corner[:whole] for corner in corners], run, quads)
        if whole < len(corners[0]):
            self._block([corner[whole:] for corner in corners], 1, quads)

    def _block(self, faces: Sequence[NDArray], run: int, quads: bool) -> None:
        count, k = len(faces), len(faces[0])
        if (count, k) not in self.scratch:
            self.scratch = {(count, k): _Scratch(self.buffer, count, k, self.exact)}
        own = self.scratch[count, k]
        for row, corner in zip(own.index, faces):
            row.reshape(run, -1)[...] = corner.reshape(-1, run).T
        self._gather(own)
        np.subtract(own.corners[:, 2:3], own.apex, out=own.base)
        np.subtract(own.corners[:, 1::2], own.apex, out=own.sides)
        normals = own.plus
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            np.multiply(own.sides[y], own.base[z], out=own.plus[x])
            np.multiply(own.sides[z], own.base[y], out=own.minus[x])
        np.subtract(own.plus[:, :1], own.minus[:, :1], out=normals[:, :1])
        if count == 4:  # the base runs the other way round the second triangle
            np.subtract(own.minus[:, 1], own.plus[:, 1], out=normals[:, 1])
        sides, base = self._bound(own)
        flipped = self._flipped(own, sides, base) if quads else ()

        np.subtract(own.corners, self.center[:, None, None], out=own.corners)
        np.einsum("cfk,ck->fk", normals, own.apex[:, 0], out=own.det)
        if self.area:
            np.multiply(normals, normals, out=normals)
            np.add(normals[0], normals[1], out=own.double)
            np.add(own.double, normals[2], out=own.double)
            np.sqrt(own.double, out=own.double)
        if len(flipped):
            own.det[:, flipped] = own.double[:, flipped] = 0.0
        if self.area:
            self.sums.double += np.add.reduce(own.double.reshape(-1))
        np.add(own.apex, own.corners[:, 2:3], out=own.vectors[:, :1])
        if self.exact:
            self._exact(own)
        else:
            self._condense(own, run)

    def _gather(self, own: _Scratch) -> None:
        """The corners' coordinates, in float64."""
        single = self.points.dtype == np.float32
        target = own.single if single else own.corners
        np.multiply(own.index, 3, out=own.offsets)
        for axis in range(3):  # the indices have been checked: "wrap" is the mode that costs least
            self.flat[axis:].take(own.offsets, out=target[axis], mode="wrap")
        if single:
            own.corners[...] = target

    def _bound(self, own: _Scratch) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(3, c-2, chunks) and (3, 1, chunks) the largest components of the sides and bases; they are added up."""
        sides, base = (np.maximum(np.maximum.reduceat(edges, own.starts, axis=2),
                                  -np.minimum.reduceat(edges, own.starts, axis=2)) for edges in (own.sides, own.base))
        self.reach = np.maximum(self.reach, np.maximum(sides.max(axis=(1, 2)), base.max(axis=(1, 2))))
        tau = sides[[1, 2, 0]] * base[[2, 0, 1]] + sides[[2, 0, 1]] * base[[1, 2, 0]]
        self.sums.tau += tau.sum(axis=1) @ own.counts
        lengths = np.sqrt((sides ** 2).sum(axis=0)) + np.sqrt((base ** 2).sum(axis=0))
        self.sums.edges += lengths.sum(axis=0) @ own.counts
        self.sums.count += own.det.size
        return sides, base

    def _flipped(self, own: _Scratch, sides: NDArray, base: NDArray) -> NDArray[np.intp]:
        """The columns of the quads that Blender cuts along their other diagonal, once they are kept in `flipped`.

        They are those whose two normals face away from each other in float32. That can differ from float64 only where
        the product is within float32's rounding of zero.
        """
        cosine = own.det[0]
        np.einsum("ck,ck->k", own.plus[:, 0], own.plus[:, 1], out=cosine)
        if self.points.dtype == np.float32:
            length = np.sqrt((np.concatenate([sides, base], axis=1) ** 2).sum(axis=0))
            margin = FLIP_MARGIN * length[0] * length[1] * length[2] ** 2
            near = np.minimum.reduceat(cosine, own.starts) <= margin
            if not near.any() and length.max() < FLOAT32_OVERFLOW:
                return own.starts[:0]
            first, second = np.einsum("cfk,cfk->fk", own.sides, own.sides)
            third = np.einsum("ck,ck->k", own.base[:, 0], own.base[:, 0])
            limit = FLIP_MARGIN * third * np.sqrt(first * second)
            limit[np.maximum(np.maximum(first, second), third) > FLOAT32_OVERFLOW ** 2] = np.inf
            suspects = np.flatnonzero(cosine <= limit)
        else:  # float32 sees coordinates that were rounded first: all are suspects
            suspects = np.arange(len(cosine))
        quads = own.index[:, suspects]
        loose = self.points[quads.T].reshape(-1, 3)
        turn = flipped_quads(loose, np.arange(len(loose)).reshape(-1, 4))
        self.flipped.append(np.roll(quads[:, turn], -1, axis=0))
        return suspects[turn]

    def _condense(self, own: _Scratch, run: int) -> None:
        """Add the block's runs to `runs`: rows of Σw, Σ w s, 2 Σ w (s s' + Σ corner corner'), a point of the run, Σ over
        its faces of the squared distances of their first corners from it, Σ |w|; the first three again for areas."""
        count, k = own.index.shape
        size = k // run
        if self.filled + size > self.runs.shape[1]:
            self.flush()
        into = self.runs[:, self.filled:self.filled + size]
        self.filled += size
        apex = own.apex.reshape(3, run, size)
        into[10:13] = apex[:, run // 2]
        away = own.plus.reshape(-1)[:3 * k].reshape(3, run, size)
        np.subtract(apex, into[10:13, None], out=away)
        np.einsum("cjk,cjk->ck", away, away, out=into[13:16])
        further, tips = own.corners[:, 1::2], own.vectors[:, 1:-1]
        np.add(further, further, out=tips)
        np.add(tips, own.vectors[:, :1], out=tips)
        vectors, weighted = own.vectors.reshape(3, -1, size), own.corners.reshape(3, -1, size)
        np.add.reduce(np.abs(own.det, out=own.minus[0]).reshape(-1, size), axis=0, out=into[16])
        for moments, weights in ((into[:10], own.det), (into[17:], own.double))[:1 + self.shell]:
            if weights is not own.det:
                own.det[...] = weights
            if count == 4:
                np.add(own.det[0], own.det[1], out=own.weights[-1])
            else:
                own.weights[-1] = own.det[0]
            np.add(own.weights[-1], own.weights[-1], out=own.weights[0])
            np.multiply(own.vectors, own.weights, out=own.corners)
            np.add.reduce(own.det.reshape(-1, size), axis=0, out=moments[0])
            bases = np.add.reduce(weighted[:, :run], axis=1)
            np.add.reduce(weighted[:, run:-run], axis=1, out=moments[1:4])
            moments[1:4] += 0.5 * bases
            moments[1:4] *= 0.5
            np.einsum("jk,djk->dk", weighted[0], vectors, out=moments[4:7])
            np.einsum("jk,djk->dk", weighted[1], vectors[1:], out=moments[7:9])
            np.einsum("jk,jk->k", weighted[2], vectors[2], out=moments[9])

    def flush(self) -> None:
        """Add the runs up, with their third moments as far as they follow from the lower ones."""
        rows = self.runs[:, :self.filled]
        self.filled = 0
        point, size = rows[10:13], rows[16]
        self.sums.size += np.add.reduce(size)
        self.sums.parts += 1
        away = np.sqrt(rows[13:16]) + self.reach[:, None]
        square = _squares(away, away)
        self.sums.volume += _shifted(rows[:10], point)
        self.sums.rest += _cubes(away, square, size)
        if self.shell:
            self.sums.area += _shifted(rows[17:], point)
            self.sums.area_rest += _cubes(away, square, rows[17])
        self.reach = np.zeros(3)

    def _exact(self, own: _Scratch) -> None:
        """Add the block up with the rule that is exact to third order: E[f] = 25/48 Σ f((s + 2 corner)/5) - 27/48 f(s/3),
        s the sum of the triangle's corners."""
        fans = len(own.det)
        for fan in range(fans):
            nodes = own.spread[:, fan]
            total = nodes[:, 3]
            np.add(own.vectors[:, 0], own.corners[:, 1 + 2 * fan], out=total)
            for node, corner in enumerate((0, 1 + 2 * fan, 2)):
                np.add(own.corners[:, corner], own.corners[:, corner], out=nodes[:, node])
                np.add(nodes[:, node], total, out=nodes[:, node])
        nodes, weight = own.spread.reshape(3, -1), own.spread_weight.reshape(-1)
        self.sums.size += np.add.reduce(np.abs(own.det).reshape(-1))
        self.sums.parts += 1
        for weights in (own.det, own.double)[:1 + self.shell]:
            own.spread_weight[...] = weights[:, None]
            sums = power_sums(weight, nodes, own.work, own.products, fans, own.index.shape[1])
            means = np.empty(20)
            means[0] = sums[0, 3]
            means[1:4] = sums[1:4, 3] / 3.0
            means[4:10] = (sums[4:10, :3].sum(axis=1) - 3.0 * sums[4:10, 3]) / 48.0
            means[10:] = (sums[10:, :3].sum(axis=1) / 5.0 - sums[10:, 3]) / 48.0
            if weights is own.det:
                self.sums.volume += means
            else:
                self.sums.area += means


def power_sums(weights: NDArray, nodes: NDArray, work: NDArray, products: NDArray, groups: int,
               k: int) -> NDArray[np.float64]:
    """(20, 4) Σ w x^p y^q z^r for p+q+r ≤ 3, in the order of `moments.monomials`, for each of four kinds of nodes.

    weights: (groups 4 k,). nodes: (3, groups 4 k). work: (3, groups 4 k) and products: (6, groups 4 k) scratch.
    """
    total = np.empty((20, 4))

    def summed(rows: NDArray) -> NDArray[np.float64]:
        return np.add.reduce(rows.reshape(-1, groups, 4, k), axis=3).sum(axis=1)

    total[:1] = summed(weights)
    np.multiply(nodes, weights, out=work)
    total[1:4] = summed(work)
    np.multiply(nodes, work[0], out=products[:3])
    np.multiply(nodes[1:], work[1], out=products[3:5])
    np.multiply(nodes[2], work[2], out=products[5])
    total[4:10] = summed(products)
    np.multiply(products[5], nodes[2], out=work[0])
    total[19:] = summed(work[0])
    np.multiply(products[3:], nodes[1], out=work)
    total[16:19] = summed(work)
    np.multiply(products, nodes[0], out=products)
    total[10:16] = summed(products)
    return total


def _squares(u: NDArray, v: NDArray) -> NDArray[np.float64]:
    """(6, k) (u v' + v u') / 2 of (3, k) vectors: xx, xy, xz, yy, yz, zz."""
    return np.stack([u[i] * v[j] if i == j else 0.5 * (u[i] * v[j] + u[j] * v[i])
                     for i in range(3) for j in range(i, 3)])


def _shifted(rows: NDArray, point: NDArray) -> NDArray[np.float64]:
    """(20,) the sums to third order of runs with the given rows: the third moments about `point`, (3, k), left out.

    With n-th moments m_n about the origin and o the point, m_3 = sym(o m_2) - sym(o o m_1) + o o o m_0 plus those.
    """
    first, second = rows[1:4] / 3.0, rows[4:10] / 24.0
    total = np.concatenate([np.add.reduce(part, axis=1) for part in (rows[:1], first, second)] + [np.zeros(10)])
    total[10:] = _cubes(point, second - _squares(point, first - point * (rows[0] / 3.0)), None)
    return total


def _cubes(vectors: NDArray, squares: NDArray, weights: NDArray | None) -> NDArray[np.float64]:
    """(10,) sums of the symmetric products of (3, k) vectors and (6, k) symmetric tensors, x (yz) + y (xz) + z (xy) for
    xyz and so on; with weights, (k,), those of the product of three vectors whose squares are given."""
    if weights is not None:
        vectors = vectors * (weights / 3.0)
    table = np.array([[np.add.reduce(vector * square) for square in squares] for vector in vectors])
    pair = ((0, 1, 2), (1, 3, 4), (2, 4, 5))
    return np.array([table[i, pair[j][k]] + table[j, pair[i][k]] + table[k, pair[i][j]]
                     for i in range(3) for j in range(i, 3) for k in range(j, 3)])
