# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about any point, along any axes, and about any axis, by the parallel-axis theorem, with bounds.

I_p = I_c + m (|d|² 1 - d dᵀ),   d = c - p.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..moments.moments import U
from ..numerics.arguments import check_type, float_array
from ..numerics.rotations import rotation_array
from ..verdict.finding import QueryError
from .canonical_frame import frame_about
from .findings import AXIS_POINTS_COINCIDE
from .mass_properties import MassProperties

IDENTITY_3 = np.eye(3)
MIN_AXIS_RATIO = 1e-6  # relative to the coordinates: float32 points nearer to each other give no direction


@dataclass(frozen=True, eq=False)
class Reference:
    """A frame that inertia is referred to: an origin, and axes as columns of a rotation, by default the identity."""

    origin: NDArray[np.float64]
    axes: NDArray[np.float64] = field(default_factory=IDENTITY_3.copy)

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin", float_array("origin", self.origin, 3))
        object.__setattr__(self, "axes", rotation_array("axes", self.axes))

    @classmethod
    def through_points(cls, first: ArrayLike, second: ArrayLike) -> Reference:
        """Return the frame with its origin at the first point and its Z axis from there to the second.

        Its other axes are as near as possible to the coordinate axes. QueryError if the points fix no direction.
        """
        first, second = float_array("first", first, 3), float_array("second", second, 3)
        way = second - first
        length = float(np.linalg.norm(way))
        if not length > MIN_AXIS_RATIO * max(np.abs(first).max(), np.abs(second).max()):
            raise QueryError(AXIS_POINTS_COINCIDE)
        return cls(first, frame_about(way / length))

    def refer(self, properties: MassProperties) -> ReferredInertia:
        """Refer the inertia of one body, given in the same coordinates, to this frame, by the parallel-axis theorem.

        With e the bound of the center, and d = |c - p|, the tensor is off by at most its own bound plus √2 d² times
        that of the mass plus m (6 d e + 2 e²).
        """
        check_type("properties", properties, MassProperties)
        arm = properties.center - self.origin
        inertia = self.axes.T @ properties.inertia_about(self.origin) @ self.axes
        distance = float(np.linalg.norm(arm))
        rounded = 2.0 * U * float(np.abs(properties.center).sum() + np.abs(self.origin).sum())
        size = float(np.linalg.norm(properties.inertia) + np.sqrt(2.0) * properties.mass * distance**2)
        bounds = []
        for delta, own in ((properties.rounding_error, rounded), (properties.input_error, 0.0)):
            center = float(delta["center"] + own)
            bounds.append(
                {
                    "mass": delta["mass"],
                    "center": center,
                    "inertia": float(
                        delta["inertia"]
                        + np.sqrt(2.0) * distance**2 * delta["mass"]
                        + properties.mass * (6.0 * distance * center + 2.0 * center**2)
                    ),
                }
            )
        bounds[0]["center"] += float(8.0 * U * distance)
        bounds[0]["inertia"] += float(40.0 * U * size)
        return ReferredInertia(
            self, properties.mass, self.axes.T @ arm, (inertia + inertia.T) / 2.0, bounds[0], bounds[1]
        )


@dataclass(frozen=True, eq=False)
class ReferredInertia:
    """Inertia about a reference, along its axes.

    `center`: the center of mass from the reference's origin, along its axes; mass times this is the first moment.
    `inertia`: the (3, 3) tensor about the reference's origin.
    `rounding_error`, `input_error`: absolute bounds of "mass", "center" and "inertia", as in `MassProperties`.
    """

    reference: Reference
    mass: float
    center: NDArray[np.float64]
    inertia: NDArray[np.float64]
    rounding_error: dict[str, float]
    input_error: dict[str, float]

    @property
    def about_z(self) -> float:
        """The moment of inertia about the reference's Z axis, the axis of `Reference.through_points`."""
        return float(self.inertia[2, 2])

    @property
    def radius_about_z(self) -> float:
        """The radius of gyration about the reference's Z axis."""
        return float(np.sqrt(max(self.about_z, 0.0) / self.mass))

    @property
    def distance_from_z(self) -> float:
        """The distance of the center of mass from the reference's Z axis."""
        return float(np.hypot(self.center[0], self.center[1]))
