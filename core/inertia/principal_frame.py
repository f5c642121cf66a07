# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The principal frame of a body, made unique where the body allows it.

The axes are the eigenvectors of the central second moments, largest first, so that axis 1 is the long axis (least
inertia). Their signs follow Zhang and Chen (ICIP 2001, eq. 11): central third moments positive. Their rule fails on
every body with a mirror plane, where M_300 is noise, so it is made robust: an axis is scored by its skewness, or where
that is noise by the other third moments odd in that axis only; the two axes with the clearest scores turn positive and
the third completes a right-handed frame. What equal moments or a want of skewness leave, moments to sixth order decide
(see `canonical_frame`). What is still free is the body's own freedom: there the frame nearest to the axes that the
caller prefers is taken, and `finding` says so.

The pose of a body is its center at the origin and that frame along the axes: two copies of a part, however they lie and
whatever their faces, have one pose.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..moments.moments import SECOND_MOMENT_INDEX, THIRD_MOMENT_INDEX, Moments
from ..verdict.finding import Finding, MeasureError, finding
from .canonical_frame import NOISE_LEVEL, EquivalentFrames, SecondMomentAxes, canonical_frames

EQUAL_MOMENTS_RTOL = 1e-6  # moments closer than this, relatively, are equal
EQUAL_SCORES_RTOL = 1e-4  # scores closer than this, relatively, are equally clear
# traces closer than the one are equal whatever the noise, than the other never
EQUAL_TRACE_ATOL, MAX_TRACE_AMBIGUITY = 1e-6, 0.1
# For each axis i the axes i, j and k that its third moments M_iii, M_ijj and M_ikk pair it with.
PARTNER_AXES = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1]])
OWN_AXIS = np.arange(3)[:, None]
# keep the frame's hand
HALF_TURN_SIGNS = np.array([signs for signs in product((1.0, -1.0), repeat=3) if np.prod(signs) > 0.0])

# by symmetry, the axes whose moments are equal
EQUAL_AXES = {"isotropic": (0, 1, 2), "prolate": (1, 2), "oblate": (0, 1), "asymmetric": ()}
# What was chosen where the body leaves a choice: the object's own directions, or of the body's own ones the nearest.
FREE = {
    "isotropic": finding("axes_all_free"),
    "prolate": finding("axes_2_3_free"),
    "oblate": finding("axes_1_2_free"),
    "asymmetric": finding("axes_ambiguous"),
}
FREE_BY_SHAPE = {
    "isotropic": finding("axes_all_free_by_shape"),
    "prolate": finding("axes_2_3_free_by_shape"),
    "oblate": finding("axes_1_2_free_by_shape"),
    "asymmetric": finding("axes_ambiguous"),
}


@dataclass(frozen=True, eq=False)
class PrincipalFrame:
    """Principal moments and axes of one body.

    Attributes
    ----------
    moments : (3,) array
        Principal moments of inertia, ascending.
    axes : (3, 3) array
        The axes as columns, determinant 1. Axis 1 is the long one.
    symmetry : str
        "asymmetric", "prolate" (moments 2 and 3 equal), "oblate" (1 and 2 equal) or "isotropic".
    is_unique : bool
        Whether the body alone fixes the frame.
    finding : Finding or None
        What was chosen where it does not.
    undetermined_axes : tuple of int
        The axes whose directions nothing that was looked at fixes.

    Examples
    --------
    >>> from body_moments.core.inertia import PrincipalFrame
    >>> frame = PrincipalFrame(np.array([1.0, 2.0, 2.5]), np.eye(3), "asymmetric", True, None)
    >>> frame.rotate(np.diag([-1.0, -1.0, 1.0])).axes.diagonal().tolist()
    [-1.0, -1.0, 1.0]
    """

    moments: NDArray[np.float64]
    axes: NDArray[np.float64]
    symmetry: str
    is_unique: bool
    finding: Finding | None
    undetermined_axes: tuple[int, ...] = ()

    def rotate(self, rotation: NDArray) -> PrincipalFrame:
        """Return the same frame in coordinates new = rotation @ old."""
        return replace(self, axes=rotation @ self.axes)


