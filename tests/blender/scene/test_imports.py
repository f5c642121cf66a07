# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface objects that are made of patches: points, weights, flags, and by how much float32 moves
them.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import imports
from body_moments.core.cad.surfaces import SurfaceBody
from body_moments.core.numerics import clamped_space
from body_moments.core.nurbs import Patch

pytestmark = pytest.mark.usefixtures("scene")
SHAPES = (4, 4), (2, 3), (4, 3), (4, 4), (3, 2)  # orders along v and u


def patches(offset=0.0, size=1.0, rational=True):
    rng, made = np.random.default_rng(1), []
    for number, shape in enumerate(SHAPES):
        points = offset + size * rng.uniform(-1.0, 1.0, (*shape, 3))
        weights = rng.uniform(0.2, 3.0, shape) if rational and number % 2 else None
        made.append(Patch(tuple(map(clamped_space, shape)), points, weights))
    return made


def stored(spline):
    """(count_v, count_u, 4) of what Blender has."""
    row = np.empty(4 * len(spline.points), np.float32)
    spline.points.foreach_get("co", row)
    return row.astype(float).reshape(spline.point_count_v, spline.point_count_u, 4)


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("offset", [0.0, 3.0, 1e4, 1e9])
@pytest.mark.parametrize("factor", [1.0, 0.001])
def test_splines_are_the_patches(offset, factor, rational):
    kept = [set(collection) for collection in (bpy.data.scenes, bpy.data.objects, bpy.data.curves)]
    given = patches(offset, rational=rational)
    obj, moved = imports.surface_object("Hull", given, factor)
    now = [set(collection) for collection in (bpy.data.scenes, bpy.data.objects, bpy.data.curves)]
    assert [len(new - old) for new, old in zip(now, kept)] == [0, 1, 1] and obj.users == 0
    assert obj.name == obj.data.name == "Hull" and obj.data.dimensions == "3D"
    origin = np.array(obj.location)
    every = factor * np.concatenate([patch.points.reshape(-1, 3) for patch in given])
    size = np.ptp(every, axis=0).max()
    is_far = offset > 16.0 * 2.0
    middle = (every.min(axis=0) + every.max(axis=0)) / 2.0
    assert np.array_equal(origin, middle.astype(np.float32) if is_far else np.zeros(3))
    found, grid = 0.0, np.linspace(0.0, 1.0, 9)
    for spline, patch in zip(obj.data.splines, given, strict=True):
        own = stored(spline)
        assert np.array_equal(own[..., :3], (factor * patch.points - origin).astype(np.float32))
        weights = (
            np.ones(patch.points.shape[:2])
            if patch.weights is None
            else patch.weights / patch.weights.max()
        )
        assert np.array_equal(own[..., 3], weights.astype(np.float32))
        assert (spline.order_v, spline.order_u) == patch.points.shape[:2]
        assert spline.use_smooth == (max(patch.points.shape[:2]) > 2)
        assert (
            spline.use_bezier_u
            and spline.use_bezier_v
            and spline.use_endpoint_u
            and spline.use_endpoint_v
        )
        assert not spline.use_cyclic_u and not spline.use_cyclic_v
        again = Patch(patch.spaces, own[..., :3] + origin, own[..., 3])
        off = again.evaluate_grid(grid, grid) - factor * patch.evaluate_grid(grid, grid)
        found = max(found, np.linalg.norm(off, axis=2).max())
    assert found <= moved * size * (1.0 + 1e-6) + 1e-15 * offset * factor
    assert moved * size <= 30.0 * found


def test_imported_bodies_are_linked_and_scene_is_unchanged():
    bpy.ops.mesh.primitive_cube_add()
    cube, before = bpy.context.object, bpy.context.scene
    into = bpy.data.collections.new("Into")
    bodies = [SurfaceBody("First", tuple(patches()[:2])), SurfaceBody("Second", tuple(patches()))]
    made = imports.import_bodies(bodies, into, 0.5)
    assert (
        [obj.name for obj, _ in made] == [obj.name for obj in into.objects] == ["First", "Second"]
    )
    assert [len(obj.data.splines) for obj, _ in made] == [2, len(SHAPES)]
    assert np.array_equal(
        stored(made[0][0].data.splines[0])[..., :3], (0.5 * patches()[0].points).astype(np.float32)
    )
    assert bpy.context.scene == before and bpy.context.object == cube and cube.select_get()
