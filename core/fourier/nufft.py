# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums Σ c exp(-i k·θ) over many points on a regular grid of k: the non-uniform fast Fourier transform of type 1.

After Barnett, Magland and af Klinteberg (2019): each point is spread over width³ cells of a grid that is twice as fine
by the kernel exp(β (sqrt(1 - z²) - 1)), the grid is transformed, and the kernel's own transform is divided out. The
error is about 10^(1 - width) of Σ |c|.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..numerics.quadrature import gauss_legendre

OVERSAMPLING = 2.0
BETA = 2.30  # per unit of width, for that oversampling
CELLS_PER_BLOCK = 1 << 19  # cells that a block of points is spread over: it stays near the cache
WIDTHS = range(4, 16)
ALIASED_ORDERS = 4  # Aliases of the fine grid that are counted; further ones are far smaller.
ROUNDING = 1e-15


def aliasing(half: int, width: int) -> NDArray[np.float64]:
    """Return (half + 1,) error bounds of the sums for |k| ≤ half along an axis, as shares of Σ |c|, by aliases of k."""
    side, k = _grid_side(half, width), np.arange(half + 1)
    aliased = sum(
        np.abs(_kernel_transform(k / side + m, width)) for m in range(-ALIASED_ORDERS, ALIASED_ORDERS + 1) if m
    )
    return aliased / _kernel_transform(k / side, width) + ROUNDING


class Spreading:
    """Sums Σ c exp(-i k·θ) for k from -half to half along each axis, with several strengths c of each point.

    half: largest k along an axis. width: of the kernel, in cells. count: the number of strengths of each point.
    """

    def __init__(self, half: int, width: int, count: int):
        self.half, self.width = half, width
        self.side = _grid_side(half, width)
        # along x some more cells, so that a block of neighbors covers one run of them
        self.cells = [np.zeros((self.side + width) * self.side**2) for _ in range(count)]

    def add(self, angles: NDArray[np.float64], strengths: NDArray[np.float64]) -> None:
        """Spread points at angles (3, p), in rad, with strengths (count, p)."""
        positions = angles * (self.side / (2.0 * np.pi)) % self.side
        positions[positions >= self.side] = 0.0  # Rounding makes tiny negative angles a full turn.
        order = np.argsort(positions[0])
        size = max(1, CELLS_PER_BLOCK // self.width**3)
        for start in range(0, len(order), size):
            some = order[start : start + size]
            self._spread(positions[:, some], strengths[:, some])

    def _spread(self, positions: NDArray, strengths: NDArray) -> None:
        n, w, p = self.side, self.width, positions.shape[1]
        steps = np.arange(w)
        first = np.floor(positions - w / 2.0) + 1.0
        kernel = _kernel(((first - positions)[..., None] + steps) * (2.0 / w), w)
        x, y, z = first.astype(np.int64)[..., None] + (steps + w // 2)
        y, z, low, high = y % n, z % n, int(x.min()), int(x.max()) + 1
        plane = (y[:, :, None] * n + z[:, None, :]).reshape(p, 1, w * w)
        index = ((x - low)[:, :, None] * (n * n) + plane).reshape(-1)
        plane = (kernel[1][:, :, None] * kernel[2][:, None, :]).reshape(p, 1, w * w)
        weights, run = np.empty((p, w, w * w)), slice(low * n * n, high * n * n)
        for cells, strength in zip(self.cells, strengths):
            np.multiply((kernel[0] * strength[:, None])[:, :, None], plane, out=weights)
            cells[run] += np.bincount(index, weights.reshape(-1), minlength=run.stop - run.start)

    def sums(self) -> Iterator[NDArray[np.complex128]]:
        """Yield the (2 half + 1, 2 half + 1, half + 1) sums of each strength, for k_z ≥ 0, and drop its cells."""
        n, along = self.side, np.arange(-self.half, self.half + 1)
        factor = np.exp(2j * np.pi / n * (self.width // 2) * along) / _kernel_transform(along / n, self.width)
        while self.cells:
            cells = self.cells.pop(0).reshape(-1, n, n)
            cells[: self.width] += cells[n:]
            waves = np.fft.rfftn(cells[:n])
            part = waves[np.ix_(along, along, along[self.half :])]
            part *= factor[:, None, None]
            part *= factor[None, :, None]
            part *= factor[None, None, self.half :]
            yield part


def _kernel(z: NDArray, width: int) -> NDArray[np.float64]:
    """Return the kernel at z, from -1 to 1 but for rounding."""
    inside = np.maximum(1.0 - z * z, 0.0)
    return np.exp(BETA * width * (np.sqrt(inside) - 1.0))


def _kernel_transform(frequencies: NDArray, width: int) -> NDArray[np.float64]:
    """Return ∫ kernel(2 t / width) exp(-2πi f t) dt over its support, by Gauss's rule."""
    nodes, weights = gauss_legendre(8 * width + 32)
    z = 2.0 * nodes - 1.0
    phases = np.pi * width * np.multiply.outer(frequencies, z)
    return (np.cos(phases) * (weights * _kernel(z, width))).sum(axis=-1) * width


def _grid_side(half: int, width: int) -> int:
    """Return the cells along a side of the fine grid: even, with small prime factors only, for a fast transform."""
    n = int(OVERSAMPLING * (2 * half + 1)) + width
    n += n % 2
    while _has_large_prime(n):
        n += 2
    return n


def _has_large_prime(n: int) -> bool:
    """Return whether a prime above 7 divides n."""
    for prime in (2, 3, 5, 7):
        while n % prime == 0:
            n //= prime
    return n > 1
