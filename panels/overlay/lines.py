# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of bodies, as arrays: colored segments in the world."""

from __future__ import annotations

import numpy as np

from ...blender.settings.scene import BodyMomentsOverlaySettings
from ...core.numerics import Array, Mask, NDArray
from .bodies import Bodies

CIRCLE = 2.0 * np.pi / 48.0 * np.arange(49)
RING = CIRCLE[::3]
DASHES = 12  # dashes of a drop line
EDGES = np.array([[i, i | 1 << axis] for i in range(8) for axis in range(3) if not i & 1 << axis])
CORNERS = np.array([[(i >> axis & 1) * 2.0 - 1.0 for axis in range(3)] for i in range(8)])


def body_lines(bodies: Bodies, settings: BodyMomentsOverlaySettings) -> Array:
    """Return the (n, k, 2, 3) segments of the enabled drawings, in the world."""
    place = bodies.centers, bodies.axes, bodies.gyration
    drawings = [np.empty((len(bodies.centers), 0, 2, 3))]
    if settings.show_axes:
        axes = axis_lines(*place)
        drawings.append(np.where(_each(bodies.shows_axes), axes, axes.mean(axis=2, keepdims=True)))
    if settings.show_drop_line:
        drops = drop_lines(bodies.centers, bodies.gyration)
        drawings.append(np.where(_each(bodies.shows_drop), drops, bodies.centers[:, None, None]))
    if settings.equivalent == "BOX":
        drawings.append(box_lines(*place))
    elif settings.equivalent == "ELLIPSOID":
        drawings.append(ellipsoid_lines(*place))
    return np.concatenate(drawings, axis=1)


def _each(mask: NDArray) -> Mask:
    """Return an (n,) mask for (n, k, 2, 3) segments."""
    return mask[:, None, None, None]


def axis_lines(centers: NDArray, axes: NDArray, gyration: NDArray) -> Array:
    """Return (n, 3, 2, 3) segments of the axes through each center, to both sides the largest
    radius of gyration.
    """
    arms = axes.transpose(0, 2, 1) * gyration.max(axis=1)[:, None, None]
    return np.stack([centers[:, None] - arms, centers[:, None] + arms], axis=2)


def drop_lines(centers: NDArray, gyration: NDArray) -> Array:
    """Return a dashed line from each center to the floor, and a ring at its foot."""
    feet = centers.copy()
    feet[:, 2] = 0.0
    steps = np.arange(2 * DASHES).reshape(-1, 2) / (2.0 * DASHES - 1.0)
    dashes = feet[:, None, None] + steps[None, :, :, None] * (centers - feet)[:, None, None]
    ring = np.stack([np.cos(RING), np.sin(RING), np.zeros_like(RING)], axis=1)
    ring = np.stack([ring[:-1], ring[1:]], axis=1)
    return np.concatenate(
        [dashes, feet[:, None, None] + 0.15 * gyration.max(axis=1)[:, None, None, None] * ring],
        axis=1,
    )


def _spread(gyration: NDArray) -> Array:
    """Return (n, 3) values (I_j + I_k - I_i) / m from (n, 3) radii of gyration.

    The values are twice the mean square distance along axis i.
    """
    squares = gyration**2
    return np.maximum(squares.sum(axis=1, keepdims=True) - 2.0 * squares, 0.0)


def box_lines(centers: NDArray, axes: NDArray, gyration: NDArray) -> Array:
    """Return the edges of the box with the same mass and inertia: sides s_i² = 6 (I_j + I_k - I_i)
    / m.
    """
    half = np.sqrt(6.0 * _spread(gyration)) / 2.0
    return (centers[:, None] + np.einsum("nij,kj,nj->nki", axes, CORNERS, half))[:, EDGES]


def ellipsoid_lines(centers: NDArray, axes: NDArray, gyration: NDArray) -> Array:
    """Return the ellipsoid with the same mass and inertia as three ellipses.

    Its semi-axes are a_i² = 5 (I_j + I_k - I_i) / (2 m).
    """
    half = np.sqrt(2.5 * _spread(gyration))
    circles = np.zeros((3, len(CIRCLE), 3))
    for axis in range(3):
        circles[axis, :, axis - 1] = np.cos(CIRCLE)
        circles[axis, :, axis - 2] = np.sin(CIRCLE)
    points = centers[:, None, None] + np.einsum("nij,ckj,nj->ncki", axes, circles, half)
    return np.stack([points[:, :, :-1], points[:, :, 1:]], axis=3).reshape(
        len(centers), 3 * (len(CIRCLE) - 1), 2, 3
    )
