# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner loop of `any_order`: all moments of triangles and pairs of triangles, a block at a
time.

Over the triangle a, b, c the mean of the monomial x^α of degree n is 2 α! / (n+2)! times the
coefficient S_α of the generating function 1 / ((1-a·ξ)(1-b·ξ)(1-c·ξ)). Each factor is one level of
a recursion,

    C_α = (n! / α!) a^α,    D_α = C_α + Σ_i c_i D_{α-e_i},    S_α = D_α + Σ_i b_i S_{α-e_i},

with only one degree kept at a time. Two triangles that share the edge a-c share C and D. Of the
last degree only sums over faces are wanted; the sums of S_α = C_α + Σ_i c_i D_{α-e_i} + Σ_i b_i
S_{α-e_i} need no D and no S of that degree.

Rows are the monomials of one degree in the order of `monomials`, columns are faces. The rows that a
level's sum takes from the degree below stand in runs, so that nothing is fetched or copied: 14
operations a moment, in few and long calls of numpy on views that are made once, as threads wait for
Python between calls. All sums are of positive terms if the coordinates are positive, so a computed
S_α is off by at most (6 n + 8) u S_α(|a|, |b|, |c|).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from math import factorial, prod

import numpy as np
from numpy.typing import NDArray

from ..moments import U
from ..moments.exponents import count_of_degree, monomial_count, monomials, quotient_indices
from ..numerics import Array
from .workspace import Workspace, gather

FACES_PER_CHUNK = 32  # faces that share one bound of their coordinates
SLICES_PER_ROW = 16  # slices of a row that einsum adds up: a divisor of FACES_PER_CHUNK
# Rounding of a determinant, and of a doubled area, relative to the sizes of their terms: see
# `third_order`.
DETERMINANT_ROUNDING = 9.0 * U
# Underflow loses less than its root of a length, and less than `DETERMINANT_ROUNDING` times it of a
# doubled area.
MIN_SQUARED_LENGTH = 1e-145
UNDERFLOW_BOUND = (
    1e-220  # more than underflow can lose of one face whose coordinates are at most 256
)


