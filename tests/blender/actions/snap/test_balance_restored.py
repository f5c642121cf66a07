# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sculpt Balance where it does not come there after it has moved something, what it says of moves, and how little it
moves."""

from dataclasses import replace
from itertools import pairwise

import bpy
import numpy as np
import pytest
from body_moments.core.statics.balance import balance as least_moves
from body_moments.operators.actions.snap import sculpt_balance
from body_moments.operators.read import read_object
from body_moments.operators.session import staleness

from tests.blender.actions.snap.test_balance import balance, center, edit, figure, group, points, told_of, world
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture(autouse=True)
def object_mode():
    yield
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("way", ["edited", "grouped"])
def test_where_no_attempt_comes_there_all_is_put_back(way, monkeypatch, reported):
    obj = figure()
    bpy.ops.object.body_moments_measure()
    (edit if way == "edited" else group)(obj)
    before, was, attempts = points(obj), center(obj), []
    reason = staleness.stale_reason(obj, bpy.context.scene)
    assert way == "edited" or reason is None

    def missing(*words, **more):
        attempts.append(more["limit"])
        found = least_moves(*words, **more)
        return replace(found, points=found.points + np.array([0.1, 0.0, 0.0]))

    monkeypatch.setattr(sculpt_balance, "balance", missing)
    with told_of(obj.data) as changes:
        assert balance() == {"CANCELLED"}
    assert len(changes) == 7  # of each attempt, and that all is as before
    assert staleness.stale_reason(obj, bpy.context.scene) == reason
    assert "balance_triangulation_varies" in reported.codes and len(attempts) == sculpt_balance.MAX_ATTEMPTS == 6
    assert np.array_equal(points(obj), before) and np.array_equal(center(obj), was)
    assert np.array_equal(points(obj), before)


@pytest.mark.parametrize("misses", [1, 5])
def test_after_a_miss_it_is_found_again_from_where_it_was(misses, monkeypatch):
    placed = {"location": (1, 2, 3), "rotation": (0.1, 0.2, 0.3), "scale": (-1.0, 2.0, 1.5)}
    found = []
    for number in (0, misses):
        bpy.context.scene.unit_settings.scale_length = 0.5
        obj, attempts = figure(**placed), []
        group(obj)

        def missing(*words, kept=attempts, first=number, **more):
            kept.append(least_moves(*words, **more))
            away = np.array([0.1, 0.0, 0.0]) * (len(kept) <= first)
            return replace(kept[-1], points=kept[-1].points + away)

        monkeypatch.setattr(sculpt_balance, "balance", missing)
        assert balance(target="POINT", point=center(obj) / 0.5 + [0.05, 0.02, 0.0]) == {"FINISHED"}
        assert len(attempts) == number + 1
        found.append(points(obj))
    assert np.abs(found[1] - found[0]).max() < 1e-6


@pytest.mark.parametrize("way", ["edited", "grouped"])
def test_the_moves_that_are_reported_are_those_in_the_world(way, reported):
    bpy.context.scene.unit_settings.scale_length = 0.5
    obj = figure(location=(1, 2, 3), rotation=(0.1, 0.2, 0.3), scale=(1.0, 2.0, 1.5))
    count = int(np.count_nonzero(edit(obj) if way == "edited" else [group(obj), points(obj)][1][:, 2] > 0.1))
    before, was = world(obj, points(obj)), center(obj)
    bpy.context.scene.cursor.location = was / 0.5 + [0.1, 0.05, 0.0]
    assert balance() == {"FINISHED"}
    moves = np.linalg.norm(world(obj, points(obj)) - before, axis=1) * 0.5
    said = reported.values("balanced")
    assert said["count"] == np.count_nonzero(moves) == count
    assert said["distance"] == pytest.approx(moves.max(), rel=1e-5)
    assert said["start"] == pytest.approx(was) and said["end"] == pytest.approx(center(obj))
    assert said["end"][:2] == pytest.approx(was[:2] + [0.05, 0.025], rel=1e-5)


@pytest.mark.parametrize("scale", [0.01, 100.0])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_it_is_there_within_a_millionth_of_the_size_and_four_roundings_of_the_farthest_coordinate(
    scale, share, monkeypatch
):
    obj = figure(location=(0.0, 15.0 * scale, 0.0), scale=(scale,) * 3)
    edit(obj)
    found = world(obj, points(obj))
    tolerance = 1e-6 * np.linalg.norm(np.ptp(found, axis=0)) + 4.0 * 2.0**-23 * np.abs(found).max()

    def beside(surface, movable, target, **more):
        return least_moves(surface, movable, target + np.array([share * tolerance, 0.0, 0.0]), **more)

    monkeypatch.setattr(sculpt_balance, "balance", beside)
    target = center(obj) + np.array([0.05, 0.02, 1e5]) * scale  # how high it is does not matter
    assert balance(target="POINT", point=target) == ({"FINISHED"} if share < 1.0 else {"CANCELLED"})


def test_a_coordinate_of_a_small_body_is_reported_as_it_is(reported):
    obj = add(box_mesh(0.02, 0.02, 0.02), "Box")
    edit(obj, lambda co: co.z > 0.0)
    assert balance(target="POINT", point=(0.002, 1e-6, 0.0)) == {"FINISHED"}
    assert reported.values("balanced")["end"][:2] == pytest.approx([0.002, 1e-6], rel=0.05)


def test_a_coordinate_below_rounding_is_reported_as_none(reported):
    obj = add(box_mesh(2, 2, 2), "Box")
    edit(obj, lambda co: co.z > 0.0)
    bpy.context.scene.cursor.location = (0.25, 0.0, 0.0)
    assert balance() == {"FINISHED"}
    said = reported.values("balanced")
    assert said["start"] == [0.0, 0.0, 0.0] and said["end"][1] == 0.0
    assert said["end"][0] == pytest.approx(0.25, rel=1e-5)


@pytest.mark.parametrize("weights", [(1.0, 1.0, 1.0, 1.0), (1.0, 0.5, 0.25, 0.75)])
def test_a_face_that_bends_is_moved_the_least_for_the_cut_that_it_gets(weights):
    """Held against the least moves from where it was, of the triangles that it has in the end."""
    mesh = bpy.data.meshes.new("Crate")
    corners = [(x, y, z) for z in (0, 1, 2) for y in (0, 1) for x in (0, 1)]
    ring = [*pairwise((0, 1, 3, 2, 0))]
    sides = [(a + k, b + k, b + k + 4, a + k + 4) for k in (0, 4) for a, b in ring]
    mesh.from_pydata(corners, [], [(0, 2, 3, 1), (8, 9, 11, 10), *sides])
    obj = add(mesh)
    start = points(obj)
    top = obj.vertex_groups.new(name="Top")
    for vertex, weight in zip(range(8, 12), weights, strict=True):
        top.add([vertex], weight, "REPLACE")
    bpy.context.scene.cursor.location = target = (0.62, 0.41, 0.0)
    assert balance() == {"FINISHED"}
    cut = read_object(obj, bpy.context.evaluated_depsgraph_get(), edges=False).parts[0].surface
    least = least_moves(
        replace(cut, points=start),
        np.arange(8, 12),
        np.array(target),
        across=np.eye(3)[:2],
        weights=np.array(weights),
        limit=10.0,
        shell=False,
    )
    assert np.abs(points(obj) - least.points).max() < 1e-6


def test_an_object_that_shows_others_at_its_vertices_is_refused_for_that(reported):
    obj = figure()
    group(obj)
    add(box_mesh(0.1, 0.1, 0.1), "Small", select=False).parent = obj
    obj.instance_type = "VERTS"
    bpy.context.view_layer.update()
    before = points(obj)
    bpy.context.scene.cursor.location = (0.05, 0.0, 0.0)
    assert balance() == {"CANCELLED"} and "balance_instances" in reported.codes
    assert np.array_equal(points(obj), before)


def test_faces_look_where_they_look_after_the_move():
    """Blender keeps normals and boxes until it is told that a mesh has changed."""
    obj = figure()
    group(obj)
    kept = [tuple(polygon.normal) for polygon in obj.data.polygons], [tuple(corner) for corner in obj.bound_box]
    bpy.context.scene.cursor.location = (0.05, 0.0, 0.0)
    assert balance() == {"FINISHED"}
    bpy.context.view_layer.update()
    now = points(obj)
    for polygon in obj.data.polygons:
        own = now[[*polygon.vertices]]
        normal = np.cross(own, np.roll(own, -1, axis=0)).sum(axis=0)
        assert np.allclose(polygon.normal, normal / np.linalg.norm(normal), 1e-5, 1e-5)
    box = np.array([tuple(corner) for corner in obj.bound_box])
    assert np.allclose([box.min(axis=0), box.max(axis=0)], [now.min(axis=0), now.max(axis=0)], 1e-6, 1e-6)
    assert kept[0] != [tuple(polygon.normal) for polygon in obj.data.polygons]
