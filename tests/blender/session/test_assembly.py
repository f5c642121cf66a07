# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Members count once their results are part of the whole assembly."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import assembly
from mathutils import Matrix, Vector

from tests.blender.bodies.test_assembly import box, collection
from tests.blender.objects import add, only
from tests.close import close
from tests.operators.assembly.test_assembly import activate

pytestmark = pytest.mark.usefixtures("registered", "scene")


def other_frame(obj):
    """The same body in other coordinates, measured again."""
    obj.data.transform(Matrix.Translation((-1.0, 0.5, 2.0)))
    obj.location = obj.matrix_world @ Vector((1.0, -0.5, -2.0))
    bpy.context.view_layer.update()
    only(obj)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}


@pytest.mark.parametrize("unit", [1.0, 0.01])
def test_members_count_whose_results_are_part_of_the_whole(unit):
    """Neither what was left out nor what has none; assemblies in it by their members."""
    bpy.context.scene.unit_settings.scale_length = unit
    root = collection("Robot")
    arm = collection("Arm", root)
    nothing, first = add(bpy.data.meshes.new("Nothing"), "a nothing"), box(root, (1, 2, 3), (4, 5, 6), name="b first")
    second, left_out = box(arm, (2, 1, 1), (-3, 0, 0), name="second"), box(root, (1, 1, 1), name="c left out")
    bpy.context.scene.collection.objects.unlink(nothing)
    root.objects.link(nothing)
    first.rotation_euler = (0.3, 0.2, 0.1)
    only(left_out)
    bpy.ops.object.body_moments_measure()
    left_out.hide_render = True
    bpy.context.view_layer.update()
    activate(root)
    assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"}
    count = len(root.body_moments.rows)
    assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"} and len(root.body_moments.rows) == count
    assert "body_mass" in arm and "body_mass" in left_out and "body_mass" not in nothing
    found = assembly._member_bodies(assembly.members_of(root, bpy.context.evaluated_depsgraph_get()))
    assert found.keys() == {first, second}
    for obj, size, center in ((first, (1, 2, 3), (4, 5, 6)), (second, (2, 1, 1), (-3, 0, 0))):
        mass, place, radius = found[obj]
        assert close(mass, 1000.0 * np.prod(size) * unit**3, 1e-6)
        assert close(place, unit * np.array(center), 1e-6)
        assert close(radius, unit * np.sqrt(np.dot(size, size) / 12.0), 1e-6)
    with assembly.kept_up_to_date(bpy.context):
        other_frame(first)
        left_out.body_moments.density = 1.0
        bpy.context.view_layer.update()
    assert assembly.stale_reason(root) is None
