# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties of a part of known mass, shared by the settings of objects and of assemblies."""

from bpy.props import BoolProperty, FloatVectorProperty

from .hooks import given_changed


class GivenPartProperties:
    """Optional given values beside a mass."""

    use_center: BoolProperty(
        name="Given Center",
        description="Enter the center of mass instead of taking that of the geometry",
        default=False,
        update=given_changed,
    )
    given_center: FloatVectorProperty(
        name="Center of Mass",
        description="Center of mass from the origin, along the axes of the object. Of a collection, in the world",
        subtype="XYZ",
        unit="LENGTH",
        precision=6,
        update=given_changed,
    )
    use_inertia: BoolProperty(
        name="Given Inertia",
        description="Enter the inertia tensor instead of taking that of the geometry with the given mass",
        default=False,
        update=given_changed,
    )
    given_inertia_diagonal: FloatVectorProperty(
        name="Ixx, Iyy, Izz",
        description=(
            "Diagonal of the inertia tensor about the center of mass in kg·m², independent of the scene units, along "
            "the axes of the object. Of a collection, along the world axes"
        ),
        min=0.0,
        precision=6,
        update=given_changed,
    )
    given_inertia_products: FloatVectorProperty(
        name="Ixy, Ixz, Iyz",
        description="Tensor entries off the diagonal in kg·m², independent of the scene units: Ixy = −∫xy dm",
        precision=6,
        update=given_changed,
    )
