# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Principal frames of a stack of bodies, as far as second and third moments fix them.

The axes are the eigenvectors of the central second moments, largest first. An axis is scored by its
skewness, or if that is noise by the other third moments odd in that axis only; the two axes with
the clearest scores turn positive and the third completes a right-handed frame. Among frames that
are left, the nearest to preferred axes is chosen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from ..moments import SECOND_MOMENT_INDEX, THIRD_MOMENT_INDEX, Moments
from ..numerics import Array, ArrayLike, Index, Mask, NDArray, cross_rows, lengths
from .plain_body import EQUAL_AXES, EQUAL_MOMENTS_RTOL, EQUAL_TRACE_ATOL, SYMMETRIES

# a normalized third moment below this is noise: ten times the noise of float32 coordinates
NOISE_LEVEL = 1e-5
EQUAL_SCORES_RTOL = 1e-4  # scores closer than this, relatively, are equally clear
# For each axis i the axes i, j and k that its third moments M_iii, M_ijj and M_ikk pair it with.
PARTNER_AXES = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1]])
AXES = np.arange(3)
OWN_AXIS = AXES[:, None]
# Signs of the axes that keep a frame right-handed.
HALF_TURN_SIGNS = np.array(
    [signs for signs in product((1.0, -1.0), repeat=3) if np.prod(signs) > 0.0]
)

FIXED_AXIS = {"prolate": 0, "oblate": 2}  # the axis with the moment that differs
IS_FIXED = np.array([[axis not in EQUAL_AXES[name] for axis in range(3)] for name in SYMMETRIES])
MAX_TRACE_AMBIGUITY = (
    0.1  # traces farther apart never count as equal; closer than EQUAL_TRACE_ATOL, always
)
AXIS_RANK = np.array([4, 2, 1])  # axes that point along the preferred ones count in this order


@dataclass(frozen=True, eq=False)
class SecondMomentAxes:
    """Axes from second moments.

    axes: (3, 3) columns, det +1, largest second moment first. size: (3,) the extents (standard
    deviations) along them. undetermined_axes: the axes that equal moments leave free. step: shift
    of the points by float32, as a length. tilt: the angle by which this shift and rounding may have
    turned the other axes. noise: normalized third moments that differ by less are equal.
    """

    axes: Array
    size: Array
    undetermined_axes: tuple[int, ...]
    step: float
    tilt: float = 0.0
    noise: float = NOISE_LEVEL


@dataclass(frozen=True, eq=False)
class ThirdMomentFrames:
    """Frames of n bodies, as far as second and third moments fix them.

    `is_body`: True if the second moments can belong to a body at all.
    `moments`: (n, 3) principal moments of inertia, ascending.
    `axes`: (n, 3, 3) the axes as columns, determinant 1, largest second moment first.
    `size`: (n, 3) the extents (standard deviations) along them.
    `symmetry`: (n,) members of `SYMMETRIES`.
    `step`, `tilt`, `noise`: as in `SecondMomentAxes`.
    `allowed`: (n, 4) mask of the HALF_TURN_SIGNS that third moments allow on the axes.
    `skewness`, `skewness_error`: (n, 3) the skewness along the axes, and its noise.
    """

    is_body: Mask
    moments: Array
    axes: Array
    size: Array
    symmetry: Index
    step: Array
    tilt: Array
    noise: float
    allowed: Mask
    skewness: Array
    skewness_error: Array

    def free(self, i: int) -> tuple[int, ...]:
        """Return the axes of one body that equal moments leave free."""
        return EQUAL_AXES[SYMMETRIES[self.symmetry[i]]]

    def spread(self, i: int) -> SecondMomentAxes:
        """Return the axes that second moments give one body."""
        return SecondMomentAxes(
            self.axes[i],
            self.size[i],
            self.free(i),
            step=float(self.step[i]),
            tilt=float(self.tilt[i]),
            noise=self.noise,
        )

    def frames(self, i: int) -> Array:
        """Return the (k, 3, 3) right-handed frames of one body that third moments allow: signs of
        its axes.
        """
        return self.axes[i] * HALF_TURN_SIGNS[self.allowed[i], None]


