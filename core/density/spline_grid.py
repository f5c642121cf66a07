# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of a density that is a trivariate B-spline, f(u, v, w) = Σ p_ijk B_i(u) B_j(v) B_k(w).

The volumetric scheme of Soldea, Elber and Rivlin. The integrals separate,

    ∫ u^p v^q w^r f = Σ_ijk p_ijk U[p,i] V[q,j] W[r,k],

so only three small tables (`full_support_integrals`) are precomputed, and the sum is three
contractions. The first one runs along the axis that is contiguous in memory, in blocks that stay in
the cache; the others take its small result. A grid may therefore be larger than memory.

The moments are taken about the middle of the knots. If the mass is far from there, relative to its
size, they are taken again about the knot nearest to its center, as the paper advises (section 5).

Rounding is bounded without another pass. In the support of B_i a power |t|^l is at most (|t| +
w)^l, with the widest support w. An odd power is at most the next lower even power times the largest
|t|. So the even moments of nonnegative coefficients bound the absolute sums of all moments.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, ArrayLike, NDArray, float_array, number_array
from ..verdict import MeasureError
from .findings import DENSITY_NON_FINITE, GRID_TRANSFORM_SINGULAR

COEFFICIENTS_PER_BLOCK = 1 << 17  # coefficients at a time: 1 MB of float64
# |offset|² over variance above which the moments are taken anew, about a point nearer to the mass
MAX_OFFSET_RATIO = 64.0

Blocks = Callable[[], Iterable[tuple[tuple[int, int, int], NDArray]]]
MAX_ORDER = 16  # Splines of higher order are refused: far above any use.


def density_moments(
    coefficients: NDArray | Blocks,
    axes: Sequence[SplineAxis],
    order: int = 3,
    value: Callable[[NDArray], NDArray] | None = None,
) -> Moments:
    """Return the mass moments of a density that is a trivariate B-spline, in the coordinates of
    three axes' knots.

    Their reference point is the middle of the knots or, if the mass is far from it, the knot
    nearest to the mass's center (Soldea, Elber and Rivlin, sections 4 and 5).

    coefficients: (nx, ny, nz) of any real type, a memory map if larger than memory. Or a function
    that yields blocks, (offset, array) each, without overlap; all other coefficients are zero.
    value: converts a block's numbers to coefficients. ValueError if the shapes differ, MeasureError
    if a coefficient is not finite.
    """
    axes = tuple(axes)
    if not callable(coefficients):
        coefficients = number_array("coefficients", coefficients, *(axis.count for axis in axes))
    about = np.array([(axis.knots[0] + axis.knots[-1]) / 2.0 for axis in axes])
    moments = _moments_about(coefficients, axes, order, value, about)
    if order < 2 or not moments.total > 0.0:
        return moments
    offset = moments.raw[1:4] / moments.total
    variance = moments.raw[[4, 7, 9]] / moments.total - offset * offset  # moments of x², y², z²
    if not (offset * offset > MAX_OFFSET_RATIO * np.maximum(variance, 0.0)).any():
        return moments
    nearest_knot = [
        axis.knots[np.abs(axis.knots - center).argmin()]
        for axis, center in zip(axes, about + offset)
    ]
    return _moments_about(coefficients, axes, order, value, np.array(nearest_knot))


