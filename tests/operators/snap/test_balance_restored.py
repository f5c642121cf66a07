# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance moves bent faces the least, and keeps the side that faces look to."""

from dataclasses import replace
from itertools import pairwise

import bpy
import numpy as np
import pytest
from body_moments.blender.read.objects import read_object
from body_moments.core.statics.balancing import balance as least_moves

from tests.blender.objects import add, mesh_of
from tests.operators.balancing import balance, points

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture(autouse=True)
def object_mode():
    yield
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("weights", [(1.0, 1.0, 1.0, 1.0), (1.0, 0.5, 0.25, 0.75)])
def test_bending_face_moves_least_for_its_final_cut(weights):
    """Held against the least moves from where it was, of the triangles that it has in the end."""
    corners = [(x, y, z) for z in (0, 1, 2) for y in (0, 1) for x in (0, 1)]
    ring = [*pairwise((0, 1, 3, 2, 0))]
    sides = [(a + k, b + k, b + k + 4, a + k + 4) for k in (0, 4) for a, b in ring]
    obj = add(mesh_of(corners, [(0, 2, 3, 1), (8, 9, 11, 10), *sides], "Crate"))
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