@dataclass(frozen=True, eq=False)
class SecondMoments:
    """Central second moments of n bodies with positive totals, (n,) each.

    `shift`: (n, 3) center from the reference point. `spread`: (n, 3) eigenvalues over total and
    `scale`, largest first, and `axes`: (n, 3, 3) their vectors as columns, determinant 1.
    `rounding`: bounds of the spread's errors. `is_body`: true if a body can have them at all.
    """

    total: Array
    shift: Array
    scale: Array
    spread: Array
    axes: Array
    rounding: Array
    is_body: Mask

    @property
    def inertia(self) -> Array:
        """(n, 3) principal moments of inertia, ascending."""
        spread = self.spread
        return (spread[:, [1, 0, 0]] + spread[:, [2, 2, 1]]) * (self.scale * self.total)[:, None]


@np.errstate(all="ignore")  # callers check for overflow
def second_moments(moments: Moments) -> SecondMoments:
    """Return the central second moments of n bodies with positive totals, along their axes."""
    total = moments.raw[:, 0]
    shift = moments.raw[:, 1:4] / total[:, None]
    second = (
        moments.raw[:, SECOND_MOMENT_INDEX] / total[:, None, None]
        - shift[:, :, None] * shift[:, None, :]
    )
    scale = np.abs(second.trace(axis1=1, axis2=2))
    is_lost = total * scale < np.finfo(float).tiny
    scale[scale == 0.0] = 1.0  # keeps eigh clear of overflow and denormals
    spread, axes = np.linalg.eigh(second / scale[:, None, None])
    spread = spread[:, ::-1]
    axes = axes[:, :, ::-1].copy()
    axes[:, :, 2] *= np.sign(np.linalg.det(axes))[:, None]
    rounding = (
        4.0 * moments.rounding_error[:, 4:10].max(axis=1) / (total * scale)
        + 8.0 * np.finfo(float).eps
    )
    is_body = (spread[:, 2] >= -rounding) & ~is_lost
    return SecondMoments(total, shift, scale, np.maximum(spread, 0.0), axes, rounding, is_body)


@np.errstate(all="ignore")  # callers check for overflow
def third_moment_frames(
    moments: Moments,
    refine: Callable[[Index], Moments] | None = None,
    noise_factor: float = 1.0,
    second: SecondMoments | None = None,
) -> ThirdMomentFrames:
    """Find the frames, as far as second and third moments fix them, of n bodies with positive
    totals.

    The moments are to order 3 at least. `refine` returns the moments with exact third order of
    given bodies; it is called if bounds do not decide. `noise_factor` multiplies NOISE_LEVEL.
    `second`: the bodies' `second_moments`, if they are known.
    """
    second = second or second_moments(moments)
    total, scale, spread, axes = second.total, second.scale, second.spread, second.axes
    # A lamina has no extent along an axis, and no skewness: 1e-15 of the largest extent is noise.
    unit_size = np.sqrt(np.maximum(spread, 1e-30 * spread[:, :1]))
    # Shift of the points by float32: the share of the volume that this moves, times the thinnest
    # extent.
    step = moments.input_error[:, 0] / total * unit_size[:, 2]
    gaps = spread[:, :2] - spread[:, 1:]  # between axes 1 and 2, and 2 and 3
    doubtful = (2.0 * step)[:, None] * unit_size[:, :2] + second.rounding[:, None]
    equal = gaps <= noise_factor * EQUAL_MOMENTS_RTOL * spread[:, :2] + doubtful
    tilts = np.where(equal, 0.0, doubtful / np.where(equal, 1.0, gaps))
    symmetry = 2 * equal[:, 0] + equal[:, 1]

    noise = noise_factor * NOISE_LEVEL + (4.0 * step)[:, None, None] / np.minimum(
        unit_size[:, :, None], unit_size[:, PARTNER_AXES]
    )
    size = unit_size * np.sqrt(scale)[:, None]
    skewness, skewness_error = _third_scores(moments, second.shift, size, axes, symmetry)
    # Two axes that noise may have turned about the third one mix the third moments along them.
    tilt_between = np.zeros((len(total), 3, 3))
    tilt_between[:, 0, 1] = tilt_between[:, 1, 0] = tilts[:, 0]
    tilt_between[:, 1, 2] = tilt_between[:, 2, 1] = tilts[:, 1]
    span = gaps.sum(axis=1)
    outer_tilt = np.where(
        symmetry == 3, 0.0, doubtful.max(axis=1) / np.where(span > 0.0, span, 1.0)
    )
    tilt_between[:, 0, 2] = tilt_between[:, 2, 0] = outer_tilt
    mixed = (tilt_between * (np.abs(skewness) + skewness_error).max(axis=2)[:, None]).sum(axis=2)
    noise += 3.0 * mixed[:, :, None]  # a third moment has three factors that the tilt mixes
    is_fixed = IS_FIXED[symmetry]
    third, error = skewness, skewness_error
    if refine is not None:
        undecided = np.flatnonzero(~_are_decided(np.abs(skewness), skewness_error, noise, is_fixed))
        if len(undecided):
            third, error = third.copy(), error.copy()
            third[undecided], error[undecided] = _third_scores(
                refine(undecided),
                second.shift[undecided],
                size[undecided],
                axes[undecided],
                symmetry[undecided],
            )
    # The score of an axis is its first third moment that is more than noise, else 0.
    is_clear = np.abs(third) > noise + error
    first_clear = is_clear.argmax(axis=2)
    is_scored = is_fixed & is_clear.any(axis=2)
    body = np.arange(len(third))[:, None]
    scores, unsure = [
        np.where(is_scored, values[body, AXES, first_clear], 0.0)
        for values in (third, noise + error)
    ]
    return ThirdMomentFrames(
        is_body=second.is_body,
        moments=second.inertia,
        axes=axes,
        size=size,
        symmetry=symmetry,
        step=step * np.sqrt(scale),
        tilt=tilts.max(axis=1),
        noise=noise_factor * NOISE_LEVEL,
        allowed=_allowed_signs(scores, unsure.max(axis=1)),
        skewness=skewness[:, :, 0],
        skewness_error=noise[:, :, 0] + skewness_error[:, :, 0],
    )


