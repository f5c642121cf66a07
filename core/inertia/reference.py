# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about any point, along any axes, and about any axis, by the parallel-axis theorem, with bounds.

I_p = I_c + m (|d|² 1 - d dᵀ),   d = c - p.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sqrt
from sys import float_info

from ..numerics.vectors import subtract
from ..verdict.finding import QueryError
from .findings import AXIS_POINTS_COINCIDE
from .plain_body import IDENTITY, Axes, PlainBody, Vector, along_axes, frame_about, move_tensor, turn_tensor

MIN_AXIS_RATIO = 1e-6  # relative to the coordinates: float32 points nearer to each other give no direction
U = float_info.epsilon / 2.0


@dataclass(frozen=True, eq=False)
class Reference:
    """A frame that inertia is referred to: an origin, and right-handed axes, by default those of the coordinates."""

    origin: Sequence[float]
    axes: Axes = IDENTITY

    @classmethod
    def through_points(cls, first: Sequence[float], second: Sequence[float]) -> Reference:
        """Return the frame with its origin at the first point and Z towards the second; else QueryError."""
        way = subtract(second, first)
        length = hypot(*way)
        if not length > MIN_AXIS_RATIO * max(map(abs, (*first, *second))):
            raise QueryError(AXIS_POINTS_COINCIDE)
        return cls(first, frame_about([along / length for along in way]))

    def refer(self, body: PlainBody) -> ReferredInertia:
        """Refer the inertia of a body, given in the same coordinates, to this frame, by the parallel-axis theorem."""
        arm = subtract(body.center, self.origin)
        distance = hypot(*arm)
        rounded = 2.0 * U * sum(map(abs, (*body.center, *self.origin)))
        size = hypot(*body.inertia, *body.inertia[3:]) + sqrt(2.0) * body.mass * distance * distance
        bounds = []
        for bound, own in ((body.error_bound, rounded), (body.error_bound["input"], 0.0)):
            mass, center = bound["volume"] * body.density, bound["center_of_mass"] + own
            inertia = bound["inertia"] + sqrt(2.0) * distance * distance * mass
            inertia += body.mass * (6.0 * distance * center + 2.0 * center * center)
            bounds.append({"mass": mass, "center": center, "inertia": inertia})
        bounds[0]["center"] += 8.0 * U * distance
        bounds[0]["inertia"] += 40.0 * U * size
        turned = turn_tensor(move_tensor(body.inertia, body.mass, arm), self.axes)
        return ReferredInertia(self, body.mass, along_axes(arm, self.axes), turned, *bounds)


@dataclass(frozen=True, eq=False)
class ReferredInertia:
    """Inertia about a reference, along its axes.

    `center`: the center of mass from the reference's origin, along its axes; mass times this is the first moment.
    `inertia`: the six entries of the tensor about the reference's origin.
    `rounding_error`, `input_error`: absolute bounds of "mass", "center" and "inertia", as in `MassProperties`.
    """

    reference: Reference
    mass: float
    center: Vector
    inertia: Vector
    rounding_error: dict[str, float]
    input_error: dict[str, float]

    @property
    def about_z(self) -> float:
        """The moment of inertia about the reference's Z axis, the axis of `Reference.through_points`."""
        return self.inertia[2]

    @property
    def radius_about_z(self) -> float:
        """The radius of gyration about the reference's Z axis."""
        return sqrt(max(self.about_z, 0.0) / self.mass)

    @property
    def distance_from_z(self) -> float:
        """The distance of the center of mass from the reference's Z axis."""
        return hypot(*self.center[:2])
