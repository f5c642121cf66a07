# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Zernike moments of a body in the unit ball, and the radial power of its Fourier transform.

Ω_nlm = sqrt(3/4π) ∫ R_nl(r) conj(Y_lm) dV with R_nl = sqrt(2n+3) r^l P_k^(0, l+1/2)(2r² - 1), k =
(n-l)/2, orthonormal on the ball: the normalization of Novotni and Klein (3D Zernike descriptors for
content based shape retrieval, 2003), in which a full ball has Ω_000 = 1. The descriptor ‖Ω_nl‖ is
the same however the body is turned, or mirrored.

To order 20 they are sums of raw moments. These sums cancel, and `descriptor_error` estimates the
loss. Above that order, and if it is too much, the cones from the center over the triangles are
integrated by quadrature. Over a triangle a polynomial of degree n takes Gauss's rule; along the
cone, with S_k = R_nl / sqrt(2n+3), n = l+2k, partial integration of r S_k' against each S_i gives
(r d/dr + 3) S_k = (n+3) S_k + Σ_{i<k} (2l+4i+3) S_i, and from that for J_k(x) = ∫_0^1 t² S_k(tx) dt
the stable recursion

    J_k = (S_k - A_k) / (n+3),    A_{k+1} = ((2n+3) S_k - n A_k) / (n+3),    A_0 = 0.

Of a plane shape in the unit disc (Zernike 1934; Teague 1980 for shapes) they are A_nm =
sqrt((n+1)/π) ∫ R_nm(r) exp(-imφ) dA with R_nm = r^m P_k^(0, m)(2r² - 1), k = (n-m)/2, orthonormal:
the sum of all |A_nm|², m = -n..n, is at most the shape's area. Turned by θ a shape has A_nm
exp(-imθ), and its mirror image in y = 0 has conj(A_nm).

Every frequency within the ball's resolution follows too, for ∫ R_nl j_l(qr) r² dr = (-1)^k
sqrt(2n+3) j_{n+1}(q)/q.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache
from itertools import accumulate, count
from math import ceil, factorial, pi, prod, sqrt
from operator import mul

import numpy as np

from ..moments import (
    Moments,
    Multiplets,
    U,
    along_first,
    complex_moments,
    harmonic_moments,
    monomials,
    with_negative_orders,
)
from ..numerics import Array, NDArray, triangle_rule

MAX_ORDER_BY_MOMENTS = 20  # the highest order that raw moments in float64 give
MAX_DESCRIPTOR_ERROR = 1e-9  # the error of a descriptor that raw moments may have
POINTS_PER_BLOCK = 16384  # points of a quadrature that are evaluated together
NO_SUM = np.zeros((), np.complex128)
QUADRATURE_RTOL = 1e-13  # for a triangle's integral, in the choice of its quadrature


