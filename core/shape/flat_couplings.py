# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Products of complex moments that are the invariants of a flat shape."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

Key = tuple[int, int]  # (p, q) of a complex moment, p ≥ q
INVARIANT_ORDER = 6
COUPLED_ORDER = 4  # largest order of two moments that are coupled with a third


@lru_cache
def counts() -> tuple[int, int]:
    """Return the numbers of invariants and of chiralities of a flat signature."""
    couplings = len(pairs()) + len(triples())
    return INVARIANT_ORDER // 2 - 1 + couplings, int(is_chiral().sum())


@lru_cache
def _turning(order: int) -> list[Key]:
    """Return (p, q) of the complex moments of order 2 to `order` that a rotation changes; first moments are zero."""
    return [(n - q, q) for n in range(2, order + 1) for q in range((n + 1) // 2)]


@lru_cache
def pairs() -> list[tuple[Key, Key]]:
    return [pair for pair in combinations_with_replacement(_turning(INVARIANT_ORDER), 2) if _sum(pair, 1) == 0]


@lru_cache
def triples() -> list[tuple[Key, Key, Key]]:
    """Return triples of moments: two, and a third with p - q equal to the sum of theirs."""
    pairs = combinations_with_replacement(_turning(COUPLED_ORDER), 2)
    return [(a, b, d) for a, b in pairs for d in _turning(INVARIANT_ORDER) if _sum((a, b, d), 2) == 0]


def _sum(keys: tuple[Key, ...], plus: int) -> int:
    """Return the sum of p - q over the first `plus` moments, minus the sum over all later moments."""
    return sum((p - q) * (1 if i < plus else -1) for i, (p, q) in enumerate(keys))


@lru_cache
def is_chiral() -> NDArray[np.bool_]:
    """Return the mask of couplings that have an imaginary part: all but the squares of one moment."""
    return np.array([a != b for a, b in pairs()] + [True] * len(triples()))
