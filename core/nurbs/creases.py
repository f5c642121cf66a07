# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Creases of patches: along the seams between them, and within them along knots of full multiplicity.

A sheet with real thickness (`patch_moments.sheet_moments`) overlaps itself on one side of a crease and gapes on the
other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..numerics.vectors import cross
from .flat_face import FlatFace, split_faces
from .patch import SIDES, Face, Patch
from .patch_topology import PatchTopology

SAMPLES_PER_SIDE = 17  # samples of a side
POLE_RTOL = 1e-9  # Relative to the largest normal: normals at a pole are shorter.


def sharpest_crease(faces: Sequence[Face], topology: PatchTopology) -> float:
    """Return the largest angle, in radians, between the normals on both sides of a crease, 0 if there is none."""
    worst = max(map(_inner_crease_angle, split_faces(faces)[0]), default=0.0)
    sides = [(face, k, curve) for face, one in enumerate(faces) for k, (curve, _) in enumerate(one.sides)]
    for seam in topology.seams.tolist():
        first_side, second_side = (
            _along_side(faces[face], k) * (-1.0 if topology.flipped[face] else 1.0)
            for face, k, _ in map(sides.__getitem__, seam)
        )
        points = [sides[k][2].samples(SAMPLES_PER_SIDE) for k in seam]
        nearest = np.linalg.norm(points[0][:, None] - points[1], axis=2).argmin(axis=1)
        worst = max(worst, _largest_angle(first_side, second_side[nearest]))
    return worst


def _along_side(patch: Face, number: int) -> NDArray[np.float64]:
    """Return (m, 3) a face's unit normals along a side, at the samples of the side's curve; zero at poles."""
    if isinstance(patch, FlatFace):
        return np.tile(patch.normal, (len(patch.sides[number][0].space.uniform_parameters(SAMPLES_PER_SIDE)), 1))
    assert isinstance(patch, Patch)
    axis, end, _ = SIDES[number]
    held, run = patch.spaces[axis], patch.spaces[1 - axis]
    tables = [(np.array([held.domain[end]]), None), (run.uniform_parameters(SAMPLES_PER_SIDE), None)]
    return _normals(patch, *(tables if axis == 0 else tables[::-1])).reshape(-1, 3)


def _inner_crease_angle(patch: Patch) -> float:
    """Return the largest crease angle at a patch's inner knots."""
    worst = 0.0
    for axis, space in enumerate(patch.spaces):
        inner = space.intervals[1:, 0]
        if not len(inner):
            continue
        across = patch.spaces[1 - axis].uniform_parameters(SAMPLES_PER_SIDE), None
        before, after = ((inner, spans) for spans in (space.spans[:-1], space.spans[1:]))
        normals_before, normals_after = (
            _normals(patch, *((parameters, across) if axis == 0 else (across, parameters)))
            for parameters in (before, after)
        )
        worst = max(worst, _largest_angle(normals_before, normals_after))
    return worst


def _normals(patch: Patch, *parameters: tuple[NDArray, NDArray | None]) -> NDArray[np.float64]:
    """Return (m, n, 3) unit normals at parameters (values, spans or None) of s and of t; zero if undefined."""
    (s, by_s), (t, by_t) = (
        [space.collocation_matrix(at, k, spans) for k in (0, 1)] for space, (at, spans) in zip(patch.spaces, parameters)
    )
    net = np.moveaxis(patch.points - patch.points[0, 0], -1, 0)
    weights = np.ones(net.shape[1:]) if patch.weights is None else patch.weights
    net = np.concatenate([net * weights, weights[None]])
    place, along, across = (s_weights @ net @ t_weights.T for s_weights, t_weights in ((s, t), (by_s, t), (s, by_t)))
    along, across = (slope[:3] - place[:3] / place[3] * slope[3] for slope in (along, across))
    normal = np.stack(cross(along, across), axis=-1)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.where(length > POLE_RTOL * length.max(), normal / np.where(length > 0.0, length, 1.0), 0.0)


def _largest_angle(first: NDArray, second: NDArray) -> float:
    """Return the largest angle between corresponding unit vectors, ignoring pairs with a zero vector."""
    known = first.any(axis=-1) & second.any(axis=-1)
    chord = np.linalg.norm(first[known] - second[known], axis=-1).max(initial=0.0)
    return float(2.0 * np.arcsin(min(chord / 2.0, 1.0)))
