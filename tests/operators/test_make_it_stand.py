# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make It Stand: the least infill of a print over its base; what is reachable; one undo step."""

import bpy
import numpy as np
import pytest
from body_moments.core.statics import infill_range, largest_margin

from tests.blender import objects
from tests.close import close

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def test_infill_range_is_where_edges_allow_it():
    empty, growth = np.array([1.0, 3.0, 1.0]), np.array([4.0, 2.0, 4.0])
    low, high = infill_range(SQUARE, empty, growth, 0.0)
    # (3 + 2 f) / (1 + 4 f) = 2
    assert close(low, 1.0 / 6.0, 1e-14) and high == 1.0
    low, high = infill_range(SQUARE, empty, growth, 0.5)
    assert close(low, 1.5 / 4.0, 1e-14)
    assert infill_range(SQUARE, empty, growth, 1.5) is None
    margin, infill = largest_margin(SQUARE, empty, growth)
    assert close(margin, 1.0, 1e-9) and close(infill, 1.0, 1e-9)


def leaning(scene):
    """Return a hook: a block with a thin plate that hangs far over at the top, in mm."""
    scene.unit_settings.scale_length = 1e-3
    outline = [(0, 0), (10, 0), (10, 26), (34, 26), (34, 28), (0, 28)]
    points = [(x, y, z) for y in (0, 20) for x, z in outline]
    count = len(outline)
    sides = [(i, (i + 1) % count, count + (i + 1) % count, count + i) for i in range(count)]
    mesh = bpy.data.meshes.new("Hook")
    ends = [tuple(reversed(range(count))), tuple(range(count, 2 * count))]
    mesh.from_pydata(points, [], [tuple(reversed(side)) for side in sides + ends])
    mesh.validate()
    obj = objects.add(mesh)
    settings = obj.body_moments
    settings.kind, settings.density, settings.print_infill = "PRINTED", 1240.0, 5.0
    return obj


def margin_of(obj):
    from body_moments.blender.session.stored import stability

    bpy.context.view_layer.update()
    return stability.support(obj).margin


def test_least_infill_gives_the_margin(scene):
    obj = leaning(scene)
    bpy.ops.object.body_moments_stability()
    wanted = 0.2
    assert margin_of(obj) < wanted
    assert bpy.ops.object.body_moments_make_it_stand(margin=wanted) == {"FINISHED"}
    settings = obj.body_moments
    assert settings.print_walls == 2 and settings.print_infill > 5.0
    assert margin_of(obj) >= wanted - 1e-6
    settings.print_infill -= 1.01
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_stability()
    assert margin_of(obj) < wanted


def test_unreachable_margin_is_stated_and_changes_nothing(scene):
    obj = leaning(scene)
    with pytest.raises(RuntimeError, match="the largest margin is"):
        bpy.ops.object.body_moments_make_it_stand(margin=20.0)
    assert obj.body_moments.print_infill == 5.0 and obj.body_moments.print_walls == 2


def test_center_comes_to_plumb_line_of_cursor(scene):
    obj = leaning(scene)
    bpy.ops.object.body_moments_measure()
    obj.body_moments.print_infill = 60.0
    bpy.ops.object.body_moments_measure()
    center = np.array(obj["body_center_of_mass"]) * 1e3
    scene.cursor.location = (center[0], center[1], 100.0)
    obj.body_moments.print_infill = 5.0
    options = {"target": "CURSOR", "margin": 0.01}
    assert bpy.ops.object.body_moments_make_it_stand(**options) == {"FINISHED"}
    found = np.array(obj["body_center_of_mass"]) * 1e3
    assert np.hypot(*(found - center)[:2]) < 0.0101
    assert 50.0 < obj.body_moments.print_infill <= 60.0
