# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said and stored of symmetries, poses and libraries: each word, and each side of each limit."""

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.shape.symmetry import Symmetry
from body_moments.operators.actions.shape import find_similar, find_symmetry, match_pose
from body_moments.operators.bodies.shape import surface_shape_of

from tests.blender.actions.shape.test_shape import prism
from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")
X, Y, Z = np.eye(3)
NOTHING = np.empty((0, 3))
HALF_TURN = np.diag([-1.0, -1.0, 1.0])


def symmetry(*operations, axes=NOTHING):
    return Symmetry(np.array([np.eye(3), *operations]), np.array(axes).reshape(-1, 3), 4)


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (symmetry(axes=np.eye(3)), ["symmetry_sphere"]),
        (symmetry(axes=[Z]), ["symmetry_revolution"]),
        (symmetry(np.diag([1.0, 1.0, -1.0]), np.diag([1.0, -1.0, -1.0]), axes=[Z]), ["symmetry_revolution_reversible"]),
        (symmetry(HALF_TURN), ["symmetry_axes"]),
        (symmetry(np.diag([1.0, 1.0, -1.0])), ["symmetry_planes"]),
        (symmetry(-np.eye(3)), ["symmetry_inversion"]),
        (symmetry(HALF_TURN, -np.eye(3), np.diag([1.0, 1.0, -1.0])), ["symmetry_axes", "symmetry_planes"]),
        (symmetry(), ["symmetry_none"]),
    ],
)
def test_each_kind_of_symmetry_is_called_what_it_is(found, said):
    assert [clause.code for clause in find_symmetry.describe(found)] == said


def test_axes_and_planes_are_counted_and_the_highest_order_is_named():
    turns = [np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) for c, s in ((0, 1), (-1, 0), (0, -1))]
    flips = [np.diag([1.0, -1.0, -1.0]) @ turn for turn in (np.eye(3), *turns)]
    mirrors = [np.diag([1.0, 1.0, -1.0]) @ turn for turn in (np.eye(3), *turns, *flips)]
    axes, planes = find_symmetry.describe(symmetry(*turns, *flips, *mirrors))
    assert axes.values == {"count": 5, "order": 4} and planes.values == {"count": 5}


def test_a_round_body_has_one_axis_and_its_planes_and_others_have_all_their_axes():
    mirror = np.diag([1.0, 1.0, -1.0])
    kinds = [(kind, order) for kind, order, _ in find_symmetry._elements(symmetry(mirror, axes=[Z]))]
    assert kinds == [("ROUND", 0), ("PLANE", 0)]
    elements = find_symmetry._elements(symmetry(HALF_TURN, mirror, -np.eye(3)))
    assert [(kind, order) for kind, order, _ in elements] == [("AXIS", 2), ("PLANE", 0)]
    assert all(np.allclose(np.abs(direction), Z) for _, _, direction in elements)


@pytest.mark.parametrize("direction", [(0.6, -0.8, 0.0), (-0.6, 0.8, 0.0), (0.0, 0.6, 0.8), (-0.8, 0.0, 0.6)])
def test_of_the_two_directions_of_a_line_that_is_taken_whose_largest_part_is_positive(direction):
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    found = turn @ find_symmetry._canonical_direction(turn, np.array(direction))
    assert found[np.argmax(np.abs(found))] == 0.8 and np.allclose(np.abs(found), np.abs(turn @ direction))


@pytest.mark.parametrize(
    ("distance", "mirrored", "said"), [(0.9, True, False), (1.1, True, True), (0.9, False, False), (1.1, False, None)]
)
def test_a_surface_says_whether_something_is_a_mirror_image_where_it_fits_or_its_image_does(distance, mirrored, said):
    match = SimpleNamespace(max_distance=distance * find_similar.MAX_FIT_RTOL * 5.0, is_mirror_image=mirrored)
    assert find_similar._is_mirror_image(match, 5.0) is said


@pytest.mark.parametrize("distance", [0.9, 1.1])
def test_a_pose_is_one_of_a_copy_within_the_tolerance_of_fits(distance):
    size = 5.0
    match = SimpleNamespace(max_distance=distance * match_pose.MAX_FIT_RTOL * size, mean_distance=0.25)
    found = match_pose._distance("Body", match, size)
    assert found.code == ("pose_distance" if distance < 1.0 else "pose_not_a_copy")
    assert found.values == {"object": "Body", "maximum": match.max_distance, "mean": 0.25}


@pytest.mark.parametrize(
    ("turned", "moved", "is_there"), [(0.9e-7, 0.9, True), (1.1e-7, 0.0, False), (0.0, 1.1, False), (-1e-6, -9, False)]
)
def test_what_lies_there_within_float32_is_there(turned, moved, is_there, monkeypatch):
    tolerance = 3e-5
    monkeypatch.setattr(match_pose.reframe, "location_tolerance", lambda obj, size: tolerance)
    matrix = np.eye(4)
    matrix[1, 2] += turned
    matrix[2, 3] += moved * tolerance
    plan = SimpleNamespace(obj=SimpleNamespace(matrix_world=matrix.tolist()), target=np.eye(4), size=1.0)
    assert match_pose._is_there(plan) == is_there


