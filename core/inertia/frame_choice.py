# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Choice of a body's frame: along the axes that second moments fix, and nearest to preferred axes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.arrays import cross_rows, lengths
from .plain_body import EQUAL_TRACE_ATOL
from .third_moment_frames import AXES, IS_FIXED, ThirdMomentFrames

MAX_TRACE_AMBIGUITY = 0.1  # traces farther apart never count as equal; closer than EQUAL_TRACE_ATOL, always
AXIS_RANK = np.array([4, 2, 1])  # axes that point along the preferred ones count in this order
MIN_ALIGNED_COSINE = 0.999  # between an axis fixed by second moments and the same axis of a copy


def align_frames(frames: NDArray, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return (m, k, 3, 3) frames, turned so that their axes fixed by second moments lie along the bodies' axes."""
    is_fixed = IS_FIXED[fixed.symmetry[bodies]]
    if not is_fixed.any():
        return frames
    along = np.einsum("mai,mkai->mki", fixed.axes[bodies], frames)
    near = fixed.axes[bodies][:, None] * np.sign(along)[:, :, None]
    # a frame stays if its axes were found among equal moments but the body's are not, or the other way round
    alike = ~is_fixed | (np.abs(along) > MIN_ALIGNED_COSINE).all(axis=1)
    is_fixed = is_fixed & alike.all(axis=1, keepdims=True)
    frames = np.where(is_fixed[:, None, None], near, frames)
    for axis in range(3):
        alone = np.flatnonzero(is_fixed[:, axis] & (is_fixed.sum(axis=1) == 1))
        if len(alone):
            first, second = (axis + 1) % 3, (axis + 2) % 3
            pole = frames[alone, :, :, axis]
            side = frames[alone, :, :, first]
            side = side - pole * np.einsum("mka,mka->mk", pole, side)[..., None]
            side /= lengths(side)
            frames[alone, :, :, first], frames[alone, :, :, second] = side, cross_rows(pole, side)
    return frames


def complete_free_axes(frames: NDArray, free: tuple[int, ...], preferred_axes: NDArray) -> NDArray[np.float64]:
    """Return the (..., 3, 3) frames with their free axes, if any, turned nearest to the preferred ones."""
    if not free:
        return frames
    shape = np.broadcast_shapes(frames.shape, preferred_axes.shape)
    preferred_axes = np.broadcast_to(preferred_axes, shape)
    if len(free) == 3:
        return preferred_axes.copy()
    first, second = free
    completed = np.array(np.broadcast_to(frames, shape))
    fixed = completed[..., 3 - first - second]
    # (first, second, fixed) is right-handed for both pairs: maximize first·p1 + (fixed x first)·p2 over the plane.
    wish = _across(preferred_axes[..., first] + cross_rows(preferred_axes[..., second], fixed), fixed)
    # half a turn away any direction is as near: the one along a preferred axis is taken
    opposite = np.linalg.norm(wish, axis=-1) < 1e-6
    if opposite.any():
        cosines = np.abs(np.einsum("...a,...ai->...i", fixed, preferred_axes))
        nearest = np.take_along_axis(preferred_axes, cosines.argmin(axis=-1)[..., None, None], -1)[..., 0]
        wish = np.where(opposite[..., None], _across(nearest, fixed), wish)
    completed[..., first] = wish / lengths(wish)
    completed[..., second] = cross_rows(fixed, completed[..., first])
    return completed


def _across(vectors: NDArray, axis: NDArray) -> NDArray[np.float64]:
    """Return the (..., 3) parts of vectors perpendicular to unit vectors."""
    return vectors - axis * np.einsum("...a,...a->...", axis, vectors)[..., None]


def nearest_frames(candidates: NDArray, preferred_axes: NDArray, tilt: ArrayLike) -> NDArray[np.float64]:
    """Return (m, 3, 3) frames, one of each row of (m, k, 3, 3) candidates, nearest to the (m, 3, 3) preferred axes.

    Among equally near frames the choice is the frame whose axes, in order, point along the preferred axes rather than
    against them, so that noise cannot flip it. tilt: the angle by which noise may have turned the candidates, one or
    (m,).
    """
    if candidates.shape[1] == 1:
        return candidates[:, 0] + 0.0
    local = preferred_axes.transpose(0, 2, 1)[:, None] @ candidates
    equal = EQUAL_TRACE_ATOL + np.minimum(4.0 * np.asarray(tilt).reshape(-1, 1), MAX_TRACE_AMBIGUITY)
    turns = local.trace(axis1=2, axis2=3)
    near = turns > turns.max(axis=1, keepdims=True) - equal
    size = np.abs(local)
    row = (size > size.max(axis=2, keepdims=True) - equal[..., None, None]).argmax(axis=2)
    body, candidate = np.arange(len(local))[:, None, None], np.arange(local.shape[1])[:, None]
    is_along = local[body, candidate, row, AXES] > 0.0
    rank = np.where(near, is_along @ AXIS_RANK, -1)
    near = rank == rank.max(axis=1, keepdims=True)
    for entry in local.reshape(*local.shape[:2], 9).transpose(2, 0, 1):  # several frames may still be left
        entry = np.where(near, entry, -np.inf)
        near = entry > entry.max(axis=1, keepdims=True) - equal
    return candidates[body[:, 0, 0], near.argmax(axis=1)] + 0.0  # no negative zeros
