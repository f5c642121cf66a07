# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Follow Center: the path of a free flight is a parabola, that of several objects the sum of
theirs; keys, signals.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.live.motion import Motion
from body_moments.blender.session.stored import balance_groups
from body_moments.core.inertia.mass_properties import combine
from mathutils import Matrix, Quaternion

from tests.blender import objects
from tests.close import close
from tests.operators.standing import box


def key_matrix(obj, frame, matrix):
    obj.rotation_mode = "QUATERNION"
    obj.matrix_world = Matrix(matrix)
    for channel in ("location", "rotation_quaternion"):
        obj.keyframe_insert(channel, frame=frame)


def path_of(empty):
    return balance_groups.path(empty)


def support_of(empty, frame):
    return balance_groups.support(empty, frame)


def groups():
    return list(balance_groups.groups(bpy.context.scene))


def spin(obj, frames, start, center, velocity, gravity):
    """Key a body that flies free: its center on a parabola, turning about an axis of its own."""
    axis = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5])
    for frame in frames:
        t = frame / len(frames)
        turn = np.array(Quaternion(axis, 7.0 * t).to_matrix())
        u, _, v = np.linalg.svd(turn)
        turn = u @ v
        place = start + velocity * t + gravity * t * t / 2.0
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = turn, place - turn @ center
        key_matrix(obj, frame, matrix)


def test_the_path_of_a_free_flight_is_a_parabola(scene):
    obj = objects.add(objects.mesh_body())
    size = float(np.ptp(objects.seen(obj), axis=0).max())
    center = objects.measured(obj).mass_properties.center
    scene.frame_start, scene.frame_end = 1, 40
    velocity, gravity = np.array([7.0, 1.0, 5.0]) * size, np.array([0.0, 0.0, -9.0]) * size
    spin(obj, range(1, 41), np.array([-4.0, 1.0, 2.0]) * size, center, velocity, gravity)
    assert bpy.ops.object.body_moments_balance_group() == {"FINISHED"}
    (empty,) = groups()
    path = path_of(empty)
    assert path.frames.tolist() == list(range(1, 41)) and path.inside is None
    t = path.frames / 40.0
    reach = np.ptp(path.centers, axis=0).max()
    assert reach > 5.0 * size and close(empty.empty_display_size, 0.05 * reach, 1e-6)
    fit = np.polynomial.polynomial.polyfit(t, path.centers, 2)
    off = path.centers - np.polynomial.polynomial.polyval(t, fit).T
    assert np.abs(off).max() <= 1e-6 * size
    assert np.abs(2.0 * fit[2] - gravity).max() <= 1e-4 * size
    scene.frame_set(17)
    assert np.abs(np.array(empty.matrix_world.translation) - path.centers[16]).max() <= 1e-6 * size


def character():
    """An armature with ten meshes: half of them deformed by its bones, half of them parented to
    them.
    """
    data = bpy.data.armatures.new("Rig")
    rig = objects.add(data, "Rig")
    bpy.ops.object.mode_set(mode="EDIT")
    for number in range(5):
        bone = data.edit_bones.new(f"Bone {number}")
        bone.head, bone.tail = (0.0, 0.0, number), (0.0, 0.0, number + 1.0)
        if number:
            bone.parent = data.edit_bones[number - 1]
    bpy.ops.object.mode_set(mode="OBJECT")
    meshes = []
    for number in range(5):
        skin, hat = f"Skin {number}", f"Hat {number}"
        skin = objects.add(objects.mesh_body(skin), skin, (0.1, 0.2, number), parent=rig)
        skin.modifiers.new("Armature", "ARMATURE").object = rig
        group = skin.vertex_groups.new(name=f"Bone {number}")
        for vertex in range(len(skin.data.vertices)):
            group.add([vertex], 0.3 + 0.6 * (vertex % 2), "REPLACE")
        hat = objects.add(objects.mesh_body(hat), hat, (1.0, 0.0, 0.5), scale=(0.3,) * 3)
        hat.parent, hat.parent_type, hat.parent_bone = rig, "BONE", f"Bone {number}"
        hat.body_moments.density = 2000.0 + number
        meshes += [skin, hat]
    for frame in range(1, 13):
        for number, bone in enumerate(rig.pose.bones):
            bone.rotation_mode = "XYZ"
            bone.rotation_euler = (0.3 * np.sin(frame + number), 0.1 * frame, 0.2 * np.cos(frame))
            bone.keyframe_insert("rotation_euler", frame=frame)
        rig.location = (0.5 * frame, 0.0, abs(np.sin(frame)))
        rig.keyframe_insert("location", frame=frame)
    bpy.context.view_layer.update()
    return rig, meshes


