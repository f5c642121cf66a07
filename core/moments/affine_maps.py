# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The monomials in storage order, and what affine maps do to a functional F[p,q,r] = ∫ x^p y^q z^r d(of).

Multiplying the integrand by the linear form l(x) = t + a·x sends F to (lF)[α] = t F[α] + Σ_i a_i F[α+e_i], one order
shorter; the moments of the image are (l0^p l1^q l2^r F)[0,0,0]. Horner's scheme does that for any order and for many
maps at once; `moments` has what is faster for one map.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .monomials import monomial_count, monomial_index, product_indices


def to_trailing_axis(matrices: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(3, 3, k) and (3, k): the linear parts and the offsets of (k, 4, 4) maps."""
    affine = np.ascontiguousarray(np.asarray(matrices, np.float64)[:, :3].transpose(1, 2, 0))
    return affine[:, :3], affine[:, 3]


def distinct_linear_parts(matrices: NDArray) -> Iterator[tuple[NDArray[np.float64], NDArray[np.intp]]]:
    """The different linear parts of (k, 4, 4) maps: each of them, (3, 3), and which of the maps have it, (j,)."""
    linear, which = np.unique(matrices[:, :3, :3].reshape(-1, 9), axis=0, return_inverse=True)
    for i, row in enumerate(linear):
        yield row.reshape(3, 3), np.flatnonzero(which.ravel() == i)


def translation_matrices(offsets: NDArray) -> NDArray[np.float64]:
    """(k, 4, 4) the maps that move by (k, 3) offsets and do nothing else."""
    matrices = np.tile(np.eye(4), (len(offsets), 1, 1))
    matrices[:, :3, 3] = offsets
    return matrices


def transform_by_horner(values: NDArray, order: int, linear: NDArray, offset: NDArray) -> NDArray[np.float64]:
    """(K, k): (l0^p l1^q l2^r F)[0,0,0] for all p+q+r ≤ order, F the functional, (K, 1) or (K, k), l_i the linear forms
    of the k maps, linear (3, 3, k) and offset (3, k)."""
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


def multiply_by_linear_form(form: tuple[NDArray, ...], values: NDArray, order: int) -> NDArray[np.float64]:
    """The functional multiplied by a linear form, one order shorter; nothing is left below order 0."""
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
