# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mass of bodies whose density is a polynomial, and a check that it is nowhere negative."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple, TypeAlias

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

Terms: TypeAlias = dict[tuple[int, int, int], float]
# Three linear functions in k places: (3, 3, k) linear parts and (3, k) constants.
Forms: TypeAlias = tuple[NDArray, NDArray]
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
    linear, offsets = to_trailing_axis(matrices)
    field_linear, field_offsets = to_trailing_axis(matrices if fields is None else fields)
    point = moments.about[:, None]
    origins = (linear * point).sum(axis=1) + offsets  # (3, k) images of the reference point
    center: Array = origins.mean(axis=1) if about is None else np.asarray(about, np.float64)
    field_origins = (field_linear * point).sum(axis=1) + field_offsets
    # The density is expanded about this point, so that its terms do not cancel.
    field_center = field_origins.mean(axis=1)
    terms = density.translate(field_center).float_terms()
    raw, error, inputs = np.zeros((3, monomial_count(order)))
    for start in range(0, len(matrices), MAPS_PER_BLOCK):
        part = slice(start, start + MAPS_PER_BLOCK)
        weighted = _weight(
            moments,
            order,
            terms,
            forms=(field_linear[:, :, part], field_origins[:, part] - field_center[:, None]),
            misplacement=8.0
            * U
            * _offset_sizes(field_linear[:, :, part], point, field_offsets[:, part], field_center),
        )
        maps = linear[:, :, part]
        # Errors of offsets: a product, sums and a difference round each term 6 times at most.
        offset = origins[:, part] - center[:, None]
        offset_error = 6.0 * U * _offset_sizes(maps, point, offsets[:, part], center)
        scale, scale_error, anisotropy = measure_scale_factors(moments.measure, maps)
        scale_error = scale_error + (len(matrices) + 6 * order + 8) * U * scale
        raw += (transform_by_horner(weighted.moments, order, maps, offset) * scale).sum(axis=1)
        reach = np.abs(maps), np.abs(offset)
        widened_reach = reach[0], reach[1] + offset_error
        size = transform_by_horner(
            np.abs(weighted.moments) + weighted.rounding_error, order, *widened_reach
        )
        rounding = (
            scale * transform_by_horner(weighted.rounding_error, order, *reach) + scale_error * size
        )
        # The derivative of x^p y^q z^r along an axis times the error of the offset along it.
        for axis, raised in enumerate(product_indices(order) if order else ()):
            powers = monomials(order)[raised, axis, None]
            rounding[raised] += powers * offset_error[axis] * scale * size[: len(raised)]
        error += rounding.sum(axis=1)
        moved = transform_by_horner(weighted.input_error, order, *reach)
        inputs += (scale * moved).sum(axis=1)
        if anisotropy.any():  # Areas scale differently from face to face.
            magnitude = transform_by_horner(weighted.magnitude, order, *widened_reach)
            inputs += (scale * anisotropy * magnitude).sum(axis=1)
    return Moments(raw, center, Measure.MASS, error, inputs)


def _offset_sizes(linear: NDArray, point: NDArray, offset: NDArray, subtracted: NDArray) -> Array:
    """Return (3, k) sums of the magnitudes in linear @ point + offset - subtracted, for maps
    (3, 3, k) and (3, k).
    """
    image = (np.abs(linear) * np.abs(point)).sum(axis=1)
    return image + np.abs(offset) + np.abs(subtracted)[:, None]


class _WeightedMoments(NamedTuple):
    """Moments times a density in k places, and bounds, (K, k) each.

    magnitude: bounds of the integrals of the absolute values.
    """

    moments: NDArray
    rounding_error: NDArray
    input_error: NDArray
    magnitude: NDArray


