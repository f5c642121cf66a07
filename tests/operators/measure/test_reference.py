# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about any reference of the scene: shown, stored, copied, and moments about it."""

import bmesh
import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import moments as moments_table
from body_moments.blender.session.stored import reference
from body_moments.blender.session.stored.reference import ReferenceChoice
from body_moments.blender.session.tracking.staleness import stale_reason
from body_moments.core.inertia.plain_body import tensor_rows
from body_moments.core.verdict import Finding
from mathutils import Euler

from tests.blender.boxes import box, boxes_inertia, collection
from tests.blender.objects import add, measure, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("registered", "scene")
SIZE, AT, DENSITY = (1, 2, 4), (8, -4, 2), 1000


def measured_box():
    obj = box(bpy.context.scene.collection, SIZE, AT, DENSITY)
    measure(obj)
    return obj


def about(point):
    mass, center, tensor = boxes_inertia([(DENSITY, SIZE, AT)])
    arm = center - point
    return tensor + mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


def choose(kind, **settings):
    chosen = bpy.context.scene.body_moments_reference
    chosen.about = kind
    for name, value in settings.items():
        setattr(chosen, name, value)


def shown(obj):
    return reference.referred(obj, bpy.context.scene)


def inertia(obj):
    return np.array(tensor_rows(shown(obj).inertia))


def test_each_reference_is_about_its_point_and_along_its_axes():
    obj = measured_box()
    choose("WORLD")
    assert np.abs(inertia(obj) - about((0, 0, 0))).max() <= 1e-14 * about((0, 0, 0)).max()
    choose("CENTER")
    assert np.abs(inertia(obj) - about(AT)).max() <= 1e-13 * about(AT).max()
    choose("ORIGIN")
    assert np.abs(inertia(obj) - about(AT)).max() <= 1e-13 * about(AT).max()
    cursor = bpy.context.scene.cursor
    choose("CURSOR")
    cursor.location = (1, 2, 3)
    assert np.abs(inertia(obj) - about((1, 2, 3))).max() <= 1e-14 * about((1, 2, 3)).max()
    cursor.rotation_euler = (0, 0, np.pi / 2)
    swapped = about((1, 2, 3))[[1, 0, 2]][:, [1, 0, 2]] * [[1, -1, 1], [-1, 1, -1], [1, -1, 1]]
    assert np.abs(inertia(obj) - swapped).max() <= 1e-6 * swapped.max()
    other = add(None, "Other", (5, 0, 0), (0.3, 0.2, 0.1), select=False)
    choose("OBJECT", object=other)
    turn = np.array(Euler((0.3, 0.2, 0.1)).to_matrix())
    truth = turn.T @ about((5, 0, 0)) @ turn
    assert np.abs(inertia(obj) - truth).max() <= 1e-6 * truth.max()
    other.location.x = 6.0
    bpy.context.view_layer.update()
    assert close(shown(obj).reference.origin[0], 6.0, 1e-14)  # it follows
    choose("AXIS", first=(0, 0, 1), second=(3, 4, 1))
    along = np.array([0.6, 0.8, 0.0])
    assert close(shown(obj).about_z, along @ about((0, 0, 1)) @ along, 1e-13)
    choose("AXIS", second=(0, 0, 1))
    assert isinstance(shown(obj), Finding) and shown(obj).code == "axis_points_coincide"
    choose("OBJECT", object=None)
    assert shown(obj).code == "reference_object_missing"


def test_references_follow_the_scene_unit():
    """Of lengths that are a fourth, inertia about what is as far away is 4^-5 of it."""
    obj = measured_box()
    other = add(None, "Other", (5, 1, -2), select=False)
    obj.data.vertices[0].co.x = -1.0
    bpy.context.scene.cursor.location = (1, 2, 3)

    def inertias():
        bpy.ops.object.body_moments_measure()
        for kind in ("WORLD", "CENTER", "ORIGIN", "CURSOR", "OBJECT"):
            choose(kind, object=other)
            yield inertia(obj)
        choose("AXIS", first=(0, 0, 1), second=(3, 4, 1))
        yield shown(obj).about_z

    large = list(inertias())
    bpy.context.scene.unit_settings.scale_length = 0.25
    for small, before in zip(inertias(), large, strict=True):
        assert np.abs(small - before / 4.0**5).max() <= 1e-13 * np.abs(before).max() / 4.0**5


