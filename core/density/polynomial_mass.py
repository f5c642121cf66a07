# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass moments of bodies whose density is a polynomial: moments times a polynomial are moments of lower order.

With F[α] = ∫ x^α and a density p(y), y = D u + e in the coordinates u about the moments' own point, the mass has the
functional G[α] = Σ_β p_β (y^β F)[α], where multiplying by a linear form costs one order, as in `moments`. So mass
moments to order 3 come exactly from moments to order 3 + degree. The polynomial is developed exactly about the place
where the body is, so that neither a body far away nor a density given far away loses digits.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..moments.affine_maps import horner, maps_last, times
from ..moments.moments import BLOCK, Measure, Moments, U, measure_factors
from ..moments.monomials import monomial_count, monomials, order_of, raised_places
from ..numerics.rotations import own_axes
from .polynomial import Polynomial

Terms = dict[tuple[int, int, int], float]


def graded_sum(
    moments: Moments,
    density: Polynomial,
    matrices: NDArray,
    fields: NDArray | None = None,
    about: ArrayLike | None = None,
) -> Moments:
    """The mass moments of k images of one body with a polynomial density, as one body, of the order that is left.

    moments: of the volume or area, to order n + the degree. matrices: (k, 4, 4) the images, as for `map_sum`.
    fields: (k, 4, 4) from the body's own coordinates to those that the density is a polynomial of, taken exactly; by
    default they are the images'. about: (3,), by default the mean of the images of `moments.about`.

    error: rounding, on top of what `moments.error` comes to; input: what `moments.input` comes to. Of a body with a
    negative density somewhere both hold all the same. ValueError where the moments' order is below the degree.
    """
    order = moments.order - density.degree
    if order < 0:
        raise ValueError("moments below density's degree")
    fields = matrices if fields is None else fields
    linear, places = maps_last(matrices)
    turn, shift = maps_last(fields)
    point, extent = moments.about[:, None], np.abs(moments.about)[:, None]
    origins = (linear * point).sum(axis=1) + places
    about = origins.mean(axis=1) if about is None else np.asarray(about, np.float64)
    homes = (turn * point).sum(axis=1) + shift
    home = homes.mean(axis=1)
    terms = density.shifted(home).rounded()
    raw, error, inputs = np.zeros((3, monomial_count(order)))
    for start in range(0, len(matrices), BLOCK):
        part = slice(start, start + BLOCK)
        forms = turn[:, :, part], homes[:, part] - home[:, None]
        astray = (
            8.0 * U * ((np.abs(turn[:, :, part]) * extent).sum(axis=1) + np.abs(shift[:, part]) + np.abs(home)[:, None])
        )
        weighed, weighed_error, weighed_input = _weighed(moments, order, terms, forms, astray)
        maps, offset = linear[:, :, part], origins[:, part] - about[:, None]
        weight, weight_error, deviation = measure_factors(moments.of, maps)
        weight_error = weight_error + (len(matrices) + 6 * order + 8) * U * weight
        raw += (horner(weighed, order, maps, offset) * weight).sum(axis=1)
        slack = 6.0 * U * ((np.abs(maps) * extent).sum(axis=1) + np.abs(places[:, part]) + np.abs(about)[:, None])
        reach = np.abs(maps), np.abs(offset)
        size = horner(np.abs(weighed) + weighed_error, order, reach[0], reach[1] + slack)
        rounding = weight * horner(weighed_error, order, *reach) + weight_error * size
        for axis, raised in enumerate(raised_places(order) if order else ()):
            rounding[raised] += monomials(order)[raised, axis, None] * slack[axis] * weight * size[: len(raised)]
        moved = horner(weighed_input, order, *reach)
        error += rounding.sum(axis=1)
        inputs += (weight * (moved + deviation * (size + moved))).sum(axis=1)
    return Moments(raw, about, Measure.MASS, error, inputs)


def _weighed(
    moments: Moments, order: int, terms: Terms, forms: tuple[NDArray, NDArray], astray: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """(K, k) each: G, the bound of its rounding, and what becomes of `moments.input`.

    forms: (3, 3, k) and (3, k), the density's coordinates; astray: (3, k) what their constants may be off by.
    """
    degree = max((sum(powers) for powers in terms), default=0)
    absolute = {powers: abs(value) for powers, value in terms.items()}
    value = _product(moments.raw, order, terms, forms)
    reach = np.abs(forms[0]), np.abs(forms[1]) + astray
    size = np.abs(moments.raw) + moments.error
    error = _product(moments.error, order, absolute, reach)
    error += U * (6 * degree + len(terms) + 4) * _product(size, order, absolute, reach)
    for axis in range(3):  # the density's slope along the axis times how far its coordinate is off
        slope = {
            tuple(np.subtract(powers, np.eye(3, dtype=int)[axis]).tolist()): factor * powers[axis]
            for powers, factor in absolute.items()
            if powers[axis]
        }
        if slope:
            error += astray[axis] * _product(size, order, slope, reach)
    return value, error, _product(moments.input, order, absolute, reach)


def _product(values: NDArray, order: int, terms: Terms, forms: tuple[NDArray, NDArray]) -> NDArray[np.float64]:
    """(K, k) the functional with (K',) values times Σ c l0^p l1^q l2^r, l the linear forms of the k columns."""
    linear, offset = forms
    count = monomial_count(order)
    top = order_of(len(values))
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
                    by_r = times(l2, by_r, top - p - q - r)
            if top > p + q:
                by_q = times(l1, by_q, top - p - q)
        if top > p:
            by_p = times(l0, by_p, top - p)
    return out


def own_fields(matrices: NDArray) -> NDArray[np.float64]:
    """(k, 4, 4) the maps from a body's coordinates to lengths along its own axes from its own origin, where `matrices`
    put it."""
    axes, _ = own_axes(matrices)
    fields = np.zeros((len(matrices), 4, 4))
    fields[:, :3, :3] = axes.transpose(0, 2, 1) @ np.asarray(matrices, np.float64)[:, :3, :3]
    fields[:, 3, 3] = 1.0
    return fields