def principal_frame(
    moments: Moments,
    preferred_axes: NDArray | None = None,
    refine: Callable[[], Moments] | None = None,
    higher: Callable[[], Moments] | None = None,
) -> PrincipalFrame:
    """Return the principal frame of a body with positive total.

    Parameters
    ----------
    moments : Moments
        To order 3 at least.
    preferred_axes : (3, 3) array, optional
        A rotation whose columns are the axes to stay near to, where the body leaves a choice; by default the coordinate
        axes.
    refine : callable, optional
        Returns the moments with exact third order; called where their bounds do not decide.
    higher : callable, optional
        Returns the moments to order `canonical_frame.MAX_ORDER`; called where third order leaves a choice.

    Returns
    -------
    PrincipalFrame

    Raises
    ------
    MeasureError
        If the second moments are those of no body.

    Notes
    -----
    Zhang and Chen 2001, eq. 11, made robust; see the module.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments, principal_frame
    >>> surface = Surface.from_triangles(
    ...     np.eye(4, 3, -1) * (3, 2, 1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    ... )
    >>> frame = principal_frame(polyhedron_moments(surface)[0])
    >>> frame.symmetry, frame.is_unique, np.round(frame.moments, 4).tolist()
    ('asymmetric', True, [0.1589, 0.3886, 0.5025])
    """
    preferred_axes = np.eye(3) if preferred_axes is None else np.asarray(preferred_axes, np.float64)
    fixed = _second_order_frame(moments, refine)
    free, symmetry, chosen = fixed.spread.undetermined_axes, fixed.symmetry, None
    if not free and len(fixed.frames) == 1:
        axes = fixed.frames[0]
    elif higher is None:
        settled_frames = [complete_free_axes(frame, free, preferred_axes) for frame in fixed.frames]
        axes, chosen = _nearest(settled_frames, preferred_axes, fixed.spread.tilt), FREE[symmetry]
    else:
        alike = canonical_frames(higher(), fixed.spread, fixed.frames)
        axes, free = nearest_frame(alike, preferred_axes), undetermined_axes(alike)
        if alike.revolution_axes or len(alike.frames) > 1:
            chosen = (FREE if alike.revolution_axes else FREE_BY_SHAPE)[symmetry]
    return PrincipalFrame(fixed.moments, axes, symmetry, chosen is None, chosen, free)


def equivalent_frames(moments: Moments, noise: float = NOISE_LEVEL) -> EquivalentFrames:
    """Return the principal frames in which the body is the same.

    Parameters
    ----------
    moments : Moments
        To order 3 at least; the frames are alike to their order.
    noise : float
        Normalized third moments below this count as zero; the tolerance of the others grows with it.

    Returns
    -------
    EquivalentFrames
        `frames` (k, 3, 3) and what no moment fixes.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> from body_moments.core.inertia import equivalent_frames
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> len(equivalent_frames(polyhedron_moments(surface, 6)[0]).frames)
    3
    """
    fixed = _second_order_frame(moments, None, noise / NOISE_LEVEL)
    return canonical_frames(moments, fixed.spread, fixed.frames)


def nearest_frame(equivalent: EquivalentFrames, preferred_axes: NDArray) -> NDArray[np.float64]:
    """Return, of the frames in which a body is the same, the one nearest to the preferred axes.

    Parameters
    ----------
    equivalent : EquivalentFrames
        As `equivalent_frames` returns them.
    preferred_axes : (3, 3) array
        A rotation, its axes as columns.

    Returns
    -------
    (3, 3) array
        The axes as columns.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> from body_moments.core.inertia import equivalent_frames, nearest_frame
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> frame = nearest_frame(equivalent_frames(polyhedron_moments(surface, 6)[0]), np.eye(3))
    >>> round(float(np.linalg.det(frame)), 9)
    1.0
    """
    return _nearest(
        [complete_free_axes(frame, undetermined_axes(equivalent), preferred_axes) for frame in equivalent.frames],
        preferred_axes,
        equivalent.tilt,
    )