def test_stored_reference_follows_next_measurement():
    obj = measured_box()
    choose("AXIS", first=(0, 0, 0), second=(0, 0, 2))
    assert bpy.ops.object.body_moments_store_reference() == {"FINISHED"}
    truth = about((0, 0, 0))
    assert close(obj["body_axis_inertia"], truth[2, 2], 1e-14)
    rotation = np.transpose(shown(obj).reference.axes)
    entries = (rotation.T @ truth @ rotation)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    assert (
        np.abs(np.array(obj["body_reference_inertia"].to_list()) - entries).max()
        <= 1e-14 * entries.max()
    )
    assert len(obj["body_reference_error_bound"]) == 4
    assert ReferenceChoice.parse(obj["body_reference"]).points == ((0, 0, 0), (0, 0, 2))
    choose("WORLD")
    obj.body_moments.density = 2.0 * DENSITY
    bpy.ops.object.body_moments_measure()
    assert close(obj["body_axis_inertia"], 2.0 * truth[2, 2], 1e-14)
    bpy.ops.object.body_moments_store_reference()
    assert (
        "body_axis_inertia" not in obj
        and ReferenceChoice.parse(obj["body_reference"]).about == "WORLD"
    )
    bpy.ops.object.body_moments_clear()
    assert "body_reference" not in obj


def test_an_assembly_is_referred_too():
    root = collection()
    member = box(root, SIZE, AT, DENSITY)
    layers = bpy.context.view_layer.layer_collection.children
    bpy.context.view_layer.active_layer_collection = layers[root.name]
    bpy.ops.object.body_moments_measure_assembly()
    choose("WORLD")
    assert np.abs(inertia(root) - about((0, 0, 0))).max() <= 1e-14 * about((0, 0, 0)).max()
    only(member)
    bpy.ops.object.body_moments_store_reference()
    assert "body_reference" in member and stale_reason(root, bpy.context.scene) is None


@pytest.mark.parametrize(
    ("active", "selected", "points"),
    [
        ("A", "AC", (3.0, 1.0)),
        ("C", "AC", (1.0, 3.0)),
        ("B", "AC", (1.0, 3.0)),
        ("A", "ABC", None),
        ("A", "", None),
    ],
)
def test_axis_runs_from_other_object_to_active(active, selected, points, reported):
    made = {
        name: box(bpy.context.scene.collection, (1, 1, 1), (ord(name) - 64, 2, 0), name=name)
        for name in "CBA"
    }
    only(made[active])
    for name, obj in made.items():
        obj.select_set(name in selected)
    if points is None:
        with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
            bpy.ops.object.body_moments_axis_from_selection()
        assert reported.texts[-1].startswith(str(len(selected)))
        return
    assert bpy.ops.object.body_moments_axis_from_selection() == {"FINISHED"}
    chosen = bpy.context.scene.body_moments_reference
    assert [tuple(point) for point in (chosen.first, chosen.second)] == [
        (place, 2.0, 0.0) for place in points
    ]


@pytest.mark.parametrize("by", ["order", "edge", "one of each"])
def test_axis_runs_through_vertices_in_selection_order(by):
    turned = {"rotation": (0, 0, np.pi / 2), "scale": (2, 3, 1)}
    objects = [
        box(bpy.context.scene.collection, (1, 1, 1), (x, 0, 0), name=f"{x}", **turned)
        for x in (5, 9)
    ]
    only(*objects)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    chosen = {"order": [(0, 7), (0, 2)], "edge": [(0, 7), (0, 2)], "one of each": [(0, 1), (1, 4)]}[
        by
    ]
    for number, index in chosen:
        mesh = bmesh.from_edit_mesh(objects[number].data)
        mesh.verts.ensure_lookup_table()
        mesh.verts[index].select_set(True)
        if by == "order":
            mesh.select_history.add(mesh.verts[index])
    if by == "edge":
        mesh.edges.ensure_lookup_table()
        mesh.select_history.add(mesh.edges[0])
        chosen = chosen[::-1]
    assert bpy.ops.object.body_moments_axis_from_selection() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    settings = bpy.context.scene.body_moments_reference
    for (number, index), point in zip(chosen, (settings.first, settings.second), strict=True):
        x, y, z = objects[number].data.vertices[index].co
        assert close(point, (objects[number].location.x - 3.0 * y, 2.0 * x, z), 1e-6)


def test_moments_of_any_order_are_about_the_reference():
    obj = measured_box()
    settings = bpy.context.scene.body_moments
    bpy.ops.object.body_moments_compute_moments()
    settings.moments_about = "REFERENCE"
    bpy.context.scene.cursor.location = (8, -4, 0)
    choose("CURSOR")
    degrees, missing = moments_table.current_numbers(obj, bpy.context.scene)
    assert missing is None
    exact = {label: float(value) for degree in degrees for label, _, value in degree.rows}
    assert close(exact["z"], 16.0, 1e-14) and close(exact["z²"], 8 * 16 / 3, 1e-14)
    bpy.context.scene.cursor.location.z = 2.0
    degrees, _ = moments_table.current_numbers(obj, bpy.context.scene)
    exact = {label: float(value) for degree in degrees for label, _, value in degree.rows}
    assert close(exact["z²"], 8 * 4 / 3, 1e-13)
