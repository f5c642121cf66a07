# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass properties of an affine image of a body, from its mass properties alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from .mass_properties import MassProperties
from .principal_frames import PrincipalFrame


def affine_image(
    properties: MassProperties, linear: ArrayLike, center: ArrayLike, mass: float, preferred_axes: ArrayLike
) -> MassProperties:
    """Return the mass properties of a body that is stretched, sheared and turned by the (3, 3) part of a map.

    `center` and `mass` are those of the image; each principal axis points the way of a column of `preferred_axes`.
    The bounds are those of `properties`: nothing better is known here. The frame is no choice of the canonical rule:
    second moments alone leave the signs open.
    """
    linear, preferred = np.asarray(linear, np.float64), np.asarray(preferred_axes, np.float64)
    second = np.trace(properties.inertia) / 2.0 * np.eye(3) - properties.inertia
    second = linear @ second @ linear.T * (mass / properties.mass)
    spread, axes = np.linalg.eigh(second)
    spread, axes = np.maximum(spread[::-1], 0.0), axes[:, ::-1]
    axes = axes * np.where((axes * preferred).sum(axis=0) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, np.abs((axes * preferred).sum(axis=0)).argmin()] *= -1.0
    moments = np.array([spread[1] + spread[2], spread[2] + spread[0], spread[0] + spread[1]])
    return replace(
        properties,
        mass=float(mass),
        center=np.asarray(center, np.float64),
        inertia=np.trace(second) * np.eye(3) - second,
        principal=PrincipalFrame(moments, axes, symmetry="", is_unique=False, finding=None),
    )
