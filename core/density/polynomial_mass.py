# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mass of bodies whose density is a polynomial, and a check that it is nowhere negative."""

from __future__ import annotations

from itertools import product

import numpy as np

from ..mesh import winding_number
from ..moments import (
    MAPS_PER_BLOCK,
    Measure,
    Moments,
    U,
    absolute_moments,
    measure_scale_factors,
    multiply_by_linear_form,
    to_trailing_axis,
    transform_by_horner,
)
from ..moments.exponents import monomial_count, monomials, order_from_count, product_indices
from ..numerics import Array, ArrayLike, NDArray, polar_rotation
from .polynomial import Polynomial

Terms = dict[tuple[int, int, int], float]
NEGLIGIBLE_RTOL = 1e-6  # Relative to the largest density: the effect of float32 coordinates.
GRID_POINTS = 9  # points along each side of the box that are tried
GRID_STEPS = np.array(list(product((np.arange(GRID_POINTS) + 0.5) / GRID_POINTS, repeat=3)))
MAX_LOCATED_POINTS = 24  # points that are located in the body


def polynomial_mass_of_images(
    moments: Moments,
    density: Polynomial,
    matrices: NDArray,
    fields: NDArray | None = None,
    about: ArrayLike | None = None,
) -> Moments:
    """Return the sum of the mass moments of k images of a body, to the moments' order less the
    density's degree.

    moments: of the volume or area; ValueError if the order is below the degree. matrices: (k, 4, 4)
    the images, as for `sum_of_images`. fields: (k, 4, 4) from the body's own coordinates to the
    density's, taken exactly; by default `matrices`. about: (3,), by default the mean of the images
    of `moments.about`. The bounds of rounding and input hold for bodies with negative density
    somewhere too.
    """
    order = moments.order - density.degree
    if order < 0:
        raise ValueError("moments below density's degree")
    fields = matrices if fields is None else fields
    linear, offsets = to_trailing_axis(matrices)
    turn, shift = to_trailing_axis(fields)
    point = moments.about[:, None]
    extent = np.abs(moments.about)[:, None]
    origins = (linear * point).sum(axis=1) + offsets
    center: Array = origins.mean(axis=1) if about is None else np.asarray(about, np.float64)
    origins_local = (turn * point).sum(axis=1) + shift
    origin = origins_local.mean(axis=1)
    terms = density.translate(origin).float_terms()
    raw, error, inputs = np.zeros((3, monomial_count(order)))
    for start in range(0, len(matrices), MAPS_PER_BLOCK):
        part = slice(start, start + MAPS_PER_BLOCK)
        forms = turn[:, :, part], origins_local[:, part] - origin[:, None]
        misplacement = (
            8.0
            * U
            * (
                (np.abs(turn[:, :, part]) * extent).sum(axis=1)
                + np.abs(shift[:, part])
                + np.abs(origin)[:, None]
            )
        )
        weighed, weighed_error, weighed_input, largest = _mass_functional(
            moments, order, terms, forms, misplacement
        )
        maps = linear[:, :, part]
        offset = origins[:, part] - center[:, None]
        weight, weight_error, anisotropy = measure_scale_factors(moments.measure, maps)
        weight_error = weight_error + (len(matrices) + 6 * order + 8) * U * weight
        raw += (transform_by_horner(weighed, order, maps, offset) * weight).sum(axis=1)
        tolerance = (
            6.0
            * U
            * (
                (np.abs(maps) * extent).sum(axis=1)
                + np.abs(offsets[:, part])
                + np.abs(center)[:, None]
            )
        )
        reach = np.abs(maps), np.abs(offset)
        size = transform_by_horner(
            np.abs(weighed) + weighed_error, order, reach[0], reach[1] + tolerance
        )
        rounding = weight * transform_by_horner(weighed_error, order, *reach) + weight_error * size
        for axis, raised in enumerate(product_indices(order) if order else ()):
            rounding[raised] += (
                monomials(order)[raised, axis, None]
                * tolerance[axis]
                * weight
                * size[: len(raised)]
            )
        moved = transform_by_horner(weighed_input, order, *reach)
        error += rounding.sum(axis=1)
        inputs += (weight * moved).sum(axis=1)
        if anisotropy.any():  # areas scale differently from face to face
            largest = transform_by_horner(largest, order, reach[0], reach[1] + tolerance)
            inputs += (weight * anisotropy * largest).sum(axis=1)
    return Moments(raw, center, Measure.MASS, error, inputs)


