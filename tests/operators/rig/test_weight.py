# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Weight and Balance Pose: margins reached, contacts that stay, refusals that change
nothing.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.displayed import displayed
from body_moments.panels.overlay.bodies import Bodies, body_lines, collect

from tests.blender.box_character import HEIGHT, boxes, weight
from tests.blender.figure import figure
from tests.blender.gymnast import gymnast
from tests.panels.drawing import shown

SHOW, BALANCE = bpy.ops.pose.body_moments_show_weight, bpy.ops.pose.body_moments_balance_pose
FREE = ("spine", "head", "arm.L", "arm.R", "forearm.L")


def posed(seed=1, held=True, show=True):
    """A figure in Pose Mode that leans and reaches out."""
    rig, body = figure(held=held)
    bpy.ops.object.mode_set(mode="POSE")
    rng = np.random.default_rng(seed)
    for name in FREE:
        rig.pose.bones[name].rotation_euler = rng.uniform(-0.8, 0.8, 3)
    bpy.context.view_layer.update()
    if show:
        assert SHOW() == {"FINISHED"}
    return rig, body


def channels(rig):
    return [
        (*bone.location, *bone.rotation_euler, *bone.rotation_quaternion) for bone in rig.pose.bones
    ]


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_center_comes_over_middle_and_contacts_stay(scene, seed):
    rig, _body = posed(seed)
    before = weight(rig)
    assert BALANCE(target="MIDDLE") == {"FINISHED"}
    after = weight(rig)
    assert np.abs(after.contacts.points - before.contacts.points).max() < 1e-4 * HEIGHT
    assert np.abs((after.parts.center - after.support.target(None))[:2]).max() < 1e-4 * HEIGHT
    assert after.support.margin > before.support.margin


def test_nearest_point_inside_has_the_margin(scene):
    rig, _body = posed()
    rig.pose.bones["spine"].rotation_euler = 1.2, 0, 0.1
    before = weight(rig).support
    assert before.margin < 0.05
    assert BALANCE(target="INSIDE", margin=0.06) == {"FINISHED"}
    inside = tuple(rig.pose.bones["hips"].location)
    assert weight(rig).support.margin == pytest.approx(0.06, abs=1e-4 * HEIGHT)
    rig.pose.bones["hips"].location = 0, 0, 0
    assert BALANCE(target="MIDDLE") == {"FINISHED"}
    assert np.linalg.norm(inside) < np.linalg.norm(rig.pose.bones["hips"].location)


def test_straight_legs_are_lowered_before_they_are_stretched(scene):
    rig, _body = posed()
    before = weight(rig)
    assert BALANCE() == {"FINISHED"}
    assert np.abs(weight(rig).contacts.points - before.contacts.points).max() < 1e-4 * HEIGHT
    assert rig.pose.bones["hips"].location.y < 0.0


@pytest.mark.parametrize("held", [False, True], ids=["free", "held"])
@pytest.mark.parametrize("target", ["INSIDE", "MIDDLE"])
def test_spine_balances_from_far_as_from_near(scene, held, target):
    """From every lean of 30° to 120° in five directions; beyond 80° a turn first lifts the body."""
    rig, _body = posed(held=held)
    for bone in rig.pose.bones:
        bone.location = bone.rotation_euler = (0, 0, 0)
    spine = rig.pose.bones["spine"]
    for direction in np.radians((0, 45, 90, 180, 270)):
        for lean in np.radians((30, 50, 65, 80, 100, 120)):
            start = lean * np.cos(direction), 0.0, lean * np.sin(direction)
            rig.pose.bones["hips"].location = 0, 0, 0
            spine.rotation_euler = start
            before = weight(rig)
            result = BALANCE(bone="spine", target=target)
            after = weight(rig)
            assert after.support.margin > 0.0499 if target == "INSIDE" else result == {"FINISHED"}
            if target == "MIDDLE":
                off = (after.parts.center - after.support.target(None))[:2]
                assert np.abs(off).max() < 1e-4 * HEIGHT
            assert np.abs(after.contacts.points - before.contacts.points).max() < 1e-4 * HEIGHT
            turn = np.subtract(spine.rotation_euler, start)
            assert np.linalg.norm(turn) < lean + 0.9


