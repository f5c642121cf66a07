# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds of the rounding of objects' places, against places in double precision."""

from fractions import Fraction
from math import atan2, comb, cos, sin

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from mathutils import Matrix

from tests.blender import batch_files as files
from tests.blender.batch_files import document, measured

pytestmark = pytest.mark.usefixtures("registered")


@pytest.mark.parametrize("far", [0.0, 1234.5678, 12345678.3])
@pytest.mark.parametrize("seed", range(4))
def test_center_in_a_blend_is_within_its_bound(tmp_path, far, seed):
    files.empty_scene()
    rng = np.random.default_rng(seed)
    place = np.eye(4)
    parent = None
    for number in range(seed):
        angles, scale = rng.uniform(-180, 180, 3), rng.uniform(0.5, 2.0, 3) * [1, -1, 1]
        obj = bpy.data.objects.new(str(number), None)
        bpy.context.scene.collection.objects.link(obj)
        obj.location = move = rng.uniform(-1, 1, 3) * far
        obj.rotation_euler, obj.scale = np.radians(angles), scale
        obj.parent = parent
        own = np.eye(4)
        own[:3, :3], own[:3, 3] = files.turn(angles) * scale, move
        place, parent = place @ own, obj
    box = files.add_box(center=(0, 0, 0))
    box.data.transform(Matrix.Translation((1024, 0, 0)))  # far from its origin
    box.location = move = rng.uniform(0.5, 1.0, 3) * (far or 1.0)
    box.parent = parent
    body = measured(files.save(tmp_path / "t.blend"))
    center = (place @ [move[0] + 1024, *move[1:], 1.0])[:3]
    bound = body["error_bound"]["input"]["center_of_mass"]
    assert np.linalg.norm(body["center_of_mass"] - center) <= bound
    assert bound <= 2e-5 * max(np.linalg.norm(center), far, 2048.0)


def _turn(cosine):
    """(3, 3) exact rotation by Pythagoras' triangle (3, 4, 5) or (5, 12, 13) about z, and its
    angle.
    """
    sine = {Fraction(3, 5): Fraction(4, 5), Fraction(5, 13): Fraction(12, 13)}[cosine]
    return [[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]], float(atan2(sine, cosine))


@pytest.mark.parametrize("far", [Fraction(1, 3), Fraction(12345678), Fraction(24691357, 3)])
@pytest.mark.parametrize("rotation_mode", ["XYZ", "QUATERNION", "AXIS_ANGLE"])
def test_turned_and_scaled_chain_is_within_its_bound(tmp_path, far, rotation_mode):
    files.empty_scene()
    point = [Fraction(1000), Fraction(0), Fraction(0)]
    obj = files.add_box(center=(0, 0, 0))
    obj.data.transform(Matrix.Translation((1000, 0, 0)))
    for cosine in (Fraction(3, 5), Fraction(5, 13), Fraction(3, 5)):
        turn, angle = _turn(cosine)
        scale = (Fraction(1, 3), Fraction(7, 5), Fraction(1))
        move = (far, -far / 7, Fraction(1, 10))
        obj.rotation_mode = rotation_mode
        if rotation_mode == "XYZ":
            obj.rotation_euler.z = angle
        elif rotation_mode == "QUATERNION":
            obj.rotation_quaternion = cos(angle / 2), 0, 0, sin(angle / 2)
        else:
            obj.rotation_axis_angle = angle, 0, 0, 1
        obj.scale, obj.location = list(map(float, scale)), list(map(float, move))
        point = [
            sum(entry * factor * value for entry, factor, value in zip(row, scale, point)) + along
            for row, along in zip(turn, move)
        ]
        above = bpy.data.objects.new("Above", None)
        bpy.context.scene.collection.objects.link(above)
        obj.parent = above
        obj = above
    body = measured(files.save(tmp_path / "t.blend"))
    off = [Fraction(value) - true for value, true in zip(body["center_of_mass"], point)]
    bound = body["error_bound"]["input"]["center_of_mass"]
    assert sum(value * value for value in off) <= Fraction(bound) ** 2
    assert bound <= 2e-5 * max(float(far), 1000.0)


def test_bounds_of_assembly_and_bone_parent_contain_the_place(tmp_path):
    files.empty_scene()
    far = 12345678.3
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.1, 0.2, 0.3), (0.1, 0.2, 1.3)
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.location.x = far
    box = files.add_box("Box", center=(0, 0, 0))
    box.parent, box.parent_type, box.parent_bone = armature, "BONE", "Bone"
    box.location.y = 1234.5678  # along the bone: upward
    inner = bpy.data.collections.new("Inner")
    inner.objects.link(files.add_box("Part", center=(0, 0, 0)))
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", inner
    outer = bpy.data.collections.new("Outer")
    outer.objects.link(empty)
    empty.location.y = far
    bpy.context.scene.collection.children.link(outer)
    bpy.context.view_layer.update()
    outer.body_moments.mass_from = "MASS"
    found = document(files.save(tmp_path / "t.blend"))
    box = next(entry for entry in found["objects"] if entry["name"] == "Box")
    for entry, center in (
        (box, (far + 0.1, 0.2, 1.3 + 1234.5678)),
        (found["assemblies"][0], (0.0, far, 0.0)),
    ):
        bound = entry["error_bound"]["input"]["center_of_mass"]
        assert np.linalg.norm(np.subtract(entry["center_of_mass"], center)) <= bound < 50.0


def test_bounds_of_moments_contain_the_rounding_of_the_place(tmp_path):
    files.empty_scene()
    move = 1234.5678
    files.add_box(center=(0, 0, 0), size=(2, 2, 2)).location = (move, move / 3, 0.0)
    path = files.save(tmp_path / "t.blend")
    found = measured("--order", 3, path)["moments"]

    def moment(center, power):  # of a side of length 2
        even = [(0, 1), (2, 1 / 3)]
        return sum(comb(power, k) * center ** (power - k) * 2 * m for k, m in even if k <= power)

    for key, raw in found["volume"].items():
        p, q, r = map(int, key.split(","))
        right = moment(move, p) * moment(move / 3, q) * moment(0.0, r)
        assert abs(raw - right) <= found["input"]["volume"][key] + found["error"]["volume"][key]
    about = measured("--order", 3, "--about", "center", path)["moments"]
    assert about["input"]["volume"]["2,0,0"] < 1e-3 < found["input"]["volume"]["2,0,0"]


def test_place_does_not_count_in_the_frame_of_the_object(tmp_path):
    files.empty_scene()
    files.add_box(center=(0, 0, 0)).location.x = 12345678.0
    path = files.save(tmp_path / "t.blend")
    bounds = [
        measured("--frame", frame, path)["error_bound"]["input"]["center_of_mass"]
        for frame in ("object", "world")
    ]
    assert bounds[0] < 1e-5 and bounds[1] > 0.5
