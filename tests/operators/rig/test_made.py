# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Centers and joints that operators make for each bone of a character."""

import bpy
import pytest
from body_moments.blender.session.tracking import staleness

from tests.blender.objects import add, measure, mesh_body, only, place
from tests.operators.characters import character, measured

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("density", [1000.0, 1e-5])
def test_rig_center_weights_each_part_by_mass(density):
    bpy.context.scene.unit_settings.scale_length = unit = 0.5
    armature, _ = character(density=density)
    armature.location, armature.rotation_euler = (3, 2, 1), (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    rig = measured(armature)
    assert bpy.ops.object.body_moments_rig_center() == {"FINISHED"}
    center = bpy.data.objects["Rig Center of Mass"]
    gyration = rig.measurement.mass_properties.radii_of_gyration.max() / unit
    assert center.show_in_front and center.empty_display_type == "SPHERE"
    assert center.empty_display_size == pytest.approx(0.1 * gyration)
    assert [one.name for one in center.constraints] == [part.name for part in rig.parts] and len(
        rig.parts
    ) == 7
    mass = 0.0
    for part, constraint in zip(rig.parts, center.constraints, strict=True):
        mass += part.mass.total
        assert constraint.type == "COPY_LOCATION" and constraint.influence == pytest.approx(
            part.mass.total / mass
        )
        empty, bone = constraint.target, armature.data.bones[part.name]
        assert empty.name == "Rig {:s} Center".format(part.name) and empty.hide_get()
        assert (empty.parent, empty.parent_type, empty.parent_bone) == (armature, "BONE", part.name)
        assert empty.empty_display_size == pytest.approx(0.1 * bone.length)
        assert place(empty)[:3, 3] * unit == pytest.approx(part.mass.center, rel=1e-5, abs=1e-5)
    assert place(center)[:3, 3] * unit == pytest.approx(
        rig.measurement.mass_properties.center, rel=1e-5, abs=1e-5
    )


def test_library_rig_center_stays_beside_new_one(tmp_path):
    armature, skin = character()
    skin_name = skin.name
    bpy.ops.object.body_moments_rig_center()
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {armature, skin, bpy.data.collections["Rig Center of Mass"]})
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.objects, names.collections = ["Rig", skin_name], ["Rig Center of Mass"]
    (linked,) = names.collections
    for obj in names.objects:
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.scene.collection.children.link(linked)
    bpy.context.view_layer.objects.active = names.objects[0]
    count = len(linked.objects)
    assert bpy.ops.object.body_moments_rig_center() == {"FINISHED"}
    (made_here,) = [one for one in bpy.data.collections if one.library is None]
    assert len(made_here.objects) == len(linked.objects) == count


@pytest.mark.parametrize("operator", ["rig_center", "physics_rig"])
def test_made_rig_objects_keep_results_current(operator):
    """Of other rigid bodies too, and of densities by materials, which no digest of a shape has."""
    other = add(mesh_body(), "Other", (9, 0, 0))
    other.data.materials.append(bpy.data.materials.new("Steel"))
    other.body_moments.density_from = "MATERIALS"
    bpy.ops.rigidbody.object_add()
    armature, _ = character()
    measure(other)
    only(armature)
    bpy.ops.object.body_moments_measure_bones()
    assert getattr(bpy.ops.object, "body_moments_" + operator)() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert staleness.stale_reason(other, bpy.context.scene) is None
    assert staleness.stale_reason(armature, bpy.context.scene) is None


def test_joint_limits_follow_inverse_kinematics():
    armature, _ = character()
    bone = armature.pose.bones["arm.L"]
    bone.lock_ik_x = bone.use_ik_limit_x = bone.use_ik_limit_y = True
    bone.ik_min_x, bone.ik_max_x, bone.ik_min_y, bone.ik_max_y = -1.0, 1.0, -0.5, 0.25
    bone.ik_min_z, bone.ik_max_z = -0.125, 0.75
    assert bpy.ops.object.body_moments_physics_rig() == {"FINISHED"}
    joint = bpy.data.objects["Rig arm.L Joint"].rigid_body_constraint
    found = {
        axis: [
            getattr(joint, name.format(axis))
            for name in ("limit_ang_{}_lower", "limit_ang_{}_upper")
        ]
        for axis in "xyz"
    }
    assert [joint.use_limit_ang_x, joint.use_limit_ang_y, joint.use_limit_ang_z] == [
        True,
        True,
        False,
    ]
    assert found == {"x": [0.0, 0.0], "y": [-0.5, 0.25], "z": [-0.125, 0.75]}
    for axis in "xyz":
        assert getattr(joint, "use_limit_lin_" + axis)
        assert [
            getattr(joint, "limit_lin_{}_{}".format(axis, end)) for end in ("lower", "upper")
        ] == [0.0, 0.0]
