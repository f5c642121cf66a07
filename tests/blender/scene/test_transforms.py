# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Transform channels against Blender's own matrices, and whatever keeps them from being set."""

import itertools

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import transforms
from body_moments.core.verdict.finding import EditRefusedError
from mathutils import Quaternion

from tests.blender.findings import refused
from tests.blender.objects import add, place
from tests.close import close

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


@pytest.mark.parametrize("mode", ORDERS)
def test_of_two_equally_near_ones_the_angles_are_taken_whose_first_turn_is_not_turned_back(mode):
    """Angles of 0.6, 0.3 and 0.6 half turns, and those of -0.4, 0.7 and -0.4, are as near to none."""
    i, j, k = ("XYZ".index(letter) for letter in mode)
    angles = np.empty(3)
    angles[[i, j, k]] = np.array([0.6, 0.3, 0.6]) * np.pi
    found = transforms.euler_angles(transforms.euler_matrix(angles, mode), mode, np.zeros(3))
    assert np.abs(found - angles).max() < 1e-12


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
    assert np.abs(now[:3, :3] - wanted).max() < 1e-6 * 3.0 and np.abs(now[:3, 3] - (1, 2, -3)).max() < 1e-6
    assert np.sign(np.prod(obj.scale) * np.prod(obj.delta_scale)) == np.sign(np.linalg.det(wanted))


def test_an_axis_of_no_length_is_blenders():
    obj = add(None)
    obj.rotation_mode, obj.rotation_axis_angle = "AXIS_ANGLE", (0.7, 0.0, 0.0, 0.0)
    assert np.abs(transforms.basis(obj) - place(obj)).max() < 1e-6
    obj.rotation_axis_angle = (0.7, 0.0, 0.6, 0.8)
    transforms.set_rotation_and_scale(obj, np.eye(3))
    assert np.abs(np.array(obj.rotation_axis_angle) - (0.0, 0.0, 0.6, 0.8)).max() < 1e-6  # the axis stays


def test_a_quaternion_keeps_its_sign():
    obj = add(None)
    obj.rotation_mode = "QUATERNION"
    for sign in (1.0, -1.0):
        obj.rotation_quaternion = sign * np.array([0.8, 0.6, 0.0, 0.0])
        transforms.set_rotation_and_scale(obj, transforms.rotation_matrix([0.6, 0.8, 0.0, 0.0]))
        assert np.abs(np.array(obj.rotation_quaternion) - sign * np.array([0.6, 0.8, 0.0, 0.0])).max() < 1e-6


@pytest.mark.parametrize("mode", ORDERS)
def test_euler_angles_are_the_nearest_of_all_that_rebuild_the_rotation(mode):
    rng = np.random.default_rng(3)
    angles, near = rng.uniform(-3.1, 3.1, (2, 20, 3)) * (1.0, 1.0, 3.0)
    middle = "XYZ".index(mode[1])
    angles[:4, middle] = (np.pi / 2, -np.pi / 2, np.pi / 2, -np.pi / 2)
    angles[4:8, middle] = np.pi / 2 + np.array([3e-8, -3e-8, 3e-7, -3e-7])
    rotations = np.stack([transforms.euler_matrix(row, mode) for row in angles])
    found = transforms.euler_angles(rotations, mode, near)
    first = "XYZ".index(mode[0])
    for row, (rotation, own, wished, given) in enumerate(zip(rotations, found, near, angles)):
        assert np.abs(transforms.euler_matrix(own, mode) - rotation).max() < (1e-12 if row not in range(4, 6) else 1e-7)
        assert np.abs(own - wished).max() <= np.pi + 1e-9
        if row < 6:  # locked, all but: the first angle is free
            assert min(abs(own[first] - wished[first]), abs(abs(own[first] - wished[first]) - np.pi)) < 1e-9
        else:
            other = given + np.pi
            other[middle] = np.pi - given[middle]
            rest = [angles + 2.0 * np.pi * np.round((wished - angles) / (2.0 * np.pi)) for angles in (given, other)]
            best = min(np.abs(angles - wished).sum() for angles in rest)
            assert abs(np.abs(own - wished).sum() - best) < 1e-6
    alone = transforms.euler_angles(rotations[9], mode, near[9])
    assert np.array_equal(alone, found[9])


