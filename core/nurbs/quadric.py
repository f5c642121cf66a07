# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cylinders, cones, spheres and tori, by the angle about their axis and a second coordinate."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..numerics import Array, NDArray

TURN = 2.0 * math.pi


@dataclass(frozen=True, eq=False)
class Quadric:
    """A whole surface of revolution of a line or a circle; its normal points away from them, or
    toward them if the frame is left-handed.

    frame: (4, 4), third axis: that of the surface. radius: of a cylinder, of a cone at the origin,
    or from a torus' axis to its tube; 0 for a sphere. minor: radius of a sphere or a tube, 0 for a
    line, whose radius grows by `slope` along the axis. Of a tube that crosses the axis, the part on
    one side: the outer one, or the inner one with a radius below 0.

    Coordinates are the angle about the axis, and the height along it or the angle along the circle.
    """

    frame: Array
    radius: float = 0.0
    minor: float = 0.0
    slope: float = 0.0

    @property
    def periods(self) -> tuple[float, float]:
        """Periods of both coordinates, 0 if there is none."""
        return TURN, TURN if 0.0 < self.minor < self.radius else 0.0

    @property
    def is_closed(self) -> bool:
        """Whether the surface is a sphere or a torus."""
        return self.minor > 0.0

    @property
    def limits(self) -> tuple[float, float]:
        """Ends of the second coordinate on a closed surface, or the apex of a cone, or infinite."""
        if self.minor:
            half = math.acos(max(-1.0, -self.radius / self.minor))
            return -half, half
        apex = -self.radius / self.slope if self.slope else math.inf
        return (apex, math.inf) if self.slope > 0.0 else (-math.inf, apex)

    def knots(self, axis: int, low: float, high: float) -> Array:
        """Return no knots: the surface is smooth."""
        return np.zeros(0)

    def step(self, each: int) -> tuple[float, float]:
        """Return the widths of tiles, `each` to a quarter of a turn."""
        width = TURN / 4.0 / each
        return width, width if self.minor else math.inf

    def transform(self, matrix: NDArray) -> Quadric:
        """Return the image of the surface under a (4, 4) affine map."""
        return replace(self, frame=np.asarray(matrix) @ self.frame)

    def reverse_orientation(self) -> Quadric:
        """Return the same surface facing the other way, its angle running backward."""
        return replace(self, frame=self.frame @ np.diag([1.0, -1.0, 1.0, 1.0]))

    def evaluate(self, u: NDArray, v: NDArray, most: int = 1) -> list[Array]:
        """Return (3, ...) points at coordinates, derivatives by u and v, and if most = 2 by uu, uv
        and vv.
        """
        cosine, sine = np.cos(u), np.sin(u)
        if self.minor:
            height, inward = self.minor * np.sin(v), self.minor * np.cos(v)
            profile = [(self.radius + inward, height), (-height, inward), (-inward, -height)]
        else:
            profile = [(self.radius + self.slope * v, v), (self.slope, 1.0), (0.0, 0.0)]
        (r, z), (r_v, z_v), (r_vv, z_vv) = profile
        rows = [
            (r * cosine, r * sine, z),
            (-r * sine, r * cosine, 0.0),
            (r_v * cosine, r_v * sine, z_v),
        ]
        if most > 1:
            rows += [
                (-r * cosine, -r * sine, 0.0),
                (-r_v * sine, r_v * cosine, 0.0),
                (r_vv * cosine, r_vv * sine, z_vv),
            ]
        local = np.empty((3, len(rows), *np.broadcast_shapes(np.shape(u), np.shape(v))))
        for k, row in enumerate(rows):
            for axis in range(3):
                local[axis, k] = row[axis]
        placed = (self.frame[:3, :3] @ local.reshape(3, -1)).reshape(local.shape)
        placed[:, 0] += self.frame[:3, 3].reshape(3, *[1] * (local.ndim - 2))
        return [placed[:, k] for k in range(len(rows))]

    def project(self, points: NDArray, guess: NDArray | None = None) -> Array:
        """Return (n, 2) coordinates of the points of the surface nearest to points, in its frame;
        angles nearest to a guess (n, 2).
        """
        x, y, z = self._inverse[:, :3] @ points.T + self._inverse[:, 3:]
        distance = np.hypot(x, y) - self.radius
        if self.minor:
            second = np.arctan2(z, distance)
        else:
            second = (z + self.slope * distance) / (1.0 + self.slope**2)
        coordinates = np.stack([np.arctan2(y, x), second], axis=1)
        if guess is not None:
            for axis, period in enumerate(self.periods):
                if period:
                    turns = np.round((guess[:, axis] - coordinates[:, axis]) / period)
                    coordinates[:, axis] += period * turns
        return coordinates

    @cached_property
    def _inverse(self) -> Array:
        return np.asarray(np.linalg.inv(self.frame)[:3], np.float64)
