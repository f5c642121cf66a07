# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Affine maps of a functional F[p,q,r] = ∫ x^p y^q z^r dm, m a volume, area, length or mass.

Multiplying the integrand by the linear form l(x) = t + a·x sends F to (lF)[α] = t F[α] + Σ_i a_i
F[α+e_i], one order shorter; the moments of the image are (l0^p l1^q l2^r F)[0,0,0]. Horner's scheme
does that for any order and for many maps at once; `moments.image` is faster for a single map.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from ..numerics import Array, ArrayLike, Index, Mask, NDArray, segment_ranges, segment_starts
from .exponents import (
    count_of_degree,
    monomial_count,
    monomial_index,
    monomials,
    product_indices,
    quotient_indices,
)

# If the columns of a matrix, scaled to unit length, span less volume than this, the rounding of
# float32 entries alone may have made it: such a matrix cannot be distinguished from one that
# flattens.
SINGULAR_RTOL = 4.0 * float(np.finfo(np.float32).eps)
SIMILARITY_RTOL = (
    1e-5  # a float32 rotation matrix is a similarity to about 1e-7; a real shear is far above this
)
ROTATIONS_PER_BLOCK = 128  # with tables of coefficients that stay in the cache
HIGHEST_ODD = (
    3.0  # safety factor of the estimate from the two lower even degrees; a thin bar needs 1.3
)


def to_trailing_axis(matrices: NDArray) -> tuple[Array, Array]:
    """Return (3, 3, k) and (3, k): the linear parts and the offsets of (k, 4, 4) maps."""
    affine = np.ascontiguousarray(np.asarray(matrices, np.float64)[:, :3].transpose(1, 2, 0))
    return affine[:, :3], affine[:, 3]


def distinct_linear_parts(
    matrices: NDArray,
) -> Iterator[tuple[Array, Index]]:
    """Yield each distinct (3, 3) linear part of (k, 4, 4) maps with the (j,) indices of the maps
    that have it.
    """
    linear, which = np.unique(matrices[:, :3, :3].reshape(-1, 9), axis=0, return_inverse=True)
    for i, row in enumerate(linear):
        yield row.reshape(3, 3), np.flatnonzero(which.ravel() == i)


def similarity_groups(matrices: NDArray) -> Iterator[tuple[Index, bool]]:
    """Yield the indices of all similarities of (k, 4, 4) maps and True, then of each uneven linear
    part and False.
    """
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield np.flatnonzero(even), True
    uneven = np.flatnonzero(~even)
    yield from ((uneven[members], False) for _, members in distinct_linear_parts(matrices[uneven]))


def affine_matrices(linear: NDArray, offsets: ArrayLike = 0.0) -> Array:
    """Return (..., 4, 4) maps with these (..., 3, 3) linear parts and (..., 3) offsets, either of
    which may be one.
    """
    matrices = np.zeros((*np.broadcast_shapes(linear.shape[:-2], np.shape(offsets)[:-1]), 4, 4))
    matrices[..., :3, :3] = linear
    matrices[..., :3, 3] = offsets
    matrices[..., 3, 3] = 1.0
    return matrices


def placed_boxes(box: tuple[NDArray, NDArray], matrices: NDArray) -> tuple[Array, Array]:
    """Return (k, 3) middles and half sides of boxes around the images of a box, (3,) and (3,), by
    (k, 4, 4) maps.
    """
    (low, high) = box
    linear = matrices[:, :3, :3]
    return linear @ ((low + high) / 2.0) + matrices[:, :3, 3], np.abs(linear) @ ((high - low) / 2.0)


def transform_by_horner(values: NDArray, order: int, linear: NDArray, offset: NDArray) -> Array:
    """Return (K, k) images of functionals, (K, 1) or (K, k), under maps with (3, 3, k) `linear` and
    (3, k) `offset`.
    """
    forms = [(offset[i], *linear[i]) for i in range(3)]
    out = np.zeros((len(values), offset.shape[1]))
    by_p = np.broadcast_to(values, out.shape)
    for p in range(order + 1):
        by_q = by_p
        for q in range(order - p + 1):
            by_r = by_q
            for r in range(order - p - q + 1):
                out[monomial_index(p, q, r)] = by_r[0]
                by_r = multiply_by_linear_form(forms[2], by_r, order - p - q - r)
            by_q = multiply_by_linear_form(forms[1], by_q, order - p - q)
        by_p = multiply_by_linear_form(forms[0], by_p, order - p)
    return out


