# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colliders as objects: made, named, updated in place, removed; what they do is stored; refusals
name the object.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.read.mesh import mesh_surface
from body_moments.blender.scene.colliders import read_colliders
from body_moments.blender.session.colliders import collider_record
from body_moments.blender.session.stored import outcome
from body_moments.blender.session.stored.collider_tolerance import tolerance_remedy
from body_moments.blender.session.tracking.staleness import stale_reason
from body_moments.blender.session.tracking.stamps import Kind, Stale
from body_moments.blender.settings.given import COLLIDER, COLLIDERS
from body_moments.command.measure.measuring import objects_to_measure
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.polyhedron.integration import volume_and_center
from mathutils import Euler, Vector

from tests.blender.objects import add, dent, measure, measured, mesh_body, mesh_of, only, seen

pytestmark = pytest.mark.usefixtures("scene")


def make(**options):
    return bpy.ops.object.body_moments_make_colliders(**options)


def colliders(body):
    bpy.context.view_layer.update()
    return sorted((child for child in body.children if COLLIDER in child), key=lambda obj: obj.name)


def test_colliders_are_hidden_children_in_their_own_collection():
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5), (1.0, 2.0, -0.5))
    before = seen(body)
    assert make(shape="PIECES") == {"FINISHED"}
    made = colliders(body)
    assert len(made) > 1 and [*bpy.data.collections["Colliders"].objects] == made
    assert all(obj.display_type == "WIRE" and obj.hide_render for obj in made)
    points = np.concatenate([seen(obj) for obj in made])
    assert np.abs(points.min(axis=0) - before.min(axis=0)).max() < 1e-5
    assert np.abs(points.max(axis=0) - before.max(axis=0)).max() < 1e-5
    assert np.array_equal(seen(body), before) and bpy.context.selected_objects == [body]
    body.scale.x = 3.0  # hulls follow
    bpy.context.view_layer.update()
    points = np.concatenate([seen(obj) for obj in made])
    assert np.abs(points.max(axis=0) - seen(body).max(axis=0)).max() < 1e-5


@pytest.mark.parametrize("shape", ["BOX", "SPHERE", "CAPSULE", "CYLINDER"])
def test_primitive_has_its_size_in_scaled_body(shape):
    body = add(mesh_body(), "Body", (100, 2, 3), (0.3, 0.4, 0.5), (1.0, 2.0, -0.5))
    assert make(shape=shape) == {"FINISHED"}
    (collider,) = colliders(body)
    assert np.abs(np.array(collider.matrix_world.to_scale()) - 1.0).max() < 1e-5
    kind, size = collider[COLLIDER]["kind"], np.array(collider[COLLIDER]["size"])
    height = {"SPHERE": 2 * size[0], "CAPSULE": size[-1] + 2 * size[0]}.get(shape, size[-1])
    assert kind == shape.lower() and collider.dimensions.z == pytest.approx(height, rel=1e-5)
    assert collider.dimensions.x == pytest.approx(size[0] * (1 if shape == "BOX" else 2), rel=0.01)


@pytest.mark.parametrize(
    "engine, shape, name",
    [
        ("NONE", "HULL", "Body Collider 01"),
        ("UNREAL", "HULL", "UCX_Body_01"),
        ("UNREAL", "BOX", "UBX_Body_01"),
        ("UNREAL", "SPHERE", "USP_Body_01"),
        ("UNREAL", "CAPSULE", "UCP_Body_01"),
        ("UNREAL", "CYLINDER", "UCX_Body_01"),
        ("GODOT", "HULL", "Body_01-convcolonly"),
        ("GODOT_MESH", "HULL", "Body_01-colonly"),
        ("UNITY", "HULL", "Body_Collider_01"),
    ],
)
def test_names_are_those_of_the_engine(engine, shape, name):
    body = add(mesh_body(), "Body")
    make(shape=shape, engine=engine)
    assert [obj.name for obj in colliders(body)] == [name]


def test_pressing_again_updates_in_place_and_removal_leaves_nothing():
    body = add(mesh_body(), "Body")
    counts = len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.collections)
    make(shape="PIECES", engine="UNREAL")
    first = colliders(body)
    make(shape="PIECES", engine="UNREAL")
    assert colliders(body) == first and len(bpy.data.meshes) == counts[1] + len(first)
    make(shape="HULL")
    assert colliders(body) == first[:1] and len(bpy.data.meshes) == counts[1] + 1
    only(colliders(body)[0])  # the body is meant
    assert bpy.ops.object.body_moments_remove_colliders() == {"FINISHED"}
    assert (len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.collections)) == counts
    assert COLLIDERS not in body
    only(body)
    assert bpy.ops.object.body_moments_remove_colliders() == {"CANCELLED"}


