# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects through the frames of an animation: which are sampled by their shape keys, and which are
measured.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.live import motion
from body_moments.core.statics.mixes import sample_count

from tests.blender.objects import add, measured, mesh_body, mesh_of

pytestmark = pytest.mark.usefixtures("scene")


def keyed(mesh=None):
    """A prism over a quad whose base turns concave, so that it is cut otherwise, from a third of
    the second key on.
    """
    mesh = mesh or mesh_body(points=[(0, 0, 0), (4, 0, 0), (4, 1, 0), (0, 4, 0)])
    obj = add(mesh, location=(3, -1, 2), rotation=(0.3, 0.2, 1.0), scale=(1.0, 2.0, 0.5))
    for number, name in enumerate(("Basis", "First", "Second")):
        key = obj.shape_key_add(name=name)
        key.data[number].co.x -= 1.5 * number
        key.value = 0.25 * number
    bpy.context.view_layer.update()
    return obj


def found(followed, obj):
    bpy.context.view_layer.update()
    return followed.mass_and_center(obj, bpy.context.evaluated_depsgraph_get())


@pytest.mark.parametrize("frames", [sample_count(2) - 1, sample_count(2)])
@pytest.mark.parametrize("given", [False, True])
def test_sampled_shape_keys_equal_measured_results(frames, given):
    obj = keyed()
    bpy.context.scene.unit_settings.scale_length = 0.1
    if given:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 7.5
    keys = obj.data.shape_keys.key_blocks
    keys["Second"].relative_key = keys["First"]
    followed = motion.Motion(frames)
    for value in (0.0, 0.25, 0.5, 1.0, 0.3):
        obj.data.shape_keys.key_blocks["Second"].value = value
        mass, center = found(followed, obj)
        truth = measured(obj).mass_properties
        assert mass == pytest.approx(truth.mass, rel=1e-6)
        assert center == pytest.approx(np.array(truth.center) / np.float32(0.1), rel=1e-6)


def test_a_polygon_that_blender_cuts_otherwise_is_measured():
    angles = np.arange(5) * 2.0 * np.pi / 5.0
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate([np.insert(ring, 2, height, axis=1) for height in (0.0, 1.0)])
    sides = [(i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i) for i in range(5)]
    obj = keyed(mesh_of(points, [(4, 3, 2, 1, 0), (5, 6, 7, 8, 9), *sides], "Prism"))
    obj.data.shape_keys.key_blocks["Second"].data[5].co = (-0.9, 0.0, 1.5)
    followed = motion.Motion(sample_count(2))
    for value in (0.0, 1.0, 0.5):
        obj.data.shape_keys.key_blocks["Second"].value = value
        assert found(followed, obj)[0] == pytest.approx(
            measured(obj).mass_properties.mass, rel=1e-6
        )
