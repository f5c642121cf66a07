# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of posed characters: centers against sums over bones, contacts, held objects and stated
masses.
"""

import time

import bpy
import numpy as np
import pytest
from body_moments.blender.session.character import weight as character
from body_moments.core.verdict import MeasureError

from tests.blender.box_character import HEIGHT, boxes, weight
from tests.blender.figure import figure
from tests.blender.objects import add, measured, mesh_body, mesh_of


def shown(rig):
    """Measure a figure, find its ground, and return its weight as it is posed."""
    character.prepare(bpy.context, rig)
    return weight(rig)


def turn(rig, seed=1, size=0.4):
    rng = np.random.default_rng(seed)
    for name in ("hips", "spine", "head", "arm.L", "forearm.R", "hold.L"):
        rig.pose.bones[name].rotation_euler = rng.uniform(-size, size, 3)
    rig.pose.bones["hips"].location = 0.01, -0.05, 0.02
    bpy.context.view_layer.update()


def sum_over_bones(rig):
    """Mass and center from the stored numbers of the bones alone."""
    mass, moment = 0.0, np.zeros(3)
    for bone in rig.pose.bones:
        if "body_mass" in bone:
            local = np.array(bone["body_center_of_mass"])
            matrix = np.array(rig.matrix_world, np.float64) @ np.array(bone.matrix, np.float64)
            scale = np.array(rig.matrix_world.to_scale())
            moment += bone["body_mass"] * (matrix[:3, :3] @ (local / scale) + matrix[:3, 3])
            mass += bone["body_mass"]
    return mass, moment / mass


@pytest.mark.parametrize("place", [(0, 0, 0), (3000, -2000, 500)])
@pytest.mark.parametrize("scale", [1.0, 0.02])
def test_center_equals_sum_over_bones(scene, place, scale):
    rig, _body = figure()
    rig.location, rig.scale, rig.rotation_euler = place, (scale,) * 3, (0, 0, 0.7)
    bpy.context.view_layer.update()
    shown(rig)
    turn(rig)
    now, (mass, center) = weight(rig), sum_over_bones(rig)
    assert now.parts.mass == pytest.approx(mass, rel=1e-9)
    assert np.abs(now.parts.center - center).max() < 1e-4 * HEIGHT * scale
    assert now.support is not None and now.contacts.names == ("foot.L", "foot.R")


def test_center_and_inertia_equal_those_of_rigid_skin(scene):
    """Each box moves with one bone alone, so that the posed skin has the exact moments of the
    parts.
    """
    rig, body = boxes()
    shown(rig)
    for number, bone in enumerate(rig.pose.bones):
        bone.rotation_mode, bone.rotation_euler, bone.location = (
            "XYZ",
            (0.3, 0.2 * number, -0.4),
            (0.1, 0.2, 0.3),
        )
    now = weight(rig)
    bpy.context.view_layer.objects.active = body
    truth = measured(body).mass_properties
    assert now.parts.mass == pytest.approx(truth.mass, rel=1e-6)
    assert now.parts.center == pytest.approx(truth.center, abs=1e-6)
    assert now.parts.inertia == pytest.approx(truth.inertia, abs=1e-5 * np.trace(truth.inertia))


def held(kind, rig, bone, **place):
    """A body that weighs 7 kg, and a constraint that holds it to a bone."""
    stone = add(mesh_body(), **place)
    stone.body_moments.mass_from, stone.body_moments.mass = "MASS", 7.0
    constraint = stone.constraints.new(kind)
    holder = constraint.targets.new() if kind == "ARMATURE" else constraint
    holder.target, holder.subtarget = rig, bone
    return stone, constraint


@pytest.mark.parametrize("kind", ["CHILD_OF", "COPY_TRANSFORMS", "COPY_LOCATION", "ARMATURE"])
def test_held_object_counts_with_its_mass_where_it_is(scene, kind):
    rig, _body = figure()
    before = shown(rig)
    stone, constraint = held(kind, rig, "forearm.L", location=(0.8, 0.0, 1.4), scale=(0.05,) * 3)
    now, own = weight(rig), measured(stone).mass_properties
    assert now.parts.mass == pytest.approx(before.parts.mass + 7.0)
    center = (before.parts.mass * before.parts.center + 7.0 * own.center) / now.parts.mass
    assert now.parts.center == pytest.approx(center, abs=1e-6)
    spread = np.trace(own.inertia) / 2.0 * np.eye(3) - own.inertia
    assert now.parts.spreads[-1] == pytest.approx(spread, rel=1e-5, abs=1e-9)
    rig.pose.bones["spine"].rotation_euler = 0.5, 0.0, 0.0
    assert weight(rig).parts.centers[-1] == pytest.approx(
        measured(stone).mass_properties.center, abs=1e-6
    )
    constraint.influence = 0.0
    assert weight(rig).parts.mass == pytest.approx(before.parts.mass)


def test_held_cane_carries(scene):
    rig, _body = figure()
    alone = shown(rig).support
    held("CHILD_OF", rig, "forearm.L", location=(0.7, -0.4, 0.0), scale=(0.02, 0.02, 0.5))
    now = weight(rig)
    assert "forearm.L" in now.contacts.names
    assert np.ptp(now.support.polygon, axis=0)[0] > np.ptp(alone.polygon, axis=0)[0] + 0.3


def test_open_held_object_is_named_without_mass(scene):
    rig, _body = figure()
    before = shown(rig)
    stone, _ = held("CHILD_OF", rig, "forearm.L", location=(0.8, 0.0, 1.4))
    stone.data.clear_geometry()
    now = weight(rig)
    assert now.parts.names[-1] == stone.name and now.parts.masses[-1] == 0.0
    assert now.parts.center == pytest.approx(before.parts.center)


def test_edit_mode_of_skin_and_bones_shows_no_error(scene):
    rig, body = figure()
    shown(rig)
    for obj in (body, rig):
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
        weight(rig)
        if obj is rig:
            rig.data.edit_bones.remove(rig.data.edit_bones["head"])
        bpy.ops.object.mode_set(mode="OBJECT")
        weight(rig)
    assert weight(rig) is None


def test_total_mass_is_shared_by_bones_without_their_own(scene):
    rig, _body = figure()
    rig.pose.bones["head"].body_moments.mass_from, rig.pose.bones["head"].body_moments.mass = (
        "MASS",
        5.0,
    )
    rig.body_moments_weight.mass = 70.0
    now = shown(rig)
    assert now.parts.mass == pytest.approx(70.0, rel=1e-9)
    assert now.parts.masses[now.parts.names.index("head")] == pytest.approx(5.0, rel=1e-9)
    rig.body_moments_weight.mass = 4.0  # less than the head's: it shares, too
    assert weight(rig).parts.mass == pytest.approx(4.0, rel=1e-9)


def test_raised_root_has_no_support(scene):
    rig, _body = figure()
    shown(rig)
    rig.pose.bones["root"].location = 0, 0, 0.5
    now = weight(rig)
    assert now.support is None and now.contacts.height == pytest.approx(0.5, abs=1e-4)
    assert now.foot[2] == pytest.approx(0.0, abs=1e-6)


def test_ground_is_found_where_the_figure_stands(scene):
    rig, _body = figure()
    rig.location.z = 1.3
    assert shown(rig).support is not None and rig.body_moments_weight.ground == pytest.approx(
        1.3, abs=1e-4
    )
    rig.pose.bones["root"].location = 0, 0, 0.5
    assert shown(rig).support is None


def test_named_bones_alone_are_contacts(scene):
    rig, _body = figure()
    for name in ("foot.L", "forearm.R"):
        rig.pose.bones[name].body_moments.is_contact = True
    now = shown(rig)
    assert now.contacts.names == ("foot.L",) and now.contacts.lifted == ("forearm.R",)
    assert (now.contacts.points[:, 0] > 0.0).all()


def test_mesh_without_weights_is_refused_and_nothing_stored(scene):
    rig, body = figure()
    body.vertex_groups.clear()
    with pytest.raises(MeasureError):
        character.measure(bpy.context, rig)
    assert "body_mass" not in rig


def tower(bones=60, rings=1000, around=100):
    """An armature of bones in a chain, and a tube of rings × around vertices, each on the two
    nearest bones.
    """
    rig = bpy.data.objects.new("Tower", bpy.data.armatures.new("Tower"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for number in range(bones):
        bone = rig.data.edit_bones.new("bone{:02d}".format(number))
        bone.head, bone.tail = (0, 0, number / bones), (0, 0, (number + 1) / bones)
        bone.parent = rig.data.edit_bones[number - 1] if number else None
    bpy.ops.object.mode_set(mode="OBJECT")
    height, angle = np.linspace(0.0, 1.0, rings), 2.0 * np.pi / around * np.arange(around)
    points = [(0.1 * np.cos(a), 0.1 * np.sin(a), z) for z in height for a in angle]
    first = np.arange(rings - 1)[:, None] * around + np.arange(around)
    after = np.arange(rings - 1)[:, None] * around + (np.arange(around) + 1) % around
    sides = np.stack([first, after, after + around, first + around], axis=2).reshape(-1, 4).tolist()
    body = add(
        mesh_of(
            points,
            [*sides, list(range(around))[::-1], list(range((rings - 1) * around, rings * around))],
            "Tube",
        ),
        "Tube",
    )
    groups = [body.vertex_groups.new(name=bone.name) for bone in rig.data.bones]
    for ring in range(rings):
        place = min(max(height[ring] * bones - 0.5, 0.0), bones - 1.001)
        for number, share in ((int(place), 1.0 - place % 1.0), (int(place) + 1, place % 1.0)):
            groups[number].add(range(ring * around, (ring + 1) * around), share, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = rig
    return rig


def test_hundred_thousand_vertices_are_weighed_in_a_redraw(scene):
    rig, seconds = tower(), []
    shown(rig)
    for step in range(12):
        rig.pose.bones[30].rotation_mode, rig.pose.bones[30].rotation_euler = (
            "XYZ",
            (0.01 * step, 0.0, 0.0),
        )
        bpy.context.view_layer.update()
        start = time.thread_time()
        now = character.weight(rig, bpy.context.view_layer.depsgraph)
        seconds.append(time.thread_time() - start)
    assert len(now.parts.names) == 60 and now.support is not None
    assert min(seconds) < 0.01