def test_linked_meshes_share_the_meshes_of_colliders():
    mesh = mesh_body()
    first = add(mesh, "First", (1, 2, 3), (0.3, 0.4, 0.5))
    second, third = (
        add(mesh, "Second", (-7, 5, 0), (1.3, -0.4, 2.5)),
        add(mesh, "Third", (0, 0, 9), scale=(1, 2, 1)),
    )
    shell, large = add(mesh, "Shell"), add(mesh, "Large", (0, 9, 0), scale=(2, 2, 2))
    shell.body_moments.kind = "SHELL"
    only(first, second, third, shell, large)
    make(shape="HULL")
    meshes = [
        [obj.data for obj in colliders(body)] for body in (first, second, third, shell, large)
    ]
    assert meshes[0] == meshes[1] and set(meshes[0]).isdisjoint(meshes[2] + meshes[3] + meshes[4])
    (own,), (eightfold,) = colliders(first), colliders(large)
    assert eightfold[COLLIDER]["mass"] == pytest.approx(8.0 * own[COLLIDER]["mass"], rel=1e-6)


def test_stored_effect_goes_out_of_date():
    body = add(mesh_body(), "Body")
    make(shape="HULL")
    stale = lambda: stale_reason(body, bpy.context.scene, Kind.COLLIDERS)  # noqa: E731
    assert stale() is None and body[COLLIDERS]["volume_ratio"] > 1.0
    body.location.x = 5.0
    bpy.context.view_layer.update()
    assert stale() is None
    (collider,) = colliders(body)
    collider.location.x += 1.0
    assert stale() == Stale.COLLIDERS
    collider.location.x -= 1.0
    collider.data.vertices[0].co.x += 1.0
    assert stale() == Stale.COLLIDERS
    make(shape="HULL")
    assert stale() is None
    dent(body, -1.0)
    assert stale() == Stale.GEOMETRY
    make(shape="HULL")
    body.scale.x = 2.0
    bpy.context.view_layer.update()
    assert stale() == Stale.TRANSFORM


def test_refused_objects_are_named_and_the_others_go_on(reported):
    body = add(mesh_body(), "Body")
    armature = add(bpy.data.armatures.new("Bones"), "Rig")
    flat = add(mesh_of([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]), "Flat")
    zero = add(mesh_body(), "Zero", scale=(1, 0, 1))
    zero.body_moments.kind = "SHELL"
    only(body, armature, flat, zero)
    assert make(shape="SPHERE") == {"FINISHED"}
    assert len(colliders(body)) == 1
    assert {"Rig", "Flat", "Zero"} == {
        one.values["object"] for one in reported if one.code == "failure"
    }
    assert not any(colliders(obj) for obj in (armature, flat, zero))


@pytest.mark.parametrize("name", ["urdf", "sdf", "mjcf", "usd", "gltf"])
def test_exports_collide_as_colliders(name, tmp_path):
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5), (1, 2, 1))
    make(shape="PIECES")
    path = tmp_path / ("r.gltf" if name == "gltf" else "r.txt")
    assert getattr(bpy.ops.export_scene, "body_moments_" + name)(filepath=str(path)) == {"FINISHED"}
    text = path.read_text(encoding="utf-8")
    pieces = len(colliders(body))
    visual, collision = {
        "urdf": ("<visual>", "<collision>"),
        "sdf": ("<visual ", "<collision "),
        "mjcf": ('group="2"', 'group="3"'),
        "usd": ('"visual_', '"collision_'),
        "gltf": ('"name": "Body mesh"', '"convexHull"'),
    }[name]
    assert pieces > 1 and text.count(visual) == 1 and text.count(collision) == pieces
    if name in ("urdf", "sdf", "mjcf"):
        assert len([*tmp_path.rglob("*.stl")]) == 1 + pieces
    make(shape="BOX")
    getattr(bpy.ops.export_scene, "body_moments_" + name)(filepath=str(path))
    assert {"usd": "def Cube"}.get(name, "box") in path.read_text(encoding="utf-8")