def _are_decided(size: NDArray, error: NDArray, noise: NDArray, fixed: Mask) -> Mask:
    """Return an (n,) mask of bodies with frames that more exact third moments could not change.

    size, error, noise: (n, 3, 3) absolute third moments of each axis, their error bounds, and
    noise. fixed: (n, 3) mask of axes.
    """
    clear = size - error > noise
    below = size + error <= noise
    has_score = (clear[:, :, 0] | (clear | below).all(axis=2) | ~fixed).all(axis=1)
    body = np.arange(len(size))[:, None]
    first_clear = clear.argmax(axis=2)
    size = size[body, AXES, first_clear]
    error = error[body, AXES, first_clear]
    noise = noise[body, AXES, first_clear]
    # Of three scores the least one is dropped: both others have to be clear of it.
    least = size[body, size.argmin(axis=1)[:, None]]
    unsure = (noise + error).max(axis=1, keepdims=True)
    is_above = size - least > EQUAL_SCORES_RTOL * least + 2.0 * (error + unsure)
    has_three_scores = (fixed & clear.any(axis=2)).all(axis=1)
    return has_score & ((is_above.sum(axis=1) == 2) | ~has_three_scores)


def _third_scores(
    moments: Moments, shift: NDArray, size: NDArray, axes: NDArray, symmetry: Index
) -> tuple[NDArray, NDArray]:
    """Return (n, 3, 3) normalized M_iii, M_ijj, M_ikk of axes i (means if j and k are free), and
    error bounds.
    """
    count = len(shift)
    total = moments.raw[:, 0]
    second = moments.raw[:, SECOND_MOMENT_INDEX] / total[:, None, None]
    third = moments.raw[:, THIRD_MOMENT_INDEX] / total[:, None, None, None]
    outer = shift[:, :, None] * shift[:, None, :]
    across = shift[:, :, None, None]
    cross = across * second[:, None]
    third = (
        third
        - cross
        - cross.transpose(0, 2, 1, 3)
        - cross.transpose(0, 2, 3, 1)
        + 2.0 * across * outer[:, None]
    )
    of_second = 3.0 * np.abs(shift).max(axis=1) * moments.rounding_error[:, 4:10].max(axis=1)
    error = (
        moments.rounding_error[:, THIRD_MOMENT_INDEX] + of_second[:, None, None, None]
    ) / total[:, None, None, None]
    squares = (axes[:, :, None] * axes[:, None]).reshape(count, 9, 3)
    unit = size[:, :, None] * size[:, PARTNER_AXES] ** 2
    turned = axes.transpose(0, 2, 1)
    scores = turned @ third.reshape(count, 3, 9) @ squares
    score_error = np.abs(turned) @ error.reshape(count, 3, 9) @ np.abs(squares)
    scores = scores[:, OWN_AXIS, PARTNER_AXES] / unit
    score_error = score_error[:, OWN_AXIS, PARTNER_AXES] / unit
    for name, axis in FIXED_AXIS.items():
        bodies = np.flatnonzero(symmetry == SYMMETRIES.index(name))
        if len(bodies):
            for values in (scores, score_error):
                values[bodies, axis, 1:] = values[bodies, axis, 1:].mean(axis=1, keepdims=True)
    return scores, score_error