def _weight(
    moments: Moments, order: int, terms: Terms, forms: Forms, misplacement: NDArray
) -> _WeightedMoments:
    """Return moments times a polynomial density in k places.

    forms: the density's coordinates; misplacement: (3, k) the error bounds of their constants.
    """
    degree = max((sum(powers) for powers in terms), default=0)
    absolute = {powers: abs(value) for powers, value in terms.items()}
    weighted = _multiply_by_polynomial(moments.raw, order, terms, forms)
    reach = np.abs(forms[0]), np.abs(forms[1]) + misplacement
    size = np.abs(moments.raw) + moments.rounding_error
    error = _multiply_by_polynomial(moments.rounding_error, order, absolute, reach)
    error += (
        U * (6 * degree + len(terms) + 4) * _multiply_by_polynomial(size, order, absolute, reach)
    )
    # Along each axis, the slope of the density times the error of its coordinate.
    for axis, step in enumerate(np.eye(3, dtype=int)):
        slope = {
            tuple(np.subtract(powers, step).tolist()): factor * powers[axis]
            for powers, factor in absolute.items()
            if powers[axis]
        }
        if slope:
            error += misplacement[axis] * _multiply_by_polynomial(size, order, slope, reach)
    magnitude = (
        absolute_moments(moments.raw, moments.order) + moments.rounding_error + moments.input_error
    )
    return _WeightedMoments(
        weighted,
        error,
        _multiply_by_polynomial(moments.input_error, order, absolute, reach),
        _multiply_by_polynomial(magnitude, order, absolute, reach),
    )


def _multiply_by_polynomial(values: NDArray, order: int, terms: Terms, forms: Forms) -> Array:
    """Return (K, k) moments to `order`: (K',) moments times Σ c u^p v^q w^r, with the k linear
    forms u, v, w.
    """
    linear, offset = forms
    count = monomial_count(order)
    top = order_from_count(len(values))
    u, v, w = ((offset[i], *linear[i]) for i in range(3))
    products = np.zeros((count, offset.shape[1]))
    with_p = np.broadcast_to(values[:, None], (len(values), offset.shape[1]))
    for p in range(_largest(terms, ()) + 1):
        if p:
            with_p = multiply_by_linear_form(u, with_p, top - p + 1)
        with_q = with_p
        for q in range(_largest(terms, (p,)) + 1):
            if q:
                with_q = multiply_by_linear_form(v, with_q, top - p - q + 1)
            with_r = with_q
            for r in range(_largest(terms, (p, q)) + 1):
                if r:
                    with_r = multiply_by_linear_form(w, with_r, top - p - q - r + 1)
                if (p, q, r) in terms:
                    products += terms[p, q, r] * with_r[:count]
    return products


def _largest(terms: Terms, start: tuple[int, ...]) -> int:
    """Return the largest next exponent of the terms whose first exponents are `start`, -1 if there
    are none.
    """
    place = len(start)
    return max((powers[place] for powers in terms if powers[:place] == start), default=-1)


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
    """Search a body for a point at which its density is negative.

    Return the negative value and its (3,) point, or None; and True if the search may have missed a
    negative value. solid: True to search inside the surface too.
    """
    used = np.unique(triangles)
    low = points[used].min(axis=0)
    high = points[used].max(axis=0)
    surface_points = points[used]
    inner_points = surface_points[:0]
    if density.degree > 1:
        surface_points = np.concatenate([surface_points, points[triangles].mean(axis=1)])
        if solid:
            inner_points = low + GRID_STEPS * (high - low)
    surface_values = density(surface_points)
    inner_values = density(inner_points)

    def first_inside(candidates: NDArray) -> int | None:
        """Return the first candidate among the inner points that the surface encloses."""
        for index in candidates[:MAX_LOCATED_POINTS].tolist():
            if abs(winding_number(points, triangles, inner_points[index])) > 0.5:
                return index
        return None

    largest = float(np.abs(surface_values).max())
    least = int(np.argmin(surface_values))
    if surface_values[least] < 0.0:
        # The density may be close to zero all over the surface, so the inside is looked at too.
        densest = first_inside(np.argsort(-inner_values, kind="stable"))
        if densest is not None:
            largest = max(largest, inner_values[densest])
    allowed = -NEGLIGIBLE_RTOL * largest
    if surface_values[least] < allowed:
        return (float(surface_values[least]), surface_points[least]), False
    if density.degree <= 1 or density.lower_bound(low, high) >= allowed:
        return None, False
    ascending = np.argsort(inner_values, kind="stable")
    negative = first_inside(ascending[inner_values[ascending] < allowed])
    if negative is None:
        return None, True
    return (float(inner_values[negative]), inner_points[negative]), False
