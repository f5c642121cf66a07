# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An object's own transform channels, in float64.

Blender's setters for `matrix_world` and `matrix_basis` take Euler angles out of a float32 matrix,
each angle by itself; near gimbal lock the angles then no longer fit together. Here each angle is
taken from the rotation that remains after the angles before it, in float64, so that the angles
rebuild any rotation.

The basis of an object is T(location + delta) · R(delta) R(rotation) · S(scale · delta), before
parents and constraints.
"""

from collections.abc import Sequence
from math import atan2, cos, pi, sin

import numpy as np
from bpy.types import Object, PoseBone

from ...core.numerics import Array, Mask, NDArray, quaternion, rotation_matrix
from ...core.verdict import EditRefusedError
from ..read.findings import SCALE_ZERO_AXIS
from .fcurves import all_curves
from .findings import CHANNEL_LOCKED, PARENT_SHEARS

FLOAT32 = float(np.finfo(np.float32).eps)
MAX_SHEAR = 2e-6  # by rounding, in float32 products of a rotation and a scale

Matrix3 = Array
Matrix4 = Array


def world(obj: Object) -> Matrix4:
    """Return the (4, 4) evaluated matrix_world of an object as float64."""
    return np.array(obj.matrix_world, np.float64)


def solve(matrix: Matrix4, right_side: Matrix4) -> Matrix4:
    """Return the (4, 4) solution x of `matrix` · x = `right_side`, declared as float64, unlike
    numpy's function.
    """
    return np.asarray(np.linalg.solve(matrix, right_side), np.float64)


def _turn(axis: int, angle: NDArray) -> Array:
    """Return the (..., 3, 3) rotations by (...,) angles about a coordinate axis."""
    matrix = np.zeros((*np.shape(angle), 3, 3))
    j, k = (axis + 1) % 3, (axis + 2) % 3
    matrix[..., axis, axis] = 1.0
    matrix[..., j, j] = matrix[..., k, k] = np.cos(angle)
    matrix[..., k, j] = np.sin(angle)
    matrix[..., j, k] = -matrix[..., k, j]
    return matrix


def _order(mode: str) -> tuple[int, int, int, float]:
    """Return the axes in the order of their turns, and 1 if it is cyclic, otherwise -1."""
    i, j, k = ("XYZ".index(letter) for letter in mode)
    return i, j, k, 1.0 if (j - i) % 3 == 1 else -1.0


def euler_matrix(angles: NDArray, mode: str) -> Matrix3:
    """Return the (3, 3) matrix of Euler angles by axis x, y, z; in mode "XYZ" the turn about X
    comes first.
    """
    i, j, k, _ = _order(mode)
    return _turn(k, angles[k]) @ _turn(j, angles[j]) @ _turn(i, angles[i])


def euler_angles(rotation: NDArray, mode: str, near: NDArray) -> Array:
    """Return (..., 3) Euler angles by axis of (..., 3, 3) rotations: of all equivalent ones the
    nearest to `near`.
    """
    i, j, k, s = _order(mode)
    # In gimbal lock, to float32 rounding of a rotation, the first angle is free.
    is_locked = np.hypot(rotation[..., k, j], rotation[..., k, k]) < 1e-7
    first = np.arctan2(s * rotation[..., k, j], rotation[..., k, k])
    first = np.where(is_locked, near[..., i], first)
    solutions = []
    for angle in (first, first + pi):
        rest = rotation @ _turn(i, angle).swapaxes(-1, -2)
        angles = np.empty(near.shape)
        angles[..., i] = angle
        angles[..., j] = np.arctan2(-s * rest[..., k, i], rest[..., k, k])
        angles[..., k] = np.arctan2(-s * rest[..., i, j], rest[..., j, j])
        solutions.append(angles - 2.0 * pi * np.round((angles - near) / (2.0 * pi)))
    distances = [np.abs(angles - near).sum(axis=-1, keepdims=True) for angles in solutions]
    # Of equally near ones, to rounding in float64, the first is taken.
    return np.where(distances[1] < distances[0] - 1e-9, solutions[1], solutions[0])


def _rotation(obj: Object) -> Matrix3:
    mode = obj.rotation_mode
    if mode == "QUATERNION":
        return rotation_matrix(obj.rotation_quaternion)
    if mode == "AXIS_ANGLE":
        angle, *axis = obj.rotation_axis_angle
        length = np.linalg.norm(axis)
        if length == 0.0:
            return np.eye(3)  # Blender, too, takes an axis of no length for no rotation
        return rotation_matrix([cos(angle / 2.0), *(sin(angle / 2.0) * np.divide(axis, length))])
    return euler_matrix(np.array(obj.rotation_euler), mode)


def _delta_rotation(obj: Object) -> Matrix3:
    if obj.rotation_mode == "QUATERNION":
        return rotation_matrix(obj.delta_rotation_quaternion)
    # An axis and angle have no delta in Blender's interface, and Blender applies none.
    if obj.rotation_mode == "AXIS_ANGLE":
        return np.eye(3)
    return euler_matrix(np.array(obj.delta_rotation_euler), obj.rotation_mode)


def basis(obj: Object) -> Matrix4:
    """Return the (4, 4) matrix of location, rotation and scale with their deltas, before parents
    and constraints.
    """
    matrix = np.eye(4)
    scale = np.array(obj.scale, np.float64) * np.array(obj.delta_scale, np.float64)
    matrix[:3, :3] = _delta_rotation(obj) @ _rotation(obj) * scale
    matrix[:3, 3] = np.array(obj.location, np.float64) + np.array(obj.delta_location, np.float64)
    return matrix


def set_location(obj: Object, location: NDArray, tolerance: float) -> None:
    """Put the origin of the basis at `location`; locked axes may move by no more than
    `tolerance`.
    """
    channel_location = location - np.array(obj.delta_location, np.float64)
    _assign(obj, "location", channel_location, obj.lock_location, tolerance)


def rotation_and_scale(linear: NDArray, scale: NDArray) -> tuple[Array, NDArray, Mask]:
    """Return rotations and scales, signed as `scale` if the handedness is the same, of (..., 3, 3)
    maps, and a mask of maps without shear or zero.
    """
    length = np.linalg.norm(linear, axis=-2)
    sign = np.where(scale < 0.0, -1.0, 1.0)
    determinant = np.linalg.det(linear)
    has_other_hand = np.prod(sign, axis=-1) * determinant < 0.0
    # The signs of a scale of the other handedness are all positive, but for x of a mirror.
    sign = np.where(has_other_hand[..., None], 1.0, sign)
    sign[..., 0] *= np.where(has_other_hand & (determinant < 0.0), -1.0, 1.0)
    has_scale = length.min(axis=-1) > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        unscaled = np.where(
            has_scale[..., None, None], linear / (length * sign)[..., None, :], np.eye(3)
        )
    u, _, vt = np.linalg.svd(unscaled)
    shear = np.abs(unscaled.swapaxes(-1, -2) @ unscaled - np.eye(3)).max(axis=(-2, -1))
    return u @ vt, length * sign, has_scale & (shear <= MAX_SHEAR)


def set_rotation_and_scale(obj: Object, linear: Matrix3) -> None:
    """Set rotation and scale so that the basis has the 3×3 part `linear`; EditRefusedError if that
    is sheared.
    """
    delta_scale = np.array(obj.delta_scale, np.float64)
    if np.linalg.norm(linear, axis=0).min() <= 0.0 or np.abs(delta_scale).min() == 0.0:
        raise EditRefusedError(SCALE_ZERO_AXIS)
    previous_scale = np.array(obj.scale, np.float64) * delta_scale
    whole_rotation, scale, is_unsheared = rotation_and_scale(linear, previous_scale)
    if not is_unsheared:
        raise EditRefusedError(PARENT_SHEARS)
    _assign(obj, "scale", scale / delta_scale, obj.lock_scale)
    rotation = _delta_rotation(obj).T @ whole_rotation
    mode = obj.rotation_mode
    if mode not in {"QUATERNION", "AXIS_ANGLE"}:
        near = np.array(obj.rotation_euler, np.float64)
        _assign(obj, "rotation_euler", euler_angles(rotation, mode, near), obj.lock_rotation)
        return
    q = quaternion(rotation)
    locks = [obj.lock_rotation_w, *obj.lock_rotation]
    if mode == "QUATERNION":
        if np.dot(q, obj.rotation_quaternion) < 0.0:
            q = -q
        _assign(obj, "rotation_quaternion", q, locks)
        return
    length = np.linalg.norm(q[1:])
    angle = 2.0 * atan2(length, q[0])
    # A rotation by nearly nothing has no axis of its own and keeps the present one.
    axis = q[1:] / length if angle > 1e-12 else np.array(obj.rotation_axis_angle[1:])
    _assign(obj, "rotation_axis_angle", np.array([angle, *axis]), locks)


def _assign(
    obj: Object, channel: str, value: NDArray, locks: Sequence[bool], tolerance: float = 1e-6
) -> None:
    """Set a channel; EditRefusedError if a locked component, or an animated channel, moves by more
    than the tolerance, or than rounding in float32.
    """
    before = np.array(getattr(obj, channel), np.float64)
    moves = np.abs(value - before) > max(tolerance, 1e-6 * np.abs(before).max())
    if np.any(moves & np.array(locks, bool)) or (np.any(moves) and channel in driven_channels(obj)):
        raise EditRefusedError(CHANNEL_LOCKED, channel=channel.split("_")[0])
    setattr(obj, channel, value)


def driven_channels(obj: Object) -> set[str]:
    """Return the data paths of the object that an action, the NLA or a driver sets."""
    drivers = obj.animation_data.drivers if obj.animation_data is not None else ()
    return {curve.data_path for curve in (*drivers, *all_curves(obj))}


class TransformChannels:
    """A copy of the transform channels of an object or a pose bone, to restore them."""

    NAMES = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale")

    def __init__(self, obj: Object | PoseBone) -> None:
        self.obj = obj
        self.values = {name: tuple(getattr(obj, name)) for name in self.NAMES}

    def restore(self) -> None:
        for name, value in self.values.items():
            if tuple(getattr(self.obj, name)) != value:
                setattr(self.obj, name, value)
