# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of masses and densities that objects, materials, assemblies and bones share; given
centers and inertia.

A given center and inertia count only if the mass is given.
"""

from typing import Any, NamedTuple

from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty
from bpy.types import Object, PropertyGroup

from ...core import measurement, numerics
from .hooks import Hook, changed

GIVEN_PROPERTIES = (
    "use_center",
    "given_center",
    "use_inertia",
    "given_inertia_diagonal",
    "given_inertia_products",
)
SURFACE_TYPES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
GEOMETRY_TYPES = SURFACE_TYPES | {"CURVES", "POINTCLOUD", "VOLUME", "GREASEPENCIL"}
Row = tuple[float, ...]
# ID property of a collider: kind, size in m and mass in kg; its parent is the body
COLLIDER = "body_collider"
COLLIDERS = "body_colliders"  # ID property of a body with colliders: what they do to its physics


def choice_property(
    name: str, description: str, *items: tuple[str, str, str], **special: Any
) -> Any:
    """Return a property with one of several values."""
    return EnumProperty(name=name, description=description, items=items, **special)


def mass_property(description: str, update: Hook, name: str = "Mass") -> Any:
    """Return a property of a given mass."""
    return FloatProperty(
        name=name,
        description=description,
        default=1.0,
        min=0.0,
        step=10,
        precision=6,
        update=update,
    )


def density_property(description: str, update: Hook, **special: Any) -> Any:
    """Return a property of a density in kg/m³; `special` arguments replace the usual ones."""
    usual = {
        "name": "Density",
        "default": 1000.0,
        "min": 0.0,
        "soft_max": 25000.0,
        "step": 1000,
        "precision": 3,
    }
    return FloatProperty(description=description, update=update, **(usual | special))


class GivenPartProperties:
    """Optional given values beside a mass."""

    use_center: BoolProperty(
        name="Given Center",
        description="Enter the center of mass instead of taking that of the geometry",
        update=changed,
    )
    given_center: FloatVectorProperty(
        name="Center of Mass",
        description="Center of mass from the origin, along the axes of the object. Of a "
        "collection, in the world",
        subtype="XYZ",
        unit="LENGTH",
        precision=6,
        update=changed,
    )
    use_inertia: BoolProperty(
        name="Given Inertia",
        description="Enter the inertia tensor instead of taking that of the geometry with the "
        "given mass",
        update=changed,
    )
    given_inertia_diagonal: FloatVectorProperty(
        name="Ixx, Iyy, Izz",
        description=(
            "Diagonal of the inertia tensor about the center of mass in kg·m², independent of the "
            "scene units, along "
            "the axes of the object. Of a collection, along the world axes"
        ),
        min=0.0,
        precision=6,
        update=changed,
    )
    given_inertia_products: FloatVectorProperty(
        name="Ixy, Ixz, Iyz",
        description="Tensor entries off the diagonal in kg·m², independent of the scene units: Ixy "
        "= −∫xy dm",
        precision=6,
        update=changed,
    )


class GivenPart(NamedTuple):
    """Given values of a part besides its mass, SI, in its own frame; None for values that follow
    from the geometry.

    center: (3,) center of mass, m. inertia: (3, 3) rows of the tensor about the center, kg·m².
    """

    center: Row | None = None
    inertia: tuple[Row, ...] | None = None

    @classmethod
    def from_settings(cls, settings: PropertyGroup, unit: float) -> "GivenPart":
        """Return the given values in the settings of an object or assembly. unit: meters per
        Blender unit.
        """
        center = inertia = None
        if settings.use_center:
            center = tuple(
                unit * numerics.shortest_decimal(value) for value in settings.given_center
            )
        if settings.use_inertia:
            xx, yy, zz = map(numerics.shortest_decimal, settings.given_inertia_diagonal)
            xy, xz, yz = map(numerics.shortest_decimal, settings.given_inertia_products)
            inertia = (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)
        return cls(center, inertia)

    def __bool__(self) -> bool:
        return self.center is not None or self.inertia is not None

    @property
    def key(self) -> str:
        """A text that changes with the given values, "" if there are none."""
        return repr(measurement.plain([self.center, self.inertia])) if self else ""


def shows_collection(obj: Object) -> bool:
    """Return whether the object instances a collection; a chosen collection may have its instancing
    off.
    """
    return obj.instance_type == "COLLECTION" and obj.instance_collection is not None


def has_density(obj: Object) -> bool:
    """Return whether an object has a density: geometry, or instances of a collection."""
    return obj.type in GEOMETRY_TYPES or shows_collection(obj)


def body_of(obj: Object) -> Object:
    """Return the body of a collider, and any other object itself."""
    return obj.parent if COLLIDER in obj and obj.parent is not None else obj


def is_point_mass(obj: Object) -> bool:
    """Return whether an object without geometry is a part of given mass."""
    settings = getattr(obj, "body_moments", None)  # None if the add-on is not registered
    return (
        obj.type == "EMPTY"
        and not shows_collection(obj)
        and settings is not None
        and settings.mass_from == "MASS"
    )