@pytest.mark.parametrize("lean", [70, 80])
def test_chest_balances_near_gimbal_lock(scene, lean):
    rig = gymnast()
    chest = rig.pose.bones["chest"]
    chest.rotation_mode = "YXZ"
    chest.rotation_euler = np.radians((lean, 0, 0))
    assert BALANCE(bone="chest", margin=0.02) == {"FINISHED"}
    assert weight(rig).support.margin > 0.0199


def test_legs_without_inverse_kinematics_turn_the_spine(scene):
    rig, _body = posed(held=False)
    before = weight(rig)
    assert BALANCE(target="INSIDE", margin=before.support.margin + 0.01) == {"FINISHED"}
    after = weight(rig)
    assert not any(rig.pose.bones["hips"].location) and after.support.margin > before.support.margin
    assert after.contacts.points == pytest.approx(before.contacts.points, abs=1e-6)


def test_balance_measures_by_itself_and_is_one_undo_step(scene):
    rig, _body = posed(show=False)
    assert BALANCE() == {"FINISHED"}
    assert "body_mass" in rig
    assert "UNDO" in bpy.types.POSE_OT_body_moments_balance_pose.bl_options


def test_total_mass_shows_the_measured_one_until_it_is_set(scene):
    rig, _body = posed()
    settings = rig.body_moments_weight
    assert settings.mass == 0.0 and settings.shown_mass == pytest.approx(rig["body_mass"])
    settings.shown_mass = 70.0
    assert settings.mass == 70.0 and weight(rig).parts.mass == pytest.approx(70.0)
    settings.shown_mass = 0.0
    assert settings.shown_mass == pytest.approx(rig["body_mass"])


def test_shown_weight_is_one_mark_with_axes_on_request(scene):
    rig, _body = posed()
    for bone in rig.pose.bones:
        if hasattr(bone, "select"):
            bone.select = True
        else:
            bone.bone.select = True

    def lengths():
        entries, _active = collect(bpy.context, [rig])
        lines = body_lines(Bodies.of(entries, 1.0), scene.body_moments.overlay)
        assert len(lines) == 1
        return np.linalg.norm(lines[0, :, 1] - lines[0, :, 0], axis=1)

    assert lengths().max() == 0.0
    rig.body_moments_weight.show_axes = True
    assert (lengths()[:3] > 0.1).all() and lengths()[3:].max() == 0.0


def test_measured_poses_have_the_mass_at_rest(scene):
    rig, body = posed(held=False, show=False)
    masses = []
    for angle in (1.2, 0.0):
        rig.pose.bones["thigh.L"].rotation_euler = -angle, 0, 0
        assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
        masses.append((displayed(rig, scene).world.mass, body["body_mass"]))
    assert (
        masses[0][0]
        == masses[1][0]
        == pytest.approx(sum(bone.get("body_mass", 0.0) for bone in rig.pose.bones))
    )
    assert masses[0][1] < 0.995 * masses[1][1] < masses[0][0]
    body.body_moments.density = 500.0
    bpy.context.view_layer.update()
    assert "Out of date" in str(shown())  # the panel gives the reason for its verdict
    body.body_moments.property_unset("density")
    assert (
        bpy.ops.object.body_moments_measure() == {"FINISHED"}
        and displayed(rig, scene).verdict == "doubtful"
    )
    assert "density" in str(shown(without=["weight", "bones", "density"])).lower()
    assert bpy.ops.object.body_moments_clear() == {"FINISHED"}
    assert not any("body_mass" in owner for owner in (rig, body, *rig.pose.bones))


def test_balance_keys_the_bone_with_auto_keying(scene):
    rig, _body = posed()
    scene.tool_settings.use_keyframe_insert_auto = True
    assert BALANCE() == {"FINISHED"}
    assert rig.animation_data.action is not None


