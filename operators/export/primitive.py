# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Equal-Inertia Shape: a box, an ellipsoid or a capsule with the mass, center and inertia of an object.

Its origin is the center of mass and its axes are the principal ones, which Bullet assumes; and from a box Bullet
computes exactly the inertia of that box. So a box with the object as its child falls as the object does.
"""

from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty, EnumProperty
from bpy.types import Context, Menu, Object, Operator

from ...blender import scene
from ...blender.write import reports
from ...core.verdict.finding import EditRefusedError
from .. import selection
from ..findings import PRIMITIVE_HAS_PARENT

if TYPE_CHECKING:
    from ...core.robots.model import Shape

KINDS = (
    ("BOX", "Box", "The box of the same mass, center and inertia"),
    ("ELLIPSOID", "Ellipsoid", "The ellipsoid of the same mass, center and inertia"),
    ("CAPSULE", "Capsule", "The capsule of the same mass and center, and of the inertia that comes nearest"),
)
COLLISION_SHAPES = {"BOX": "BOX", "ELLIPSOID": "CONVEX_HULL", "CAPSULE": "CONVEX_HULL"}


class OBJECT_OT_body_moments_equal_inertia(selection.OnSelectionInObjectMode, Operator):
    """Add a simple shape with the mass, center of mass and inertia of each selected object"""

    bl_idname = "object.body_moments_equal_inertia"
    bl_label = "Add Equal-Inertia Shape"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(name="Shape", description="What is added", items=KINDS, default="BOX")
    rigid_body: BoolProperty(
        name="As Rigid Body",
        description="Make the shape an active rigid body with the mass, and the object its child",
        default=False,
    )

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        depsgraph = context.evaluated_depsgraph_get()
        shapes: list[tuple[Object, Shape, float]] = []

        def measure(obj: Object) -> None:
            if self.rigid_body and (not obj.is_editable or obj.parent is not None):
                raise EditRefusedError(PRIMITIVE_HAS_PARENT)
            if self.rigid_body:
                scene.rigid_world.require_rigid_world(context.scene)
            shapes.append((obj, *scene.find_primitive(obj, depsgraph, self.kind.lower())))

        _, failures = selection.apply_to_all(objects, measure)
        added = [scene.add_primitive(context, obj, shape, mass) for obj, shape, mass in shapes]
        if self.rigid_body:
            self._make_rigid(context, [(new, mass) for new, (_, _, mass) in zip(added, shapes)])
            for new, (obj, _, _) in zip(added, shapes):
                obj.parent, obj.matrix_parent_inverse = new, new.matrix_world.inverted()
        done = reports.phrase("{count} shape added", "{count} shapes added", count=len(added))
        return selection.summarize(self, len(added), len(objects), done, failures)

    def _make_rigid(self, context: Context, bodies: list[tuple[Object, float]]) -> None:
        scene.rigid_world.add_rigid_bodies(context, [obj for obj, _ in bodies])
        for obj, mass in bodies:
            obj.rigid_body.collision_shape = COLLISION_SHAPES[self.kind]
            obj.rigid_body.mass = mass


def _menu(menu: Menu, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.operator(OBJECT_OT_body_moments_equal_inertia.bl_idname, icon="MESH_CUBE")


CLASSES = (OBJECT_OT_body_moments_equal_inertia,)
MENUS = ((bpy.types.VIEW3D_MT_object_rigid_body, _menu),)
