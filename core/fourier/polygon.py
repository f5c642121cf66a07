# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of plane polygons with holes, in closed form at any frequency.

What `transform` says of a body holds one dimension lower: with the edges e, their outward normals n of the same length,
the phases m in their middles and half the phase t along them

    ∫ exp(-i q·x) dA = i/q² Σ (q·n) (exp(-i m) sinc(t) - 1).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..moments.moments import U
from ..numerics.compensated import phase_factors
from .spectrum import Spectrum
from .transform import ROUNDING_FACTOR, ZERO_WAVE_NUMBER
from .triangle_kernel import PAIRS_PER_BLOCK
from .wave_vectors import wave_vectors

SERIES_TERMS = 10  # of sinc(t) - 1 for t up to 1


def polygon_transform(loops: Sequence[ArrayLike], q: ArrayLike) -> Spectrum:
    """Return the Fourier transform of polygons in the plane, F(q) = ∫ exp(-i q·x) dA, in closed form.

    Parameters
    ----------
    loops : sequence of (n, 2) array_like
        Outlines counter-clockwise, holes clockwise. Where they overlap, each counts, with its sign.
    q : (M, 2) array_like
        Wave vectors, rad per unit of length.

    Returns
    -------
    Spectrum
        Values in unit².

    Raises
    ------
    ValueError
        If a loop is not three or more rows of two finite numbers.
    MeasureError
        If the wave vectors are not finite (M, 2).

    Examples
    --------
    >>> from body_moments.core.fourier import polygon_transform
    >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    >>> np.round(polygon_transform([square], [[0.0, 0.0], [np.pi, 0.0]]).values, 6).tolist()
    [(1+0j), -0.63662j]
    """
    q = wave_vectors(q, 2)
    corners = [np.asarray(loop, np.float64) for loop in loops]
    if not corners or any(loop.ndim != 2 or loop.shape[1] != 2 or len(loop) < 3 for loop in corners):
        raise ValueError("not loops (n, 2)")
    points = np.concatenate(corners)
    if not np.isfinite(points).all():
        raise ValueError("coordinates must be finite")
    center = points.min(axis=0) / 2.0 + points.max(axis=0) / 2.0
    reach = np.sqrt(((points - center) ** 2).sum(axis=1)).max()
    scale = float(np.ldexp(1.0, int(np.ceil(np.log2(reach))))) if reach > 0.0 else 1.0
    start = np.concatenate([(loop - center) / scale for loop in corners])
    end = np.concatenate([(np.roll(loop, -1, axis=0) - center) / scale for loop in corners])
    edge = end - start
    values = _edge_sum((start + end).T / 2.0, edge.T / 2.0, np.stack([edge[:, 1], -edge[:, 0]]), q * scale)
    near = np.sqrt((q**2).sum(axis=1)) * scale <= ZERO_WAVE_NUMBER
    if near.any():
        cross = start[:, 0] * edge[:, 1] - start[:, 1] * edge[:, 0]
        first = (cross[:, None] * (start + end)).sum(axis=0) / 6.0
        values[near] = cross.sum() / 2.0 - 1j * (q[near] @ first * scale)
    values *= scale**2
    perimeter = np.sqrt((edge**2).sum(axis=1)).sum()
    error = U * ROUNDING_FACTOR * perimeter * scale**2 + 8.0 * U * np.abs(values)
    return Spectrum(q, values * phase_factors(q, center), error)


def _edge_sum(middle: NDArray, half: NDArray, normal: NDArray, q: NDArray) -> NDArray[np.complex128]:
    """(M,) the sum over edges, by columns (2, k)."""
    values, size = np.empty(len(q), np.complex128), max(1, PAIRS_PER_BLOCK // middle.shape[1])
    for begin in range(0, len(q), size):
        block = q[begin : begin + size].T
        m, t, across = (
            sum((np.multiply.outer(a, b) for a, b in zip(block, vectors)), np.zeros(()))
            for vectors in (middle / 2.0, half, normal)
        )
        v = -2.0 * np.sin(m) * (np.sin(m) + 1j * np.cos(m))  # exp(-i q·x) - 1
        less = _sinc_minus_one(t)
        square = np.maximum((block**2).sum(axis=0), ZERO_WAVE_NUMBER**2)
        values[begin : begin + size] = 1j * (across * (v + (1.0 + v) * less)).sum(axis=1) / square
    return values


def _sinc_minus_one(t: NDArray) -> NDArray[np.float64]:
    """sin(t) / t - 1, accurate to its last digits."""
    square = np.minimum(t * t, 1.0)
    total = np.zeros_like(t)
    for k in range(SERIES_TERMS, 0, -1):
        total = square * (total + (-1.0) ** k / factorial(2 * k + 1))
    large = np.abs(t) > 1.0
    return np.where(large, np.sin(t) / np.where(large, t, 1.0) - 1.0, total)