def multiply_by_linear_form(form: tuple[NDArray, ...], values: NDArray, order: int) -> Array:
    """Return the (K', k) values of a functional, (K, k), times the linear form (t, a, b, c), (k,)
    each, one order shorter than `order`: empty if that is 0.
    """
    if not order:
        return values[:0]
    t, a, b, c = form
    x, y, z = product_indices(order)
    image = t * values[: monomial_count(order - 1)]
    for factor, raised in ((a, x), (b, y), (c, z)):
        term = values.take(raised, axis=0)
        term *= factor
        image += term
    return image


def apply_linear(values: NDArray, order: int, linear: NDArray) -> Array:
    """Map functionals (..., m, K): the first of m by the map (..., 3, 3), its bounds by the map's
    absolute value.
    """
    out = np.array(values)
    for part, table in _image_coefficients(np.stack([linear, np.abs(linear)], axis=-3), order):
        out[..., 0, part] = np.add.reduce(table[..., 0, :, :] * values[..., 0, None, part], axis=-1)
        out[..., 1:, part] = np.einsum(
            "...rc,...mc->...mr", table[..., 1, :, :], values[..., 1:, part]
        )
    return out


def rotate_moments(raw: NDArray, order: int, rotation: NDArray) -> Array:
    """Return (..., K) moments of bodies after rotations (..., 3, 3), from their moments `raw`; no
    error bounds.
    """
    if raw.ndim + 1 == rotation.ndim == 3 and len(rotation) == len(raw) > ROTATIONS_PER_BLOCK:
        blocks = [
            slice(start, start + ROTATIONS_PER_BLOCK)
            for start in range(0, len(raw), ROTATIONS_PER_BLOCK)
        ]
        return np.concatenate(
            [rotate_moments(raw[block], order, rotation[block]) for block in blocks]
        )
    out = np.zeros((*np.broadcast_shapes(raw.shape[:-1], rotation.shape[:-2]), raw.shape[-1]))
    out += raw
    for part, table in _image_coefficients(rotation, order):
        out[..., part] = np.add.reduce(table * raw[..., None, part], axis=-1)
    return out


def _image_coefficients(forms: NDArray, order: int) -> Iterator[tuple[slice, Array]]:
    """Yield, by degree from 1, the slice of its monomials, and the (..., rows, rows) coefficients
    of their images.
    """
    table = np.ones((*forms.shape[:-2], 1, 1))
    for degree in range(1, order + 1):
        table = _raise_polynomials(table, degree, forms)
        yield slice(monomial_count(degree - 1), monomial_count(degree)), table


def _raise_polynomials(table: NDArray, degree: int, forms: NDArray) -> Array:
    """Return (..., rows, rows) coefficients of the images of a degree's monomials. table: those one
    degree lower; forms: (..., 3, 3) the images of x, y and z.
    """
    if degree == 1:
        return forms
    count = count_of_degree(degree)
    below = count_of_degree(degree - 1)
    padded = np.concatenate([table, np.zeros((*table.shape[:-1], 1))], axis=-1)
    raised = padded[..., quotient_indices(degree, below)]  # times x, y, z: (..., below, 3, rows)
    grown = np.empty((*table.shape[:-2], count, count))
    # In storage order: all lower monomials times x, the last `degree` of them times y (without
    # x), and the last one times z (a power of z).
    for axis, old, new in (
        (0, slice(0, below), slice(0, below)),
        (1, slice(below - degree, below), slice(below, count - 1)),
        (2, slice(below - 1, below), slice(count - 1, count)),
    ):
        form = forms[..., axis, :, None, None]
        into = grown[..., new, :]
        np.multiply(raised[..., old, 0, :], form[..., 0, :, :], out=into)
        into += raised[..., old, 1, :] * form[..., 1, :, :]
        into += raised[..., old, 2, :] * form[..., 2, :, :]
    return grown


@lru_cache
def _terms(
    order: int,
) -> list[tuple[Index, Index, Array, Index]]:
    """Return, by axis, the terms of all shifted monomials: (t,) old indices, powers, binomials;
    (K,) first terms.

    By the axis x: (x + t)^p y^q z^r = Σ_k binomial(p, k) t^(p-k) x^k y^q z^r.
    """
    exponents = monomials(order)
    tables = []
    for axis in range(3):
        counts = exponents[:, axis] + 1
        monomial = np.repeat(np.arange(len(exponents)), counts)
        p = exponents[monomial, axis]
        k = segment_ranges(counts)
        source = exponents[monomial]
        source[:, axis] = k
        binomials = np.array([float(math.comb(*pair)) for pair in zip(p.tolist(), k.tolist())])
        tables.append((monomial_index(*source.T), p - k, binomials, segment_starts(counts)))
    return tables