def grid_moments(
    samples: NDArray | Blocks,
    shape: Sequence[int],
    matrix: ArrayLike,
    spline_order: int = 1,
    order: int = 3,
    value: Callable[[NDArray], NDArray] | None = None,
    positions: Sequence[ArrayLike | None] = (None, None, None),
) -> Moments:
    """Return the mass moments of a grid of density samples.

    The moments are about the point to which the matrix takes the middle of the grid or, if the mass
    is far from there, the knot nearest to the center of mass. The samples are the coefficients of a
    spline with full supports, uniform along each axis without positions.

    Parameters
    ----------
    samples : (nx, ny, nz) array, or callable
        Numbers of any real type, a memory map if larger than memory; or a function that yields
        (offset, array) blocks.
    shape : sequence of three int
        Shape of the grid, also if `samples` yields blocks.
    matrix : (4, 4) array_like
        Affine: the sample (i, j, k) stands at matrix @ (i, j, k, 1).
    spline_order : int
        1 for voxels, 2 for trilinear, 4 for cubic.
    order : int
        Order of the moments.
    value : callable, optional
        Converts a block's numbers to densities.
    positions : sequence of three array_like or None
        Ascending positions of the samples of an axis, in place of 0, 1, 2, …, before the matrix is
        applied.

    Returns
    -------
    Moments
        Mass moments, in the coordinates that the matrix leads to.

    Raises
    ------
    MeasureError
        If the matrix flattens the grid or is not finite, or a density is not finite.

    Examples
    --------
    >>> from body_moments.core import grid_moments
    >>> spacing = np.diag([0.1, 0.1, 0.2, 1.0])
    >>> round(grid_moments(np.full((10, 10, 5), 1000.0), (10, 10, 5), spacing).total, 9)
    1000.0
    """
    if not callable(samples):
        samples = number_array("samples", samples, *shape)
    matrix = float_array("matrix", matrix, 4, 4)
    if not np.isfinite(matrix).all() or not np.linalg.det(matrix[:3, :3]):
        raise MeasureError(GRID_TRANSFORM_SINGULAR)
    axes = [
        SplineAxis.uniform(count, spline_order)
        if row is None
        else SplineAxis.at_positions(row, spline_order)
        for count, row in zip(shape, positions)
    ]
    if [axis.count for axis in axes] != list(shape):
        raise ValueError("positions for other samples")
    moments = density_moments(samples, axes, order, value)
    # The map stretches the volume under the density, and so the mass.
    stretched = replace(moments, measure=Measure.VOLUME).transform(matrix)
    return replace(stretched, measure=Measure.MASS)


def _moments_about(
    coefficients: NDArray | Blocks,
    axes: tuple[SplineAxis, ...],
    order: int,
    value: Callable | None,
    about: NDArray,
) -> Moments:
    """Return the mass moments about a point, with bounds of rounding as the module describes."""
    axis_order = np.arange(3)
    if not callable(coefficients):  # the first contraction runs along the contiguous axis
        axis_order = np.argsort([-abs(stride) for stride in coefficients.strides], kind="stable")
        coefficients = coefficients.transpose(axis_order)
    tables = [
        full_support_integrals(axes[i].knots - about[i], axes[i].order, order) for i in axis_order
    ]
    # By the powers of the three axes: sums for the coefficients and for their magnitudes.
    sums, magnitudes = np.zeros((2, order + 1, order + 1, order + 1))
    blocks = 0
    longest = 0
    for offset, block in _pieces(coefficients):
        with np.errstate(invalid="ignore"):  # Signaling NaN would warn.
            block = np.asarray(block, np.float64)
        if value is not None:
            block = value(block)
        factors = [
            table[:, first : first + length]
            for table, first, length in zip(tables, offset, block.shape)
        ]
        added = contract(block, factors)
        sums += added
        magnitudes += added if block.min() >= 0.0 else contract(np.abs(block), factors)
        blocks += 1
        longest = max(longest, sum(block.shape))
    if not np.isfinite(sums).all():
        raise MeasureError(DENSITY_NON_FINITE)
    bound_matrices = [_absolute_from_even(axes[i], order, about[i]) for i in axis_order]
    size = np.einsum("ax,by,cz,xyz->abc", *bound_matrices, magnitudes)
    # Roundings of the tables along each axis, of the sums in blocks and over blocks, with margins;
    # 1.01 covers products of roundings.
    units = sum(2 * axis.order + 3 * order + 8 for axis in axes) + longest + blocks + 8
    p, q, r = monomials(order)[:, axis_order].T
    return Moments(sums[p, q, r], about, Measure.MASS, 1.01 * units * U * size[p, q, r])