def undetermined_axes(equivalent: EquivalentFrames) -> tuple[int, ...]:
    """The axes whose directions no moment fixes."""
    return (
        (tuple(i for i in range(3) if i not in equivalent.revolution_axes) or (0, 1, 2))
        if equivalent.revolution_axes
        else ()
    )


def zhang_chen_frame(moments: Moments, refine: Callable[[], Moments] | None = None) -> PrincipalFrame:
    """Return the frame by Zhang and Chen's own rule: axes 1 and 2 in the direction of positive M_300 and M_030.

    Parameters
    ----------
    moments : Moments
        To order 3 at least.
    refine : callable, optional
        As for `principal_frame`.

    Returns
    -------
    PrincipalFrame

    Raises
    ------
    MeasureError
        If one of the two moments is noise, or second moments are equal: the rule has no answer there.

    Notes
    -----
    Zhang and Chen, ICIP 2001, eq. 11. Axis 3 completes a right-handed frame.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> from body_moments.core.inertia import zhang_chen_frame
    >>> surface = Surface.from_triangles(
    ...     np.eye(4, 3, -1) * (3, 2, 1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    ... )
    >>> zhang_chen_frame(polyhedron_moments(surface)[0]).is_unique
    True
    """
    fixed = _second_order_frame(moments, None)
    if refine is not None and not (np.abs(fixed.skewness[:2]) > 2.0 * fixed.skewness_error[:2]).all():
        fixed = _second_order_frame(refine(), None)
    if fixed.spread.undetermined_axes:
        raise MeasureError("strict_rule_equal_moments")
    if not (np.abs(fixed.skewness[:2]) > fixed.skewness_error[:2]).all():
        raise MeasureError("strict_rule_no_skewness")
    axes = fixed.spread.axes.copy()
    axes[:, :2] *= np.sign(fixed.skewness[:2])
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return PrincipalFrame(fixed.moments, axes, fixed.symmetry, True, None)


def pose_matrix(center: NDArray, axes: NDArray) -> NDArray[np.float64]:
    """Return the matrix that brings the center to the origin and the axes along x, y and z.

    Parameters
    ----------
    center : (3,) array
    axes : (3, 3) array
        A rotation, its axes as columns.

    Returns
    -------
    (4, 4) array
        For column vectors: pose = matrix @ (x, y, z, 1).

    Examples
    --------
    >>> from body_moments.core import pose_matrix
    >>> pose_matrix(np.array([1.0, 2.0, 3.0]), np.eye(3))[:3, 3].tolist()
    [-1.0, -2.0, -3.0]
    """
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = axes.T, -axes.T @ center
    return matrix + 0.0  # no negative zeros


@dataclass(frozen=True, eq=False)
class _SecondOrderFrame:
    """What second and third moments fix. moments: (3,) principal. frames: (k, 3, 3) those they allow: signs of axes
    only. skewness, skewness_error: (3,) the skewness along the spread's axes and what of it is noise."""

    moments: NDArray[np.float64]
    spread: SecondMomentAxes
    symmetry: str
    frames: NDArray[np.float64]
    skewness: NDArray[np.float64]
    skewness_error: NDArray[np.float64]


