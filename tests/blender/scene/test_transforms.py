# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Transform channels against Blender's own matrices, and whatever keeps them from being set."""

import itertools

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import changes, transforms
from body_moments.core.verdict import EditRefusedError
from mathutils import Quaternion

from tests.blender.findings import refused
from tests.blender.objects import add, place

pytestmark = pytest.mark.usefixtures("scene")
ORDERS = ["".join(order) for order in itertools.permutations("XYZ")]
MODES = [*ORDERS, "QUATERNION", "AXIS_ANGLE"]


def turned(rng):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def posed(mode, seed=1):
    """An object with every channel and every delta set."""
    rng, obj = np.random.default_rng(seed), add(None)
    obj.rotation_mode = mode
    for name in ("location", "delta_location", "rotation_euler", "delta_rotation_euler"):
        setattr(obj, name, rng.normal(size=3))
    obj.scale, obj.delta_scale = (2.0, -0.5, 3.0), (0.5, 4.0, -1.5)
    obj.rotation_quaternion = Quaternion(rng.normal(size=4)).normalized()
    obj.delta_rotation_quaternion = Quaternion(rng.normal(size=4)).normalized()
    obj.rotation_axis_angle = (1.2, *rng.normal(size=3))
    return obj


@pytest.mark.parametrize("mode", MODES)
def test_the_basis_is_blenders_and_can_be_set(mode):
    obj = posed(mode)
    matrix = place(obj)
    assert np.abs(transforms.basis(obj) - matrix).max() < 2e-6 * np.abs(matrix).max()
    rng = np.random.default_rng(2)
    wanted = turned(rng) * (3.0, -0.25, 0.5)
    transforms.set_rotation_and_scale(obj, wanted)
    transforms.set_location(obj, np.array([1.0, 2.0, -3.0]), 0.0)
    now = place(obj)
    assert (
        np.abs(now[:3, :3] - wanted).max() < 1e-6 * 3.0
        and np.abs(now[:3, 3] - (1, 2, -3)).max() < 1e-6
    )
    assert np.sign(np.prod(obj.scale) * np.prod(obj.delta_scale)) == np.sign(np.linalg.det(wanted))


def test_a_quaternion_keeps_its_sign():
    obj = add(None)
    obj.rotation_mode = "QUATERNION"
    for sign in (1.0, -1.0):
        obj.rotation_quaternion = sign * np.array([0.8, 0.6, 0.0, 0.0])
        transforms.set_rotation_and_scale(obj, transforms.rotation_matrix([0.6, 0.8, 0.0, 0.0]))
        assert (
            np.abs(np.array(obj.rotation_quaternion) - sign * np.array([0.6, 0.8, 0.0, 0.0])).max()
            < 1e-6
        )


@pytest.mark.parametrize("mode", ORDERS)
def test_euler_angles_are_nearest_of_equal_rotations(mode):
    rng = np.random.default_rng(3)
    angles, near = rng.uniform(-3.1, 3.1, (2, 20, 3)) * (1.0, 1.0, 3.0)
    middle = "XYZ".index(mode[1])
    angles[:4, middle] = (np.pi / 2, -np.pi / 2, np.pi / 2, -np.pi / 2)
    angles[4:8, middle] = np.pi / 2 + np.array([3e-8, -3e-8, 3e-7, -3e-7])
    rotations = np.stack([transforms.euler_matrix(row, mode) for row in angles])
    found = transforms.euler_angles(rotations, mode, near)
    first = "XYZ".index(mode[0])
    for row, (rotation, own, wished, given) in enumerate(zip(rotations, found, near, angles)):
        assert np.abs(transforms.euler_matrix(own, mode) - rotation).max() < (
            1e-12 if row not in range(4, 6) else 1e-7
        )
        assert np.abs(own - wished).max() <= np.pi + 1e-9
        if row < 6:  # locked, all but: the first angle is free
            assert (
                min(abs(own[first] - wished[first]), abs(abs(own[first] - wished[first]) - np.pi))
                < 1e-9
            )
        else:
            other = given + np.pi
            other[middle] = np.pi - given[middle]
            rest = [
                angles + 2.0 * np.pi * np.round((wished - angles) / (2.0 * np.pi))
                for angles in (given, other)
            ]
            best = min(np.abs(angles - wished).sum() for angles in rest)
            assert abs(np.abs(own - wished).sum() - best) < 1e-6
    alone = transforms.euler_angles(rotations[9], mode, near[9])
    assert np.array_equal(alone, found[9])


