# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of a body as plain numbers: in other frames, and summed, without numpy, while a panel is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, sqrt
from sys import float_info
from typing import TYPE_CHECKING, Any, NamedTuple

from ...core.inertia.tensors import (
    TENSOR,
    Axes,
    Vector,
    along_axes,
    move_tensor,
    principal_axes,
    rotation_axes,
    turn_tensor,
)
from ...core.numerics.vectors import subtract

if TYPE_CHECKING:
    from mathutils import Matrix

    from ...core.inertia.mass_properties import MassProperties

BOUND_KEYS = ("volume", "area", "center_of_mass", "inertia")
ENTRIES, ROWS, COLUMNS = zip(*TENSOR)


class StoredProperties(NamedTuple):
    """Stored results of an object as plain numbers, SI, in the object frame, or in the world after `in_world`.

    center: (3,). inertia: (6,) in the order of ENTRIES. moments, axes: the (3,) principal moments, and the axes as
    three vectors. error_bound: as in `Measurement`.
    """

    mass: float
    density: float
    volume: float
    area: float
    center: Vector
    inertia: Vector
    moments: Vector
    axes: tuple[Vector, ...]
    error_bound: dict[str, Any]

    @classmethod
    def of_body(
        cls, body: MassProperties, density: float, volume: float, area: float, error_bound: dict[str, Any]
    ) -> StoredProperties:
        """Return mass properties as plain numbers, with density, volume, area and error bound."""
        center, entries, moments = body.center.tolist(), body.inertia[ROWS, COLUMNS].tolist(), body.principal.moments
        axes = tuple(map(tuple, body.principal.axes.T.tolist()))
        return cls(
            body.mass, density, volume, area, tuple(center), tuple(entries), tuple(moments.tolist()), axes, error_bound
        )

    @property
    def gyration(self) -> Vector:
        """(3,) radii of gyration about the principal axes."""
        return tuple(sqrt(max(moment, 0.0) / self.mass) if self.mass > 0.0 else 0.0 for moment in self.moments)

    @property
    def bounds(self) -> tuple[dict[str, float], dict[str, float]]:
        """Bounds of "mass", "center" and "inertia": of rounding, and of float32 coordinates."""
        rounding, moved = (
            {"mass": bound["volume"] * self.density, "center": bound["center_of_mass"], "inertia": bound["inertia"]}
            for bound in (self.error_bound, self.error_bound["input"])
        )
        return rounding, moved

    def along_axes(self, axes: Axes) -> StoredProperties:
        """Return the results in a frame with other axes and the same origin."""
        return self._replace(
            center=along_axes(self.center, axes),
            inertia=turn_tensor(self.inertia, axes),
            axes=tuple(along_axes(axis, axes) for axis in self.axes),
        )

    def in_world(self, matrix_world: Matrix, unit: float) -> StoredProperties:
        """Return the results in the world frame.

        matrix_world: of the object; unit: meters per Blender unit.
        """
        location, turn, _ = matrix_world.decompose()
        turned = self.along_axes(tuple(zip(*rotation_axes(turn))))
        return turned._replace(center=tuple(value + unit * along for value, along in zip(turned.center, location)))

    def in_object(self, matrix_world: Matrix, unit: float) -> StoredProperties:
        """Return the results of the world frame in the object frame, as `in_world` takes them."""
        location, turn, _ = matrix_world.decompose()
        from_there = tuple(value - unit * along for value, along in zip(self.center, location))
        return self._replace(center=from_there).along_axes(rotation_axes(turn))


def add(parts: Sequence[StoredProperties]) -> StoredProperties | None:
    """Return bodies as one, in their common frame, by the parallel-axis theorem; None if they have no mass."""
    mass, volume, area = (sum([getattr(part, name) for part in parts]) for name in ("mass", "volume", "area"))
    if not mass > 0.0:  # the stored values were changed
        return None
    center = tuple(sum([part.mass * part.center[axis] for part in parts]) / mass for axis in range(3))
    arms = [subtract(part.center, center) for part in parts]
    tensors = [move_tensor(part.inertia, part.mass, arm) for part, arm in zip(parts, arms)]
    tensor = tuple(map(sum, zip(*tensors)))
    moments, axes, _ = principal_axes(tensor)
    reach = [hypot(*arm) for arm in arms]
    bound = _bound_of_sum(parts, reach, [part.error_bound for part in parts])
    bound["input"] = _bound_of_sum(parts, reach, [part.error_bound["input"] for part in parts])
    density = mass / volume if volume else 0.0
    return StoredProperties(mass, density, volume, area, center, tensor, moments, axes, bound)


def _bound_of_sum(
    parts: Sequence[StoredProperties], arms: Sequence[float], bounds: Sequence[dict[str, float]]
) -> dict[str, Any]:
    """Return the bound of a sum of bodies, from the bound of each, and its distance from the center."""
    # a shell without thickness has its mass by area
    shares = [
        bound["volume"] / part.volume if part.volume > 0.0 else bound["area"] / max(part.area, float_info.min)
        for part, bound in zip(parts, bounds)
    ]
    bodies = [
        (part.mass, share, arm, bound["center_of_mass"]) for part, share, arm, bound in zip(parts, shares, arms, bounds)
    ]
    mass = sum([part.mass for part in parts])
    center = sum([own * ((1.0 + share) * error + share * arm) for own, share, arm, error in bodies]) / mass
    inertia = sum([bound["inertia"] for bound in bounds])
    for own, share, arm, error in bodies:
        reach = arm + error + center
        inertia += own * ((1.0 + share) * (reach * reach - arm * arm) + share * arm * arm)
    values = sum([bound["volume"] for bound in bounds]), sum([bound["area"] for bound in bounds]), center, inertia
    return dict(zip(BOUND_KEYS, values))
