# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Theorem 4.2 of Soldea, Elber and Rivlin, as printed: the reference for `full_support_integrals`.

With δ_{x,y} = (t_{x+y} - t_x) / y and [t_m, t_{m+1}) the interval that holds t,

    ∫_{t_i}^t τ^l B_{i,k}(τ) dτ =
        δ_{i,k} Σ_{j=0..l} (-1)^j (t^l)^{(j)} Σ_{s0=i..m} B_{s0,k+j+1}(t)
        Σ_{s1=i..s0} δ_{s1,k+j} ... Σ_{sj=i..s(j-1)} δ_{sj,k+1}.    (11)

The theorem is right, but costs l nested sums, so only tests use it. The arithmetic is that of its
arguments: exact with `fractions.Fraction`.
"""

from collections.abc import Sequence

from ..numerics import Number


def integral_of_basis(knots: Sequence[Number], i: int, k: int, power: int, t: Number) -> Number:
    """Return ∫ from t_i to t of τ^power B_{i,k}(τ) dτ by equation (11).

    The sums reach functions of order k + power + 1, beyond the last knot: the knots there may be
    anything that ascends.

    Parameters
    ----------
    knots : sequence of numbers
    i, k : int
        The function and its order.
    power : int
    t : number
        In [t_i, t_{i+k}].

    Returns
    -------
    number

    Examples
    --------
    >>> from fractions import Fraction
    >>> from body_moments.core.papers.soldea_elber_rivlin_2002_theorem_4_2 import integral_of_basis
    >>> integral_of_basis([Fraction(n) for n in range(3)], 0, 2, 1, Fraction(2))
    Fraction(1, 1)
    """
    last = knots[i + k]
    knots = [*knots[: i + k + 1], *(last + 1 + j for j in range(k + power))]
    m = max(j for j in range(i, i + k) if knots[j] <= t)

    def delta(x: int, y: int) -> Number:
        return (knots[x + y] - knots[x]) / y

    def nested(s: int, order: int) -> Number:
        """Return Σ_{s'=i..s} δ_{s',order} Σ ... down to order k + 1."""
        if order == k:
            return 1
        return sum(delta(first, order) * nested(first, order - 1) for first in range(i, s + 1))

    total, derivative = 0, 1
    for j in range(power + 1):
        inner = sum(_basis(knots, s, k + j + 1, t) * nested(s, k + j) for s in range(i, m + 1))
        total += (-1) ** j * derivative * t ** (power - j) * inner
        derivative *= power - j
    return delta(i, k) * total


def _basis(knots: Sequence[Number], i: int, k: int, t: Number) -> Number:
    """Return B_{i,k}(t) by the recursion of Cox and de Boor."""
    if k == 1:
        return 1 if knots[i] <= t < knots[i + 1] else 0
    value = 0
    if knots[i + k - 1] > knots[i]:
        value += (t - knots[i]) / (knots[i + k - 1] - knots[i]) * _basis(knots, i, k - 1, t)
    if knots[i + k] > knots[i + 1]:
        value += (knots[i + k] - t) / (knots[i + k] - knots[i + 1]) * _basis(knots, i + 1, k - 1, t)
    return value