def zernike_moments(raw: NDArray, order: int) -> Multiplets:
    """Return {(n, l): (2l+1, …)} Ω_nlm, m = -l..l, of a body in the unit ball by its raw moments
    (K, …).
    """
    harmonic = harmonic_moments(raw, order)
    return {
        (n, l): sqrt(3.0 / (4.0 * pi))
        * sum(
            (
                sqrt(2 * n + 3) * float(c) * harmonic[l + 2 * i, l]
                for i, c in enumerate(_radial((n - l) // 2, Fraction(2 * l + 1, 2)))
            ),
            NO_SUM,
        )
        for n, l in degrees(order)
    }


def descriptor_error(raw: NDArray, order: int) -> Array:
    """Estimate (…) the descriptors' error: their change if raw moments (K, …) change by a few
    roundings.
    """
    factors = 1.0 + 8.0 * U * np.random.default_rng(0).uniform(-1.0, 1.0, len(raw))
    rounded = raw * along_first(factors, raw)
    before = descriptors(zernike_moments(raw, order))
    after = descriptors(zernike_moments(rounded, order))
    return np.abs(after - before).max(axis=0)


def descriptors(moments: Multiplets) -> Array:
    """Return (D, …) ‖Ω_nl‖ in the order of `degrees`."""
    return np.array(
        [np.linalg.norm(multiplet, axis=0) for _, multiplet in sorted(moments.items())], np.float64
    )


def degrees(order: int) -> list[tuple[int, int]]:
    """Return (n, l) for 0 ≤ l ≤ n ≤ order with n-l even, n first; of a disc, (n, m)."""
    return [(n, l) for n in range(order + 1) for l in range(n % 2, n + 1, 2)]


def zernike_quadrature(points: NDArray, triangles: NDArray, order: int) -> Multiplets:
    """Return the `zernike_moments` of the body that the cones from the origin over outward
    triangles make up.

    points: (n, 3) within the unit ball. triangles: (m, 3). The work grows with the order cubed, and
    with the number of nodes of a triangle: one for the smallest, order²/4 for a triangle as large
    as the ball.
    """
    corners = [points[triangles[:, i]] for i in range(3)]
    longest = np.sqrt(
        np.max([((corners[i] - corners[i - 1]) ** 2).sum(axis=1) for i in range(3)], axis=0)
    )
    nodes = _nodes(longest, order)
    # Of each degree those of m ≥ 0; the others follow.
    total = {key: np.zeros(key[1] + 1, complex) for key in degrees(order)}
    for needed in np.unique(nodes):
        faces = np.flatnonzero(nodes == needed)
        (_, u, v), weight = triangle_rule(int(needed) + 1)
        step = max(1, POINTS_PER_BLOCK // len(u))
        for start in range(0, len(faces), step):
            a, b, c = (corner[faces[start : start + step]] for corner in corners)
            det = (a * np.cross(b, c)).sum(axis=1)
            x = a[:, None] + u[:, None] * (b - a)[:, None] + v[:, None] * (c - a)[:, None]
            _add_cones(total, x.reshape(-1, 3), (det[:, None] * weight).ravel(), order)
    return {key: sqrt(3.0 / (4.0 * pi)) * with_negative_orders(half) for key, half in total.items()}


def _nodes(longest: NDArray, order: int) -> NDArray[np.int64]:
    """Return the number of Gauss points on a line for each triangle, by its longest side and the
    polynomials' oscillation.
    """
    exact_count = ceil((order + 2) / 2)
    counts = np.full(len(longest), exact_count)
    # A polynomial of degree n turns by at most about n radians over the ball, whose diameter is 2.
    phase = (order + 2.0) * longest / 2.0
    for points in range(exact_count - 1, 0, -1):
        # By Gauss's rule, the error of e^(ix) over [-phase/2, phase/2] is (phase/2)^2g / (2g)! in
        # size, with g points.
        error = (phase / 2.0) ** (2 * points) / factorial(2 * points)
        counts[error < QUADRATURE_RTOL] = points
    return counts


def _add_cones(total: Multiplets, x: NDArray, weight: NDArray, order: int) -> None:
    """Add to each total[n, l], (l+1,) for m = 0..l, the integrals along the cones to (k, 3) points.

    weight: (k,) of the points, their triangle's determinant times the rule's weight.
    """
    argument = 2.0 * (x * x).sum(axis=1) - 1.0
    for l, harmonics in _solid_harmonics(x, order):
        conjugate = harmonics.conj()
        # J_k and A_k by the module's recursion, without the factor r^l of S_k, which the solid
        # harmonics have.
        a = 0.0
        for n, s in zip(range(l, order + 1, 2), _jacobi(l + 0.5, argument)):
            along = weight * (s - a) / (n + 3)
            total[n, l] += sqrt(2 * n + 3) * (conjugate * along).sum(axis=1)
            a = ((2 * n + 3) * s - n * a) / (n + 3)


def _solid_harmonics(x: NDArray, order: int) -> Iterator[tuple[int, NDArray[np.complex128]]]:
    """Yield l and (l+1, k) r^l Y_lm at (k, 3) points for m = 0..l, l = 0..order, by recursion
    upward in l.
    """
    r2 = (x * x).sum(axis=1)
    x_plus_iy = x[:, 0] + 1j * x[:, 1]
    z = x[:, 2]
    before_last = None
    last = np.full((1, len(x)), 1.0 / sqrt(4.0 * pi), complex)
    yield 0, last
    for l in range(1, order + 1):
        m = np.arange(l)
        a = np.sqrt((4.0 * l * l - 1.0) / (l * l - m * m))
        below_l = a[:, None] * z * last  # for m < l
        if before_last is not None:
            m = m[:-1]
            b = np.sqrt((2 * l + 1) * ((l - 1.0) ** 2 - m * m) / ((2 * l - 3) * (l * l - m * m)))
            below_l[:-1] -= b[:, None] * r2 * before_last
        at_l = -sqrt((2 * l + 1) / (2.0 * l)) * x_plus_iy * last[-1]  # for m = l
        before_last = last
        last = np.concatenate([below_l, at_l[None]])
        yield l, last


def _jacobi(beta: float, x: NDArray) -> Iterator[Array]:
    """Yield P_k^(0, beta)(x) for k = 0, 1, and so on."""
    before_last = np.ones_like(x)
    last = (-beta + (beta + 2.0) * x) / 2.0
    yield before_last
    for k in count(2):
        yield last
        doubled = 2.0 * k + beta
        scale = 2.0 * k * (k + beta) * (doubled - 2.0)
        factor = (doubled - 1.0) * (doubled * (doubled - 2.0) * x - beta * beta)
        less = 2.0 * (k - 1.0) * (k + beta - 1.0) * doubled * before_last
        before_last, last = last, (factor * last - less) / scale


def radial_power(moments: Multiplets, wave_numbers: NDArray) -> Array:
    """Return the (k, …) means of |F(q)|² over all directions of q, without those orders of moments
    that are missing.

    moments: of a body in the unit ball, (2l+1, …). wave_numbers: (k,) |q|, in units of the ball's
    inverse radius.
    """
    order = max(n for n, _ in moments)
    first = moments[0, 0]
    bessel = _spherical_bessel(np.asarray(wave_numbers, np.float64), order)  # j_{n+1}(q)/q
    power = np.zeros((bessel.shape[1], *first.shape[1:]))
    for l in range(order + 1):
        amplitude = sum(
            (-1.0) ** ((n - l) // 2)
            * sqrt(2 * n + 3)
            * along_first(bessel[n], first)
            * moments[n, l][:, None]
            for n in range(l, order + 1, 2)
        )
        power += (np.abs(amplitude) ** 2).sum(axis=0)
    return (4.0 * pi) ** 2 / 3.0 * power


def _spherical_bessel(q: NDArray, order: int) -> Array:
    """Return (order+1, k) j_{n+1}(q)/q for n = 0..order, by Miller's recursion downward."""
    q = np.maximum(q, 1e-8)  # j_1(q)/q is 1/3 from there down
    # So far above, any start ends in multiples of j_n.
    start = order + 60 + int(2.0 * q.max())
    multiples = np.zeros((order + 3, len(q)))
    above = np.zeros_like(q)
    current = np.full_like(q, 1e-250)
    for n in range(start, -1, -1):
        if n < len(multiples):
            multiples[n] = current
        if n:
            below = (2 * n + 1) / q * current - above
            above = current
            current = below
            is_large = np.abs(current) > 1e200
            for values in (multiples, above, current):
                values[..., is_large] *= 1e-200
    j0 = np.sin(q) / q
    j1 = np.sin(q) / q**2 - np.cos(q) / q
    # The factor comes from the larger of j_0 and j_1, as either may be zero.
    by_j0 = np.abs(multiples[0]) > np.abs(multiples[1])
    factor = np.where(by_j0, j0, j1) / np.where(by_j0, multiples[0], multiples[1])
    return (multiples * factor)[1 : order + 2] / q


@lru_cache
def _radial(k: int, beta: Fraction) -> tuple[Fraction, ...]:
    """Return the coefficients of r^2i, i = 0..k, in P_k^(0, beta)(2r² - 1)."""
    first = Fraction((-1) ** k) * prod((beta + 1 + i) / (i + 1) for i in range(k))
    ratios = ((i - k) * (k + beta + 1 + i) / ((beta + 1 + i) * (i + 1)) for i in range(k))
    return tuple(accumulate(ratios, mul, initial=first))


def disc_zernike(moments: Moments, radius: float) -> NDArray[np.complex128]:
    """Return the (k,) Zernike moments A_nm of a flat shape, in the order of `degrees`.

    moments: its area moments about the disc's center, in the plane z = 0.
    """
    degree = monomials(moments.order).sum(axis=1)
    scaled = Moments(moments.raw / radius ** (degree + 2.0), moments.about, moments.measure)
    c = {key: entry.value for key, entry in complex_moments(scaled).items()}
    return np.array(
        [
            sqrt((n + 1) / pi)
            * sum(
                float(factor) * c[m + i, i].conjugate()
                for i, factor in enumerate(_radial((n - m) // 2, Fraction(m)))
            )
            for n, m in degrees(moments.order)
        ]
    )
