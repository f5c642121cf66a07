# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make It Stand: the least infill of a print over its base; what is reachable; one undo step."""

import re

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import stability
from body_moments.core.statics import infill_range, largest_margin
from mathutils import Matrix

from tests.blender import objects
from tests.blender.boxes import box_mesh
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
    ends = [tuple(reversed(range(count))), tuple(range(count, 2 * count))]
    mesh = objects.mesh_of(points, [tuple(reversed(side)) for side in sides + ends], "Hook")
    mesh.validate()
    obj = objects.add(mesh)
    settings = obj.body_moments
    settings.kind, settings.density, settings.print_infill = "PRINTED", 1240.0, 5.0
    return obj


def margin_of(obj):
    bpy.context.view_layer.update()
    return stability.support(obj, bpy.context.scene).margin


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
    with pytest.raises(RuntimeError, match="the margin is at best"):
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


@pytest.fixture
def beam(scene):
    """Return a beam of 60 by 20 by 20 mm, turned about z by 0.5, lying on the ground."""
    scene.unit_settings.scale_length = 1e-3
    obj = objects.add(box_mesh(60, 20, 20))
    obj.location, obj.rotation_euler = (5.0, 0.0, 10.0), (0.0, 0.0, 0.5)
    obj.scale = (0.5, 0.5, 0.5)
    obj.data.transform(Matrix.Scale(2.0, 4))
    settings = obj.body_moments
    settings.kind, settings.density = "PRINTED", 1240.0
    bpy.context.view_layer.update()
    return obj


WITHOUT = 1240.0 * (24e-6 - 0.85 * 58.32 * 18.32 * 18.4e-9)
EXCESS = 7820.0 - 0.15 * 1240.0


def test_ball_in_core_has_closed_moments(beam, capfd):
    settings = beam.body_moments
    settings.pocket_center, settings.pocket_radius = (20.0, 0.0, -4.0), 6.0
    bpy.ops.object.body_moments_measure()
    added = EXCESS * 4.0 / 3.0 * np.pi * 6e-3**3
    mass = WITHOUT + added
    assert close(beam["body_mass"], mass, 1e-6)
    center = added / mass * np.array([10e-3, 0.0, -2e-3])
    assert np.abs(np.array(beam["body_center_of_mass"]) - center).max() < 1e-9
    settings.pocket_radius = 7.5
    bpy.ops.object.body_moments_measure()
    assert "reaches out of the core" in capfd.readouterr().out


@pytest.mark.parametrize("away", [4.0, -4.0])
def test_least_pocket_brings_center_to_plumb_line(beam, scene, away):
    turned = np.array([np.cos(0.5), np.sin(0.5)])
    scene.cursor.location = (*(np.array([5.0, 0.0]) + away * turned), 50.0)
    options = {"target": "CURSOR", "margin": 0.001, "change": "BALLAST"}
    assert bpy.ops.object.body_moments_make_it_stand(**options) == {"FINISHED"}
    found = np.array(beam["body_center_of_mass"])[:2] * 1e3
    assert np.hypot(*(found - [away, 0.0])) < 0.0011
    # The least ball touches the end of the core: added · (29.16 - r - 4) = without · 4.
    radii = np.linspace(1.0, 9.0, 80001)
    added = EXCESS * 4.0 / 3.0 * np.pi * (1e-3 * radii) ** 3
    least = radii[np.argmax(added * (25.16 - radii) >= WITHOUT * (4.0 - 0.001))]
    radius = beam.body_moments.pocket_radius
    assert least * 0.999 <= radius <= least * 1.005


def test_unreachable_pocket_is_stated_and_changes_nothing(beam, scene):
    beam.rotation_euler = (0.0, 0.0, 0.0)
    scene.cursor.location = (55.0, 0.0, 0.0)
    options = {"target": "CURSOR", "change": "BALLAST"}
    with pytest.raises(RuntimeError, match="A pocket cannot do it: the margin is at best") as found:
        bpy.ops.object.body_moments_make_it_stand(**options)
    moved, radius = (1e3 * float(n) for n in re.findall(r"([\d.]+) m\b", str(found.value)))
    # The best ball touches walls and layers: where it has its largest radius, farthest out.
    ball = EXCESS * 4.0 / 3.0 * np.pi * (1e-3 * radius) ** 3
    assert 0.98 * 9.16 <= radius <= 9.16
    assert close(50.0 - moved, (29.16 - radius) * ball / (WITHOUT + ball), 0.02)
    assert beam.body_moments.pocket_radius == 0.0


def test_pocket_gives_margin_of_base_and_is_taken_out_unneeded(scene):
    obj = leaning(scene)
    options = {"margin": 0.2, "change": "BALLAST", "ballast": 11350.0}
    assert bpy.ops.object.body_moments_make_it_stand(**options) == {"FINISHED"}
    assert close(obj.body_moments.pocket_density, 11350.0, 0.0)
    assert obj.body_moments.pocket_radius > 0.0 and obj.body_moments.print_infill == 5.0
    assert abs(margin_of(obj) - 0.2) < 1e-4
    obj.body_moments.print_infill = 60.0
    assert bpy.ops.object.body_moments_make_it_stand(**options) == {"FINISHED"}
    assert obj.body_moments.pocket_radius == 0.0


def test_pocket_beside_given_mass_is_refused(beam, capfd):
    beam.body_moments.mass_from, beam.body_moments.mass = "MASS", 0.02
    assert bpy.ops.object.body_moments_make_it_stand(change="BALLAST") == {"CANCELLED"}
    assert "needs a density" in capfd.readouterr().out
    assert beam.body_moments.pocket_radius == 0.0


def test_margin_is_a_millimeter_in_any_unit(beam, scene):
    for unit, scale in ((1e-3, 1.0), (1.0, 1e-3)):
        scene.unit_settings.scale_length = unit
        beam.data.transform(Matrix.Scale(scale, 4))
        bpy.context.view_layer.update()
        beam.location = (5.0 * scale, 0.0, 10.0 * scale)
        scene.cursor.location = (9.0 * scale, 0.0, 0.0)
        beam.rotation_euler = (0.0, 0.0, 0.0)
        beam.body_moments.pocket_radius = 0.0
        options = {"target": "CURSOR", "change": "BALLAST"}
        assert bpy.ops.object.body_moments_make_it_stand(**options) == {"FINISHED"}
        assert close(beam["body_center_of_mass"][0], 3e-3, 1e-4)
