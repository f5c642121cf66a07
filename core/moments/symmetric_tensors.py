# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of one degree as symmetric tensors: contractions, rotations, distinct entries."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .exponents import tensor_index
from .moments import Moments, monomials


def distinct_arrays(arrays: NDArray, within: float) -> NDArray[np.float64]:
    """Return the (n, ...) vectors or matrices that differ from all earlier ones by at least `within` in some entry."""
    same = np.abs(arrays[:, None] - arrays[None]).max(axis=tuple(range(2, arrays.ndim + 1))) < within
    return arrays[np.argmax(same, axis=1) == np.arange(len(arrays))]


def invert_through_point(moments: Moments) -> Moments:
    """Return the moments of the body's point reflection in `about`: its mirror image, turned."""
    sign = (-1.0) ** monomials(moments.order).sum(axis=1)
    return replace(moments, raw=moments.raw * sign)


def _contract(tensor: NDArray, times: int, points: NDArray) -> NDArray[np.float64]:
    """Return (n, 3, ...) contractions of a symmetric tensor with each of (n, 3) points, `times` times (at least 1)."""
    out = np.tensordot(points, tensor, axes=(1, 0))
    for _ in range(times - 1):
        out = np.einsum("n...i,ni->n...", out, points)
    return out


def _rotate_tensor(tensor: NDArray, frames: NDArray) -> NDArray[np.float64]:
    """Return the (k, 3, ..., 3) entries of a symmetric tensor along the axes of k frames."""
    degree = tensor.ndim
    out = np.broadcast_to(tensor, (len(frames), *tensor.shape))
    for _ in range(degree):
        out = np.einsum("kai,ka...->k...i", frames, out)
    return out


@lru_cache
def _tensor_positions(degree: int) -> NDArray[np.int64]:
    """Return for each monomial of a degree, in storage order, its first index in the flattened tensor."""
    return np.unique(tensor_index(degree), return_index=True)[1]
