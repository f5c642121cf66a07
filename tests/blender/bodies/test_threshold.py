# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body of a Volume object within a threshold: numbers through every transform, fillings,
refusals, the slider.
"""

import math

import bpy
import numpy as np
import pytest
from body_moments.blender.session.tracking import staleness, stamps

from tests.blender.findings import said
from tests.blender.grids import SHEARED, measure, vdb_grid, volume_object
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def ramp(tmp_path, shape=(12, 9, 7), matrix=None, dtype=np.float32, name="ramp"):
    """A volume whose values are 1 + i along x: as a body, a box whose face moves with the
    threshold.
    """
    values = (1.0 + np.arange(shape[0]))[:, None, None] * np.ones(shape)
    obj = volume_object(
        tmp_path / (name + ".vdb"), vdb_grid(values.astype(dtype), matrix=matrix, background=-1e6)
    )
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 3.25
    return obj


def sampled_ball(tmp_path, n=24, radius=9.3):
    index = np.arange(n) - (n - 1) / 2.0
    values = radius - np.sqrt(index[:, None, None] ** 2 + index[:, None] ** 2 + index**2)
    obj = volume_object(
        tmp_path / "ball.vdb", vdb_grid(values.astype(np.float32), background=-30.0)
    )
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 0.0
    return obj, values.astype(np.float32)


@pytest.mark.parametrize("matrix", [None, SHEARED], ids=["plain", "sheared"])
def test_thresholded_ball_is_exact_under_any_transform(tmp_path, matrix):
    obj, values = sampled_ball(tmp_path)
    plain = measure(obj)
    assert (
        close(plain.volume, 4.0 / 3.0 * math.pi * 9.3**3, rel=1e-2)
        and str(plain.method) == "grid exact"
    )
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


def test_thresholded_ramp_is_box_of_material_or_ramp(tmp_path):
    """Beyond the last layer the density falls to the background within one voxel, almost at
    once.
    """
    obj = ramp(tmp_path)
    obj.body_moments.density = 2000.0
    solid = measure(obj)
    box = (11.0 - 2.25) * 8.0 * 6.0  # from x = 2.25 to 11
    assert close(solid.volume, box, rel=1e-4) and close(
        solid.mass_properties.mass, 2000.0 * box, rel=1e-4
    )
    assert close(solid.mass_properties.center[0], (11.0 + 2.25) / 2.0, rel=1e-4)
    obj.body_moments.threshold_fill, obj.body_moments.value_density = "GRID", 7.0
    filled = measure(obj)
    assert close(filled.volume, solid.volume, rel=1e-12)
    assert close(filled.mass_properties.mass, 7.0 * 48.0 * (12.0**2 - 3.25**2) / 2.0, rel=1e-4)


def test_threshold_moments_of_any_order_are_the_body_s(tmp_path):
    measured = measure(ramp(tmp_path), order=6, surface=True)
    about = measured.volume_moments.about_point((0.0, 0.0, 0.0))
    assert close(about[6, 0, 0], 48.0 * (11.0**7 - 2.25**7) / 7.0, rel=1e-3)
    assert measured.area_moments.order == 6


@pytest.mark.parametrize("spline_order", [3, 4])
def test_a_spline_is_measured_within_its_bound(tmp_path, spline_order):
    index = np.arange(-6.0, 7.0)
    values = 20.0 - (index[:, None, None] ** 2 + index[:, None] ** 2 + index**2)
    obj = volume_object(
        tmp_path / "cubic.vdb", vdb_grid(values.astype(np.float32), background=-60.0)
    )
    obj.body_moments.grid_as, obj.body_moments.threshold, obj.body_moments.spline_order = (
        "THRESHOLD",
        0.0,
        spline_order,
    )
    measured = measure(obj)
    truth = 4.0 / 3.0 * math.pi * (20.0 - spline_order / 4.0) ** 1.5  # Σ i² B = x² + order / 12
    assert abs(measured.volume - truth) <= measured.error_bound["volume"] < 1e-3 * truth
    assert measured.error_bound["estimated"]


def test_threshold_body_at_grid_edge_is_reported(tmp_path):
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
    assert staleness.stale_reason(obj, bpy.context.scene) == stamps.Stale.SETTINGS
    obj.body_moments.threshold = 2.0
    assert staleness.stale_reason(obj, bpy.context.scene) is None


def test_threshold_slider_keeps_results_after_edit(tmp_path):
    obj, _ = sampled_ball(tmp_path)
    before = stored(obj)
    obj.scale = (2.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    obj.body_moments.threshold = 2.0
    assert obj["body_volume"] == before
    assert staleness.stale_reason(obj, bpy.context.scene) is not None


@pytest.mark.parametrize("dtype", [np.float64, np.int64])
def test_values_of_eight_bytes_keep_their_digits(tmp_path, dtype):
    """From 2^24 on, float32 knows even numbers only."""
    values = (2**24 + np.arange(12))[:, None, None] * np.ones((12, 9, 7), np.int64)
    obj = volume_object(tmp_path / "fine.vdb", vdb_grid(values.astype(dtype)))
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 2**24 + 2
    whole = measure(obj).volume
    obj.body_moments.threshold = 2**24 + 6
    assert close(whole - measure(obj).volume, 4.0 * 8.0 * 6.0, rel=1e-4)