def _second_order_frame(
    moments: Moments, refine: Callable[[], Moments] | None, noise_factor: float = 1.0
) -> _SecondOrderFrame:
    total = moments.raw[0]
    shift = moments.raw[1:4] / total
    second = moments.raw[SECOND_MOMENT_INDEX] / total - np.outer(shift, shift)
    scale = abs(np.trace(second)) or 1.0  # keeps eigh clear of overflow and denormals
    spread, vectors = np.linalg.eigh(second / scale)
    spread, axes = spread[::-1], vectors[:, ::-1]
    axes = axes * [1.0, 1.0, np.sign(np.linalg.det(axes))]
    rounding = 4.0 * moments.rounding_error[SECOND_MOMENT_INDEX].max() / (total * scale) + 8.0 * np.finfo(float).eps
    if spread[2] < -rounding:
        raise MeasureError("negative_inertia")
    spread = np.maximum(spread, 0.0)

    size = np.sqrt(np.maximum(spread, 1e-30 * spread[0]))  # a lamina has no extent along an axis, and no skewness
    # How far float32 has moved the points: the share of the volume that this moves, times the thinnest extent.
    step = moments.input_error[0] / total * size[2]
    gaps = np.array([spread[0] - spread[1], spread[1] - spread[2]])
    doubtful = 2.0 * step * size[:2] + rounding
    equal = gaps <= noise_factor * EQUAL_MOMENTS_RTOL * spread[:2] + doubtful
    tilts = np.where(equal, 0.0, doubtful / np.where(equal, 1.0, gaps))  # of axes 1 and 2, and of 2 and 3
    symmetry = "isotropic" if equal.all() else "oblate" if equal[0] else "prolate" if equal[1] else "asymmetric"

    free = EQUAL_AXES[symmetry]
    noise = noise_factor * NOISE_LEVEL + 4.0 * step / np.minimum(size[:, None], size[PARTNER_AXES])
    real = size * np.sqrt(scale)
    skewness, skewness_error = _third_scores(moments, shift, real, axes)
    # Two axes that noise may have turned about the third one mix what the body has along them.
    (first_tilt, second_tilt), both = tilts, 0.0 if equal.all() else float(doubtful.max() / gaps.sum())
    tilts_matrix = np.array([[0.0, first_tilt, both], [first_tilt, 0.0, second_tilt], [both, second_tilt, 0.0]])
    noise += 3.0 * (tilts_matrix * (np.abs(skewness) + skewness_error).max(axis=1)).sum(axis=1)[:, None]
    scores, fixed = np.zeros(3), [i for i in range(3) if i not in free]
    if fixed:
        third = skewness, skewness_error
        if refine is not None and not _is_decided(np.abs(skewness[fixed]), skewness_error[fixed], noise[fixed]):
            third = _third_scores(refine(), shift, real, axes)
        values, errors = third[0][fixed], third[1][fixed]
        is_clear = np.abs(values) > noise[fixed] + errors
        first = np.arange(len(fixed)), is_clear.argmax(axis=1)  # zero where none of them is more than noise
        scores[fixed] = np.where(is_clear[first], values[first], 0.0)
    inertia = (spread[[1, 0, 0]] + spread[[2, 2, 1]]) * (scale * total)
    extents = SecondMomentAxes(axes, real, free, step * np.sqrt(scale), float(tilts.max()), noise_factor * NOISE_LEVEL)
    return _SecondOrderFrame(
        inertia,
        extents,
        symmetry,
        _sign_consistent_frames(axes, scores),
        skewness[:, 0],
        noise[:, 0] + skewness_error[:, 0],
    )


def _is_decided(size: NDArray, error: NDArray, noise: NDArray) -> bool:
    """Whether better third moments could neither change which scores count, nor their signs, nor their order."""
    clear = size - error > noise
    below = size + error <= noise
    if not (clear[:, 0] | (clear | below).all(axis=1)).all():
        return False
    if len(size) < 3 or not clear.any(axis=1).all():
        return True
    axis_index, first = np.arange(3), clear.argmax(axis=1)
    size, error = size[axis_index, first], error[axis_index, first]
    last = np.argsort(size)[:2]  # of three scores, which one is the last
    return size[last[1]] - size[last[0]] > 2.0 * error[last].sum()