def apply_translation(values: NDArray, order: int, offsets: NDArray) -> Array:
    """Return (..., K) values F[(x+t)^α] of functionals F, (..., K), each with its own offset t,
    (..., 3).
    """
    moved = offsets.any(axis=-1)
    if not moved.all():  # most images are about the image of their point
        values = values.copy()
        if moved.any():
            values[moved] = apply_translation(values[moved], order, offsets[moved])
        return values
    lead = values.shape[:-1]
    values = values.reshape(-1, values.shape[-1])
    offsets = offsets.reshape(-1, 3)
    for axis, (sources, lags, binomials, starts) in enumerate(_terms(order)):
        powers = np.ones((len(values), order + 1))
        powers[:, 1:] = offsets[:, axis, None]
        with np.errstate(over="ignore", invalid="ignore"):
            powers = np.multiply.accumulate(powers, axis=1)
            terms = binomials * powers.take(lags, axis=1)
            terms *= values.take(sources, axis=1)
            values = np.add.reduceat(terms, starts, axis=1)
    return values.reshape(*lead, -1)


def are_singular(linear: NDArray) -> Mask:
    """Return a (k,) mask of the (k, 3, 3) maps that are singular to the accuracy of float32
    entries.
    """
    columns = np.asarray(linear, np.float64).transpose(1, 2, 0).copy()
    # Divide by the largest entry first, so that no square of a very small or large scale leaves
    # float64's range.
    largest = np.abs(columns).max(axis=0)
    columns /= np.where(largest > 0.0, largest, 1.0)
    lengths = np.sqrt((columns * columns).sum(axis=0))
    columns /= np.where(lengths > 0.0, lengths, 1.0)
    x, y, z = columns
    volume = (
        x[0] * (y[1] * z[2] - z[1] * y[2])
        + y[0] * (z[1] * x[2] - x[1] * z[2])
        + z[0] * (x[1] * y[2] - y[1] * x[2])
    )
    return np.abs(volume) <= SINGULAR_RTOL


def absolute_moments(raw: NDArray, order: int) -> Array:
    """Return (..., K) upper bounds of ∫ |x^p y^q z^r|; if `order` is odd, those of its degree are
    estimates.
    """
    bounds = np.abs(raw)
    # By degree: ∫ |x|^n, ∫ |y|^n or ∫ |z|^n, whichever is largest, bounds all of that degree.
    largest = [
        bounds[
            ..., [monomial_index(n, 0, 0), monomial_index(0, n, 0), monomial_index(0, 0, n)]
        ].max(axis=-1)
        for n in range(order + 1)
    ]
    # The integrals of odd powers may cancel: Cauchy and Schwarz bound them by their neighbors.
    for n in range(1, order + 1, 2):
        if n < order:
            largest[n] = np.sqrt(largest[n - 1]) * np.sqrt(largest[n + 1])
        elif n > 1:
            with np.errstate(invalid="ignore"):
                reach = np.sqrt(largest[n - 1] / largest[n - 3])
            largest[n] = HIGHEST_ODD * largest[n - 1] * np.where(np.isfinite(reach), reach, 0.0)
    for n in range(1, order + 1):
        part = slice(monomial_count(n - 1), monomial_count(n))
        bounds[..., part] = np.maximum(bounds[..., part], largest[n][..., None])
    return bounds


def are_similarities(linear: NDArray) -> Mask:
    """Return a (k,) mask of the (k, 3, 3) maps that are similarities to the accuracy of float32
    entries.
    """
    return (
        anisotropy(np.ascontiguousarray(np.asarray(linear, np.float64).transpose(1, 2, 0)))
        <= SIMILARITY_RTOL
    )


def anisotropy(linear: NDArray) -> Array:
    """Return (k,) bounds of the variation of (3, 3, k) maps' squared stretch, relative to its mean;
    infinite for 0. They are Gershgorin's, for the eigenvalues of AᵀA.
    """
    columns = linear.transpose(1, 0, 2)
    a, b, c = [np.add.reduce(column * column) for column in columns]
    ab, ac, bc = [
        np.abs(np.add.reduce(columns[i] * columns[j])) for i, j in ((0, 1), (0, 2), (1, 2))
    ]
    mean = (a + b + c) / 3.0
    off = np.maximum(
        np.maximum(np.abs(a - mean) + ab + ac, np.abs(b - mean) + ab + bc),
        np.abs(c - mean) + ac + bc,
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        off = off / mean
    return np.where(np.isfinite(off), off, np.inf)
