# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Laying one body onto another by their poses, and what is left between them.

The pose leaves as many ways as the body has rotations, and all of them are tried. So are half turns about the axes, for
noise may decide a sign. The residual is measured on the surfaces, in both directions, so that neither may be a part of
the other; where a few points are farther apart than all points are in a better way, no more of them are looked at.
A mirror image is recognized as such: a reflection fits, and no rotation does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..inertia.canonical_frame import Frames
from ..inertia.principal_frame import frames_alike, free_axes, settled
from ..moments.moments import Moments
from ..moments.symmetric_tensors import distinct, inverted

HALF_TURNS = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
EQUAL = 1e-4  # of the size: residuals nearer than this are equal, and the smallest turn is taken
FITS = 1e-3  # of the size: below, a body lies on the other one
FEW = 32  # points of each surface that are looked at first
BETTER = 0.2  # a reflection that leaves less than this share of what rotations leave tells a mirror image


@dataclass(frozen=True, eq=False)
class Match:
    """rotation: (3, 3) about the centers. largest, mean: distances of points of either surface from the other one.
    mirrored: whether a reflection fits so much better that the bodies are mirror images."""

    rotation: NDArray[np.float64]
    largest: float
    mean: float
    mirrored: bool


Residual = Callable[[NDArray, int | None], NDArray]


def match(source: Moments, target: Moments, residual: Residual, size: float) -> Match:
    """The rotation that lays the source onto the target, both about their centers.

    source, target: central moments to the order of a pose. residual: the distances, (n,), that an orthogonal (3, 3)
    map of the source leaves: of all points, or of about so many of them. size: of the target.
    """
    first = frames_alike(source).frames[0]
    rotation, distances = _best(_ways(first, frames_alike(target)), residual, size)
    largest, mirrored = float(distances.max()), False
    if largest > FITS * size:
        reflected = _best(-_ways(first, frames_alike(inverted(target))), residual, size)[1].max()
        mirrored = bool(reflected < BETTER * largest)
    return Match(rotation, largest, float(distances.mean()), mirrored)


def _ways(first: NDArray, target: Frames) -> NDArray[np.float64]:
    """(k, 3, 3) the rotations from a frame of the source to those of the target and their half turns."""
    frames = (target.frames[:, None] * HALF_TURNS[:, None, :]).reshape(-1, 3, 3)
    frames = np.array([settled(frame, free_axes(target), first) for frame in frames])
    return distinct(frames @ first.T, 1e-9)


def _best(ways: NDArray, residual: Residual, size: float) -> tuple[NDArray, NDArray]:
    least = np.array([residual(way, FEW).max() for way in ways])
    worst, distances = np.full(len(ways), np.inf), {}
    for i in np.argsort(least, kind="stable"):
        if least[i] > worst.min() + EQUAL * size:
            break
        distances[i] = residual(ways[i], None)
        worst[i] = distances[i].max()
    near = np.flatnonzero(worst <= worst.min() + EQUAL * size)
    best = max(near, key=lambda i: np.trace(ways[i]))
    return ways[best], distances[best]
