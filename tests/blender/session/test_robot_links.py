# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects, collections and bones become links, what is said of the others, and what each link shows."""

import bpy
import numpy as np
import pytest
from body_moments.core.polyhedron.first_order import volume_and_center
from body_moments.operators.session import robot_links
from body_moments.operators.settings.options import MeasureOptions

from tests.blender.actions.rig.test_rig import character, half_a_box
from tests.blender.bodies.test_assembly import box, collection
from tests.blender.findings import refused, said
from tests.blender.objects import add, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def lamp():
    return add(bpy.data.lights.new("Lamp", "POINT"), "Lamp")


def assert_surfaces(made):
    """What each link shows is the body of its inertial, of water."""
    assert made.robot.links
    for link in made.robot.links:
        volume, center = volume_and_center(made.surface(bpy.context, link.name))
        assert close(1000.0 * volume, link.inertial.mass, 1e-5), link.name
        assert np.linalg.norm(center - link.inertial.center) < 1e-5 * np.cbrt(volume), link.name


def test_the_objects_that_may_be_links_are_of_a_collection_or_selected_or_rendered():
    parts = collection("Parts")
    inner, first = box(collection("Inner", parts), (1, 1, 1), name="inner"), box(parts, (1, 1, 1), name="first")
    alone, hidden = add(mesh_body(), "Alone"), add(mesh_body(), "Hidden")
    hidden.hide_render = first.hide_render = True
    only(hidden, inner)
    context = bpy.context
    assert set(robot_links.candidates(context, "Parts", True)) == {inner, first}
    assert set(robot_links.candidates(context, "", True)) == {hidden, inner}
    assert set(robot_links.candidates(context, "", False)) == {inner, alone}


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_what_an_object_shows_is_what_its_inertial_is_of(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    objects = [
        add(mesh_body(), name, place, turn, scale)
        for name, place, turn, scale in (
            ("First", (1, 2, 3), (0.3, 0.2, 0.1), (1, 1, 1)),
            ("Second", (-4, 0, 9), (1, 2, 3), (2, 3, 0.5)),
        )
    ]
    made = robot_links.object_links(bpy.context, "robot", objects)
    assert robot_links.meters_per_unit(bpy.context) == unit
    assert_surfaces(made)
    assert robot_links.SceneLinks(made.robot, []).surface(bpy.context, "First") is None


def test_collections_are_links_of_all_that_they_hold_and_show_what_is_asked_for():
    """One that holds nothing is left out, with the reason; without any in it a collection is a link itself."""
    root, lamp_object = collection("Robot"), lamp()
    bare, arm, leg = (collection(name, root) for name in ("Bare", "Arm", "Leg"))
    upper, fore = box(arm, (1, 2, 3), (4, 0, 0), name="upper"), box(collection("Hand", arm), (1, 1, 1), name="fore")
    foot = box(leg, (1, 1, 4), (0, 9, 0), name="foot", rotation=(0.1, 0.2, 0.3))
    bare.objects.link(lamp_object)
    arm.objects.link(lamp_object)
    bpy.context.view_layer.update()
    made = robot_links.collection_links(bpy.context, "robot", root, [foot, lamp_object, fore, upper])
    assert [link.name for link in made.robot.links] == ["Arm", "Leg"] and made.robot.name == "robot"
    assert close([link.inertial.mass for link in made.robot.links], [7000.0, 4000.0], 1e-6)
    assert made.members == {"Arm": [fore, upper], "Leg": [foot]}
    assert_surfaces(made)
    (found,) = made.findings
    assert (found.code, found.values["count"], found.values["total"]) == ("left_out_of_robot", 1, 3)
    assert [cause["values"]["object"] for cause in found.values["causes"]] == ["Bare"]
    heavier = robot_links.collection_links(bpy.context, "robot", root, [foot], MeasureOptions(density=2000.0))
    assert close([link.inertial.mass for link in heavier.robot.links], [14000.0, 8000.0], 1e-6)
    assert heavier.members == {"Arm": [], "Leg": [foot]}
    assert heavier.surface(bpy.context, "Arm") is None
    (alone,) = robot_links.collection_links(bpy.context, "robot", leg, [foot]).robot.links
    assert alone.name == "Leg" and close(alone.inertial.mass, 4000.0, 1e-6)
    with refused("failure", object="Bare"):
        robot_links.collection_links(bpy.context, "robot", bare, [])


def test_bones_are_called_by_their_character_where_there_are_several():
    one, _ = character()
    one.location, one.rotation_euler = (5, -3, 2), (0.4, -0.7, 1.9)
    one.pose.bones["head"].lock_rotation = (True, True, False)
    names = {link.name for link in robot_links.bone_links(bpy.context, "robot", [*bpy.data.objects]).robot.links}
    other = half_a_box()
    bpy.context.view_layer.update()
    made = robot_links.bone_links(bpy.context, "robot", [one, lamp(), other])
    several = {*("{}:{}".format(one.name, name) for name in names), "{}:Upper".format(other.name)}
    assert {link.name for link in made.robot.links} == several == made.pieces.keys() and made.members == {}
    assert "bone_parts_impossible" in said(made)
    assert {(joint.parent, joint.child) for joint in made.robot.joints} >= {
        ("{}:chest".format(one.name), "{}:arm.L".format(one.name))
    }
    (neck,) = [joint for joint in made.robot.joints if joint.child.endswith(":head")]
    assert [axis.axis.tolist() for axis in neck.free] == [[0.0, 0.0, 1.0]]
    assert_surfaces(made)
    with refused("robot_without_bones"):
        robot_links.bone_links(bpy.context, "robot", [bpy.data.objects["Lamp"]])