def test_the_center_of_a_character_is_that_of_its_parts(scene):
    _, meshes = character()
    motion = Motion(frames=12)
    for frame in range(1, 13):
        scene.frame_set(frame)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        masses, centers = zip(*(motion.mass_and_center(obj, depsgraph) for obj in meshes))
        parts = [objects.measured(obj).mass_moments for obj in meshes]
        truth = combine(parts)
        total = np.sum(masses)
        center = np.einsum("i,ij->j", np.array(masses) / total, np.array(centers))
        assert close(total, truth.mass, 1e-12)
        assert np.abs(center - truth.center).max() <= 1e-12 * 10.0


def test_an_armature_stands_for_its_meshes(scene):
    rig, meshes = character()
    objects.add(objects.mesh_body(), "Beside", parent=rig)
    held = objects.add(objects.mesh_body(), "Held")
    held.parent, held.parent_type = objects.add(bpy.data.armatures.new("Other"), "Other"), "BONE"
    scene.frame_start, scene.frame_end = 1, 12
    objects.only(rig)
    assert bpy.ops.object.body_moments_balance_group() == {"FINISHED"}
    (empty,) = groups()
    assert empty["body_balance_group"].split("\n") == sorted(obj.name for obj in meshes)
    assert len(path_of(empty).frames) == 12


@pytest.mark.parametrize("mass", [None, 12.0])
def test_shape_keys_are_followed_by_their_polynomials(scene, mass):
    obj = objects.add(
        objects.mesh_body(),
        location=(1.0, 2.0, 3.0),
        rotation=(0.3, 0.2, 0.1),
        scale=(2.0, 2.0, 2.0),
    )
    if mass is not None:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", mass
    obj.shape_key_add(name="Basis")
    random = np.random.default_rng(4)
    for name in ("Fat", "Tall"):
        key = obj.shape_key_add(name=name)
        for point in key.data:
            point.co.x *= 1.4 if name == "Fat" else 1.0
            point.co.z *= 1.5 if name == "Tall" else 1.0
            point.co.y += 0.1 * point.co.x
        for frame in range(1, 41):
            key.value = random.uniform(0.0, 1.0)
            key.keyframe_insert("value", frame=frame)
    motion = Motion(frames=40)
    for frame in range(1, 41, 3):
        scene.frame_set(frame)
        total, center = motion.mass_and_center(obj, bpy.context.evaluated_depsgraph_get())
        truth = objects.measured(obj).mass_properties
        assert close(total, truth.mass, 1e-6)
        assert np.abs(center - truth.center).max() <= 1e-6 * 10.0


def test_scales_that_change_are_followed(scene):
    solid = objects.add(objects.mesh_body(), location=(1.0, 0.0, 0.0))
    sheet = objects.add(objects.mesh_body("Sheet"), "Sheet")
    sheet.body_moments.kind, sheet.body_moments.thickness = "SHELL", 0.01
    motion = Motion(frames=3)
    for scale in ((1.0, 1.0, 1.0), (2.0, 2.0, 2.0), (1.0, -3.0, 0.5)):
        for obj in (solid, sheet):
            obj.scale = scale
        bpy.context.view_layer.update()
        for obj in (solid, sheet):
            total, center = motion.mass_and_center(obj, bpy.context.evaluated_depsgraph_get())
            truth = objects.measured(obj).mass_properties
            assert close(total, truth.mass, 1e-6)
            assert np.abs(center - truth.center).max() <= 1e-6 * 10.0


def mirrored_by_a_key(frames):
    """8 m³ at (1, 2, 3) whose height becomes its negative, beside 1 m³ at (9, 0, 0)."""
    obj, other = (
        objects.add(box((1, 2, 4), (-0.5, -1, -2)), location=(1, 2, 3)),
        objects.add(box((1, 1, 1)), "Other"),
    )
    other.location = (8.5, -0.5, -0.5)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Mirrored")
    for point in key.data:
        point.co.z *= -1.0
    for frame in range(1, frames + 1):
        key.value = (frame - 1) / (frames - 1)
        key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, frames
    objects.only(obj, other)


@pytest.mark.parametrize("frames", [4, 10])
def test_body_turned_inside_out_by_key_keeps_its_weight(scene, frames):
    """In few frames, in each of which it is measured, as in many."""
    mirrored_by_a_key(frames)
    assert bpy.ops.object.body_moments_balance_group() == {"FINISHED"}
    weights = 8.0 * np.abs(1.0 - 2.0 * np.arange(frames) / (frames - 1.0))[:, None]
    expected = (weights * (1.0, 2.0, 3.0) + (9.0, 0.0, 0.0)) / (weights + 1.0)
    assert np.abs(path_of(groups()[0]).centers - expected).max() <= 1e-5


