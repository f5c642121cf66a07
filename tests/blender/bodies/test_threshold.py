# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body of a Volume object within a threshold: numbers through every transform, fillings, refusals, the slider."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.blender.bodies.grids import threshold as threshold_module
from body_moments.blender.bodies.measure_object import measure_body
from body_moments.blender.session.tracking import staleness
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.verdict.finding import finding

from tests.blender.bodies.test_grid import SHEARED, measure
from tests.blender.findings import refused, said
from tests.blender.grids import vdb_grid, volume_object
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def ramp(tmp_path, shape=(12, 9, 7), matrix=None, dtype=np.float32, name="ramp"):
    """A volume whose values are 1 + i along x: as a body, a box whose face moves with the threshold."""
    values = (1.0 + np.arange(shape[0]))[:, None, None] * np.ones(shape)
    obj = volume_object(tmp_path / (name + ".vdb"), vdb_grid(values.astype(dtype), matrix=matrix, background=-1e6))
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 3.25
    return obj


def sampled_ball(tmp_path, n=24, radius=9.3):
    index = np.arange(n) - (n - 1) / 2.0
    values = radius - np.sqrt(index[:, None, None] ** 2 + index[:, None] ** 2 + index**2)
    obj = volume_object(tmp_path / "ball.vdb", vdb_grid(values.astype(np.float32), background=-30.0))
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 0.0
    return obj, values.astype(np.float32)


@pytest.mark.parametrize("matrix", [None, SHEARED], ids=["plain", "sheared"])
def test_a_ball_is_the_set_above_the_threshold_wherever_the_grid_stands(tmp_path, matrix):
    obj, values = sampled_ball(tmp_path)
    plain = measure(obj)
    assert close(plain.volume, 4.0 / 3.0 * math.pi * 9.3**3, rel=1e-2) and str(plain.method) == "grid exact"
    assert close(plain.area, 4.0 * math.pi * 9.3**2, rel=1e-2)
    assert close(plain.mass_properties.mass, 1000.0 * plain.volume, rel=1e-14)
    assert "threshold_measured" in said(plain) and "threshold_clipped" not in said(plain)
    if matrix is not None:
        obj.matrix_world = matrix.T.tolist()
        moved = measure(obj)
        stored = np.array(obj.matrix_world)
        assert close(moved.volume, plain.volume * abs(np.linalg.det(stored[:3, :3])), rel=1e-6)
        expected = stored[:3, :3] @ plain.mass_properties.center + stored[:3, 3]
        assert close(moved.mass_properties.center, expected, rel=1e-6)


def test_the_body_of_a_ramp_is_a_box_filled_with_material_or_with_the_ramp(tmp_path):
    """Beyond the last layer the density falls to the background within one voxel, almost at once."""
    obj = ramp(tmp_path)
    obj.body_moments.density = 2000.0
    solid = measure(obj)
    box = (11.0 - 2.25) * 8.0 * 6.0  # from x = 2.25 to 11
    assert close(solid.volume, box, rel=1e-4) and close(solid.mass_properties.mass, 2000.0 * box, rel=1e-4)
    assert close(solid.mass_properties.center[0], (11.0 + 2.25) / 2.0, rel=1e-4)
    obj.body_moments.threshold_fill, obj.body_moments.value_density = "GRID", 7.0
    filled = measure(obj)
    assert close(filled.volume, solid.volume, rel=1e-12)
    assert close(filled.mass_properties.mass, 7.0 * 48.0 * (12.0**2 - 3.25**2) / 2.0, rel=1e-4)


def test_moments_of_any_order_are_those_of_the_body(tmp_path):
    measured = measure(ramp(tmp_path), order=6, surface=True)
    about = measured.volume_moments.about_point((0.0, 0.0, 0.0))
    assert close(about[6, 0, 0], 48.0 * (11.0**7 - 2.25**7) / 7.0, rel=1e-3)
    assert measured.area_moments.order == 6


@pytest.mark.parametrize("spline_order", [3, 4])
def test_a_spline_is_measured_within_its_bound(tmp_path, spline_order):
    index = np.arange(-6.0, 7.0)
    values = 20.0 - (index[:, None, None] ** 2 + index[:, None] ** 2 + index**2)
    obj = volume_object(tmp_path / "cubic.vdb", vdb_grid(values.astype(np.float32), background=-60.0))
    obj.body_moments.grid_as, obj.body_moments.threshold, obj.body_moments.spline_order = "THRESHOLD", 0.0, spline_order
    measured = measure(obj)
    truth = 4.0 / 3.0 * math.pi * (20.0 - spline_order / 4.0) ** 1.5  # Σ i² B = x² + order / 12
    assert abs(measured.volume - truth) <= measured.error_bound["volume"] < 1e-3 * truth
    assert measured.error_bound["estimated"]


def test_what_reaches_the_edge_is_reported_where_nothing_is_known_beyond(tmp_path):
    values = np.full((4, 4, 4), 2.0, np.float32)
    obj = volume_object(tmp_path / "full.vdb", vdb_grid(values, background=5.0))
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 1.0
    assert "threshold_clipped" in said(measure(obj))


def stored(obj):
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    return obj["body_volume"]


def test_the_threshold_is_a_slider_after_measure(tmp_path):
    obj, _ = sampled_ball(tmp_path)
    before = stored(obj)
    obj.body_moments.threshold = 2.0
    assert obj["body_volume"] < before and close(obj["body_volume"], measure(obj).volume, rel=1e-13)
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    obj.body_moments.threshold = 99.0  # nothing is above: the numbers stay, and are out of date
    assert staleness.stale_reason(obj, bpy.context.scene) == "stale_settings"
    obj.body_moments.threshold = 2.0
    assert staleness.stale_reason(obj, bpy.context.scene) is None