def refused(rig, operator, text, **options):
    """Check that an operator refuses with a text, and leaves all channels as they were."""
    before = channels(rig)
    with pytest.raises(RuntimeError, match=text):
        operator(**options)
    assert channels(rig) == before


def test_locked_hips_and_unheld_root_are_refused(scene):
    rig, _body = posed()
    rig.pose.bones["hips"].lock_location = rig.pose.bones["hips"].lock_rotation = True, True, True
    refused(rig, BALANCE, "No bone that may move", bone="hips")
    refused(rig, BALANCE, "No bone that may move", bone="root")
    refused(rig, BALANCE, "no bone “nobody”", bone="nobody")


def test_driven_bone_is_refused(scene):
    rig, _body = posed()
    bone = rig.pose.bones["hips"]
    for path in ("location", "rotation_euler"):
        for axis in range(3):
            bone.driver_add(path, axis).driver.expression = "0.0"
    bpy.context.view_layer.update()
    refused(rig, BALANCE, "No bone that may move", bone="hips")


def test_contacts_in_the_air_are_refused(scene):
    rig, _body = posed()
    rig.pose.bones["root"].location = 0, 0, 0.3
    bpy.context.view_layer.update()
    refused(rig, BALANCE, "Nothing touches the ground.*Set Ground|Lower the pose")


@pytest.mark.parametrize("missing", ["mesh", "weights", "gravity"])
def test_rig_without_skin_or_gravity_is_refused(scene, missing):
    rig, body = posed(show=False)
    if missing == "mesh":
        bpy.data.objects.remove(body)
    elif missing == "weights":
        body.vertex_groups.clear()
    else:
        scene.use_gravity = False
    for operator in (SHOW, BALANCE):
        refused(rig, operator, "no gravity" if missing == "gravity" else "assign weights")
    assert not rig.body_moments_weight.show and "body_mass" not in rig


def test_several_characters_are_shown_together(scene):
    rig, _body = figure()
    other, _boxes = boxes()
    rig.select_set(True)
    bpy.context.view_layer.objects.active = rig
    other.select_set(True)
    bpy.ops.object.mode_set(mode="POSE")
    assert SHOW() == {"FINISHED"}
    assert rig.body_moments_weight.show and other.body_moments_weight.show
    assert weight(other).parts.names == ("bone0", "bone1", "bone2")
    assert SHOW() == {"FINISHED"}
    assert not rig.body_moments_weight.show and not other.body_moments_weight.show


def test_override_is_measured_and_balanced(scene, tmp_path):
    """An override cannot hold results, so they are remembered while the file is open."""
    rig, body = figure()
    cast = bpy.data.collections.new("Cast")
    scene.collection.children.link(cast)
    for obj in (rig, body):
        cast.objects.link(obj)
        scene.collection.objects.unlink(obj)
    path = str(tmp_path / "cast.blend")
    bpy.data.libraries.write(path, {cast})
    for obj in (rig, body):
        bpy.data.objects.remove(obj)
    bpy.data.collections.remove(cast)
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.collections = ["Cast"]
    here.collections[0].override_hierarchy_create(
        scene, bpy.context.view_layer, do_fully_editable=True
    )
    rig = next(obj for obj in bpy.data.objects if obj.type == "ARMATURE" and obj.override_library)
    bpy.context.view_layer.objects.active = rig
    rig.select_set(True)
    bpy.ops.object.mode_set(mode="POSE")
    rig.pose.bones["spine"].rotation_euler = 0.7, 0, 0
    assert SHOW() == {"FINISHED"}
    assert "body_mass" not in rig
    assert BALANCE(target="MIDDLE") == {"FINISHED"}
    assert (
        np.abs((weight(rig).parts.center - weight(rig).support.target(None))[:2]).max()
        < 1e-4 * HEIGHT
    )


def test_posed_armature_without_meshes_is_refused(scene):
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    rig.select_set(True)
    bpy.ops.object.mode_set(mode="POSE")
    with pytest.raises(RuntimeError, match="Nothing selected can be measured"):
        bpy.ops.object.body_moments_measure()
