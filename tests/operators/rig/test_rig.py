# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of skinned characters: what each part weighs, in rest pose and the bone's rest frame,
however it is posed.
"""

from math import inf

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.read.joints import bone_freedom, bone_parents
from body_moments.blender.session.displayed import drawn, drawn_bone
from body_moments.blender.session.robots import bone_links
from body_moments.blender.session.tracking import handlers, staleness
from body_moments.blender.session.tracking.stamps import Stale
from body_moments.blender.write import properties
from body_moments.core.polyhedron.integration import volume_and_center

from tests.blender.boxes import box_mesh
from tests.blender.characters import armature_of, pose, skin_of
from tests.blender.objects import add, arrays, dent, only
from tests.close import close
from tests.core import characters as made
from tests.operators.characters import character, measured

pytestmark = pytest.mark.usefixtures("registered", "scene")


def codes(rig):
    return {found.code for found in rig.measurement.findings}


def test_bone_results_are_exact_in_rest_frame_at_any_pose():
    armature, _ = character()
    armature.location, armature.rotation_euler = (3, 2, 1), (0.1, 0.2, 0.3)
    pose(armature)
    before = [list(row) for row in armature.pose.bones["arm.L"].matrix]
    assert bpy.ops.object.body_moments_measure_bones() == {"FINISHED"}
    assert armature.data.pose_position == "POSE"
    assert [list(row) for row in armature.pose.bones["arm.L"].matrix] == before
    for name, (low, high) in zip(made.NAMES, made.BOXES):
        bone = armature.pose.bones[name]
        size, center = np.subtract(high, low).astype(float), np.add(high, low) / 2.0
        mass = 1000.0 * size.prod()
        assert close(bone["body_mass"], mass, 2e-6)  # the armature's matrix is float32
        rest = np.array(bone.bone.matrix_local, np.float64)
        local = rest[:3, :3].T @ (center - rest[:3, 3])
        assert np.abs(np.array(bone["body_center_of_mass"].to_list()) - local).max() < 1e-5
        tensor = rest[:3, :3].T @ np.diag((size @ size - size * size) * mass / 12.0) @ rest[:3, :3]
        xx, yy, zz, xy, xz, yz = bone["body_inertia"].to_list()
        found = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert np.abs(found - tensor).max() < 1e-5 * tensor.max()
        assert bone["body_method"] == "exact" and set(properties.FIELDS) <= set(bone.keys())
    assert close(
        armature["body_mass"],
        1000.0 * sum(np.prod(np.subtract(h, low)) for low, h in made.BOXES),
        2e-6,
    )
    assert staleness.stale_reason(armature, bpy.context.scene) is None
    bpy.ops.object.body_moments_clear_bones()
    assert not any("body_mass" in owner for owner in (armature, *armature.pose.bones))


@pytest.mark.parametrize("name", made.characters())
def test_rig_parts_sum_to_measured_skin(name):
    armature, skin = character(made.characters()[name])
    rig = measured(armature)
    whole = measure_object(skin, bpy.context.evaluated_depsgraph_get())
    moments, factor = whole.mass_moments
    truth = moments * factor
    mass = rig.measurement.mass_moments[0].about_point(truth.about)
    reach = np.ptp(np.array([vertex.co for vertex in skin.data.vertices]), axis=0).max()
    for n, part in ((0, slice(0, 1)), (1, slice(1, 4)), (2, slice(4, 10)), (3, slice(10, 20))):
        assert np.abs(mass.raw - truth.raw)[part].max() <= 1e-12 * truth.raw[0] * reach**n
    assert ("unweighted_vertices" in codes(rig)) == (name == "unweighted")
    assert close(rig.measurement.area, whole.area, 1e-6) and close(
        rig.measurement.volume, whole.volume, 1e-6
    )
    bound, own = rig.measurement.error_bound["input"], whole.error_bound["input"]
    for name in ("volume", "area"):
        assert 0.9 * own[name] <= bound[name] < 64.0 * own[name], name


def test_clothes_and_bone_children_count():
    armature, _ = character()
    coat = made.box_skeleton()
    coat.points = coat.points * 1.0
    shirt = skin_of(coat, armature, "Shirt")
    shirt.body_moments.kind, shirt.body_moments.thickness, shirt.body_moments.density = (
        "SHELL",
        0.001,
        500.0,
    )
    sword = bpy.data.objects.new("Sword", box_mesh(1, 2, 4))
    bpy.context.scene.collection.objects.link(sword)
    sword.parent, sword.parent_type, sword.parent_bone = armature, "BONE", "arm.L"
    sword.body_moments.density = 7850.0
    plume = bpy.data.objects.new("Plume", box_mesh(1, 1, 1))
    bpy.context.scene.collection.objects.link(plume)
    plume.parent, plume.location = sword, (0, 0, 5)
    plume.body_moments.density = 100.0
    pose(armature)
    parts = {part.name: part for part in measured(armature).parts}
    area = 2 * (4 * 2 + 4 * 1) + 2  # of the arm's box without the side at the chest
    assert close(parts["arm.L"].mass.total, 8000 + 0.5 * area + 8 * 7850 + 100, 2e-6)
    assert parts["arm.L"].sources == ("Shirt", "Skin", "Sword", "Plume")
    assert close(parts["arm.R"].mass.total, 8000 + 0.5 * area, 2e-6)
    # in the bone's frame a part that hangs on it is where it hangs, whatever the pose
    bone = armature.data.bones["arm.L"]
    without = measured(armature)
    center = {part.name: part.measurement.in_object_frame().center for part in without.parts}[
        "arm.L"
    ]
    for one in armature.pose.bones:
        one.rotation_euler = (0, 0, 0)
    bpy.context.view_layer.update()
    again = {
        part.name: part.measurement.in_object_frame().center for part in measured(armature).parts
    }["arm.L"]
    assert np.abs(center - again).max() < 1e-5 and bone.length > 0.0


def test_an_open_skin_is_capped_as_measure_does():
    shape = made.box_skeleton()
    foot = (shape.points[shape.quads][:, :, 2] == -5).all(axis=1)
    shape.quads = shape.quads[~foot]
    armature, skin = character(shape)
    rig = measured(armature)
    told = {found.code: found.values for found in rig.measurement.findings}
    assert told["holes_capped"]["sources"] == [skin.name]
    parts = {part.name: part.measurement for part in rig.parts}
    assert close(parts["leg.L"].volume, 10.0, 1e-6) and str(parts["leg.L"].method) == "capped"


def test_bones_have_densities_and_masses_of_their_own():
    armature, _ = character()
    armature.pose.bones["head"].body_moments.mass_from = "DENSITY"
    armature.pose.bones["head"].body_moments.density = 500.0
    armature.pose.bones["leg.L"].body_moments.mass_from = "MASS"
    armature.pose.bones["leg.L"].body_moments.mass = 3.0
    armature.location, armature.rotation_euler = (1.0, 2.0, 3.0), (0.0, 0.0, 0.5)
    bpy.context.scene.unit_settings.scale_length = 1.0
    rig = measured(armature)
    parts = {part.name: part for part in rig.parts}
    sources = {
        "head": "one value",
        "leg.L": "given mass",
        "leg.R": "members",
    }
    for name, source in sources.items():
        found = parts[name].measurement
        assert (found.name, found.type, found.kind, str(found.density_from)) == (
            name,
            "BONE",
            "bone",
            source,
        )
    whole = rig.measurement
    assert (whole.name, whole.type, whole.kind) == (armature.name, "ARMATURE", "rig")
    assert whole.density_from.code == "density_from" and str(whole.method) == "assembly"
    assert whole.location.tolist() == [1.0, 2.0, 3.0] and close(
        whole.rotation[0, 0], np.cos(0.5), 1e-6
    )
    assert close(parts["head"].mass.total, 4000.0, 1e-6) and close(
        parts["leg.L"].mass.total, 3.0, 1e-9
    )
    assert close(parts["leg.R"].mass.total, 10000.0, 1e-6)


@pytest.mark.parametrize("kind", ["SOLID", "SHELL"])
def test_a_mass_that_is_given_for_the_skin_is_shared_by_volume(kind):
    armature, skin = character()
    skin.body_moments.kind = kind
    skin.body_moments.mass_from, skin.body_moments.mass = "MASS", 70.0
    skin.body_moments.property_unset("density")
    rig = measured(armature)
    assert close(rig.measurement.mass_properties.mass, 70.0, 1e-12) and not codes(rig)


def test_a_part_that_no_body_can_have_is_a_finding():
    shape = made.box_skeleton()
    inner, quads = made.boxes_skin([((0, 0, 3), (1, 1, 4))])
    inner = inner * 0.5 + (-0.25, -0.25, 1.5)
    count = len(shape.points)
    shape.points = np.concatenate([shape.points, inner])
    shape.quads = np.concatenate([shape.quads, quads[:, ::-1] + count])  # a cavity in the chest
    shape.names, shape.bones = (
        (*shape.names, "hole"),
        np.concatenate([shape.bones, [[(0, 0, 3), (0, 0, 4)]]]),
    )
    extra = np.arange(count, len(shape.points))
    shape.weights = type(shape.weights)(
        np.concatenate([shape.weights.vertex, extra]),
        np.concatenate([shape.weights.bone, np.full(len(extra), 7)]),
        np.concatenate([shape.weights.weight, np.ones(len(extra))]),
    )
    armature = armature_of(shape)
    skin_of(shape, armature)
    only(armature)
    rig = measured(armature)
    assert "bone_parts_impossible" in codes(rig)
    assert {part.name for part in rig.parts if part.refusal} == {"hole"}
    bpy.ops.object.body_moments_measure_bones()
    assert (
        "body_mass" not in armature.pose.bones["hole"]
        and "body_mass" in armature.pose.bones["chest"]
    )


def test_posing_is_no_edit_and_sculpting_and_settings_are():
    armature, skin = character()
    bpy.ops.object.body_moments_measure_bones()
    pose(armature, 2)
    assert staleness.stale_reason(armature, bpy.context.scene) is None
    skin.body_moments.density = 2.0
    bpy.context.view_layer.update()
    assert staleness.stale_reason(armature, bpy.context.scene) is not None
    bpy.ops.object.body_moments_measure_bones()
    assert staleness.stale_reason(armature, bpy.context.scene) is None
    armature.pose.bones["head"].body_moments.mass_from = "MASS"
    bpy.context.view_layer.update()
    assert staleness.stale_reason(armature, bpy.context.scene) == Stale.BONES
    bpy.ops.object.body_moments_measure_bones()
    assert staleness.stale_reason(armature, bpy.context.scene) is None
    dent(skin, 1.0)
    assert staleness.stale_reason(armature, bpy.context.scene) == Stale.GEOMETRY


def test_modifiers_after_the_armature_count():
    armature, skin = character()
    skin.modifiers.new("Subdivision", "SUBSURF").levels = 1
    rig = measured(armature)
    whole = measure_object(skin, bpy.context.evaluated_depsgraph_get())
    assert close(rig.measurement.mass_properties.mass, whole.mass_properties.mass, 1e-12)
    assert len(rig.parts) == 7


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_a_physics_rig_has_exact_masses_and_joints_at_the_bones(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    armature, _ = character()
    armature.pose.bones["arm.L"].use_ik_limit_x = True
    armature.pose.bones["arm.L"].ik_min_x = -0.5
    for _ in range(2):
        assert bpy.ops.object.body_moments_physics_rig() == {"FINISHED"}
    (collection,) = [one for one in bpy.data.collections if one.name.startswith("Rig Physics Rig")]
    bodies = {
        obj.name.removeprefix("Rig "): obj for obj in collection.objects if obj.type == "MESH"
    }
    joints = [obj for obj in collection.objects if obj.rigid_body_constraint]
    assert bodies.keys() == set(made.NAMES) and len(joints) == 6
    for name, (low, high) in zip(made.NAMES, made.BOXES):
        body = bodies[name]
        mass = 1000.0 * unit**3 * float(np.prod(np.subtract(high, low)))
        assert close(body.rigid_body.mass, mass, 1e-6)
        assert (
            np.abs(np.array(body.dimensions) - sorted(np.subtract(high, low), reverse=True)).max()
            < 1e-6
        )
        assert not any(polygon.use_smooth for polygon in body.data.polygons)
        assert np.abs(np.array(body.location) - np.add(high, low) / 2.0).max() < 1e-6
        measurement = measure_object(body, bpy.context.evaluated_depsgraph_get())
        local = measurement.in_object_frame()
        assert np.abs(local.center).max() < 1e-6
        assert (
            np.abs(local.inertia - np.diag(np.diag(local.inertia))).max()
            < 1e-6 * local.inertia.max()
        )
    joint = next(obj for obj in joints if "arm.L" in obj.name)
    constraint = joint.rigid_body_constraint
    assert (constraint.object1, constraint.object2) == (bodies["chest"], bodies["arm.L"])
    assert np.abs(np.array(joint.location) - (2, 0, 4.5)).max() < 1e-6
    assert constraint.use_limit_ang_x and close(constraint.limit_ang_x_lower, -0.5, 1e-6)
    assert not constraint.use_limit_ang_y


def test_rig_center_follows_pose_by_constraints():
    armature, _ = character()
    armature.location, armature.rotation_euler = (3, 2, 1), (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    rest = {
        part.name: (part.mass.total, part.measurement.in_object_frame().center)
        for part in measured(armature).parts
    }
    for _ in range(2):
        assert bpy.ops.object.body_moments_rig_center() == {"FINISHED"}
    pose(armature, 5)
    (center,) = [obj for obj in bpy.data.objects if obj.name.startswith("Rig Center of Mass")]
    total = sum(mass for mass, _ in rest.values())
    truth = sum(
        mass
        * np.array(armature.matrix_world @ armature.pose.bones[name].matrix, np.float64)
        @ [*local, 1.0]
        for name, (mass, local) in rest.items()
    )[:3]
    found = np.array(
        center.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation
    )
    assert np.abs(found - truth / total).max() < 2e-5


def test_results_of_bones_drive():
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    bpy.context.view_layer.update()
    driven = add(None, "Driven", select=False)
    driver = driven.driver_add("location", 0).driver
    variable = driver.variables.new()
    variable.type, variable.name = "SINGLE_PROP", "mass"
    variable.targets[0].id, variable.targets[0].data_path = (
        armature,
        'pose.bones["head"]["body_mass"]',
    )
    driver.expression = "mass"

    def location():
        bpy.context.view_layer.update()
        return driven.evaluated_get(bpy.context.evaluated_depsgraph_get()).location[0]

    assert close(location(), 8000.0, 1e-6)
    bpy.data.objects["Skin"].body_moments.density = 1.0
    bpy.ops.object.body_moments_measure_bones()
    assert close(location(), 8.0, 1e-6)


def test_link_surface_has_mass_and_center_of_inertial():
    armatures = []
    for location, rotation in (((5, -3, 2), (0.4, -0.7, 1.9)), ((-40, 3, 1), (-1.1, 0.3, 0.8))):
        armature, _ = character()
        armature.location, armature.rotation_euler = location, rotation
        armatures.append(armature)
    bpy.context.view_layer.update()
    made_links = bone_links(bpy.context, "robot", armatures)
    labels = ["{}:{}".format(armature.name, name) for armature in armatures for name in made.NAMES]
    assert sorted(link.name for link in made_links.robot.links) == sorted(labels)
    for label in labels:
        inertial = made_links.robot.link(label).inertial
        volume, center = volume_and_center(made_links.surface(bpy.context, label))
        assert close(1000.0 * volume, inertial.mass, 1e-5)
        assert np.linalg.norm(center - inertial.center) < 1e-5 * np.cbrt(volume)


def test_overlay_rig_is_sum_of_posed_parts():
    """What is stored is the rest pose; bones' parts move with their bones."""
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    scene = bpy.context.scene
    rest = drawn(armature, scene).world
    assert np.abs(np.subtract(rest.center, armature["body_center_of_mass"])).max() < 1e-6
    assert close(np.array(rest.moments), np.array(armature["body_principal_moments"]), 1e-6)
    pose(armature)
    handlers.count_change()
    now = drawn(armature, scene).world
    parts = [arrays(drawn_bone(bone, scene).world) for bone in armature.pose.bones]
    center = sum(part.mass * part.center for part in parts) / sum(part.mass for part in parts)
    assert (
        np.abs(now.center - center).max() < 1e-12
        and np.abs(np.subtract(now.center, rest.center)).max() > 1e-3
    )
    inertia = sum(
        part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        for part in parts
        for arm in [part.center - center]
    )
    found, axes = arrays(now).inertia, arrays(now).axes
    assert (
        np.abs(found - inertia).max() < 1e-12 * np.abs(inertia).max() and np.linalg.det(axes) > 0.0
    )