def _mass_functional(
    moments: Moments,
    order: int,
    terms: Terms,
    forms: tuple[NDArray, NDArray],
    misplacement: NDArray,
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return four (K, k) arrays: G, its rounding bound, its bound by `moments.input_error`, bounds
    of magnitudes.

    forms: (3, 3, k) and (3, k), the density's coordinates; misplacement: (3, k) the error bounds of
    their constants.
    """
    degree = max((sum(powers) for powers in terms), default=0)
    absolute = {powers: abs(value) for powers, value in terms.items()}
    value = _apply_polynomial(moments.raw, order, terms, forms)
    reach = np.abs(forms[0]), np.abs(forms[1]) + misplacement
    size = np.abs(moments.raw) + moments.rounding_error
    error = _apply_polynomial(moments.rounding_error, order, absolute, reach)
    error += U * (6 * degree + len(terms) + 4) * _apply_polynomial(size, order, absolute, reach)
    for axis in range(3):  # the density's slope along the axis times how far its coordinate is off
        slope = {
            tuple(np.subtract(powers, np.eye(3, dtype=int)[axis]).tolist()): factor * powers[axis]
            for powers, factor in absolute.items()
            if powers[axis]
        }
        if slope:
            error += misplacement[axis] * _apply_polynomial(size, order, slope, reach)
    largest = (
        absolute_moments(moments.raw, moments.order) + moments.rounding_error + moments.input_error
    )
    inputs, largest = (
        _apply_polynomial(one, order, absolute, reach) for one in (moments.input_error, largest)
    )
    return value, error, inputs, largest


def _apply_polynomial(
    values: NDArray, order: int, terms: Terms, forms: tuple[NDArray, NDArray]
) -> Array:
    """Return the (K, k) products of a functional, (K',), with Σ c l0^p l1^q l2^r in the k columns
    of linear forms.
    """
    linear, offset = forms
    count = monomial_count(order)
    top = order_from_count(len(values))
    l0, l1, l2 = ((offset[i], *linear[i]) for i in range(3))
    out = np.zeros((count, offset.shape[1]))
    by_p = np.broadcast_to(values[:, None], (len(values), offset.shape[1]))
    for p in range(max((powers[0] for powers in terms), default=-1) + 1):
        by_q = by_p
        for q in range(max((powers[1] for powers in terms if powers[0] == p), default=-1) + 1):
            by_r = by_q
            last = max((powers[2] for powers in terms if powers[:2] == (p, q)), default=-1)
            for r in range(last + 1):
                if (p, q, r) in terms:
                    out += terms[p, q, r] * by_r[:count]
                if r < last:
                    by_r = multiply_by_linear_form(l2, by_r, top - p - q - r)
            if top > p + q:
                by_q = multiply_by_linear_form(l1, by_q, top - p - q)
        if top > p:
            by_p = multiply_by_linear_form(l0, by_p, top - p)
    return out


def local_coordinates(matrices: NDArray) -> Array:
    """Return (k, 4, 4) maps from a body's coordinates to lengths along its own axes, under (k, 4,
    4) transforms.
    """
    axes, _ = polar_rotation(matrices)
    fields = np.zeros((len(matrices), 4, 4))
    fields[:, :3, :3] = axes.transpose(0, 2, 1) @ np.asarray(matrices, np.float64)[:, :3, :3]
    fields[:, 3, 3] = 1.0
    return fields


def find_negative_point(
    density: Polynomial, points: NDArray, triangles: NDArray, solid: bool
) -> tuple[tuple[float, NDArray] | None, bool]:
    """Return a negative value and its (3,) point, or None; and True if there may be an undetected
    negative value.
    """
    used = np.unique(triangles)
    tried = points[used]
    if density.degree > 1:
        tried = np.concatenate([tried, points[triangles].mean(axis=1)])
    values = density(tried)
    low = points[used].min(axis=0)
    high = points[used].max(axis=0)
    grid = low + GRID_STEPS * (high - low) if solid and density.degree > 1 else tried[:0]
    inner = density(grid)

    def inside(i: int) -> bool:
        return abs(winding_number(points, triangles, grid[i])) > 0.5

    largest = float(np.abs(values).max())
    least = int(np.argmin(values))
    if values[least] < 0.0:  # the density may be close to zero all over the surface
        most = next(
            filter(inside, np.argsort(-inner, kind="stable")[:MAX_LOCATED_POINTS].tolist()), None
        )
        largest = largest if most is None else max(largest, inner[most])
    if values[least] < -NEGLIGIBLE_RTOL * largest:
        return (float(values[least]), tried[least]), False
    if density.degree <= 1:
        return None, False
    if density.lower_bound(low, high) >= -NEGLIGIBLE_RTOL * largest:
        return None, False
    worst = np.argsort(inner, kind="stable")[:MAX_LOCATED_POINTS]
    negative_index = next(
        filter(inside, worst[inner[worst] < -NEGLIGIBLE_RTOL * largest].tolist()), None
    )
    return (
        (None, True)
        if negative_index is None
        else ((float(inner[negative_index]), grid[negative_index]), False)
    )
