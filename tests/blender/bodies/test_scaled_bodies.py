# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body of each kind that is larger, or in other units, has the numbers and the bounds of a larger body."""

import bpy
import numpy as np
import pytest
from body_moments.operators.bodies.measure_object import measure_object
from body_moments.operators.settings.options import MeasureOptions

from tests.blender.objects import add, mesh_body
from tests.blender.spline_bodies import surface
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
THICKNESS = 2.0**-7


def patch():
    u, v = np.meshgrid(np.arange(4.0), np.arange(4.0))
    return surface(np.stack([u, v, 0.25 * u * v], axis=2))


def ball():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    return bpy.context.object


def ring(dimensions):
    bpy.ops.curve.primitive_nurbs_circle_add()
    bpy.context.object.data.dimensions = dimensions
    return bpy.context.object


def instances():
    members = bpy.data.collections.new("Members")
    for place in (0.0, 8.0):
        member = add(mesh_body(), location=(place, 0.0, 0.0), scale=(1.0, 1.0 + place, 1.0))
        bpy.context.scene.collection.objects.unlink(member)
        members.objects.link(member)
    obj = add(None)
    obj.instance_type, obj.instance_collection = "COLLECTION", members
    return obj


KINDS = {
    "solid": (lambda: add(mesh_body()), {}),
    "sheet": (lambda: add(mesh_body()), {"kind": "shell"}),
    "wall": (lambda: add(mesh_body()), {"kind": "shell", "wall": "inward"}),
    "instances": (instances, {}),
    "instances, sheets": (instances, {"kind": "shell"}),
    "instances, walls": (instances, {"kind": "shell", "wall": "outward"}),
    "patches": (ball, {}),
    "sheet of patches": (patch, {"kind": "shell"}),
    "wall of patches": (patch, {"kind": "shell", "wall": "centered"}),
    "wire": (lambda: ring("3D"), {"kind": "wire"}),
    "region": (lambda: ring("2D"), {"kind": "shell"}),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_larger_body_has_larger_numbers_and_bounds(kind):
    make, options = KINDS[kind]
    obj, found = make(), []
    obj.location = (1.0, 2.0, 3.0)
    scene, scale = bpy.context.scene, np.array(obj.scale)
    for by, unit in ((1.0, 1.0), (4.0, 1.0), (1.0, 0.25)):
        scene.unit_settings.scale_length, obj.scale, obj.location = unit, by * scale, by * np.array((1.0, 2.0, 3.0))
        bpy.context.view_layer.update()
        given = MeasureOptions(density=1000.0, thickness=by * unit * THICKNESS, **options)
        found.append((by * unit, measure_object(obj, bpy.context.evaluated_depsgraph_get(), given)))
    plain, power = found[0][1], 3 if options.get("kind") == "wire" else 5
    rows = {"volume": 3, "area": 2, "center_of_mass": 1, "inertia": power}
    for factor, larger in found[1:]:
        assert close(larger.volume, factor**3 * plain.volume, 1e-12)
        assert close(larger.area, factor**2 * plain.area, 1e-12)
        assert close(larger.mass_properties.mass, factor ** (power - 2) * plain.mass_properties.mass, 1e-12)
        for now, own in (
            (larger.error_bound, plain.error_bound),
            (larger.error_bound["input"], plain.error_bound["input"]),
        ):
            for name, degree in rows.items():
                assert close(now[name], factor**degree * own[name], 1e-6), name