@lru_cache
def multinomials(degree: int) -> Array:
    """Return (rows, 1) n! / α!, exact to degree 30."""
    return np.array(
        [
            [factorial(degree) // (factorial(p) * factorial(q) * factorial(r))]
            for p, q, r in monomials(degree)[-count_of_degree(degree) :].tolist()
        ],
        np.float64,
    )


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums over a block of faces, in the unit in which their coordinates are at most about 256.

    sums: (weights, K) Σ over faces of determinant S_α, and of doubled area S_α. chunks: (3 + 3 +
    weights + c-1, m), for each chunk of FACES_PER_CHUNK faces the largest and the least
    coordinates, Σ |weight| and the squares of its longest edges from the first corner. half_ulp:
    (3,) of the coordinates.
    """

    sums: Array
    chunks: Array
    half_ulp: Array


@lru_cache
def scratch_layout(count: int, order: int, weights: int) -> tuple[dict[str, tuple[int, ...]], ...]:
    """Return the row shapes of the arrays of `_Block`: lasting ones, and two groups that share
    memory.
    """
    ends = count - 1
    fans = count - 2
    lower = count_of_degree(order - 1)
    return (
        {"heavy": (weights, 3, count), "tips": (weights, fans), "both": (weights,)},
        {
            "index": (count,),
            "edges": (3, ends),
            "normals": (3, fans),
            "minus": (3, fans),
            "single": (3 * count,),
        },
        {"powers": (lower,), "levels": (ends, lower), "room": (2 * ends * (order - 1),)},
    )


@lru_cache
def row_count(count: int, order: int, weights: int) -> int:
    """Return the number of rows of a block, with one for the gap behind each array."""
    kept, weighing, summing = (
        sum(prod(shape) + 1 for shape in group.values())
        for group in scratch_layout(count, order, weights)
    )
    return kept + max(weighing, summing)


class _Block:
    """Rows of a block of faces, k columns, and the calls on them, `steps`, once corners and edges
    are there.

    corners: (3, c, k). edges: (3, c-1, k). apex_vectors: (w, c-2, k), the weights of the triangles
    a, b, c and a, c, d; both: (w, k), their sums. powers: (R, k) and levels: (c-1, R, k), C, and S,
    D and S, of one degree. weighted_products: (w, 3, c, k), weights times corners. room: scratch.
    total: (w, K), the sums. chunks: as in `Sums`; neighbors stand below each other in the
    (FACES_PER_CHUNK, m) that a row is.
    """

    def __init__(self, workspace: Workspace, count: int, k: int, *, order: int, weights: int):
        kept, *passing = (
            {name: (*row_count, k) for name, row_count in group.items()}
            for group in scratch_layout(count, order, weights)
        )
        arrays = {name: workspace.take(*shape) for name, shape in kept.items()}
        for group, taken in zip(
            passing, workspace.overlay(*(list(group.values()) for group in passing))
        ):
            arrays |= dict(zip(group, taken))
        self.k, self.order = k, order
        self.weighted_products, self.edges, self.powers, self.levels = (
            arrays[name] for name in ("heavy", "edges", "powers", "levels")
        )
        self.corners = self.weighted_products[-1]
        self.apex_vectors = arrays["tips"]
        self.both = arrays["both"] if count == 4 else self.apex_vectors[:, 0]
        self.index = arrays["index"].view(np.intp)
        self.room = arrays["room"].reshape(-1)
        self.single = (
            arrays["single"].reshape(-1).view(np.float32)[: 3 * count * k].reshape(3, count, k)
        )
        self.total = np.empty((weights, monomial_count(order)))
        self.chunks = np.empty((6 + weights + count - 1, k // FACES_PER_CHUNK))
        self.steps: list[Callable[[], object]] = []
        self._append_weights(arrays["normals"], arrays["minus"])
        self._append_sums()

    def _append_call(self, function: Callable, *operands: object) -> None:
        self.steps.append(partial(function, *operands))

    def _append_weights(self, normals: NDArray, minus: NDArray) -> None:
        """Append the calls for determinants, doubled areas, and the terms of their bounds."""
        edges = self.edges
        corners = self.corners
        apex_vectors = self.apex_vectors
        first = edges[:, :-1]
        second = edges[:, 1:]
        for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            self._append_call(np.multiply, first[y], second[z], normals[x])
            self._append_call(np.multiply, first[z], second[y], minus[x])
        self._append_call(np.subtract, normals, minus, normals)
        self._append_call(
            partial(np.einsum, out=apex_vectors[0]), "cfk,ck->fk", normals, corners[:, 0]
        )
        if len(apex_vectors) == 2:
            self._append_call(
                partial(np.einsum, out=apex_vectors[1]), "cfk,cfk->fk", normals, normals
            )
            self._append_call(np.sqrt, apex_vectors[1], apex_vectors[1])
        if apex_vectors.shape[1] == 2:
            self._append_call(np.add.reduce, apex_vectors, 1, None, self.both)
        squares = minus.reshape(-1)[: edges[0].size].reshape(edges[0].shape)
        self._append_call(partial(np.einsum, out=squares), "ick,ick->ck", edges, edges)
        sizes = edges.reshape(-1)[: apex_vectors.size].reshape(apex_vectors.shape)
        self._append_call(np.abs, apex_vectors, sizes)
        row = 0
        for function, values in (
            (np.maximum, corners),
            (np.minimum, corners),
            (np.add, sizes),
            (np.maximum, squares),
        ):
            split = values.reshape(len(values), -1, self.k // FACES_PER_CHUNK)
            self._append_call(function.reduce, split, 1, None, self.chunks[row : row + len(values)])
            row += len(values)

    def _append_sums(self) -> None:
        """Append the calls for the sums over the block, degree by degree."""
        corners = self.corners
        levels = self.levels
        powers = self.powers
        apex_vectors = self.apex_vectors
        first = corners[:, 0]
        ends = corners[:, 1:]
        self._append_call(np.add.reduce, self.both, 1, None, self.total[:, 0])
        self._append_call(np.add, first, corners[:, 2], levels[1, :3])
        self._append_call(
            np.add, corners[:, 1::2].transpose(1, 0, 2), levels[1, :3], levels[::2, :3]
        )
        self._append_dot("wfsk,frsk->wrk", apex_vectors, levels[::2, :3], self.total[:, 1:4])
        for degree in range(2, self.order):
            count = count_of_degree(degree)
            known = monomial_count(degree - 1)
            self._append_raise(degree, ends[:, :, None])
            _raise_powers(
                self._append_call, first if degree == 2 else powers, degree, first, powers
            )
            self._append_powers(degree)
            self._append_call(np.add, levels[::2, :count], levels[1, :count], levels[::2, :count])
            self._append_dot(
                "wfsk,frsk->wrk",
                apex_vectors,
                levels[::2, :count],
                self.total[:, known : known + count],
            )
        self._append_last_degree()

    def _append_powers(self, degree: int) -> None:
        """Append the calls that add C of this degree to D."""
        count = count_of_degree(degree)
        most = len(self.room) // self.k
        for start in range(0, count, most):
            part = slice(start, min(start + most, count))
            grown = self._room(part.stop - start)
            self._append_call(np.multiply, self.powers[part], multinomials(degree)[part], grown)
            self._append_call(np.add, self.levels[1, part], grown, self.levels[1, part])

    def _append_raise(self, degree: int, vectors: NDArray) -> None:
        """Append the calls that replace all levels L, one degree lower, by Σ_i v_i L_{α-e_i}, v (3,
        c-1, 1, k).
        """
        levels = self.levels
        below = count_of_degree(degree - 1)
        last = levels[:, below - degree : below]
        new = levels[:, below : below + degree + 1]
        self._append_call(np.multiply, last, vectors[1], new[:, :-1])
        self._append_call(np.multiply, last[:, -1:], vectors[2], new[:, -1:])
        by_z = self._room(len(levels), degree - 1)
        self._append_call(np.multiply, last[:, :-1], vectors[2], by_z)
        self._append_call(np.add, new[:, 1:-1], by_z, new[:, 1:-1])
        end = degree - 1
        while end:
            first = end  # extended to the runs before that fit into the room
            while first > 1 and _first_row(end) - _first_row(first - 2) < self.order:
                first -= 1
            products = self._room(2, len(levels), _first_row(end) - _first_row(first - 1))
            self._append_call(
                np.multiply,
                levels[:, _first_row(first - 1) : _first_row(end)],
                vectors[1:],
                products,
            )
            level_rows = levels[:, _first_row(first) if first > 1 else 0 : _first_row(end + 1)]
            self._append_call(np.multiply, level_rows, vectors[0], level_rows)
            for s in range(first, end + 1):
                before = _first_row(s - 1) - _first_row(first - 1)
                for axis in (0, 1):
                    level_rows = levels[:, _first_row(s) + axis : _first_row(s) + axis + s]
                    self._append_call(
                        np.add, level_rows, products[axis, :, before : before + s], level_rows
                    )
            end = first - 1

    def _append_last_degree(self) -> None:
        """Append the calls for sums of the last degree, of rows one degree lower and weighted
        coordinates.
        """
        degree = self.order
        weighted_products = self.weighted_products
        powers = self.powers
        count = count_of_degree(degree)
        below = count_of_degree(degree - 1)
        known = monomial_count(degree - 1)
        # The last products replace the corners.
        for row, both, apex_vectors in zip(weighted_products, self.both, self.apex_vectors):
            self._append_call(np.multiply, self.corners[:, ::2], both, row[:, ::2])
            self._append_call(np.multiply, self.corners[:, 1::2], apex_vectors, row[:, 1::2])
        sums = np.zeros((len(weighted_products), 3, below + 1))
        grown = np.empty((len(weighted_products), count))
        self._append_dot(
            "wifsk,frsk->wirk", weighted_products[:, :, 1:], self.levels, sums[:, :, :-1]
        )
        for axis, old, new in ((0, 0, 0), (1, below - degree, below), (2, below - 1, count - 1)):
            self._append_dot(
                "wsk,rsk->wrk",
                weighted_products[:, axis, 0],
                powers[old:],
                grown[:, new : new + below - old],
            )
        self._append_call(_add_last, sums, grown, degree, self.total[:, known:])

    def _room(self, *shape: int) -> Array:
        return self.room[: prod(shape) * self.k].reshape(*shape, self.k)

    def _append_dot(self, products: str, weights: NDArray, terms: NDArray, out: NDArray) -> None:
        """Append the calls for scalar products of weights (..., k) with rows (..., k)."""
        self._append_call(
            _sliced_dot,
            products,
            weights.reshape(*weights.shape[:-1], SLICES_PER_ROW, -1),
            terms.reshape(*terms.shape[:-1], SLICES_PER_ROW, -1),
            out,
        )


class AnyOrderKernel:
    """The loop body to an order, at least 3, perhaps with areas, and its scratch.

    Not to be shared by threads.
    """

    def __init__(self, order: int, area: bool):
        self.order = order
        self.weights = 2 if area else 1
        self.workspace = Workspace(partial(_Block, order=order, weights=self.weights))

    def block_sums(
        self,
        points: NDArray,
        center: NDArray,
        scale: float,
        half_ulp: NDArray,
        faces: Sequence[NDArray] | NDArray,
        size: int,
    ) -> Sums:
        """Return the sums over a block of faces, all triangles or all pairs. size: number of faces
        in a full block.

        Contiguous points, their center, (3,), subtracted, are multiplied by `scale`, a power of
        two. faces: checked vertices a, b, c (and d), (k,) each: triangles a, b, c and a, c, d.
        """
        k = len(faces[0])
        shape = len(faces), -(-(size if k > 0.9 * size else k) // FACES_PER_CHUNK) * FACES_PER_CHUNK
        block = self.workspace.block(
            shape, row_count(shape[0], self.order, self.weights) * shape[1]
        )
        self._gather_corners(block, points, faces, center, scale)
        for step in block.steps:
            step()
        return Sums(block.total.copy(), block.chunks.copy(), half_ulp * scale)

    @staticmethod
    def _gather_corners(
        block: _Block,
        points: NDArray,
        faces: Sequence[NDArray] | NDArray,
        center: NDArray,
        scale: float,
    ) -> None:
        """Gather the corners' coordinates and compute the edges from the first corner."""
        k = len(faces[0])
        for row, corner in zip(block.index, faces):
            if k < block.k:  # filled up with faces that are a point
                corner = np.concatenate([corner, np.full(block.k - k, faces[0][0])])
            row.reshape(FACES_PER_CHUNK, -1)[...] = corner.reshape(-1, FACES_PER_CHUNK).T
        gather(points, block.index, block.single, block.corners)
        if scale != 1.0:
            np.multiply(block.corners, scale, out=block.corners)
        np.subtract(block.corners[:, 1:], block.corners[:, :1], out=block.edges)
        np.subtract(block.corners, (center * scale)[:, None, None], out=block.corners)


def absolute_sums(order: int, weights: int, parts: Sequence[Sums]) -> Array:
    """Return (sets, K) Σ weight reach^α over the chunks of blocks of one kind, for each set of
    weights.

    The weights are |determinant| with its rounding, that rounding alone, the volume that moving
    vertices by half ulps sweeps; and with areas: doubled area with its rounding, that alone, and
    the area that moving the vertices adds.
    """
    chunks = np.concatenate([part.chunks for part in parts], axis=1)
    half_ulp = parts[0].half_ulp
    high, low, weight_sums, squares = np.split(chunks, (3, 6, 6 + weights))
    reach = np.maximum(high, -low) * (1.0 + 4.0 * U) + half_ulp[:, None]
    edges = np.sqrt(squares + MIN_SQUARED_LENGTH) * (1.0 + 1e-9)
    weight_sums = weight_sums * (1.0 + 1e-9)
    # This bounds Σ |normal|, and the products that make up its components.
    terms = FACES_PER_CHUNK * (edges[:-1] * edges[1:]).sum(axis=0)
    rounding = DETERMINANT_ROUNDING * terms
    step = np.linalg.norm(half_ulp)
    double = weight_sums[1] + 3.0 * rounding if weights == 2 else terms
    added = (
        step
        * FACES_PER_CHUNK
        * ((edges[:-1] + edges[1:]).sum(axis=0) + 2.0 * (len(edges) - 1) * step)
    )
    uncertain = rounding * reach.sum(axis=0)
    seeds = [weight_sums[0] + uncertain, uncertain, step * (double / 2.0 + added)]
    if weights == 2:
        seeds += [double, 3.0 * rounding, added]
    powers = np.empty((count_of_degree(order), len(seeds), chunks.shape[1]))
    powers[0] = seeds
    by_degree = [np.add.reduce(powers[:1], axis=2)]
    vector = np.broadcast_to(reach[:, None], (3, *powers.shape[1:]))
    for degree in range(1, order + 1):
        _raise_powers(lambda ufunc, *operands: ufunc(*operands), powers, degree, vector, powers)
        by_degree.append(np.add.reduce(powers[: count_of_degree(degree)], axis=2))
    return np.concatenate(by_degree).T


def _raise_powers(
    do: Callable, old: NDArray, degree: int, vector: NDArray, powers: NDArray
) -> None:
    """Compute x^α of one degree from the degree below, perhaps in its place. do: calls, or records,
    each step.
    """
    count = count_of_degree(degree - 1)
    do(np.multiply, old[count - degree : count], vector[1], powers[count : count + degree])
    do(np.multiply, old[count - 1], vector[2], powers[count + degree])
    do(np.multiply, old[:count], vector[0], powers[:count])


def _first_row(run: int) -> int:
    """Return the first row, among the rows of one degree, with q + r = `run`."""
    return run * (run + 1) // 2


def _sliced_dot(products: str, weights: NDArray, terms: NDArray, out: NDArray) -> None:
    """Compute scalar products over slices of the rows, and add up the slices."""
    np.add.reduce(np.einsum(products, weights, terms), axis=-1, out=out)


def _add_last(sums: NDArray, powers: NDArray, degree: int, total: NDArray) -> None:
    """Add the last degree: x, y and z times the rows one degree lower, and C."""
    np.multiply(powers, multinomials(degree)[:, 0], total)
    for axis, quotients in enumerate(quotient_indices(degree, count_of_degree(degree - 1))):
        total += sums[:, axis].take(quotients, axis=1)