def _third_scores(moments: Moments, shift: NDArray, size: NDArray, axes: NDArray) -> tuple[NDArray, NDArray]:
    """(3, 3) for each axis i its skewness and the two normalized third moments odd in i and even in another axis,
    M_iii, M_ijj and M_ikk; and the bounds of their errors."""
    total = moments.raw[0]
    second, third = moments.raw[SECOND_MOMENT_INDEX] / total, moments.raw[THIRD_MOMENT_INDEX] / total
    outer = np.outer(shift, shift)
    cross = shift[:, None, None] * second
    third = third - cross - cross.transpose(1, 0, 2) - cross.transpose(1, 2, 0) + 2.0 * shift[:, None, None] * outer
    error = (
        moments.rounding_error[THIRD_MOMENT_INDEX]
        + 3.0 * np.abs(shift).max() * moments.rounding_error[SECOND_MOMENT_INDEX].max()
    ) / total
    squares = (axes[:, None] * axes).reshape(9, 3)
    unit = size[:, None] * size[PARTNER_AXES] ** 2
    scores, score_error = axes.T @ third.reshape(3, 9) @ squares, np.abs(axes.T) @ error.reshape(3, 9) @ np.abs(squares)
    return scores[OWN_AXIS, PARTNER_AXES] / unit, score_error[OWN_AXIS, PARTNER_AXES] / unit


def _sign_consistent_frames(axes: NDArray, scores: NDArray) -> NDArray[np.float64]:
    """(k, 3, 3) the right-handed frames along the axes that agree with the scores."""
    size = np.abs(scores)
    fixed = [i for i in range(3) if scores[i]]
    if len(fixed) == 3:  # the weakest is dropped; of equal ones the last
        fixed.remove(max([i for i in fixed if size[i] <= size.min() * (1.0 + EQUAL_SCORES_RTOL)]))
    return axes * HALF_TURN_SIGNS[(HALF_TURN_SIGNS[:, fixed] * scores[fixed] > 0.0).all(axis=1), None]


def complete_free_axes(frame: NDArray, free: tuple[int, ...], preferred_axes: NDArray) -> NDArray[np.float64]:
    """The frame with its free axes, if any, turned nearest to the preferred ones."""
    if not free:
        return frame
    if len(free) == 3:
        return preferred_axes.copy()
    first, second = free
    fixed = frame[:, 3 - first - second]
    # (first, second, fixed) is right-handed for both pairs: maximize first·p1 + (fixed x first)·p2 over the plane.
    wish = preferred_axes[:, first] + np.cross(preferred_axes[:, second], fixed)
    wish = wish - fixed * (fixed @ wish)
    if np.linalg.norm(wish) < 1e-6:  # half a turn away: any direction is as near; take the one along a preferred axis
        wish = preferred_axes[:, np.argmin(np.abs(fixed @ preferred_axes))]
        wish = wish - fixed * (fixed @ wish)
    completed = frame.copy()
    completed[:, first] = wish / np.linalg.norm(wish)
    completed[:, second] = np.cross(fixed, completed[:, first])
    return completed


def _nearest(candidates: Sequence[NDArray], preferred_axes: NDArray, tilt: float) -> NDArray[np.float64]:
    """The frame with the smallest turn from the preferred one. Where several are as near, the one whose axes, in
    order, point along rather than against their preferred axes, so that noise cannot flip it.

    tilt: the angle by which noise may have turned the candidates.
    """
    local = preferred_axes.T @ np.array(candidates)
    equal = EQUAL_TRACE_ATOL + min(4.0 * tilt, MAX_TRACE_AMBIGUITY)
    turns = np.trace(local, axis1=1, axis2=2)
    near = np.flatnonzero(turns > turns.max() - equal)

    def along(i: int) -> list[bool]:
        columns = np.abs(local[i]) > np.abs(local[i]).max(axis=0) - equal
        return [bool(local[i][np.argmax(columns[:, axis]), axis] > 0.0) for axis in range(3)]

    ways = [along(i) for i in near.tolist()]
    near = near[[way == max(ways) for way in ways]]
    for entry in local.reshape(-1, 9).T:  # what is left may still be several frames, in an order of no meaning
        near = near[entry[near] > entry[near].max() - equal]
    return candidates[near[0]] + 0.0  # no negative zeros
