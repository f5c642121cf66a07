# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes, ellipsoids and capsules with the mass, center and inertia of objects."""

from __future__ import annotations

import bmesh
import bpy
from bpy.types import Context, Depsgraph, Mesh, Object
from mathutils import Matrix

from ...core.numerics.float32 import shortest_decimal
from ...core.robots.model import Inertial, Shape
from ...core.robots.primitives import equal_inertia_shape
from ..bodies.measure_object import measure_body

SEGMENTS, RINGS = 32, 17  # odd, so that no ring lies on the equator


def find_primitive(obj: Object, depsgraph: Depsgraph, kind: str) -> tuple[Shape, float]:
    """Return the shape of a kind with the inertia of an object, in meters, and its mass in kg."""
    body = measure_body(obj, depsgraph).measurement.mass_properties
    inertial = Inertial(body.mass, body.center, body.inertia, body.principal.moments, body.principal.axes)
    return equal_inertia_shape(inertial, kind), body.mass


def add_primitive(context: Context, obj: Object, shape: Shape, mass: float) -> Object:
    """Add an object with the given shape and mass, at the center of mass of `obj`, and return it."""
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    name = "{} {}".format(obj.name, shape.kind.title())
    new = bpy.data.objects.new(name, _mesh(name, shape, unit))
    holder = next(iter(obj.users_collection), context.scene.collection)
    holder.objects.link(new)
    matrix = Matrix(shape.pose.rotation.tolist()).to_4x4()
    matrix.translation = shape.pose.position / unit
    new.matrix_world = matrix
    new.display_type, new.hide_render = "WIRE", True
    new.body_moments.mass_from, new.body_moments.mass = "MASS", mass
    return new


def _mesh(name: str, shape: Shape, unit: float) -> Mesh:
    """Return a mesh of the shape in Blender units, in the shape's own frame."""
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
