# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of known mass: given, with or without its center and inertia.

Objects and assemblies have these settings alike; they count if the mass is given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bpy.types import Object, PropertyGroup
from numpy.typing import NDArray

from ...core.numerics.float32 import shortest_decimal

GIVEN_PROPERTIES = ("use_center", "given_center", "use_inertia", "given_inertia_diagonal", "given_inertia_products")


@dataclass(frozen=True, eq=False)
class GivenPart:
    """Given values of a part beside its mass, SI, in its own frame; a value is None if it follows from the geometry.

    center: (3,) center of mass, m. inertia: (3, 3) tensor about the center, kg·m².
    """

    center: NDArray[np.float64] | None = None
    inertia: NDArray[np.float64] | None = None

    @classmethod
    def from_settings(cls, settings: PropertyGroup, unit: float) -> GivenPart:
        """Return the given part of the settings.

        unit: meters per Blender unit.
        """
        center = inertia = None
        if settings.use_center:
            center = _decimals(settings.given_center) * unit
        if settings.use_inertia:
            inertia = np.diag(_decimals(settings.given_inertia_diagonal))
            xy, xz, yz = _decimals(settings.given_inertia_products)
            inertia += np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]])
        return cls(center, inertia)

    def __bool__(self) -> bool:
        return self.center is not None or self.inertia is not None

    @property
    def key(self) -> str:
        """Text that changes with the settings, "" if nothing is given."""
        values = [None if value is None else value.tolist() for value in (self.center, self.inertia)]
        return repr(values) if self else ""


def shows_collection(obj: Object) -> bool:
    """Return whether the object instances a collection: one stays chosen after its instancing was switched off."""
    return obj.instance_type == "COLLECTION" and obj.instance_collection is not None


def is_point_mass(obj: Object) -> bool:
    """Return whether an object without any geometry stands for a part of given mass."""
    settings = getattr(obj, "body_moments", None)  # none where the add-on is not registered
    return obj.type == "EMPTY" and not shows_collection(obj) and settings is not None and settings.mass_from == "MASS"


def _decimals(values) -> NDArray[np.float64]:
    return np.array([shortest_decimal(value) for value in values])