@pytest.mark.parametrize("by", ["shape key", "scale", "scale of a mix"])
def test_body_that_becomes_flat_ends_balance_group(scene, reported, by):
    mirrored_by_a_key(9 if by == "shape key" else 10)
    if by != "shape key":
        obj = bpy.context.object if by == "scale of a mix" else bpy.data.objects["Other"]
        for frame, scale in ((1, 1.0), (5, 0.0)):
            obj.scale.x = scale
            obj.keyframe_insert("scale", frame=frame)
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_balance_group()
    assert reported.codes == ["no_volume" if by == "shape key" else "zero_scale"] and not groups()


def test_signal_tells_center_beyond_support_polygon(scene, reported):
    """A weight that slides over a foot from -2 to 2: over the foot as long as their common center
    is within ±1.
    """
    foot = objects.add(box((2.0, 2.0, 0.1), (-1.0, -1.0, 0.0)), "Foot")
    weight = objects.add(box((1.0, 1.0, 1.0), (-0.5, -0.5, 0.0)), "Weight")
    for frame in range(1, 42):
        weight.location = (-2.03 + 0.1 * (frame - 1), 0.0, 1.0)
        foot.location = (0.0, 0.0, 0.0 if frame < 31 else 1.0)
        for obj in (foot, weight):
            obj.keyframe_insert("location", frame=frame)
    collection = bpy.data.collections.new("Feet")
    scene.collection.children.link(collection)
    collection.objects.link(foot)
    scene.frame_start, scene.frame_end = 1, 41
    objects.only(foot, weight)
    assert bpy.ops.object.body_moments_balance_group(contacts="Feet") == {"FINISHED"}
    (empty,) = groups()
    path = path_of(empty)
    share = 1.0 / 1.4
    expected = (np.abs(share * (-2.03 + 0.1 * (path.frames - 1))) < 1.0) & (path.frames < 31)
    assert path.inside.tolist() == expected.tolist()
    assert f"{np.count_nonzero(expected)} of 41" in reported.texts[-1]
    assert (
        support_of(empty, 20).stands
        and not support_of(empty, 1).stands
        and len(support_of(empty, 1).polygon) == 4
    )
    assert support_of(empty, 31) is None and support_of(foot, 20) is None
    scene.frame_set(20)
    assert empty["body_balance_inside"] == 1
    scene.frame_set(1)
    assert empty["body_balance_inside"] == 0
    shown = empty.id_properties_ui("body_balance_inside").as_dict()
    assert (shown["min"], shown["max"]) == (0, 1)
    assert shown["description"] == "Whether the center is over the support polygon"


@pytest.mark.parametrize(("reach", "distance"), [(0.0, 0.02), (0.005, 0.005)])
def test_foot_within_contact_distance_touches_ground(scene, reach, distance):
    """Of a foot of 2 m, a hundredth of that where none is given."""
    foot = objects.add(box((2.0, 2.0, 0.1), (-1.0, -1.0, 0.0)), "Foot")
    for frame, share in ((1, 0.98), (2, 1.02)):
        foot.location.z = 3.0 + share * distance
        foot.keyframe_insert("location", frame=frame)
    collection = bpy.data.collections.new("Feet")
    scene.collection.children.link(collection)
    collection.objects.link(foot)
    scene.frame_start, scene.frame_end = 1, 2
    assert bpy.ops.object.body_moments_balance_group(contacts="Feet", ground=3.0, reach=reach) == {
        "FINISHED"
    }
    assert path_of(groups()[0]).inside.tolist() == [True, False]


def test_the_frame_and_the_selection_stay_and_one_empty_is_made(scene):
    first = objects.add(objects.mesh_body(), "First")
    second = objects.add(objects.mesh_body(), "Second", location=(4.0, 0.0, 0.0))
    objects.add(None, "Other Empty")
    objects.add(objects.strip_mesh(), "Strip")["body_balance_group"] = "First\nSecond"
    objects.only(first, second)
    scene.frame_set(7, subframe=0.25)
    for end in (10, 5):
        assert bpy.ops.object.body_moments_balance_group(
            use_scene_range=False, frame_start=2, frame_end=end
        ) == {"FINISHED"}
        assert scene.frame_float == 7.25
        assert first.select_get() and second.select_get() and bpy.context.object == first
        # an empty without a path is none, nor is a mesh that was given the same property
        (empty,) = groups()
        assert path_of(empty).frames.tolist() == list(range(2, end + 1))
    scene.frame_start, scene.frame_end, scene.use_preview_range, scene.frame_preview_end = (
        1,
        6,
        True,
        3,
    )
    assert bpy.ops.object.body_moments_balance_group() == {"FINISHED"}
    # those of the scene, as the property says
    assert path_of(empty).frames.tolist() == [*range(1, 7)]
    assert np.abs(np.ptp(path_of(empty).centers, axis=0)).max() == 0.0
    assert not any(obj.animation_data for obj in (first, second))