def test_bone_freedom_follows_locks_limits_constraints():
    armature, _ = character()
    bone = armature.pose.bones["head"]
    axes = {axis: [float(other == axis) for other in "xyz"] for axis in "xyz"}

    def free():
        return [(one.kind, one.axis.tolist(), one.lower, one.upper) for one in bone_freedom(bone)]

    assert free() == [("rotate", axes[axis], -inf, inf) for axis in "zyx"]
    bone.use_ik_limit_x, bone.ik_min_x, bone.ik_max_x = True, -0.5, 0.25
    bone.lock_rotation[1] = True
    bone.lock_ik_z = True
    assert free() == [("rotate", axes["x"], -0.5, 0.25)]
    bone.lock_rotation[1] = bone.lock_ik_z = False
    limit = bone.constraints.new("LIMIT_ROTATION")
    limit.use_limit_x = limit.use_limit_y = True
    limit.min_x, limit.max_x, limit.min_y, limit.max_y = -1.0, 1.5, 0.5, 0.5
    # in the world it leaves the bone free
    assert [one[1] for one in free()] == [axes[axis] for axis in "zyx"]
    limit.owner_space = "LOCAL"
    assert free() == [("rotate", axes["z"], -inf, inf), ("rotate", axes["x"], -1.0, 1.5)]
    limit.enabled = False
    assert [one[1] for one in free()] == [axes[axis] for axis in "zyx"]
    other = bone.constraints.new("COPY_ROTATION")
    assert other.owner_space != "" and [one[1] for one in free()] == [axes[axis] for axis in "zyx"]
    assert bone_parents(bone, {"hips": "Hips"}) == ["Hips"]
    assert bone_parents(bone, {"hips": "Hips", "chest": "Chest", "arm.L": "Arm"}) == [
        "Chest",
        "Hips",
    ]


