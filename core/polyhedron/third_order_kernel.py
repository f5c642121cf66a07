# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `third_order`: triangles and pairs of triangles, a block at a time, in scratch
that is made once.

A face is a base a-c with a corner b on one side, and perhaps a corner d on the other: the triangles
a, b, c and a, c, d. With their determinants v and w, u = v + w, q = a + c and
Z = u q + 2 (v b + w d),

    H = u (a a' + c c') + 2 (v b b' + w d d')
    120 ∫ x x'     = H + (q Z' + Z q') / 2
    288 ∫ x x' x'' = q H + the same for the other two orders of the indices,

but for the third moments about q / 2.

With e = c - a and f = 2 b - q these are v / 2880 (f (f f' + e e') + the other two orders) for one
triangle. They are of the order of an edge cubed, and added on request. No sum cancels, because all
weights are positive. If no areas are wanted, the determinants share a product: with m = (c-a) x a,
v = (b-a)·m and w = (a-d)·m.

Corners are gathered by component, so that numpy runs along contiguous rows. A call costs as much as
some thousand additions, and threads gain only if calls are long. Hence blocks are long, calls few,
and results overwrite rows that are no longer needed. einsum sums products over slices of rows, in
one pass, into rows that stay in the cache.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import flipped_quads
from .workspace import Workspace, gather

SLICES_PER_ROW = 32  # slices of a row that einsum adds up
COLUMNS_PER_CHUNK = (
    1024  # most columns with one common bound of their edges; a multiple of SLICES_PER_ROW
)
MIN_FLIP_COSINE = (
    1e-6  # float32 may choose a quad's other diagonal if the cosine in float64 is below this
)
FLOAT32_OVERFLOW = (
    1e9  # edges from which the fourth powers in that decision leave the range of float32
)
FLOAT32_UNDERFLOW = 1e-36  # cosines below this may have underflowed there
NO_VERTEX = "no such vertex"
NO_SUM = np.zeros(())
TRIPLES = [(i, j, k) for i in range(3) for j in range(i, 3) for k in range(j, 3)]
PAIR_INDEX = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
# Indices, in a table of x, y, z times xx, xy, xz, yy, yz, zz, x, y, z, of the terms of the
# symmetric products: two of each xx, xy, ... and three of each xxx, xxy, ...
SQUARE = np.array([[9 * i + 6 + j, 9 * j + 6 + i] for i in range(3) for j in range(i, 3)]).T
CUBE = np.array(
    [
        [9 * i + PAIR_INDEX[j, k], 9 * j + PAIR_INDEX[i, k], 9 * k + PAIR_INDEX[i, j]]
        for i, j, k in TRIPLES
    ]
).T


@dataclass(frozen=True, eq=False)
class BlockSums:
    """Sums over some blocks.

    sums, areas: (20,) Σ weight, 48, 120 and 2880 ∫ of the monomials of first to third order in the
    order of `monomials`, over the cones, and over their faces as if they were cones of unit height.
    side, base: (3, n) the largest components of b-a (or d-a) and c-a in each chunk of triangles.
    sizes: (2, n) Σ |determinant| and Σ doubled area. counts: (n,) triangles. blocks: their number.
    """

    sums: NDArray[np.float64]
    areas: NDArray[np.float64] | None
    side: NDArray[np.float64]
    base: NDArray[np.float64]
    sizes: NDArray[np.float64]
    counts: NDArray[np.integer]
    blocks: int = 1


def scratch_size(count: int, each: bool, exact: bool) -> int:
    """Return the count of numbers in the scratch for a face of `count` corners; each: as for
    `_BlockCalls`.
    """
    fans = count - 2
    return (
        6 * count
        + 2 * fans
        + max(3 * count - 3 + 6 * (fans if each else 1), 16)
        + (9 * fans if exact else 0)
    )