def _allowed_signs(scores: NDArray, unsure: NDArray) -> Mask:
    """Return an (n, 4) mask of the HALF_TURN_SIGNS that agree with (n, 3) scores; (n,) `unsure` is
    their noise.
    """
    size = np.abs(scores)
    counts = scores != 0.0
    # The weakest of three is dropped; the last of equal ones.
    weak = size <= size.min(axis=1, keepdims=True) * (1.0 + EQUAL_SCORES_RTOL) + unsure[:, None]
    last = 2 - weak[:, ::-1].argmax(axis=1)
    counts = counts & ~(counts.all(axis=1)[:, None] & (last[:, None] == AXES))
    return ((HALF_TURN_SIGNS * scores[:, None] > 0.0) | ~counts[:, None]).all(axis=2)


def complete_free_axes(frames: NDArray, free: tuple[int, ...], preferred_axes: NDArray) -> Array:
    """Return the (..., 3, 3) frames with their free axes, if any, turned nearest to the preferred
    ones.
    """
    if not free:
        return frames
    shape = np.broadcast_shapes(frames.shape, preferred_axes.shape)
    preferred_axes = np.broadcast_to(preferred_axes, shape)
    if len(free) == 3:
        return preferred_axes.copy()
    first, second = free
    completed = np.array(np.broadcast_to(frames, shape))
    fixed = completed[..., 3 - first - second]
    # (first, second, fixed) is right-handed for both pairs: maximize first·p1 + (fixed x first)·p2
    # over the plane.
    direction = _across(
        preferred_axes[..., first] + cross_rows(preferred_axes[..., second], fixed), fixed
    )
    # If the fixed axis points against its preferred one, any direction may be as near: that along a
    # preferred axis is taken.
    is_opposite = np.linalg.norm(direction, axis=-1) < 1e-6
    if is_opposite.any():
        cosines = np.abs(np.einsum("...a,...ai->...i", fixed, preferred_axes))
        perpendicular = cosines.argmin(axis=-1)[..., None, None]
        nearest = np.take_along_axis(preferred_axes, perpendicular, -1)[..., 0]
        direction = np.where(is_opposite[..., None], _across(nearest, fixed), direction)
    completed[..., first] = direction / lengths(direction)
    completed[..., second] = cross_rows(fixed, completed[..., first])
    return completed


def _across(vectors: NDArray, axis: NDArray) -> Array:
    """Return the (..., 3) parts of vectors perpendicular to unit vectors."""
    return vectors - axis * np.einsum("...a,...a->...", axis, vectors)[..., None]


def nearest_frames(candidates: NDArray, preferred_axes: NDArray, tilt: ArrayLike) -> Array:
    """Return (m, 3, 3) frames, one of each row of (m, k, 3, 3) candidates, nearest to the (m, 3, 3)
    preferred axes.

    Among equally near frames the choice is the frame whose axes, in order, point along the
    preferred axes rather than against them, so that noise cannot flip it. tilt: the angle by which
    noise may have turned the candidates, one or (m,).
    """
    if candidates.shape[1] == 1:
        return candidates[:, 0] + 0.0
    local = preferred_axes.transpose(0, 2, 1)[:, None] @ candidates
    equal = EQUAL_TRACE_ATOL + np.minimum(
        4.0 * np.asarray(tilt).reshape(-1, 1), MAX_TRACE_AMBIGUITY
    )
    traces = local.trace(axis1=2, axis2=3)
    is_left = traces > traces.max(axis=1, keepdims=True) - equal
    size = np.abs(local)
    # the preferred axis nearest to each axis
    row = (size > size.max(axis=2, keepdims=True) - equal[..., None, None]).argmax(axis=2)
    body = np.arange(len(local))[:, None, None]
    is_along = local[body, np.arange(local.shape[1])[:, None], row, AXES] > 0.0
    rank = np.where(is_left, is_along @ AXIS_RANK, -1)
    is_left = rank == rank.max(axis=1, keepdims=True)
    # If several frames are still left, their first entries that differ decide.
    for entries in local.reshape(*local.shape[:2], 9).transpose(2, 0, 1):
        entries = np.where(is_left, entries, -np.inf)
        is_left = entries > entries.max(axis=1, keepdims=True) - equal
    return candidates[body[:, 0, 0], is_left.argmax(axis=1)] + 0.0  # no negative zeros