def test_impossible_rotation_and_scale_are_refused():
    obj = add(None)

    def refuses(code, linear, **values):
        before = transforms.TransformChannels(obj).values
        with refused(code, **values):
            transforms.set_rotation_and_scale(obj, np.asarray(linear, float))
        assert transforms.TransformChannels(obj).values == before

    refuses("scale_zero_axis", np.diag([1.0, 0.0, 1.0]))
    obj.delta_scale = (1.0, 1.0, 0.0)
    refuses("scale_zero_axis", np.eye(3))
    obj.delta_scale = (1.0, 1.0, 1.0)
    refuses("parent_shears", [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]])
    obj.lock_scale = (False, True, False)
    refuses("channel_locked", np.diag([1.0, 2.0, 1.0]), channel="scale")
    refuses("channel_locked", np.diag([1.0, 1.0 + 2e-6, 1.0]), channel="scale")
    transforms.set_rotation_and_scale(obj, np.diag([3.0, 1.0 + 5e-7, 2.0]))
    assert np.abs(np.array(obj.scale) - (3.0, 1.0, 2.0)).max() < 1e-6
    turn = np.diag([3.0, 1.0, 2.0])[[1, 0, 2]] * ((1,), (-1,), (1,))
    obj.lock_scale, obj.scale = (False,) * 3, (1.0, 1.0, 1.0)
    for mode, locks in (
        ("XYZ", "lock_rotation"),
        ("QUATERNION", "lock_rotation"),
        ("AXIS_ANGLE", "lock_rotation"),
    ):
        obj.rotation_mode = mode
        setattr(obj, locks, (False, False, True))
        with refused("channel_locked", channel="rotation"):
            transforms.set_rotation_and_scale(obj, turn / np.abs(turn).sum(axis=0))
        setattr(obj, locks, (False, False, False))
    obj.lock_rotation_w = True
    with refused("channel_locked", channel="rotation"):
        transforms.set_rotation_and_scale(obj, turn / np.abs(turn).sum(axis=0))


@pytest.mark.parametrize("by", ["action", "strip", "driver"])
def test_animated_channel_is_refused_if_it_would_move(by):
    obj = add(None)
    assert transforms.driven_channels(obj) == set()
    if by == "driver":
        obj.driver_add("location", 0)
    else:
        obj.keyframe_insert("location", frame=1)
        if by == "strip":
            animation = obj.animation_data
            animation.nla_tracks.new().strips.new("Strip", 1, animation.action)
            animation.action = None
    assert transforms.driven_channels(obj) == {"location"}
    transforms.set_location(obj, np.zeros(3), 0.0)
    with refused("channel_locked", channel="location"):
        transforms.set_location(obj, np.array([0.0, 0.0, 1.0]), 0.0)
    obj.scale = (1.0, 1.0, 1.0)
    transforms.set_rotation_and_scale(obj, 2.0 * np.eye(3))
    assert tuple(obj.scale) == (2.0, 2.0, 2.0)


def test_an_action_without_a_slot_moves_nothing():
    obj = add(None)
    obj.keyframe_insert("location", frame=1)
    obj.animation_data.action_slot = None
    assert transforms.driven_channels(obj) == set()


def test_channels_are_put_back():
    for mode in MODES:
        obj = posed(mode)
        saved = transforms.TransformChannels(obj)
        for name in saved.NAMES:
            setattr(obj, name, [0.1] * len(getattr(obj, name)))
        saved.restore()
        assert transforms.TransformChannels(obj).values == saved.values


def test_linked_objects_are_refused(tmp_path):
    add(None, "Linked")
    bpy.data.libraries.write(str(tmp_path / "a.blend"), {bpy.data.objects["Linked"]})
    own = bpy.data.objects["Linked"]
    own.name = "Own"
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (_, names):
        names.objects = ["Linked"]
    changes.require_editable(own)
    changes.require_storable_data(own)
    for check in (changes.require_editable, changes.require_storable_data):
        with pytest.raises(EditRefusedError) as error:
            check(names.objects[0])
        assert error.value.finding.code == "linked_object"
    parent, child = add(None, "Parent"), add(None, "Child")
    child.parent = parent
    assert [*changes.ancestors(child)] == [child, parent] and [*changes.ancestors(None)] == []