class _BlockCalls:
    """Arrays for blocks of one shape, and the numpy calls bound to them, because views made in the
    loop cost time.

    For faces with c corners there are chunks times width, k columns: corners: (3, c, k). weights:
    (2, c-2, k), the determinants and the doubled areas. In one memory, index: (c, k) and single:
    (3, c, k) in float32; then weighted: (3, c, k); at last heavy: (6, c-2, k). In another, edges:
    (3, c-1, k), b-a, c-a, a-d, and normals and spare: (3, f, k), f = c-2, or f = 1 if not each
    triangle's normal is wanted; then table: (13, k), the tensors' six rows, two vectors and a
    number, and middle: (3, k). On request tips: (3, c-2, k), the vectors f, and local: (6, c-2, k),
    f f' + e e'.

    start: the calls from the corners to the normals, weigh: the calls to the weights. largest,
    least: (3, c-1, chunks) of the edges, sizes: (1 or 2, c-2, chunks) of the weights' absolute
    values. volume: 6 times the tetrahedron of each quad's corners, room: two rows that are free
    meanwhile. prepare: the calls that the moments with all weights share, moments: the calls for
    each weight, and the calls that return sums.
    """

    def __init__(
        self,
        workspace: Workspace,
        count: int,
        chunks: int,
        width: int,
        each: bool,
        *,
        center: NDArray,
        area: bool,
        area_moments: bool,
        exact: bool,
    ):
        fans = count - 2
        k = chunks * width
        crosses = fans if each else 1
        self.corners = workspace.take(3, count, k)
        self.weights = workspace.take(2, fans, k)
        (index, single), (room,) = workspace.overlay(
            [(count, k), (3 * count * k // 2,)], [(3 * count * k,)]
        )
        self.index = index.view(np.intp)
        self.unsigned = index.view(np.uintp)
        self.single = single.view(np.float32).reshape(3, count, k)
        weighted = room.reshape(3, count, k)
        heavy = room[: 6 * fans * k].reshape(6, fans, k)
        (self.edges, self.normals, spare), (table, middle) = workspace.overlay(
            [(3, count - 1, k), (3, crosses, k), (3, crosses, k)], [(13, k), (3, k)]
        )
        tips, local = (
            (workspace.take(size, fans, k) for size in (3, 6))
            if exact
            else (np.empty(0), np.empty(0))
        )

        def chunked(array: NDArray) -> NDArray[np.float64]:
            return array.reshape(*array.shape[:-1], chunks, width)

        corners = self.corners
        edges = self.edges
        normals = self.normals
        apex = corners[:, :1]
        base = edges[:, 1:2]
        sides = edges[:, ::2]
        self.start = [partial(np.subtract, corners[:, 1:3], apex, edges[:, :2])]
        if fans == 2:
            self.start.append(partial(np.subtract, corners[:, 0], corners[:, 3], edges[:, 2]))
        self.start.append(partial(np.subtract, corners, center[:, None, None], corners))
        self.start += _cross_calls(*((sides, base) if each else (base, apex)), normals, spare)
        self.largest, self.least = (
            partial(function.reduce, chunked(edges), axis=3)
            for function in (np.maximum, np.minimum)
        )

        factors = (normals, apex[:, 0]) if each else (sides, normals[:, 0])
        self.weigh = [partial(np.einsum, "dfk,dk->fk", *factors, out=self.weights[0])]
        if area:
            self.weigh += [
                partial(np.einsum, "dfk,dfk->fk", normals, normals, out=self.weights[1]),
                partial(np.sqrt, self.weights[1], self.weights[1]),
            ]
        self.cosine = self.weights[1, 0]
        if fans == 2 and each:
            self.room = spare[:, 0]
            self.volume = partial(
                np.einsum, "dk,dk->k", sides[:, 0], normals[:, 1], out=self.room[2]
            )
        spare = spare.reshape(-1)[: fans * k].reshape(fans, k)
        self.weigh.append(partial(np.abs, self.weights[0], spare))
        self.sizes = [
            partial(np.add.reduce, chunked(row), axis=2)
            for row in (spare, self.weights[1])[: 1 + area]
        ]

        self.prepare = _local_calls(sides, base, tips, local, heavy[:, :1]) if exact else []
        self.prepare.append(partial(np.add, corners[:, 0], corners[:, 2], middle))
        self.moments = []
        for weights in self.weights[: 1 + area_moments]:
            calls = _weighted_calls(corners, weights, weighted, table)
            sums = [
                partial(np.add.reduce, table, axis=1),
                partial(_scalar_products, _in_slices(middle), _in_slices(table[:9])),
            ]
            if exact:
                calls.append(partial(np.multiply, local, weights, heavy))
                sums.append(partial(_scalar_products, _in_slices(tips), _in_slices(heavy)))
            self.moments.append((calls, sums))


# One block: its faces, the edges' extremes, the sizes, the sums.
BlockResult = tuple[int, NDArray, NDArray, list, list]


class BlockAccumulator:
    """The loop body for blocks of faces over contiguous points. results: the sums of each block so
    far.

    area: True for doubled areas, area_moments: also for their moments. exact: True for the exact
    third order.
    """

    def __init__(
        self, points: NDArray, center: NDArray, *, area: bool, area_moments: bool, exact: bool
    ):
        self.points = points
        self.area = area
        self.exact = exact
        self.workspace = Workspace(
            partial(_BlockCalls, center=center, area=area, area_moments=area_moments, exact=exact)
        )
        self.flipped: list[NDArray] = []
        self.results: list[BlockResult] = []

    def add_faces(
        self,
        faces: Sequence[NDArray] | NDArray,
        quads: bool = False,
        observe: Callable | None = None,
    ) -> None:
        """Add faces, the vertices a, b, c and perhaps d, (k,) each.

        ValueError if an index names no point.

        quads: if Blender cuts a quad along the other diagonal, it is left out and appended to
        `flipped`, turned by one corner. observe: called with the doubled areas, (c - 2, k), and for
        quads also with 6 times the corners' tetrahedra, (k,), the columns with triangles that may
        face away from each other, and scratch, (2, k).
        """
        k = len(faces[0])
        shape = (len(faces), *chunk_shape(k), self.area or quads)
        workspace = self.workspace.block(
            shape, scratch_size(len(faces), shape[3], self.exact) * shape[1] * shape[2]
        )
        if isinstance(faces, np.ndarray):
            workspace.index[:, :k] = faces
        else:
            for row, corner in zip(workspace.index, faces):
                row[:k] = corner
        if k < workspace.index.shape[1]:
            workspace.index[:, k:] = faces[0][0]  # faces without extent fill the block
        if workspace.unsigned.max() >= len(self.points):  # a negative index becomes a large one
            raise ValueError(NO_VERTEX)
        gather(self.points, workspace.index, workspace.single, workspace.corners)
        for call in workspace.start:
            call()
        largest = workspace.largest()
        least = workspace.least()
        suspects = None
        if quads:
            suspects, flipped = self._find_flipped(workspace, np.maximum(largest, -least), k)
            workspace.normals[:, :, flipped] = 0.0
        for call in workspace.weigh:
            call()
        sizes = [size() for size in workspace.sizes]
        sums = []
        if observe is not None and suspects is not None:
            observe(
                workspace.weights[1, :, :k],
                workspace.volume()[:k],
                suspects,
                workspace.room[:2, :k],
            )
        elif observe is not None:
            observe(workspace.weights[1, :, :k])
        for call in workspace.prepare:
            call()
        for calls, totals in workspace.moments:
            for call in calls:
                call()
            sums.append([total() for total in totals])
        self.results.append((k, largest, least, sizes, sums))

    def _find_flipped(
        self, workspace: _BlockCalls, largest: NDArray, k: int
    ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return the columns below k of quads that Blender may cut along the other diagonal, and of
        quads that it does.

        The two normals of such a quad face away from each other in float32. The result in float64
        can differ only if the product is within float32's rounding of zero. The cut quads are
        appended to `flipped`.
        """
        cosine = np.einsum(
            "dk,dk->k", workspace.normals[:, 0], workspace.normals[:, 1], out=workspace.cosine
        )
        cosine[k:] = np.inf  # the filling of the block
        if self.points.dtype == np.float32:
            length = np.sqrt((largest**2).sum(axis=0))
            margin = np.maximum(
                MIN_FLIP_COSINE * length[0] * length[1] ** 2 * length[2], FLOAT32_UNDERFLOW
            )
            least = np.minimum.reduce(cosine.reshape(len(margin), -1), axis=1)
            if length.max() < FLOAT32_OVERFLOW and (least > margin).all():
                return workspace.index[0, :0], workspace.index[0, :0]
            square = np.einsum("cik,cik->ik", workspace.edges, workspace.edges)
            limit = np.maximum(
                MIN_FLIP_COSINE * square[1] * np.sqrt(square[0] * square[2]), FLOAT32_UNDERFLOW
            )
            limit[square.max(axis=0) > FLOAT32_OVERFLOW**2] = np.inf
            suspects = np.flatnonzero(cosine <= limit)
        else:  # float32 sees coordinates that were rounded first: all are suspects
            suspects = np.arange(k)
        quads = workspace.index[:, suspects] // 3
        loose = self.points[quads.T].reshape(-1, 3)
        turn = flipped_quads(loose, np.arange(len(loose)).reshape(-1, 4))
        self.flipped.append(np.roll(quads[:, turn], -1, axis=0))
        return suspects, suspects[turn]


def combine_blocks(results: Sequence[BlockResult]) -> BlockSums:
    """Return the sums over all these blocks together."""
    columns = []
    for k, largest, least, sizes, _ in results:
        edges = np.maximum(largest, -least)
        width = chunk_shape(k)[1]
        counts = np.minimum(k - width * np.arange(edges.shape[2]), width)
        columns += [
            (edges[:, 2 * i], edges[:, 1], counts, *fan) for i, fan in enumerate(zip(*sizes))
        ]
    side, base, counts, *sizes = (np.concatenate(column, axis=-1) for column in zip(*columns))
    sums, *areas = (
        to_monomial_sums(*(sum(of, NO_SUM) for of in zip(*parts)))
        for parts in zip(*(sums for *_, sums in results))
    )
    return BlockSums(
        sums,
        areas[0] if areas else None,
        side,
        base,
        np.array((*sizes, np.zeros_like(sizes[0]))[:2]),
        counts,
        len(results),
    )


def to_monomial_sums(
    table_sums: NDArray, products: NDArray, local: NDArray | None = None
) -> NDArray[np.float64]:
    """Return (20,) `BlockSums.sums` from the sums of the table's rows, (13,), and from summed
    products of its rows.
    """
    mixed = 0.5 * np.add.reduce(products.take(SQUARE))
    third = 10.0 * np.add.reduce(products.take(CUBE))
    total = 2.0 * np.concatenate(
        [table_sums[12:], table_sums[6:9] + table_sums[9:12], table_sums[:6] + mixed, third]
    )
    if local is not None:
        total[10:] += np.add.reduce(local.take(CUBE - CUBE // 9 * 3))  # in a table without x, y, z
    return total


def chunk_shape(k: int) -> tuple[int, int]:
    """Return the number of chunks that hold k columns, and their width."""
    chunks = -(-k // COLUMNS_PER_CHUNK)
    return chunks, -(-k // (chunks * SLICES_PER_ROW)) * SLICES_PER_ROW


def _cross_calls(first: NDArray, second: NDArray, out: NDArray, spare: NDArray) -> list[partial]:
    """Return the calls for (3, f, k) cross products of (3, f, k) with (3, 1, k) rows of x, y
    and z.
    """
    return [
        partial(np.multiply, first[1:], second[::-2], out[:2]),  # y z', z x'
        partial(np.multiply, first[0], second[1], out[2]),
        partial(np.multiply, first[::-2], second[1:], spare[:2]),  # z y', x z'
        partial(np.multiply, first[1], second[0], spare[2]),
        partial(np.subtract, out, spare, out),
    ]


def _local_calls(
    sides: NDArray, base: NDArray, apex_vectors: NDArray, local: NDArray, squares: NDArray
) -> list[partial]:
    """Return the calls for the vectors f and for f f' + e e' of every triangle."""
    calls = [
        partial(np.multiply, sides, np.array([[2.0], [-2.0]])[: sides.shape[1]], apex_vectors),
        partial(np.subtract, apex_vectors, base, apex_vectors),
    ]
    for vectors, tensors in ((apex_vectors, local), (base, squares)):
        calls += [
            partial(np.multiply, vectors, vectors[0], tensors[:3]),
            partial(np.multiply, vectors[1:], vectors[1], tensors[3:5]),
            partial(np.multiply, vectors[2], vectors[2], tensors[5]),
        ]
    return [*calls, partial(np.add, local, squares, local)]


def _weighted_calls(
    corners: NDArray, weights: NDArray, weighted: NDArray, table: NDArray
) -> list[partial]:
    """Return the calls for the weighted corners, and for the table: half of H, of Z, of u q and of
    u.
    """
    both = table[9:12]
    every = table[6:9]
    half = table[12]
    if len(weights) == 2:
        calls = [
            partial(np.add, weights[0], weights[1], half),
            partial(np.multiply, half, 0.5, half),
        ]
    else:
        calls = [partial(np.multiply, weights[0], 0.5, half)]
    calls += [
        partial(np.multiply, corners[:, ::2], half, weighted[:, ::2]),
        partial(np.multiply, corners[:, 1::2], weights, weighted[:, 1::2]),
        partial(np.einsum, "ck,dck->dk", weighted[0], corners, out=table[:3]),
        partial(np.einsum, "ck,dck->dk", weighted[1], corners[1:], out=table[3:5]),
        partial(np.einsum, "ck,ck->k", weighted[2], corners[2], out=table[5]),
        partial(np.add, weighted[:, 0], weighted[:, 2], both),
        partial(np.add, both, weighted[:, 1], every),
    ]
    if len(weights) == 2:
        calls.append(partial(np.add, every, weighted[:, 3], every))
    return calls


def _in_slices(table: NDArray) -> NDArray[np.float64]:
    """Return the rows as (m, SLICES_PER_ROW, ·), so that their products can be summed."""
    return table.reshape(len(table), SLICES_PER_ROW, -1)


def _scalar_products(vectors: NDArray, second: NDArray) -> NDArray[np.float64]:
    """Return the (m, n) scalar products of m rows with n."""
    return np.add.reduce(np.einsum("cjk,pjk->cpk", vectors, second), axis=2)
