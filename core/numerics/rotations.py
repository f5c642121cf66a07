# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversions of rotations between matrix and quaternion, in double precision; Blender's own are in
single.
"""

from __future__ import annotations

import numpy as np

from .arguments import float_array
from .array_types import Array, ArrayLike, Mask, NDArray
from .arrays import IDENTITY_3

ROTATION_ATOL = 1e-5  # a rotation matrix of float32 numbers is orthonormal to about 1e-7


def rotation_array(name: str, values: ArrayLike) -> Array:
    """Return a parameter as (..., 3, 3) rotations, right-handed and orthonormal as far as float32
    goes.
    """
    rotation = float_array(name, values, ..., 3, 3, finite=True)
    off = np.abs(rotation.swapaxes(-1, -2) @ rotation - IDENTITY_3).max(initial=0.0)
    if off > ROTATION_ATOL or (np.linalg.det(rotation) < 0.0).any():
        raise ValueError("{} must be a rotation".format(name))
    return rotation


def rotation_matrix(quaternion: ArrayLike) -> Array:
    """Convert quaternions (..., 4), w, x, y, z of any length but zero, to rotation matrices (...,
    3, 3).
    """
    q = float_array("quaternion", quaternion, ..., 4)  # before the norm: mathutils returns float32
    w, x, y, z = (q / np.sqrt(np.add.reduce(q * q, axis=-1))[..., None]).T
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.array(rows).T.swapaxes(-1, -2)


def rotation_about(axis: NDArray, angle: float) -> Array:
    """Return the (3, 3) rotation about a (3,) axis of any length."""
    return rotation_matrix(
        [np.cos(angle / 2.0), *(np.sin(angle / 2.0) / np.linalg.norm(axis) * axis)]
    )


def quaternion(rotation: ArrayLike) -> Array:
    """Convert a rotation matrix to a unit quaternion.

    Parameters
    ----------
    rotation : (..., 3, 3) array_like
        Orthonormal, determinant 1.

    Returns
    -------
    (..., 4) array
        w, x, y, z with w ≥ 0.

    Examples
    --------
    >>> from body_moments.core.numerics import quaternion
    >>> quaternion(np.eye(3)).tolist()
    [1.0, 0.0, 0.0, 0.0]
    """
    m = float_array("rotation", rotation, ..., 3, 3).swapaxes(-1, -2).T
    # Shepperd's method: 4 q qᵀ has no cancellation in the column of its largest diagonal entry.
    outer = np.array(
        [
            [
                1 + m[0, 0] + m[1, 1] + m[2, 2],
                m[2, 1] - m[1, 2],
                m[0, 2] - m[2, 0],
                m[1, 0] - m[0, 1],
            ],
            [
                m[2, 1] - m[1, 2],
                1 + m[0, 0] - m[1, 1] - m[2, 2],
                m[0, 1] + m[1, 0],
                m[0, 2] + m[2, 0],
            ],
            [
                m[0, 2] - m[2, 0],
                m[0, 1] + m[1, 0],
                1 - m[0, 0] + m[1, 1] - m[2, 2],
                m[1, 2] + m[2, 1],
            ],
            [
                m[1, 0] - m[0, 1],
                m[0, 2] + m[2, 0],
                m[1, 2] + m[2, 1],
                1 - m[0, 0] - m[1, 1] + m[2, 2],
            ],
        ]
    )
    best = outer.diagonal(axis1=0, axis2=1).argmax(axis=-1)
    column = outer.reshape(4, 4, -1)[:, best.ravel(), np.arange(best.size)].reshape(4, *best.shape)
    column = column / np.sqrt(np.add.reduce(column * column))
    return np.where(column[0] >= 0.0, column, -column).T + 0.0  # no negative zeros


OFF_DIAGONAL = 1.0 - np.eye(3)
MAX_AXIS_COSINE = 1e-5  # float32 rotations never have axes with a larger cosine


def polar_rotation(matrices: NDArray) -> tuple[Array, Mask]:
    """Return the (k, 3, 3) orthogonal factors of (k, 4, 4) maps (Higham 1986), left-handed for
    mirroring maps, and a (k,) mask of the maps that shear.
    """
    linear = np.asarray(matrices, np.float64)[:, :3, :3]
    length = np.sqrt(np.add.reduce(linear * linear, axis=1, keepdims=True))
    columns = np.divide(linear, length, out=np.zeros_like(linear), where=length > 0.0)
    cosines = (np.abs(columns.transpose(0, 2, 1) @ columns) * OFF_DIAGONAL).max(axis=(1, 2))
    # Unit columns at right angles are the factor already; columns with NaN or zeros are not.
    is_orthogonal = (cosines == 0.0) & (length > 0.0).all(axis=(1, 2))
    rest = np.flatnonzero(~is_orthogonal)
    if len(rest):
        u, _, v = np.linalg.svd(columns[rest])
        columns[rest] = u @ v
    return columns, cosines > MAX_AXIS_COSINE


def along_x(axis: NDArray) -> Array:
    """Return a (3, 3) rotation with a unit vector as its first column."""
    second = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    second = second / np.linalg.norm(second)
    return np.column_stack([axis, second, np.cross(axis, second)])