def test_what_lies_on_the_active_object_already_is_not_moved_again_and_counts(reported, monkeypatch):
    first = add(mesh_body(), "First")
    other, there = (add(mesh_body(), name, place) for name, place in (("Other", (5, 1, 2)), ("There", (0, 0, 0))))
    only(first, other, there)
    bpy.ops.object.body_moments_measure()
    moved, move = [], match_pose.reframe.move
    monkeypatch.setattr(match_pose.reframe, "move", lambda context, plan: moved.append(plan.obj) or move(context, plan))
    assert bpy.ops.object.body_moments_match_pose() == {"FINISHED"}
    assert moved == [other] and reported.values("poses_matched") == {"count": 2, "object": "First"}
    assert np.allclose(other["body_center_of_mass"], first["body_center_of_mass"], 1e-5)
    assert np.allclose(other["body_inertia"], first["body_inertia"], 1e-5, 1e-5 * max(first["body_inertia"]))


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("share", [0.5, 2.0])
def test_how_near_a_pose_has_to_be_goes_by_the_size_in_the_scene_s_unit(unit, share):
    bpy.context.scene.unit_settings.scale_length = unit
    first, other = add(mesh_body(), "First"), add(mesh_body(), "Other")
    size = surface_shape_of(first, bpy.context.evaluated_depsgraph_get()).size / unit
    only(first, other)
    other.location.x = away = share * 4e-7 * size
    assert bpy.ops.object.body_moments_match_pose() == {"FINISHED"}
    assert (other.location.x == np.float32(away)) == (share < 1.0)


def library(path, *records):
    text = json.dumps({"file": "parts.blend", "objects": [*records]}, default=list)
    path.write_text(text, encoding="utf-8")
    return str(path)


def record_of(obj, name):
    signature = surface_shape_of(obj, bpy.context.evaluated_depsgraph_get()).signature(find_similar.DESCRIPTOR_ORDER)
    return {"name": name, "signature": signature.as_record()}


def test_bodies_of_a_library_that_have_no_signature_are_named_and_others_compared(tmp_path, reported):
    from body_moments.operators.session import outcome

    obj = add(mesh_body())
    record = record_of(obj, "Copy")
    path = library(tmp_path / "all.jsonl", record)
    assert bpy.ops.object.body_moments_find_in_library(filepath=path) == {"FINISHED"}
    assert reported.codes == ["shapes_compared", "shape_counts", "shapes_copy", "nearest_shape"]
    assert reported.values("shapes_compared") == {"count": 1} and outcome.last() is None
    (row,) = bpy.context.scene.body_moments_search.found
    assert (row.name, row.file, row.verdict) == ("Copy", "parts.blend", "copy")
    assert row.distance < 1e-4 and abs(row.scale - 1.0) < 1e-6
    reported.clear()
    path = library(tmp_path / "some.jsonl", record, {"name": "Plain"}, {"name": "Line", "signature": None})
    assert bpy.ops.object.body_moments_find_in_library(filepath=path) == {"FINISHED"}
    assert reported.codes[:4] == ["shapes_compared", "shape_counts", "shapes_copy", "nearest_shape"]
    causes = [cause["code"] for cause in reported.values("records_left_out")["causes"]]
    assert sorted(causes) == ["record_without_shape", "record_without_signature"]
    reported.clear()
    path = library(tmp_path / "none.jsonl", {"name": "Plain"})
    assert bpy.ops.object.body_moments_find_in_library(filepath=path) == {"FINISHED"}
    assert reported.codes[:2] == ["shapes_compared", "none_similar"] and "nearest_shape" not in reported.codes
    assert not len(bpy.context.scene.body_moments_search.found)


def test_of_many_elements_of_a_symmetry_the_first_are_stored():
    bpy.ops.mesh.primitive_cylinder_add(vertices=20)
    assert bpy.ops.object.body_moments_find_symmetry() == {"FINISHED"}
    stored = bpy.context.object.body_moments_symmetry
    assert stored.group == "D20h" and len(stored.elements) == find_symmetry.MAX_STORED_ELEMENTS == 32
    assert [one.order for one in stored.elements[:2]] == [20, 2]


def test_of_many_shapes_the_nearest_are_listed(monkeypatch):
    obj = add(mesh_body())
    signature = surface_shape_of(obj, bpy.context.evaluated_depsgraph_get()).signature(find_similar.DESCRIPTOR_ORDER)
    likeness = find_similar.similarity(signature, signature)
    ranked = [(find_similar.Entry(str(number), "", signature), likeness) for number in range(25)]
    search = SimpleNamespace(scaled=False, mirrored=False)
    find_similar._SearchMixin.store_results(search, bpy.context, ranked, "parts.jsonl")
    found = bpy.context.scene.body_moments_search
    assert [row.name for row in found.found] == [str(number) for number in range(find_similar.MAX_LISTED_BODIES)]
    assert len(found.found) == 20 and (found.wanted, found.looked_at) == (obj.name, "parts.jsonl")


@pytest.mark.parametrize(("factor", "verdict"), [(1.0, "copy"), (3.0, "scaled_copy")])
def test_the_surface_of_a_copy_of_another_size_decides_about_its_hand_as_well(factor, verdict):
    wanted = prism("Wanted", [(0, 0), (3, 0), (1, 1)])
    prism("Other", [(0, 0), (3, 0), (1, 1)], location=(30, 0, 0)).scale = (factor,) * 3
    bpy.context.view_layer.update()
    only(wanted)
    assert bpy.ops.object.body_moments_find_similar() == {"FINISHED"}
    (row,) = bpy.context.scene.body_moments_search.found
    assert (row.name, row.verdict) == ("Other", verdict) and row.scale == pytest.approx(factor)
