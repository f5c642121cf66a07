# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes as moments."""

from fractions import Fraction

import numpy as np
from body_moments.core.moments import Measure, Moments, monomials


def box(size, center, mass=1):
    """(Moments about a point that is not the center, exact function of (point) → tensor) of a solid
    box.
    """
    size, center = [Fraction(x) for x in size], [Fraction(x) for x in center]
    second = [[Fraction(0)] * 3 for _ in range(3)]
    for i in range(3):
        second[i][i] = Fraction(mass) * size[i] ** 2 / 12

    def tensor(point):
        arm = [c - Fraction(p) for c, p in zip(center, point)]
        whole = [
            [second[i][j] + Fraction(mass) * arm[i] * arm[j] for j in range(3)] for i in range(3)
        ]
        trace = sum(whole[i][i] for i in range(3))
        return np.array(
            [[float((trace if i == j else 0) - whole[i][j]) for j in range(3)] for i in range(3)]
        )

    raw = np.zeros(20)
    for k, (p, q, r) in enumerate(monomials(3).tolist()):
        value = Fraction(mass)
        for n, length in zip((p, q, r), size):
            value *= 0 if n % 2 else length**n / (2**n * (n + 1))
        raw[k] = float(value)
    return Moments(raw, np.array(center, float), Measure.MASS, np.abs(raw) * 1e-16), tensor
