# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sculpt Balance moves bent faces the least, and keeps the side that faces look to."""

from dataclasses import replace
from itertools import pairwise

import bpy
import numpy as np
import pytest
from body_moments.blender.read.objects import read_object
from body_moments.core.statics.balancing import balance as least_moves

from tests.blender.objects import add
from tests.operators.snap.test_balance import balance, figure, group, points

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture(autouse=True)
def object_mode():
    yield
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


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