def test_ground_is_in_direction_of_gravity(scene):
    """Gravity that points along x: a foot whose face at x = -3 stands on ground at height 3."""
    foot = objects.add(box((0.1, 2.0, 2.0), (-0.1, -1.0, -1.0)), "Foot")
    for frame, x in ((1, -3.0), (2, -4.0), (3, -2.0)):
        foot.location.x = x
        foot.keyframe_insert("location", frame=frame)
    collection = bpy.data.collections.new("Feet")
    scene.collection.children.link(collection)
    for obj in (foot, objects.add(bpy.data.cameras.new("Camera"), "Camera")):
        collection.objects.link(obj)
    objects.only(foot)
    scene.gravity = (9.81, 0.0, 0.0)
    arguments = {
        "use_scene_range": False,
        "frame_end": 3,
        "contacts": "Feet",
        "ground": 3.0,
        "reach": 0.01,
    }
    assert bpy.ops.object.body_moments_balance_group(**arguments) == {"FINISHED"}
    assert path_of(groups()[0]).inside.tolist() == [True, False, True]


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_masses_given_for_a_nested_collection_count(scene, unit):
    """A cube of water at 0, and one in a collection that weighs three times as much at 4."""
    scene.unit_settings.scale_length = unit
    outer, inner = bpy.data.collections.new("Outer"), bpy.data.collections.new("Inner")
    scene.collection.children.link(outer)
    outer.children.link(inner)
    for place, collection in ((0.0, outer), (4.0, inner)):
        obj = objects.add(box((1.0, 1.0, 1.0), (-0.5, -0.5, -0.5)), location=(place, 0.0, 0.0))
        collection.objects.link(obj)
        scene.collection.objects.unlink(obj)
    inner.body_moments.mass_from, inner.body_moments.mass = "MASS", 3000.0 * unit**3
    bpy.context.view_layer.update()
    arguments = {"use_scene_range": False, "frame_start": 1, "frame_end": 2}
    assert bpy.ops.object.body_moments_balance_group(collection="Outer", **arguments) == {
        "FINISHED"
    }
    assert close(path_of(groups()[0]).centers[:, 0], 3.0, 1e-6)


def test_collection_instances_are_followed(scene):
    shown, parts = bpy.data.collections.new("Shown"), bpy.data.collections.new("Parts")
    scene.collection.children.link(parts)
    obj = objects.add(box((1.0, 1.0, 1.0), (-0.5, -0.5, -0.5)))
    shown.objects.link(obj)
    scene.collection.objects.unlink(obj)
    for place in (1.0, 5.0):
        instancer = objects.add(None, "At {:g}".format(place), location=(place, 0.0, 0.0))
        instancer.instance_type, instancer.instance_collection = "COLLECTION", shown
        parts.objects.link(instancer)
    bpy.context.view_layer.update()
    arguments = {"use_scene_range": False, "frame_start": 1, "frame_end": 2}
    assert bpy.ops.object.body_moments_balance_group(collection="Parts", **arguments) == {
        "FINISHED"
    }
    assert groups()[0]["body_balance_group"] == "At 1\nAt 5"
    assert close(path_of(groups()[0]).centers[:, 0], 3.0, 1e-6)


@pytest.mark.parametrize(
    "arguments", [{}, {"collection": "Nowhere"}, {"contacts": "Nowhere"}, {"contacts": "Lamps"}]
)
def test_missing_groups_are_refused(scene, reported, arguments):
    bpy.data.collections.new("Lamps")
    if arguments:
        objects.add(objects.mesh_body())
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_balance_group(**arguments)
    is_missing = "Nowhere" in arguments.values()
    assert reported.codes[-1] == ("no_such_name" if is_missing else "balance_group_empty")
    assert not groups()


def test_an_object_without_a_certain_center_ends_it(scene, reported):
    objects.add(objects.strip_mesh())
    scene.frame_set(5)
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_balance_group()
    assert "open_object" in reported.codes and scene.frame_current == 5 and not groups()