def _pieces(coefficients: NDArray | Blocks) -> Iterator[tuple[tuple[int, int, int], NDArray]]:
    """Yield the first indices and the coefficients of blocks of about COEFFICIENTS_PER_BLOCK or
    fewer.
    """
    if callable(coefficients):
        for (i0, j0, k0), array in coefficients():
            for (i, j, k), piece in _pieces(array):
                yield (i0 + i, j0 + j, k0 + k), piece
        return
    nx, ny, nz = coefficients.shape
    columns = max(1, COEFFICIENTS_PER_BLOCK // nz)
    planes = max(1, COEFFICIENTS_PER_BLOCK // (ny * nz))
    for i in range(0, nx, planes):
        for j in range(0, ny, columns):
            yield (i, j, 0), coefficients[i : i + planes, j : j + columns]


def contract(block: NDArray, factors: list[NDArray]) -> Array:
    """Return (n, n, n) Σ block_ijk X[p,i] Y[q,j] Z[r,k]."""
    partial = np.stack([np.einsum("ijk,k->ij", block, row) for row in factors[2]])
    return np.einsum("rqi,pi->pqr", np.einsum("rij,qj->rqi", partial, factors[1]), factors[0])


def _absolute_from_even(axis: SplineAxis, order: int, center: float) -> Array:
    """Return the (order + 1, order + 1) matrix that turns even moments along an axis, of
    nonnegative coefficients, into bounds of the absolute moments.
    """
    reach = np.abs(axis.knots[[0, -1]] - center).max()
    width = (axis.knots[axis.order :] - axis.knots[: -axis.order]).max()
    matrix = np.zeros((order + 1, order + 1))
    for power in range(order + 1):
        for j in range(power + 1):
            even = j - j % 2
            matrix[power, even] += math.comb(power, j) * width ** (power - j) * reach ** (j % 2)
    return matrix


@dataclass(frozen=True, eq=False)
class SplineAxis:
    """The spline space of one direction of a trivariate spline, by (n + order,) ascending knots.

    order: the degree plus one: 1 voxels, 2 linear, 4 the paper's cubic. ValueError if it is out of
    range, or there are too few knots.
    """

    knots: Array
    order: int

    def __post_init__(self) -> None:
        if not 1 <= self.order <= MAX_ORDER:
            raise ValueError("order beyond 1…{:d}".format(MAX_ORDER))
        if self.count < 1:
            raise ValueError("too few knots")

    @classmethod
    def uniform(cls, count: int, order: int = 1) -> SplineAxis:
        """Return an axis of `count` functions with full supports, centered at whole numbers."""
        return cls(np.arange(count + order, dtype=np.float64) - order / 2.0, order)

    @classmethod
    def at_positions(cls, positions: ArrayLike, order: int = 1) -> SplineAxis:
        """Return an axis with one function of full support around each sample.

        ValueError unless positions ascend.
        """
        x = float_array("positions", positions, "n")
        if len(x) < 2 or not np.isfinite(x).all() or not (np.diff(x) > 0.0).all():
            raise ValueError("positions must ascend")
        # The first and the last step are repeated beyond the samples.
        steps = np.arange(1, (order + 1) // 2 + 1)
        before = x[0] - (x[1] - x[0]) * steps[::-1]
        after = x[-1] + (x[-1] - x[-2]) * steps
        positions = np.concatenate([before, x, after])
        if order % 2 == 0:
            return cls(positions, order)
        return cls(positions[:-1] + np.diff(positions) / 2.0, order)

    @property
    def count(self) -> int:
        """The number of functions, and so of coefficients."""
        return len(self.knots) - self.order


def full_support_integrals(knots: ArrayLike, order: int, degree: int) -> Array:
    """Return (degree + 1, n) ∫ t^l B_i over full supports, by a closed form; knots may be
    repeated.
    """
    # (t_{i+k} - t_i) / k · h_l(t_i, ..., t_{i+k}) / binomial(k + l, l), h_l the complete
    # homogeneous polynomial of the k + 1 knots; positive if the knots are. Theorem 4.2
    # (`core.papers`) needs l nested sums.
    knots = np.asarray(knots, np.float64)
    count = len(knots) - order
    h = np.zeros((degree + 1, count))
    h[0] = 1.0
    for j in range(order + 1):  # times the series of 1 / (1 - t z)
        for power in range(1, degree + 1):
            h[power] += knots[j : j + count] * h[power - 1]
    h *= (knots[order:] - knots[:count]) / order
    for power in range(1, degree + 1):
        h[power] /= math.comb(order + power, power)
    return h
