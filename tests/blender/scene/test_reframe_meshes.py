# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many meshes that get other frames at once, and nothing visible moves."""

import bpy
import numpy as np
import pytest

from tests.blender.objects import place
from tests.corpus import shapes as s

pytestmark = pytest.mark.usefixtures("scene")
OPERATORS = "body_moments_origin_to_center", "body_moments_axes_to_principal"


def parts(count=6):
    """Objects of all kinds that may be reframed together, and some that may not."""
    rng, made = np.random.default_rng(5), []
    for i in range(count):
        points, faces = (
            s.box(-rng.uniform(0.5, 2, 3), rng.uniform(0.5, 2, 3)) if i % 2 else s.random_hull(i)
        )
        mesh = bpy.data.meshes.new("Part")
        mesh.from_pydata(
            (np.asarray(points) + rng.normal(size=3)).tolist(),
            [],
            [list(map(int, face)) for face in faces],
        )
        for twin in range(3):
            obj = bpy.data.objects.new("Part {} {}".format(i, twin), mesh)
            bpy.context.scene.collection.objects.link(obj)
            obj.rotation_mode = ("XYZ", "ZYX", "QUATERNION", "YZX", "XZY", "XYZ")[i]
            obj.rotation_euler, obj.location = (
                rng.uniform(-3, 3, 3),
                rng.normal(size=3) * 10.0 ** rng.uniform(-1, 3),
            )
            obj.scale = (
                (1.0, 1.0, 1.0)
                if twin
                else np.full(3, rng.uniform(0.5, 2.0)) * (1, 1, -1 if i % 2 else 1)
            )
            made.append(obj)
    if count > 1:
        made[1].delta_location.x, made[4].lock_location[1] = 0.5, True
        made[7].modifiers.new("Mirror", "MIRROR")
        follower = bpy.data.objects.new("Follower", None)
        bpy.context.scene.collection.objects.link(follower)
        follower.parent = made[2]
        other = bpy.data.objects.new("Not selected", made[9].data)
        bpy.context.scene.collection.objects.link(other)
    for obj in made:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = made[0]
    bpy.context.view_layer.update()
    return made


def seen(objects):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = {}
    for obj in objects:
        evaluated = obj.evaluated_get(depsgraph)
        matrix = np.array(evaluated.matrix_world)
        points = np.array([vertex.co[:] for vertex in evaluated.data.vertices])
        normals = np.array([face.normal[:] for face in evaluated.data.polygons])
        normals = normals @ np.linalg.inv(matrix[:3, :3])  # outward stays outward
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        found[obj.name] = (points @ matrix[:3, :3].T + matrix[:3, 3], normals)
    return found


@pytest.mark.parametrize("operator", OPERATORS)
def test_reframed_meshes_keep_visible_points_and_normals(operator):
    objects = parts()
    before, places = seen(objects), [place(obj) for obj in objects]
    assert getattr(bpy.ops.object, operator)() == {"FINISHED"}
    after = seen(objects)
    moved = [
        np.abs(place(obj) - was).max() > 1e-3 for obj, was in zip(objects, places, strict=True)
    ]
    assert sum(moved) > len(objects) / 2
    for name in before:
        size = np.ptp(before[name][0], axis=0).max() + 1e-3 * np.abs(before[name][0]).max()
        assert np.abs(before[name][0] - after[name][0]).max() < 1e-5 * size, name
        assert np.abs(before[name][1] - after[name][1]).max() < 1e-3, name