def test_rigid_body_is_a_compound_of_its_colliders():
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5))
    make(shape="PIECES")
    before = [seen(obj) for obj in colliders(body)]
    only(body, *colliders(body))
    assert bpy.ops.object.body_moments_rigid_bodies() == {"FINISHED"}
    made = colliders(body)
    assert body.rigid_body.collision_shape == "COMPOUND"
    assert [obj.rigid_body.collision_shape for obj in made] == ["CONVEX_HULL"] * len(before)
    assert all(np.abs(seen(obj) - points).max() < 1e-5 for obj, points in zip(made, before))


def test_instancer_gets_colliders_around_its_instances():
    body = add(mesh_body(), "Body", (1, 0, 0))
    source = bpy.data.collections.new("Source")
    source.objects.link(body)
    shown = add(None, "Shown", (5, 6, 7), (0.1, 0.2, 0.3))
    shown.instance_type, shown.instance_collection = "COLLECTION", source
    bpy.context.view_layer.update()
    assert make(shape="HULL") == {"FINISHED"}
    (collider,) = colliders(shown)
    place = np.array(shown.matrix_world) @ np.array(body.matrix_world)
    points = np.array([vertex.co for vertex in body.data.vertices]) @ place[:3, :3].T + place[:3, 3]
    assert np.abs(seen(collider).max(axis=0) - points.max(axis=0)).max() < 1e-5
    assert not colliders(body)


def test_colliders_are_left_out_of_measuring():
    body = add(mesh_body(), "Body")
    make(shape="PIECES")
    made = colliders(body)
    chosen, left_out, _ = objects_to_measure(None, False, {})
    assert [obj for _, obj in chosen] == [body]
    assert [entry["name"] for entry in left_out] == [obj.name for obj in made]
    measure(body, *made)
    assert "body_mass" in body and not any("body_mass" in obj for obj in made)


def test_record_states_effect_of_colliders():
    from body_moments.blender.session.colliders import collider_record

    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5))
    assert collider_record(body, measured(body), bpy.context) is None
    make(shape="HULL", engine="UNREAL")
    record = collider_record(body, measured(body), bpy.context)
    assert record["count"] == 1 and record["engine"] == "UNREAL" and record["out_of_date"] is None
    assert record["volume_ratio"] == pytest.approx(body[COLLIDERS]["volume_ratio"])
    body.scale.z = 2.0
    assert collider_record(body, measured(body), bpy.context)["out_of_date"] == Stale.TRANSFORM


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_corrections_bring_colliders_nearer_to_the_body(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5), (2, 1, 1))
    make(shape="HULL", correct="VERTICES", outward=0.3, inward=0.3)
    effect = body[COLLIDERS]
    assert effect["mass_ratio"] == pytest.approx(1.0, abs=1e-12) and effect["inertia_change"] < 1e-5
    make(shape="PIECES", correct="MASSES")
    masses = [obj[COLLIDER]["mass"] for obj in colliders(body)]
    assert len(masses) > 1 and min(masses) >= 0.0
    assert sum(masses) == pytest.approx(measured(body).mass_properties.mass, rel=1e-6)


def test_sphere_keeps_its_shape_without_vertices_to_move():
    body = add(mesh_body(), "Body")
    make(shape="SPHERE")
    size = list(colliders(body)[0][COLLIDER]["size"])
    make(shape="SPHERE", correct="VERTICES")
    assert list(colliders(body)[0][COLLIDER]["size"]) == size


def add_rod_along_path(points=((1, 2, 3), (4, 2, 5))):
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions = "3D"
    curve.use_path, curve.bevel_depth, curve.use_fill_caps = True, 0.3, True
    spline = curve.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, place in zip(spline.points, points):
        point.co = (*place, 1.0)
    return add(curve, "Curve", (3, 1, 0), (0.3, 0.5, 0.7))


@pytest.mark.parametrize("shape", ["HULL", "BOX", "EQUAL_BOX"])
def test_colliders_of_a_curve_with_a_path_stand_where_it_is(shape):
    body = add_rod_along_path()
    assert make(shape=shape) == {"FINISHED"}
    (collider,) = colliders(body)
    around = np.array([body.matrix_world @ Vector(corner) for corner in body.bound_box])
    middle = (around.min(axis=0) + around.max(axis=0)) / 2.0
    points = seen(collider)
    assert np.abs((points.min(axis=0) + points.max(axis=0)) / 2.0 - middle).max() < 1e-4
    rotation = rotation_matrix(body.matrix_world.to_quaternion())
    (read,) = read_colliders([collider], rotation, 1.0)
    points = (points - np.array(body.location)) @ rotation
    center = read.pose.position if read.surface is None else read.surface.points.mean(axis=0)
    assert np.abs(points.mean(axis=0) - center).max() < 1e-5


