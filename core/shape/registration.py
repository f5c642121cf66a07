# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration of one body onto another by their poses, and the residual between them.

The pose leaves as many choices as the body has rotations, and all of them are tried. So are half turns about the
axes, as noise may decide a sign. The residual is measured on the surfaces, in both directions, so that neither may be
a part of the other; if a few points are farther apart than all points under a better rotation, the
other points are skipped. A mirror image is recognized as such: a reflection fits, and no rotation does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..inertia.canonical_frame import EquivalentFrames
from ..inertia.principal_frames import equivalent_frames, undetermined_axes
from ..inertia.third_moment_frames import HALF_TURN_SIGNS, complete_free_axes
from ..moments.moments import Moments
from ..moments.symmetric_tensors import distinct_arrays, invert_through_point

EQUAL_RESIDUAL_RTOL = 1e-4  # relative to the size: residuals nearer than this are equal, and the smallest turn is taken
MAX_FIT_RTOL = 1e-3  # relative to the size: below, a body lies on the other one
FIRST_SAMPLES = 32  # points of each surface that are compared first
MIRROR_SHARE = 0.2  # a reflection that leaves less than this share of what rotations leave means a mirror image


@dataclass(frozen=True, eq=False)
class RigidMatch:
    """The placement of one body on another.

    `rotation`: (3, 3) about the centers.
    `max_distance`, `mean_distance`: distances of points of either surface from the other one.
    `is_mirror_image`: True if a reflection fits so much better that the bodies are mirror images.
    """

    rotation: NDArray[np.float64]
    max_distance: float
    mean_distance: float
    is_mirror_image: bool


Residual = Callable[[NDArray, int | None], NDArray]


def match(source: Moments, target: Moments, residual: Residual, size: float) -> RigidMatch:
    """Find the rotation that lays one body onto another, both about their centers.

    source, target: central moments, to the order of a pose. residual: (map, count) to (n,) distances that an orthogonal
    (3, 3) map of the source leaves: of all points if count is None, otherwise of about `count` points. size: the
    target's.
    """
    first = equivalent_frames(source).frames[0]
    rotation, distances = best_rotation(_candidate_rotations(first, equivalent_frames(target)), residual, size)
    largest, mirrored = float(distances.max()), False
    if largest > MAX_FIT_RTOL * size:
        reflected = best_rotation(
            -_candidate_rotations(first, equivalent_frames(invert_through_point(target))), residual, size
        )[1].max()
        mirrored = bool(reflected < MIRROR_SHARE * largest)
    return RigidMatch(rotation, largest, float(distances.mean()), mirrored)


def _candidate_rotations(first: NDArray, target: EquivalentFrames) -> NDArray[np.float64]:
    """Return the (k, 3, 3) rotations from a frame of the source to the frames of the target and their half turns."""
    frames = (target.frames[:, None] * HALF_TURN_SIGNS[:, None, :]).reshape(-1, 3, 3)
    frames = np.array([complete_free_axes(frame, undetermined_axes(target.revolution_axes), first) for frame in frames])
    return distinct_arrays(frames @ first.T, 1e-9)


def best_rotation(candidates: NDArray, residual: Residual, size: float) -> tuple[NDArray, NDArray]:
    """Return that of (k, 3, 3) maps with the least residual, else the smallest turn, and its distances."""
    least = np.array([residual(way, FIRST_SAMPLES).max() for way in candidates])
    worst, distances = np.full(len(candidates), np.inf), {}
    for i in np.argsort(least, kind="stable"):
        if least[i] > worst.min() + EQUAL_RESIDUAL_RTOL * size:
            break
        distances[i] = residual(candidates[i], None)
        worst[i] = distances[i].max()
    near = np.flatnonzero(worst <= worst.min() + EQUAL_RESIDUAL_RTOL * size)
    best = max(near, key=lambda i: np.trace(candidates[i]))
    return candidates[best], distances[best]
