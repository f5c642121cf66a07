# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments in n dimensions, n ≥ 1: of the inside of a boundary of (n-1)-simplices, and of the
boundary itself.

Sheynin and Tuzikov's formulae hold in any dimension. Over the simplex of the origin and v_1 … v_n

    ∫ x^α = det(v_1 … v_n) · S_α · α! / (|α|+n)!,

S_α the coefficient of ξ^α in Π_i 1 / (1 - v_i·ξ), and over the facet v_1 … v_n alone the same with
|N|, (n-1)! times its measure, in place of det, and |α|+n-1 in place of |α|+n. Each factor is one
pass of the recursion S_α ← S_α + Σ_k v_k S_{α-e_k} (Pozo et al.), over blocks of simplices. det =
v_1·N; minors give N, the generalized cross product of the facet's edges. As there are only products
and sums, rounding is relative to the same expression in absolute values, which gives a rigorous
bound.
"""

from dataclasses import dataclass
from functools import lru_cache, reduce
from itertools import combinations
from math import comb, isfinite

import numpy as np

from ..inertia import MOMENTS_OVERFLOW
from ..moments import PAIRWISE_SUM_ROUNDINGS, U, check_exponents, factorial_ratios
from ..numerics import (
    Array,
    ArrayLike,
    Index,
    Int64,
    Integers,
    NDArray,
    check_filled,
    check_order,
    float_array,
    index_array,
)
from ..verdict import OBJECT_SIZE, TOO_SMALL, MeasureError
from .findings import BOUNDARY_OPEN

NUMBERS_PER_BLOCK = 1 << 20  # numbers in the table of a block
MIN_SIMPLICES_PER_BLOCK = 64  # at least so many simplices in a block, for any size of table
UNDERFLOW = 2.0**-1000  # relative to a body of size 1: far above the loss of products that vanish


@dataclass(frozen=True, eq=False)
class SimplexMoments:
    """Moments in n dimensions to some order; `moments[p, q, …]` is one moment.

    raw: (K,) ∫ x^α about `about`, (n,), in the order of `multi_indices`. rounding_error: (K,)
    bounds of |raw - exact| for the coordinates and the point as given.
    """

    raw: Array
    about: Array
    order: int
    rounding_error: Array

    def __getitem__(self, exponents: tuple[int, ...]) -> float:
        return float(self.raw[self._position(exponents)])

    def bound(self, exponents: tuple[int, ...]) -> float:
        """Return the error bound of one moment."""
        return float(self.rounding_error[self._position(exponents)])

    def _position(self, exponents: tuple[int, ...]) -> int:
        """Return the index of the moment with these exponents.

        IndexError if they are negative or beyond the order.
        """
        dimension = len(self.about)
        return _positions(dimension, self.order)[check_exponents(exponents, dimension, self.order)]


@lru_cache
def multi_indices(dimension: int, order: int) -> Int64:
    """Return all (K, n) exponents to an order, by degree, then by descending first exponents;
    read-only.
    """
    exponents = [
        row for degree in range(order + 1) for row in _exponents_of_degree(dimension, degree)
    ]
    table = np.array(exponents, np.int64).reshape(-1, dimension)
    table.flags.writeable = False
    return table


def enclosed_moments(
    points: ArrayLike,
    simplices: ArrayLike,
    order: int,
    about: ArrayLike | None = None,
    signs: ArrayLike | None = None,
    *,
    allow_open: bool = False,
) -> SimplexMoments:
    """Return the moments of the inside of a boundary of simplices, in any dimension.

    The moments are about the middle of the bounding box of the used points, unless `about` is
    given. An open boundary's moments would depend on that point: such a boundary is refused unless
    `allow_open`.

    Parameters
    ----------
    points : (m, n) array_like
    simplices : (k, n) array_like of int
        Outward if det(v_1, …, v_n) > 0 for a body around the origin: edges counter-clockwise in the
        plane, triangles counter-clockwise from outside in space.
    order : int
    about : (n,) array_like, optional
        The reference point.
    signs : (k,) array_like, optional
        1 or -1, the orientation of each simplex beside the order of its corners; on a line, because
        a corner alone has none, it distinguishes upper ends from lower ones.
    allow_open : bool
        True to take simplices as they are: gaps are closed by the cone from the reference point.
        Saves the check, too.

    Returns
    -------
    SimplexMoments
        Positive if the boundary is oriented outward.

    Raises
    ------
    ValueError
        If coordinates are not finite or an index has no point.
    MeasureError
        If the simplices do not close, or moments are beyond the range of numbers.

    Examples
    --------
    >>> from body_moments.core.polyhedron import enclosed_moments
    >>> round(enclosed_moments([[0, 0], [2, 0], [0, 2]], [[0, 1], [1, 2], [2, 0]], 0)[0, 0], 12)
    2.0
    """
    return _measure(points, simplices, order, about, signs, enclosed=True, allow_open=allow_open)


def facet_moments(
    points: ArrayLike, simplices: ArrayLike, order: int, about: ArrayLike | None = None
) -> SimplexMoments:
    """Return the moments of the boundary: length in the plane, area in space, points on a line.

    The moments are about the middle of the bounding box of the used points, unless `about` is
    given.

    Parameters
    ----------
    points, simplices, order, about
        As for `enclosed_moments`.

    Returns
    -------
    SimplexMoments

    Examples
    --------
    >>> from body_moments.core.polyhedron import facet_moments
    >>> round(facet_moments([[0, 0], [3, 0], [3, 4]], [[0, 1], [1, 2], [2, 0]], 0)[0, 0], 12)
    12.0
    """
    return _measure(points, simplices, order, about, None, enclosed=False, allow_open=True)


def _measure(
    points: ArrayLike,
    simplices: ArrayLike,
    order: int,
    about: ArrayLike | None,
    signs: ArrayLike | None,
    enclosed: bool,
    allow_open: bool,
) -> SimplexMoments:
    """Return `enclosed_moments` or `facet_moments`."""
    points, simplices = simplex_arrays(points, simplices)
    dimension = points.shape[1]
    check_order("order", order)
    indices = multi_indices(dimension, order)
    used = points[simplices.ravel()] if simplices.size else np.zeros((1, dimension))
    low, high = used.min(axis=0), used.max(axis=0)
    if not all(map(isfinite, [*low, *high])):
        raise ValueError("coordinates must be finite")
    center = (
        low / 2.0 + high / 2.0
        if about is None
        else float_array("about", about, dimension, finite=True)
    )
    reach = float(np.maximum(np.abs(high - center), np.abs(low - center)).max())
    exponent = int(np.frexp(reach)[1])  # the body is brought to size 1, which rounds nothing

    measure = dimension if enclosed else dimension - 1  # the exponent of length in moment 0
    extent = float((high / 2.0 - low / 2.0).max())
    if extent > 0.0 and int(np.frexp(extent)[1]) * measure < np.finfo(np.float64).minexp:
        raise MeasureError(OBJECT_SIZE, fault=TOO_SMALL)
    if signs is not None:
        signs = float_array("signs", signs, len(simplices))
    if not (allow_open or closes(points, simplices, signs)):
        raise MeasureError(BOUNDARY_OPEN)
    degree = indices.sum(axis=1)
    raw, size = np.zeros((2, len(indices)))
    block = max(MIN_SIMPLICES_PER_BLOCK, NUMBERS_PER_BLOCK // (2 * len(indices)))
    blocks = range(0, len(simplices), block)
    for start in blocks:
        vertices = simplices[start : start + block].T
        # (n corners, n coordinates, k)
        corners = np.ascontiguousarray(points[vertices].transpose(0, 2, 1))
        edges = np.ldexp(corners[1:] - corners[:1], -exponent)
        corners = np.ldexp(corners - center[:, None], -exponent)
        weight, weight_size = _weights(corners, edges, enclosed)
        if signs is not None:
            weight = weight * signs[start : start + block]
        raw += np.add.reduce(_recursion(corners, order) * weight, axis=1)
        size += np.add.reduce(_recursion(np.abs(corners), order) * weight_size, axis=1)

    # Count the roundings of one product of coordinates: in each coordinate, product and sum of the
    # recursion, in the passes that only carry it on, in the minors on the way to the weight, and in
    # the sum over all simplices.
    minors = sum(3 + rows for rows in range(1, dimension)) + 2 * dimension + 6
    steps = (
        degree * (dimension + 2)
        + dimension * dimension
        + minors
        + PAIRWISE_SUM_ROUNDINGS
        + len(blocks)
        + 4
    )
    # 1 % allows for products of roundings, and for the rounding of the bound itself.
    error = 1.01 * steps * U * size + len(simplices) * UNDERFLOW
    factor = factorial_ratios(indices, measure)
    power = (exponent * (degree + measure)).astype(np.int32)
    with np.errstate(over="ignore"):
        raw = np.ldexp(raw * factor, power)
        error = np.ldexp(error * factor, power)
    if not np.isfinite([raw, error]).all():
        raise MeasureError(MOMENTS_OVERFLOW, order=int(order))
    return SimplexMoments(raw, center, order, error + np.finfo(np.float64).smallest_subnormal)


def _recursion(corners: NDArray, order: int) -> Array:
    """Return (K, k) S_α of k simplices; corners: (n corners, n coordinates, k)."""
    dimension = corners.shape[1]
    starts, raised = _degree_steps(dimension, order)
    table = np.zeros((starts[-1], corners.shape[2]))
    table[0] = 1.0
    for corner in corners:
        for n in range(order):
            lower = table[starts[n] : starts[n + 1]]
            upper = table[starts[n + 1] : starts[n + 2]]
            for coordinate, positions in zip(corner, raised[n]):
                upper[positions] += lower * coordinate
    return table


def _weights(corners: NDArray, edges: NDArray, enclosed: bool) -> tuple[Array, Array]:
    """Return (k,) det or |N| of each simplex, and (k,) the same expressions in absolute values."""
    normal, size = _normals(edges)
    nothing = np.zeros(edges.shape[2])
    if enclosed:
        determinant = sum((v * n for v, n in zip(corners[0], normal)), nothing)
        return determinant, sum((np.abs(v) * s for v, s in zip(corners[0], size)), nothing)
    return reduce(np.hypot, normal, nothing), reduce(np.hypot, size, nothing)


def _normals(edges: NDArray) -> tuple[list[NDArray], list[NDArray]]:
    """Return the n components, (k,) each, of the generalized cross products of n-1 edges, (n-1, n,
    k), and the same with all terms positive.
    """
    dimension = len(edges) + 1
    ones = np.ones(edges.shape[2])
    # The minors of the first rows, by their columns, grow by a row at a time (Laplace).
    minors: dict[tuple[int, ...], tuple[NDArray, NDArray]] = {(): (ones, ones)}
    for row, edge in enumerate(edges):
        grown: dict[tuple[int, ...], tuple[NDArray, NDArray]] = {}
        for columns in combinations(range(dimension), row + 1):
            value = size = np.zeros(())
            for i, column in enumerate(columns):
                minor, minor_size = minors[columns[:i] + columns[i + 1 :]]
                value = value + (-1) ** (row + i) * (edge[column] * minor)
                size = size + np.abs(edge[column]) * minor_size
            grown[columns] = value, size
        minors = grown
    every = tuple(range(dimension))
    components = [minors[every[:i] + every[i + 1 :]] for i in range(dimension)]
    return [(-1) ** i * value for i, (value, _) in enumerate(components)], [
        size for _, size in components
    ]


def _exponents_of_degree(dimension: int, degree: int) -> list[tuple[int, ...]]:
    """Return all exponents of a degree, by descending first exponents."""
    if dimension == 1:
        return [(degree,)]
    return [
        (first, *rest)
        for first in range(degree, -1, -1)
        for rest in _exponents_of_degree(dimension - 1, degree - first)
    ]


@lru_cache
def _positions(dimension: int, order: int) -> dict[tuple[int, ...], int]:
    """Return the index of each of the `multi_indices`."""
    return {tuple(row): i for i, row in enumerate(multi_indices(dimension, order).tolist())}


@lru_cache
def _degree_steps(dimension: int, order: int) -> tuple[list[int], list[list[NDArray]]]:
    """Return starts of degrees, and by degree and axis the indices, in the next degree, of products
    with the axis.
    """
    starts = [0] + [comb(n + dimension, dimension) for n in range(order + 1)]
    positions = _positions(dimension, order)
    table = multi_indices(dimension, order).tolist()
    raised = []
    for n in range(order):
        exponents = table[starts[n] : starts[n + 1]]
        raised.append(
            [
                np.array(
                    [
                        positions[*row[:k], row[k] + 1, *row[k + 1 :]] - starts[n + 1]
                        for row in exponents
                    ]
                )
                for k in range(dimension)
            ]
        )
    return starts, raised


def facets_of(points: ArrayLike, simplices: ArrayLike) -> tuple[Integers, Array]:
    """Return the facets around full simplices, with signs that make the enclosed volume positive.

    Parameters
    ----------
    points : (m, n) array_like
    simplices : (k, n + 1) array_like of int

    Returns
    -------
    facets : ((n + 1) k, n) int array
    signs : ((n + 1) k,) array
        1 or -1, for `enclosed_moments`.

    Examples
    --------
    >>> from body_moments.core.polyhedron import enclosed_moments, facets_of
    >>> points = [[0, 0], [1, 0], [0, 1]]
    >>> facets, signs = facets_of(points, [[0, 2, 1]])
    >>> round(enclosed_moments(points, facets, 0, signs=signs)[0, 0], 12)
    0.5
    """
    points, simplices = simplex_arrays(points, simplices, 1)
    corners = points[simplices]
    turned = np.sign(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    count = simplices.shape[1]
    facets = [np.delete(simplices, k, axis=1) for k in range(count)]
    signs = [turned * (-1.0) ** k for k in range(count)]
    return np.concatenate(facets), np.concatenate(signs)


def simplex_arrays(
    points: ArrayLike, simplices: ArrayLike, more: int = 0
) -> tuple[Array, Integers]:
    """Return (m, n) points and (k, n + `more`) simplices as arrays."""
    points = float_array("points", points, "m", "n")
    check_filled("points", points.T)
    return points, index_array(
        "simplices", simplices, "k", points.shape[1] + more, count=len(points)
    )


def closes(points: ArrayLike, simplices: ArrayLike, signs: ArrayLike | None = None) -> bool:
    """Return whether every ridge is used equally often both ways.

    Points at the same place count as one.
    """
    _, corners, parity = _sorted_corners(points, simplices, signs)
    if not len(corners):
        return True
    ridges = np.concatenate([np.delete(corners, k, axis=1) for k in range(corners.shape[1])])
    uses = np.concatenate([parity * (-1.0) ** k for k in range(corners.shape[1])])
    _, number = np.unique(ridges, axis=0, return_inverse=True)
    return not np.bincount(number.reshape(-1), uses).any()


def outer_facets(points: ArrayLike, simplices: ArrayLike, signs: ArrayLike | None = None) -> Index:
    """Return the (j, n) facets that bound simplices on one side only; a pair of opposite facets
    cancels.
    """
    facets, corners, parity = _sorted_corners(points, simplices, signs)
    _, first, which = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    uses = np.abs(np.bincount(which.reshape(-1), parity, len(first))).astype(np.intp)
    return facets[np.repeat(first, uses)]


def _sorted_corners(
    points: ArrayLike, simplices: ArrayLike, signs: ArrayLike | None
) -> tuple[Index, Index, Array]:
    """Return the facets with an extent, their sorted corners with equal points merged, and
    orientations, 1 or -1.
    """
    simplices = np.asarray(simplices)
    _, place = np.unique(np.asarray(points, np.float64) + 0.0, axis=0, return_inverse=True)
    corners = place.reshape(-1)[simplices]
    signs = np.ones(len(corners)) if signs is None else np.asarray(signs, np.float64)
    order = np.argsort(corners, axis=1)
    # Each pair of corners in the wrong order changes the sign of the permutation.
    orientation = signs.copy()
    for first in range(order.shape[1]):
        for second in range(first + 1, order.shape[1]):
            orientation[order[:, first] > order[:, second]] *= -1.0
    corners = np.take_along_axis(corners, order, 1)
    has_extent = (np.diff(corners, axis=1) > 0).all(axis=1)
    return simplices[has_extent], corners[has_extent], orientation[has_extent]