def test_origin_of_a_hull_is_its_center_of_mass():
    body = add(mesh_body(), "Body", (100, 2, 3), (0.3, 0.4, 0.5), (1.0, 2.0, -0.5))
    make(shape="PIECES", engine="GODOT")
    made = colliders(body)
    assert len(made) > 1
    for collider in made:
        volume, center = volume_and_center(mesh_surface(collider.data, edges=False))
        assert abs(volume) > 0.0 and np.abs(center).max() < 1e-6


@pytest.mark.parametrize("turn", [(0, 0, 0), (0.3, 0.7, 1.1)], ids=["level", "turned"])
@pytest.mark.parametrize("correct", ["NONE", "MASSES", "VERTICES"])
@pytest.mark.parametrize("shape", ["AUTOMATIC", "BOX", "AXES_BOX", "CYLINDER", "HULL", "PIECES"])
def test_flat_colliders_are_refused_with_a_remedy(shape, correct, turn):
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]) @ np.array(
        Euler(turn).to_matrix()
    )
    body = add(mesh_of(corners, [(0, 1, 2), (0, 2, 3)], "Sheet"), "Sheet", rotation=turn)
    body.body_moments.kind, body.body_moments.thickness = "SHELL", 0.01
    assert make(shape=shape, correct=correct) == {"CANCELLED"}
    (group,) = outcome.last().groups
    assert group.finding.code == "colliders_flat" and not colliders(body)
    assert make(shape="SPHERE") == {"FINISHED"}


@pytest.mark.parametrize("shape", ["PIECES", "AUTOMATIC"])
def test_rod_of_extreme_length_gets_colliders(shape):
    bpy.ops.mesh.primitive_cube_add(scale=(5e4, 0.5, 0.5))
    bpy.ops.object.transform_apply()
    body = bpy.context.object
    assert make(shape=shape) == {"FINISHED"}
    assert body[COLLIDERS]["volume_ratio"] == pytest.approx(1.0, rel=1e-4)


def test_tolerance_that_is_not_kept_is_a_warning(capfd):
    bpy.ops.mesh.primitive_uv_sphere_add()
    make(shape="HULL", vertices=8, inward=0.001, outward=0.5)
    told = capfd.readouterr().out
    assert "the tolerance is not kept" in told and "Allow more vertices" in told
    make(shape="HULL", vertices=8, inward=0.9, outward=0.9)
    assert "tolerance" not in capfd.readouterr().out


@pytest.mark.parametrize(
    "shape, count, outward, remedy",
    [
        ("hull", 1, 2.0, "Convex Pieces"),
        ("hull", 1, 0.5, "vertices"),
        ("pieces", 16, 2.0, "more pieces"),
        ("pieces", 3, 2.0, "vertices"),  # more pieces were allowed already
    ],
)
def test_remedy_of_tolerance_names_what_helps(shape, count, outward, remedy):
    record = {"shape": shape, "count": count, "outward": outward, "inward": 2.0}
    record |= {"tolerance": (1.0, 1.0), "limits": (16, 64)}
    told = tolerance_remedy(record)
    assert remedy in told and ("pieces" in told) == (remedy == "more pieces")


def test_record_of_turned_body_keeps_its_colliders():
    body = add(mesh_body(), "Body")
    make(shape="HULL")
    body.rotation_euler = (1.0, 2.0, 3.0)
    bpy.context.view_layer.update()

    def reason():
        depsgraph = bpy.context.evaluated_depsgraph_get()
        found = collider_record(body, measure_object(body, depsgraph), bpy.context)
        return found["out_of_date"]

    assert reason() is None and "body" not in body
    body[COLLIDERS]["body"] = [*body[COLLIDERS]["body"][:-1], 9.0]
    assert reason() == Stale.GEOMETRY


def test_turning_a_sheared_body_keeps_its_colliders_valid():
    parent = add(None, "Parent", scale=(1, 2, 0.7))
    body = add(mesh_body(), "Body", rotation=(0.4, 0.6, 0.8))
    body.parent = parent
    only(body)
    make(shape="HULL")
    parent.rotation_euler = 1, 2, 3
    bpy.context.view_layer.update()
    assert stale_reason(body, bpy.context.scene, Kind.COLLIDERS) is None
    parent.scale = 1, 1, 1
    bpy.context.view_layer.update()
    assert stale_reason(body, bpy.context.scene, Kind.COLLIDERS) == Stale.TRANSFORM