def test_a_density_that_varies_is_shared_as_its_mean():
    armature, skin = character()
    settings = skin.body_moments
    settings.property_unset("density")
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "1000 + 100*z"
    whole = measure_object(skin, bpy.context.evaluated_depsgraph_get())
    mean = whole.mass_properties.mass / whole.volume
    assert abs(mean - 1000.0) > 10.0
    rig = measured(armature)
    told = {found.code: found.values for found in rig.measurement.findings}
    assert (
        told["rig_mean_density"] == {"sources": [skin.name]} and "members_density_unset" not in told
    )
    assert close(rig.measurement.mass_properties.mass, whole.mass_properties.mass, 1e-9)
    arm = next(part for part in rig.parts if part.name == "arm.L")
    assert close(arm.mass.total, 8.0 * mean, 2e-6)


def test_stretched_skin_area_is_that_of_its_faces():
    armature, skin = character()
    skin.body_moments.kind, skin.body_moments.thickness = "SHELL", 0.01
    for scale in ((1, 1, 1), (2, 2, 2), (1, 2, 3), (-1, 2, 1)):
        armature.scale = scale
        bpy.context.view_layer.update()
        matrix = np.array(skin.matrix_world, float)[:3, :3]
        corners = [
            np.array([skin.data.vertices[i].co for i in polygon.vertices])
            for polygon in skin.data.polygons
        ]
        area = 0.0
        for a, b, c, d in (one @ matrix.T for one in corners):
            area += (
                np.linalg.norm(np.cross(b - a, c - a)) + np.linalg.norm(np.cross(c - a, d - a))
            ) / 2.0
        found = measured(armature).measurement
        assert close(found.area, area, 1e-6) and close(
            found.mass_properties.mass, 10.0 * area, 1e-6
        )
