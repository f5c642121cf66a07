# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sum of one body's images under many affine maps, its instances; and its point reflection."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..numerics import ArrayLike, NDArray, check_filled, float_array
from .affine_maps import absolute_moments, to_trailing_axis, transform_by_horner
from .exponents import monomial_count, monomials
from .raw import Moments, U, image, measure_scale_factors

MAPS_PER_BLOCK = (
    2048  # maps at a time at order 3, fewer at higher ones: their functionals stay in the cache
)


def sum_of_images(moments: Moments, matrices: ArrayLike) -> Moments:
    """Return the summed moments of one body's images under (k, 4, 4) affine maps, at least one.

    Its point is the mean of the images of `moments.about`. ValueError if a map of areas or lengths
    is no similarity.
    """
    matrices = float_array("matrices", matrices, "k", 4, 4, finite=True)
    check_filled("matrices", matrices)
    linear, offsets = to_trailing_axis(matrices)
    point = moments.about[:, None]
    order = moments.order
    origins = linear[:, 0] * point[0] + linear[:, 1] * point[1] + linear[:, 2] * point[2] + offsets
    center = origins.mean(axis=1)
    if len(matrices) == 1:
        return image(moments, matrices[0], center)
    raw, error, extra = np.zeros((3, len(moments.raw)))
    block = max(MAPS_PER_BLOCK * 20 // len(moments.raw), 16)
    for start in range(0, len(matrices), block):
        part = slice(start, start + block)
        maps = linear[:, :, part]
        weight, weight_error, uneven = measure_scale_factors(moments.measure, maps)
        offset = origins[:, part] - center[:, None]
        # The images of the reference point are rounded, and the body moves with them: by
        # six roundings at most.
        stretch = np.abs(maps).sum(axis=1).max(axis=0)
        reach = np.abs(offset).max(axis=0)
        size = np.abs(offsets[:, part]).max(axis=0) + np.abs(center).max()
        tolerance = 6 * U * (size + stretch * np.abs(point).max())
        # The sum of the images, six roundings for each linear form, and those of the weights.
        weight_error = weight_error + (len(matrices) + 6 * order + 8) * U * weight
        raw += np.add.reduce(
            transform_by_horner(moments.raw[:, None], order, maps, offset) * weight, axis=1
        )
        rounding, mapped_input = _image_error_bounds(
            moments, stretch, reach, tolerance, weight, weight_error, uneven
        )
        error += rounding
        extra += mapped_input
    return Moments(raw, center, moments.measure, error, extra)


def invert_through_point(moments: Moments) -> Moments:
    """Return the moments of the body's point reflection in `about`: its mirror image, turned."""
    return replace(moments, raw=moments.raw * ((-1.0) ** monomials(moments.order).sum(axis=1)))


def _image_error_bounds(
    moments: Moments,
    stretch: NDArray,
    reach: NDArray,
    tolerance: NDArray,
    weight: NDArray,
    weight_error: NDArray,
    uneven: NDArray,
) -> tuple[NDArray, NDArray]:
    """Return (K,) `rounding_error`, including the rounding of the maps, and (K,) `input_error` of
    the sum of k images.

    By degree: if the rows of |linear| sum to at most `stretch` and |offset| is at most `reach`,
    both (k,), a product of n linear forms has binomial(n, j) stretch^j reach^(n-j) moments of
    degree j, each at most the largest one. An offset that may be off by `tolerance` changes it by
    at most n `tolerance` times n-1 forms.
    """
    order = moments.order
    degree = monomials(order).sum(axis=1)
    starts = [monomial_count(n - 1) for n in range(order + 1)]
    error = np.maximum.reduceat(moments.rounding_error, starts)
    inputs = np.maximum.reduceat(moments.input_error, starts)
    size = np.maximum.reduceat(np.abs(moments.raw), starts) + error

    def product_sums(factor: NDArray, reach: NDArray, *largest: NDArray) -> list[NDArray]:
        """Return by degree n the sums of those moments over all maps, times (k,) factors, for each
        of the largest moments (by degree).
        """
        powers = [[factor]]  # by n and j: factor stretch^j reach^(n-j)
        for _ in range(order):
            powers.append([power * reach for power in powers[-1]] + [powers[-1][-1] * stretch])
        counts = [
            [math.comb(n, j) * power.sum() for j, power in enumerate(row)]
            for n, row in enumerate(powers)
        ]
        return [np.array([np.dot(row, top[: len(row)]) for row in counts]) for top in largest]

    rounding, mapped_input = product_sums(weight, reach, error, inputs)
    rounding += product_sums(weight_error, reach, size)[0]
    shifted = product_sums(weight * tolerance, reach + tolerance, size)[0]
    rounding[1:] += np.arange(1, order + 1) * shifted[:-1]
    if uneven.any():
        absolute = (
            np.maximum.reduceat(absolute_moments(moments.raw, order), starts) + error + inputs
        )
        rounding += product_sums(weight * uneven, reach, absolute)[0]
    return rounding[degree], mapped_input[degree]
