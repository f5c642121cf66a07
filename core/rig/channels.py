# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of animated channels: rotations as continuous quaternions, axes and angles or Euler
angles; Bézier handles.
"""

from __future__ import annotations

import numpy as np

from ..numerics import Array, NDArray, quaternion, rotation_matrix
from .motion import continuous
from .spin import LAST, NODES, node_weights

# The cosine of the middle Euler angle below which the outer two angles cannot be told apart; and
# the sine of half an angle below which its axis is not known.
LOCKED = 1e-5
OFF = 0.003  # relative to the angular velocity: a larger deviation between keys divides a frame
LEAST_ANGLE = 1e-3  # rad a frame, below which the velocity is not compared


def rotation_values(turns: NDArray, mode: str, first: NDArray) -> Array:
    """Return (s, k) values of rotations (s, 3, 3) without jumps, the first being the nearest to
    `first`.

    mode: Blender's name of the rotation mode.
    """
    if mode in ("QUATERNION", "AXIS_ANGLE"):
        quaternions = continuous(quaternion(turns))
        if mode == "QUATERNION":
            return quaternions * (1.0 if quaternions[0] @ first >= 0.0 else -1.0)
        return _axis_angles(quaternions, first)
    values = np.empty((len(turns), 3))
    last = np.asarray(first, np.float64)
    for row, matrix in enumerate(turns):
        # Each rotation has two triples of angles, and whole turns of each.
        triples = [_euler_angles(matrix, mode, side, last) for side in (1.0, -1.0)]
        nearest = [_nearest_turn(angles, last) for angles in triples]
        last = min(nearest, key=lambda angles: float(np.abs(angles - last).sum()))
        values[row] = last
    return values


def _euler_angles(m: NDArray, mode: str, side: float, last: NDArray) -> Array:
    """Return the (3,) angles about x, y and z of a (3, 3) rotation, in the order of the mode.

    side: the sign of the middle angle's cosine. last: the former angles, of which the third one is
    kept if the outer two cannot be told apart.
    """
    # The rotation is R_k R_j R_i. The formulas are those of the even orders, such as XYZ; an odd
    # order is the mirror image of an even one, in which all angles have the other sign.
    i, j, k = ("XYZ".index(axis) for axis in mode)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    cosine = float(np.hypot(m[i, i], m[j, i]))
    third = last[k] * sign
    if cosine > LOCKED:
        third = np.arctan2(side * m[j, i], side * m[i, i])
    # The matrix turned back about the third axis shows the first angle, however small the cosine
    # is.
    c, s = np.cos(third), np.sin(third)
    angles = np.empty(3)
    angles[i] = np.arctan2(s * m[i, k] - c * m[j, k], c * m[j, j] - s * m[i, j])
    angles[j] = np.arctan2(-m[k, i], side * cosine)
    angles[k] = third
    return sign * angles


def _nearest_turn(angles: NDArray, last: NDArray) -> NDArray:
    """Return angles with the whole turns added that bring them next to others."""
    return angles + 2.0 * np.pi * np.round((last - angles) / (2.0 * np.pi))


def _axis_angles(turns: NDArray, first: NDArray) -> Array:
    """Return (s, 4) rows of an angle and its axis, of continuous quaternions; close to no turn, the
    axis stays. first: (4,) angle and axis that the first row is next to.
    """
    values = np.empty((len(turns), 4))
    last = np.asarray(first, np.float64)
    length = float(np.linalg.norm(last[1:]))
    axis = last[1:] / length if length else np.array([0.0, 1.0, 0.0])
    angle = last[0]
    for row, turn in enumerate(turns):
        sine = float(np.linalg.norm(turn[1:]))
        if sine > LOCKED:
            axis = turn[1:] / (sine if turn[1:] @ axis >= 0.0 else -sine)
        angle = _nearest_turn(2.0 * np.arctan2(turn[1:] @ axis, turn[0]), angle)
        values[row] = angle, *axis
    return values


def rotations(values: NDArray, mode: str) -> Array:
    """Return the (s, 3, 3) rotations of values of a rotation mode."""
    if mode == "QUATERNION":
        return rotation_matrix(values)
    half = values / 2.0
    if mode == "AXIS_ANGLE":
        axes = values[:, 1:] / np.linalg.norm(values[:, 1:], axis=1, keepdims=True)
        return rotation_matrix(np.hstack([np.cos(half[:, :1]), np.sin(half[:, :1]) * axes]))
    total = np.eye(3)
    for axis in ("XYZ".index(letter) for letter in mode):
        turn = np.zeros((len(values), 4))
        turn[:, 0] = np.cos(half[:, axis])
        turn[:, 1 + axis] = np.sin(half[:, axis])
        total = rotation_matrix(turn) @ total
    return total


def divide_frames(quaternions: NDArray, mode: str, first: NDArray, shortest: float) -> Array:
    """Return (m + 1,) ascending places, in frames from 0 to f, between which cubics follow a
    rotation.

    quaternions: (LAST f + 1, 4) at the nodes of f frames, continuous. A piece of a frame is divided
    while the angular velocity would be off: close to a gimbal lock, or to the rest position of an
    axis and angle. Pieces are no shorter than `shortest`.
    """
    ends = quaternions[::LAST]
    cosines = np.abs((ends[1:] * ends[:-1]).sum(axis=1)).clip(max=1.0)
    limits = np.maximum(2.0 * np.arccos(cosines), LEAST_ANGLE) * OFF / 4.0
    places = np.arange(len(ends)).astype(np.float64)
    while True:
        # Compare with the cubics in the middle of each piece.
        wanted = rotation_matrix(in_pieces(quaternions, places))
        values = rotation_values(wanted, mode, first)
        right, left = handle_values(values)
        middle = (values[:-1:LAST] + 3.0 * (right + left) + values[LAST::LAST]) / 8.0
        off = np.linalg.norm(rotations(middle, mode) - wanted[LAST // 2 :: LAST], axis=(1, 2))
        lengths = np.diff(places)
        # The cubic meets all nodes but the middle one, so that its error is c (u² - 1)(u² - 1/2)
        # for u from -1 to 1 in the piece: c/2 in the middle, with slopes up to c by u. By the
        # piece's length that is 4 times the middle error. A small angle changes a matrix by √2
        # times it.
        rough = off / np.sqrt(2.0) > limits[places[:-1].astype(int)] * lengths
        rough &= lengths > 2.0 * shortest
        if not rough.any():
            return places
        places = np.sort(np.append(places, (places[:-1] + lengths / 2.0)[rough]))


def in_pieces(values: NDArray, places: NDArray) -> Array:
    """Return (LAST m + 1, ...) values at the nodes of the m pieces between (m + 1,) places, from
    (LAST f + 1, ...) values at the nodes of f frames.
    """
    times = (places[:-1, None] + np.diff(places)[:, None] * NODES[:-1]).ravel()
    frames = np.repeat(places[:-1].astype(int), LAST)
    near = values[LAST * frames[:, None] + np.arange(len(NODES))]
    inner = np.einsum("mn,mn...->m...", node_weights(times - frames), near)
    return np.concatenate([inner, values[-1:]])


def handle_values(values: NDArray) -> tuple[Array, Array]:
    """Return the values of the handles, a third of a frame after and before the keys, of values at
    the nodes of frames.

    values: (LAST f + 1, ...). The two (f, ...) handles make the cubic through all nodes but the
    middle one.
    """
    # At the place x the cubic is (1 - x)³ start + 3x (1 - x)² right + 3x² (1 - x) left + x³ end:
    # two nodes give two equations for the handles.
    places = NODES[[1, -2]]
    inner = 3.0 * places * (1.0 - places) ** 2, 3.0 * places**2 * (1.0 - places)
    start, end = values[:-1:LAST], values[LAST::LAST]
    near = [
        values[1::LAST] - (1.0 - places[0]) ** 3 * start - places[0] ** 3 * end,
        values[LAST - 1 :: LAST] - (1.0 - places[1]) ** 3 * start - places[1] ** 3 * end,
    ]
    right, left = np.einsum("ij,jf...->if...", np.linalg.inv(np.transpose(inner)), near)
    return right, left
