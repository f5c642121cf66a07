# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signature of a flat shape: numbers that find it again and distinguish it from its mirror image.

They do so however it is moved, turned, scaled or cut into faces.

    invariants   c_pp, and the real parts of products of complex moments with p - q that add up to zero, c_a conj(c_b)
                 and c_a c_b conj(c_c); of central moments over A s^n with the radius of gyration s.
    zernike      the |A_nm| in the disc about the centroid that just holds the shape (see `disc_zernike`).
    chirality    the imaginary parts: a mirror image has the same with the opposite sign, and a shape that is its own
                 mirror image has none.

A flat shape has a front, and is seen from there: turned over it is its mirror image. A sheet has none.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from ..moments.complex_form import complex_moments
from ..moments.exponents import monomial_count, monomials
from ..moments.moments import Moments, U
from .disc_zernike import MAX_DISC_ORDER, disc_zernike
from .flat_couplings import INVARIANT_ORDER, is_chiral, pairs, triples
from .signatures import Signature

FLAT = 2  # the dimension of such signatures


def flat_signature(moments: Moments, radius: float) -> Signature:
    """Return the signature of a flat shape, of dimension 2.

    moments: of area, about the centroid, with z = 0, to order 6 at least; orders above 20 are not used. radius: of the
    disc about the centroid that just holds the shape. The invariants are Flusser's (Pattern Recognition 33, 2000), the
    Zernike descriptors those of Khotanzad and Hong (PAMI 12, 1990).
    """
    order = min(moments.order, MAX_DISC_ORDER)
    moments = moments.truncate(order)
    size = sqrt((moments[2, 0, 0] + moments[0, 2, 0]) / moments.total)
    low = moments.truncate(INVARIANT_ORDER)
    degree = monomials(INVARIANT_ORDER).sum(axis=1)
    scaled = Moments(low.raw / size**degree / moments.total, low.about, low.measure)
    c = {key: entry.value for key, entry in complex_moments(scaled).items()}
    couplings: NDArray[np.complex128] = np.array(
        [c[a] * c[b].conjugate() for a, b in pairs()] + [c[a] * c[b] * c[d].conjugate() for a, b, d in triples()]
    )
    scalars = [c[p, p].real for p in range(2, INVARIANT_ORDER // 2 + 1)]
    zernike = np.abs(disc_zernike(moments, radius))
    rounded = np.random.default_rng(0).uniform(-8.0 * U, 8.0 * U, monomial_count(order))
    moved = Moments(moments.raw * (1.0 + rounded), moments.about, moments.measure)
    error = float(np.abs(np.abs(disc_zernike(moved, radius)) - zernike).max())
    return Signature(
        size,
        np.concatenate([scalars, couplings.real]),
        zernike,
        np.empty(0),
        couplings.imag[is_chiral()],
        error,
        FLAT,
    )