def test_linear_maps_are_rotations_and_scales_of_the_present_signs():
    rng = np.random.default_rng(4)
    turns = np.stack([turned(rng) for _ in range(16)])
    sizes = rng.uniform(0.1, 9.0, (16, 3)) * np.resize([[1, 1, 1], [1, -1, 1], [-1, -1, 1], [-1, -1, -1]], (16, 3))
    linear = turns * sizes[:, None]
    for scale in (sizes, np.abs(sizes), -np.abs(sizes)):
        rotations, found, is_even = transforms.rotation_and_scale(linear, scale)
        assert is_even.all() and close(np.linalg.det(rotations), 1.0, 1e-12)
        assert np.abs(rotations * found[:, None] - linear).max() < 1e-12 * 9.0
        assert np.array_equal(np.sign(found[:, 1:]), np.sign(scale[:, 1:]))
        assert np.array_equal(np.prod(np.sign(found), axis=1), np.sign(np.linalg.det(linear)))
    shear = np.eye(3)
    for angle, is_even in ((1.8e-6, True), (2.2e-6, False)):
        shear[0, 1] = angle
        assert transforms.rotation_and_scale(shear, np.ones(3))[2] == is_even
        turned_shears = turns @ shear
        assert (transforms.rotation_and_scale(turned_shears, np.ones((16, 3)))[2] == is_even).all()
    some = transforms.rotation_and_scale(np.stack([np.eye(3), shear, np.diag([1.0, 0.0, 2.0])]), np.ones((3, 3)))
    assert some[2].tolist() == [True, False, False]
    assert not transforms.rotation_and_scale(np.diag([1.0, 0.0, 2.0]), np.ones(3))[2]


def test_what_cannot_be_set_is_refused():
    obj = add(None)

    def refuses(code, linear, **values):
        before = transforms.TransformChannels(obj).values
        with refused(code, **values):
            transforms.set_rotation_and_scale(obj, np.asarray(linear, float))
        assert transforms.TransformChannels(obj).values == before

    refuses("parent_or_delta_scale_zero", np.diag([1.0, 0.0, 1.0]))
    obj.delta_scale = (1.0, 1.0, 0.0)
    refuses("parent_or_delta_scale_zero", np.eye(3))
    obj.delta_scale = (1.0, 1.0, 1.0)
    refuses("parent_shears", [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]])
    obj.lock_scale = (False, True, False)
    refuses("channel_locked", np.diag([1.0, 2.0, 1.0]), channel="scale")
    refuses("channel_locked", np.diag([1.0, 1.0 + 2e-6, 1.0]), channel="scale")
    transforms.set_rotation_and_scale(obj, np.diag([3.0, 1.0 + 5e-7, 2.0]))
    assert np.abs(np.array(obj.scale) - (3.0, 1.0, 2.0)).max() < 1e-6
    turn = np.diag([3.0, 1.0, 2.0])[[1, 0, 2]] * ((1,), (-1,), (1,))
    obj.lock_scale, obj.scale = (False,) * 3, (1.0, 1.0, 1.0)
    for mode, locks in (("XYZ", "lock_rotation"), ("QUATERNION", "lock_rotation"), ("AXIS_ANGLE", "lock_rotation")):
        obj.rotation_mode = mode
        setattr(obj, locks, (False, False, True))
        with refused("channel_locked", channel="rotation"):
            transforms.set_rotation_and_scale(obj, turn / np.abs(turn).sum(axis=0))
        setattr(obj, locks, (False, False, False))
    obj.lock_rotation_w = True
    with refused("channel_locked", channel="rotation"):
        transforms.set_rotation_and_scale(obj, turn / np.abs(turn).sum(axis=0))


def test_locked_axes_may_move_by_the_tolerance_alone():
    obj = add(None, location=(1.0, 100.0, 1.0))
    obj.lock_location = (True, True, False)
    transforms.set_location(obj, np.array([1.009, 100.0, 5.0]), 0.01)
    assert np.abs(np.array(obj.location) - (1.009, 100.0, 5.0)).max() < 1e-5
    for moved in ((1.02, 100.0, 5.0), (1.009, 100.02, 5.0)):
        with refused("channel_locked", channel="location"):
            transforms.set_location(obj, np.array(moved), 0.01)
    transforms.set_location(obj, np.array([1.009, 100.00005, 5.0]), 0.0)  # a millionth of the largest
    with refused("channel_locked", channel="location"):
        transforms.set_location(obj, np.array([1.009, 100.00025, 5.0]), 0.0)


@pytest.mark.parametrize("by", ["action", "strip", "driver"])
def test_what_is_animated_is_refused_where_it_would_move(by):
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
    with refused("channel_animated", channel="location"):
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
    transforms.require_editable(own)
    transforms.require_storable_data(own, "channel_locked")
    for check in (transforms.require_editable, lambda obj: transforms.require_storable_data(obj, "channel_locked")):
        with pytest.raises(EditRefusedError) as error:
            check(names.objects[0])
        assert error.value.finding.code == "linked_object"
    parent, child = add(None, "Parent"), add(None, "Child")
    child.parent = parent
    assert [*transforms.ancestors(child)] == [child, parent] and [*transforms.ancestors(None)] == []


@pytest.mark.parametrize("mode", ORDERS)
def test_of_two_triples_of_euler_angles_the_nearer_one_is_taken_however_little_nearer(mode):
    """No rotation is three zeros, and three half turns."""
    for off in (1e-7, -1e-7):
        found = transforms.euler_angles(np.eye(3), mode, np.full(3, np.pi / 2.0 + off))
        assert np.abs(found - (np.pi if off > 0.0 else 0.0)).max() < 1e-12
