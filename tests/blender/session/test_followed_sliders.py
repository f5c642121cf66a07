# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""When the sliders of walls and thresholds change stored numbers, and when these are out of date instead."""

from math import inf, nextafter
from types import SimpleNamespace

import bpy
import pytest
from body_moments.operators.session import staleness, threshold, walls
from body_moments.operators.write import properties

from tests.blender.session.test_what_is_remembered import body
from tests.blender.session.test_what_is_remembered import threshold as grid_body
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def wall(unit=0.5, **settings):
    bpy.context.scene.unit_settings.scale_length = unit
    return body(kind="SHELL", wall="INWARD", thickness=0.01, **settings)


def set_quietly(settings, **values):
    """As a script that Blender tells nobody of."""
    with pytest.MonkeyPatch.context() as patched:
        for name in ("on_wall_change", "on_density_change", "on_threshold_change", "on_change"):
            patched.setattr(walls.hooks, name, [])
        for name, value in values.items():
            setattr(settings, name, value)


def moved(obj):
    bpy.context.view_layer.update()
    obj.scale = (1.0, 1.0, 2.0)
    bpy.context.view_layer.update()


def edited(obj):
    obj.data.vertices[0].co.z -= 0.5
    obj.data.update()
    bpy.context.view_layer.update()


def unit(obj):
    bpy.context.scene.unit_settings.scale_length = 0.25


def damaged(obj):
    obj["body_fingerprint"] = "nothing"


def by_another(obj):
    obj["body_fingerprint"] = obj["body_fingerprint"].replace(":", ":0", 1)


@pytest.mark.parametrize(
    "change",
    [
        lambda obj: set_quietly(obj.body_moments, kind="SOLID"),
        lambda obj: set_quietly(obj.body_moments, wall="THIN"),
        lambda obj: set_quietly(obj.body_moments, density_from="POLYNOMIAL", density_polynomial="1"),
        unit,
        moved,
        edited,
        damaged,
        by_another,
        lambda obj: walls._cache.clear(),
    ],
)
def test_the_slider_of_a_wall_leaves_numbers_that_are_not_those_of_a_wall_as_it_is(change):
    obj = wall()
    change(obj)
    before = properties.numbers(obj)
    obj.body_moments.thickness = 0.02
    walls.on_wall_setting(obj.body_moments, bpy.context)
    assert properties.numbers(obj) == before


@pytest.mark.parametrize("given", [{}, {"mass_from": "MASS", "mass": 3.0, "density_from": "POLYNOMIAL"}])
def test_the_slider_of_a_wall_gives_what_measuring_does(given):
    obj = wall(**given)
    for side in ("INWARD", "OUTWARD", "CENTERED"):
        for thickness in (0.02, 0.03125):
            before = obj["body_volume"]
            obj.body_moments.wall, obj.body_moments.thickness = side, thickness
            slid, mass = obj["body_volume"], obj["body_mass"]
            assert slid != before and staleness.stale_reason(obj, bpy.context.scene) is None
            bpy.ops.object.body_moments_measure()
            assert close([slid, mass], [obj["body_volume"], obj["body_mass"]], 1e-9)


def test_a_wall_is_too_thick_from_where_it_folds_over():
    obj = wall()
    limit = walls.max_thickness(obj) / 0.5  # in Blender's units
    assert 0.0 < limit < inf and not walls.is_too_thick(obj)
    for thickness, is_too_thick in ((0.99 * limit, False), (1.01 * limit, True)):
        obj.body_moments.thickness = thickness
        assert walls.is_too_thick(obj) == is_too_thick
    set_quietly(obj.body_moments, wall="THIN")
    assert walls.max_thickness(obj) is None and not walls.is_too_thick(obj)
    set_quietly(obj.body_moments, wall="INWARD")
    cached = walls._cache.get(obj)
    for known, wanted in ((inf, None), (nextafter(inf, 0.0), nextafter(inf, 0.0)), (0.25, 0.25)):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(walls, "_walls_on_side", lambda *_, known=known: SimpleNamespace(max_thickness=known))
            assert walls.max_thickness(obj) == wanted
            set_quietly(obj.body_moments, thickness=0.5)
            assert walls.is_too_thick(obj) == (known == 0.25)  # as thick as that already
    walls._cache.clear()
    assert walls.max_thickness(obj) is None and not walls.is_too_thick(obj)
    walls._cache[obj] = cached
    assert walls.max_thickness(obj) is not None
    damaged(obj)
    assert walls.max_thickness(obj) is None and not walls.is_too_thick(obj)


@pytest.mark.parametrize(
    "change",
    [lambda obj: setattr(obj.body_moments, "grid_as", "DENSITY"), unit, moved, damaged, by_another]
    + [lambda obj: threshold._cache.clear(), lambda obj: obj.data.update_tag()],
)
def test_the_slider_of_a_threshold_changes_numbers_of_that_grid_alone(change, monkeypatch):
    obj = grid_body()
    scene = bpy.context.scene
    assert threshold._current(obj, scene) is threshold._cache.get(obj) is not None
    assert threshold._current(obj, None) is None
    change(obj)
    bpy.context.view_layer.update()
    assert threshold._current(obj, scene) is None
    before = properties.numbers(obj)
    obj.body_moments.threshold = 0.75
    assert properties.numbers(obj) == before and not threshold._pending


def test_a_threshold_that_leaves_nothing_leaves_the_numbers_and_going_back_follows_again():
    obj = grid_body()
    before, volume = properties.numbers(obj), obj["body_volume"]
    obj.body_moments.threshold = 100.0
    assert properties.numbers(obj) == before and not threshold._pending
    assert staleness.stale_reason(obj, bpy.context.scene) is not None
    volumes = []
    for value in (0.75, 0.5, 0.75, 0.25):
        obj.body_moments.threshold = value
        assert staleness.stale_reason(obj, bpy.context.scene) is None
        volumes.append(obj["body_volume"])
    assert volumes[0] == volumes[2] < volumes[1] < volumes[3] and close(volumes[3], volume, 1e-9)