def test_the_slider_leaves_what_was_edited_since(tmp_path):
    obj, _ = sampled_ball(tmp_path)
    before = stored(obj)
    obj.scale = (2.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    obj.body_moments.threshold = 2.0
    assert obj["body_volume"] == before
    assert staleness.stale_reason(obj, bpy.context.scene) is not None


def test_a_level_set_has_no_threshold(tmp_path):
    grid = vdb_grid(np.ones((4, 4, 4), np.float32), "distance")
    grid.gridClass = "level set"
    obj = volume_object(tmp_path / "level.vdb", grid)
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 0.5
    with refused("grid_is_level_set", obj.name, grid="distance"):
        measure(obj)


@pytest.mark.parametrize("dtype", [np.float64, np.int64])
def test_values_of_eight_bytes_keep_their_digits(tmp_path, dtype):
    """From 2^24 on, float32 knows even numbers only."""
    values = (2**24 + np.arange(12))[:, None, None] * np.ones((12, 9, 7), np.int64)
    obj = volume_object(tmp_path / "fine.vdb", vdb_grid(values.astype(dtype)))
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 2**24 + 2
    whole = measure(obj).volume
    obj.body_moments.threshold = 2**24 + 6
    assert close(whole - measure(obj).volume, 4.0 * 8.0 * 6.0, rel=1e-4)


def test_a_body_of_negative_or_of_too_large_densities_says_which(tmp_path):
    obj = ramp(tmp_path)
    obj.body_moments.threshold, obj.body_moments.threshold_fill = 3.25, "GRID"
    weight = measure(obj).mass_properties.mass
    assert close(weight, 48.0 * (12.0**2 - 3.25**2) / 2.0, rel=1e-4)
    obj.body_moments.value_density = 3e38
    assert close(measure(obj).mass_properties.mass, 3e38 * weight, rel=1e-12)
    empty = volume_object(tmp_path / "empty.vdb", vdb_grid(np.zeros((4, 4, 4), np.float32) - 2.0))
    empty.body_moments.grid_as, empty.body_moments.threshold_fill = "THRESHOLD", "GRID"
    empty.body_moments.threshold = -3.0
    with refused("grid_empty", empty.name):
        measure(empty)
    huge = volume_object(tmp_path / "huge.vdb", vdb_grid(np.full((4, 4, 4), 1e120)))
    huge.body_moments.grid_as, huge.body_moments.threshold_fill = "THRESHOLD", "GRID"
    with refused("mass_overflow", huge.name):
        measure(huge)


def body_of(obj, **options):
    bpy.context.view_layer.update()
    return measure_body(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(**options)).body


def test_what_is_known_of_a_body_and_what_is_summed_to_a_higher_order_agree(tmp_path):
    obj, _ = sampled_ball(tmp_path, 6, 2.3)
    settings = obj.body_moments
    settings.threshold, settings.value_density = 0.5, 3.0
    for fill in ("MATERIAL", "GRID"):
        settings.threshold_fill = fill
        body = body_of(obj, order=4)
        assert body.estimated and body.health.closed
        if fill == "GRID":
            assert body.higher_mass.order == 4 and body.higher_mass.measure == "mass"
            assert close(body.higher_mass.total, body.mass.total, rel=1e-9)
            assert body.density_from == finding("density_from_grid", grid="density")
        else:
            assert body.higher_mass is body.mass is body.density_from is None
    volume, area = body.moments(4, True)
    for known, summed in ((body.volume, volume), (body.area, area)):
        assert close(summed.total, known.total, rel=1e-9)
        assert close(summed.about_point(known.about)[2, 0, 0], known[2, 0, 0], rel=1e-9)
    assert body.moments(4, False)[1] is None
    for order in (None, 2, 3):
        assert body_of(obj, order=order).higher_mass is None


def test_more_voxels_than_any_memory_has_are_counted_and_refused():
    for shape, samples in (((1 << 22, 1 << 22, 1 << 22), 1 << 66), (((1 << 29) + 1, 1, 1), (1 << 29) + 1)):
        reading = SimpleNamespace(level_set=False, shape=shape, grid="large", background=None)
        with refused("threshold_too_large", grid="large", samples=samples):
            threshold_module.threshold_grid(reading, 1.0)


@pytest.mark.parametrize("fill", ["MATERIAL", "GRID"])
def test_a_body_may_be_small_and_light(tmp_path, fill):
    obj = ramp(tmp_path)
    obj.scale, obj.body_moments.threshold_fill, obj.body_moments.value_density = (1e-3, 1e-3, 1e-3), fill, 10.0
    found = measure(obj)
    assert close(found.volume, 420e-9, rel=1e-3)
    density = 1000.0 if fill == "MATERIAL" else 10.0 * (12.0**2 - 3.25**2) / 2.0 / 8.75
    assert close(found.mass_properties.mass, density * 420e-9, rel=1e-3)


def test_the_largest_value_is_that_of_numbers_as_they_are_converted():
    values = np.array([[[1.0, np.nan]], [[-7.0, 2.0]]])
    grid = threshold_module.ThresholdGrid("Grid", values, np.eye(4), None)
    assert grid.largest() == 2.0
    turned = threshold_module.ThresholdGrid("Grid", values, np.eye(4), None, lambda block: 1.0 - 2.0 * block)
    assert turned.largest() == 15.0
    assert math.isnan(threshold_module.ThresholdGrid("Grid", values[:0], np.eye(4), None).largest())
