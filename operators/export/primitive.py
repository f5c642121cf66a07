# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Equal-Inertia Shape: a box, an ellipsoid or a capsule with the mass, center and inertia of an object.

Its origin is the center of mass and its axes are the principal ones, which Bullet assumes; and the inertia that Bullet
computes from a box is that of the box. So a box with the object as its child falls as the object does.
"""

from __future__ import annotations

import bmesh
import bpy
from bpy.props import BoolProperty, EnumProperty
from bpy.types import Context, Menu, Mesh, Object, Operator
from mathutils import Matrix

from ...blender.bodies.measure_object import measure_object
from ...blender.scene.rigid_world import add_rigid_bodies, require_rigid_world
from ...core.numerics.float32 import shortest_decimal
from ...core.robots.model import Inertial, Shape
from ...core.robots.primitives import equal_inertia_shape
from ...core.verdict.finding import EditRefusedError, finding
from .. import selection
from ..findings import PRIMITIVE_HAS_PARENT, PRIMITIVES_ADDED

KINDS = (
    ("BOX", "Box", "The box of the same mass, center and inertia"),
    ("ELLIPSOID", "Ellipsoid", "The ellipsoid of the same mass, center and inertia"),
    ("CAPSULE", "Capsule", "The capsule of the same mass and center, and of the inertia that comes nearest"),
)
COLLISION_SHAPES = {"BOX": "BOX", "ELLIPSOID": "CONVEX_HULL", "CAPSULE": "CONVEX_HULL"}
SEGMENTS, RINGS = 32, 17  # odd, so that no ring lies on the equator


class OBJECT_OT_body_moments_equal_inertia(Operator):
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

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        depsgraph = context.evaluated_depsgraph_get()
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        shapes: list[tuple[Object, Shape, float]] = []

        def measure(obj: Object) -> None:
            if self.rigid_body and (not obj.is_editable or obj.parent is not None):
                raise EditRefusedError(PRIMITIVE_HAS_PARENT)
            if self.rigid_body:
                require_rigid_world(context.scene)
            body = measure_object(obj, depsgraph).mass_properties
            inertial = Inertial(body.mass, body.center, body.inertia, body.principal.moments, body.principal.axes)
            shapes.append((obj, equal_inertia_shape(inertial, self.kind.lower()), body.mass))

        _, failures = selection.apply_to_all(objects, measure)
        added = [self._add(context, obj, shape, mass, unit) for obj, shape, mass in shapes]
        if self.rigid_body:
            self._make_rigid(context, [(new, mass) for new, (_, _, mass) in zip(added, shapes)])
            for new, (obj, _, _) in zip(added, shapes):
                obj.parent, obj.matrix_parent_inverse = new, new.matrix_world.inverted()
        done = finding(PRIMITIVES_ADDED, count=len(added))
        return selection.summarize(self, len(added), len(objects), done, failures)

    def _add(self, context: Context, obj: Object, shape: Shape, mass: float, unit: float) -> Object:
        name = "{} {}".format(obj.name, self.kind.title())
        new = bpy.data.objects.new(name, _mesh(name, shape, unit))
        holder = next(iter(obj.users_collection), context.scene.collection)
        holder.objects.link(new)
        matrix = Matrix(shape.pose.rotation.tolist()).to_4x4()
        matrix.translation = shape.pose.position / unit
        new.matrix_world = matrix
        new.display_type, new.hide_render = "WIRE", True
        new.body_moments.mass_from, new.body_moments.mass = "MASS", mass
        return new

    def _make_rigid(self, context: Context, bodies: list[tuple[Object, float]]) -> None:
        add_rigid_bodies(context, [obj for obj, _ in bodies])
        for obj, mass in bodies:
            obj.rigid_body.collision_shape = COLLISION_SHAPES[self.kind]
            obj.rigid_body.mass = mass


def _mesh(name: str, shape: Shape, unit: float) -> Mesh:
    """Return the shape in Blender units, in its own frame."""
    made = bmesh.new()
    if shape.kind == "box":
        bmesh.ops.create_cube(made, size=1.0)
    else:
        bmesh.ops.create_uvsphere(made, u_segments=SEGMENTS, v_segments=RINGS, radius=1.0)
    for vertex in made.verts:
        x, y, z = vertex.co
        if shape.kind == "capsule":
            radius, length = shape.size
            half = length / 2.0 if z > 0.0 else -length / 2.0
            vertex.co = (x * radius / unit, y * radius / unit, (z * radius + half) / unit)
        else:
            vertex.co = [value * size / unit for value, size in zip((x, y, z), shape.size)]
    mesh = bpy.data.meshes.new(name)
    made.to_mesh(mesh)
    made.free()
    return mesh


def _menu(menu: Menu, _context: Context) -> None:
    menu.layout.separator()
    menu.layout.operator(OBJECT_OT_body_moments_equal_inertia.bl_idname, icon="MESH_CUBE")


def register() -> None:
    bpy.utils.register_class(OBJECT_OT_body_moments_equal_inertia)
    bpy.types.VIEW3D_MT_object_rigid_body.append(_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object_rigid_body.remove(_menu)
    bpy.utils.unregister_class(OBJECT_OT_body_moments_equal_inertia)
