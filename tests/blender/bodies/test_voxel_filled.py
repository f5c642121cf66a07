# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh filled with the density of a Volume object, and what operators do with Volume objects."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.session.tracking import staleness, stamps
from body_moments.blender.settings.options import MeasureOptions
from body_moments.blender.write import properties
from body_moments.core.verdict import finding

from tests.blender.findings import refused, said
from tests.blender.grids import mesh_to_volume, vdb_grid, volume_object
from tests.blender.objects import strip_mesh
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def measure(obj, **options):
    bpy.context.view_layer.update()
    return measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(**options))


def cube(**transform):
    """Two to a side, around its origin."""
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    for key, value in transform.items():
        setattr(obj, key, value)
    return obj


def cloud(tmp_path, values, **transform):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(values))
    for key, value in transform.items():
        setattr(obj, key, value)
    return obj


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_a_box_around_whole_voxels_weighs_them(tmp_path, mirror):
    values = np.random.default_rng(0).integers(0, 9, (6, 6, 6)).astype(np.float32)
    volume = cloud(tmp_path, values, scale=(mirror, 1, 1))
    # voxels 1 and 2 along x, 2 to 3 along y, 3 to 4 along z; their centers are at whole numbers
    box = cube(location=(1.5 * mirror, 2.5, 3.5))
    box.body_moments.density_from = "VOLUME"
    box.body_moments.density_volume = volume
    found = measure(box)
    part = values[1:3, 2:4, 3:5].astype(float)
    assert str(found.method) == "grid exact"
    assert found.mass_properties.mass == pytest.approx(part.sum(), rel=1e-12)
    index = np.stack(np.meshgrid([1, 2], [2, 3], [3, 4], indexing="ij"), axis=-1)
    center = (part[..., None] * index).sum(axis=(0, 1, 2)) / part.sum() * [mirror, 1, 1]
    assert found.mass_properties.center == pytest.approx(center, rel=1e-12)
    assert found.volume == pytest.approx(8.0)
    assert found.density == pytest.approx(part.mean(), rel=1e-12)
    assert found.error_bound["estimated"]
    meaning = finding("values_scaled", density=1.0, order=1).as_record()
    assert said(found) == {
        "grid_density": {"samples": [6, 6, 6], "cause": meaning, "sources": [volume.name]}
    }
    volume.body_moments.spline_order = (
        4  # voxels fill what is inside of them whatever a grid by itself is taken for
    )
    assert (
        said(measure(box)) == said(found)
        and measure(box).mass_properties.mass == found.mass_properties.mass
    )
    assert found.density_from == finding("density_from_grid", grid="density").of_sources(
        [volume.name]
    )


@pytest.mark.parametrize("unit", [1.0, 0.25])
def test_a_uniform_grid_is_a_plain_density_wherever_both_stand(tmp_path, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    volume = cloud(
        tmp_path,
        np.full((40, 40, 40), 3.0, np.float32),
        location=(-5, -6, -7),
        rotation_euler=(0.1, 0.2, 0.3),
        scale=(0.5, 0.75, 0.6),
    )
    volume.body_moments.value_density = 2.0
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, location=(3, 3, 3))
    ball = bpy.context.object
    ball.scale = (2, 1, 3)
    plain = measure(ball, density=6.0)
    ball.body_moments.density_from = "VOLUME"
    ball.body_moments.density_volume = volume
    found = measure(ball)
    assert found.mass_properties.mass == pytest.approx(plain.mass_properties.mass, rel=1e-11)
    assert np.abs(
        found.mass_properties.inertia - plain.mass_properties.inertia
    ).max() <= 1e-9 * np.trace(plain.mass_properties.inertia)
    assert 0.0 < found.error_bound["inertia"] < 1e-6 * unit**5
    for name in ("volume", "area", "center_of_mass", "inertia"):
        assert close(found.error_bound["input"][name], plain.error_bound["input"][name], 0.4), name


def test_space_outside_the_grid_is_empty_and_reported(tmp_path):
    volume = cloud(tmp_path, np.ones((4, 4, 4), np.float32))
    box = cube(location=(-0.5, 1.5, 1.5))
    box.body_moments.density_from = "VOLUME"
    box.body_moments.density_volume = volume
    found = measure(box)
    assert found.mass_properties.mass == pytest.approx(4.0, rel=1e-12)
    assert said(found)["outside_grid"] == {"share": pytest.approx(0.5)}
    box.location.x = 0.5 - 5e-5
    assert close(said(measure(box))["outside_grid"]["share"], 2.5e-5, rel=1e-2)
    box.location.x = 0.5 - 2.0**-22
    assert close(said(measure(box))["outside_grid"]["share"], 2.0**-23, rel=1e-3)
    box.location.x = 0.5
    assert said(measure(box)).keys() == {"grid_density"}
    box.location.x = -0.5
    assert measure(box, mass=3.0).mass_properties.mass == pytest.approx(3.0)
    assert measure(box, density=2.0).mass_properties.mass == pytest.approx(16.0)
    assert str(measure(box, density=2.0).method) == "exact"
    volume.scale, box.location.x = (2, 2, 2), -1.0  # voxels of 8 m³
    assert said(measure(box))["outside_grid"] == {"share": pytest.approx(0.5)}
    volume.scale, box.location = (1, 1, 1), (50, 0, 0)
    for place in (50.0, -50.0):
        box.location = (place, 0, 0)
        with refused("density_grid_elsewhere", box.name, object=volume.name, grid="density"):
            measure(box)
    volume.scale = (0, 1, 1)
    with refused("grid_empty", box.name):
        measure(box)


def test_stored_numbers_know_when_the_grid_moves(tmp_path):
    volume = cloud(tmp_path, np.ones((4, 4, 4), np.float32))
    box = cube(location=(1.5, 1.5, 1.5))
    box.body_moments.density_from = "VOLUME"
    box.body_moments.density_volume = volume
    properties.store(box, measure(box))
    staleness.mark_up_to_date(bpy.context, [box])
    assert staleness.stale_reason(box, bpy.context.scene) is None
    volume.body_moments.value_density = 5.0
    assert staleness.stale_reason(box, bpy.context.scene) == stamps.Stale.SETTINGS
    volume.body_moments.value_density = 1.0
    assert staleness.stale_reason(box, bpy.context.scene) is None
    volume.location.x = 1.0
    bpy.context.view_layer.update()
    assert staleness.stale_reason(box, bpy.context.scene) == stamps.Stale.SETTINGS


def test_stored_numbers_know_when_the_voxels_change(tmp_path):
    fog = mesh_to_volume(cube())
    box = cube()
    box.body_moments.density_from = "VOLUME"
    box.body_moments.density_volume = fog
    plain = cube(location=(9, 0, 0))
    for obj in (box, plain):
        properties.store(obj, measure(obj))
    staleness.mark_up_to_date(bpy.context, [box, plain])
    assert staleness.stale_reason(box, bpy.context.scene) is None
    fog.body_moments.value_density = 5.0  # a setting is no change of voxels
    bpy.context.view_layer.update()
    fog.body_moments.value_density = 1.0
    bpy.context.view_layer.update()
    assert staleness.stale_reason(box, bpy.context.scene) is None
    fog.modifiers[0].density = 3.0
    bpy.context.view_layer.update()
    assert staleness.stale_reason(box, bpy.context.scene) == stamps.Stale.GEOMETRY
    assert staleness.stale_reason(plain, bpy.context.scene) is None
    properties.store(box, measure(box))
    staleness.mark_up_to_date(bpy.context, [box])
    assert staleness.stale_reason(box, bpy.context.scene) is None


def chosen(tmp_path):
    values = np.random.default_rng(0).random((6, 7, 18)).astype(np.float32)
    obj = cloud(tmp_path, values, location=(1, 2, 3), rotation_euler=(0.1, 0.5, 0.2))
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return obj


def test_snapping_of_a_cloud(tmp_path):
    obj = chosen(tmp_path)
    center = measure(obj).mass_properties.center
    assert bpy.ops.object.body_moments_add_empty() == {"FINISHED"}
    empty = next(one for one in bpy.context.scene.objects if one.type == "EMPTY")
    assert np.allclose(empty.matrix_world.translation, center, atol=1e-5)
    assert bpy.ops.object.body_moments_create_orientation() == {"FINISHED"}
    assert bpy.ops.view3d.body_moments_cursor_to_center() == {"FINISHED"}
    assert np.allclose(bpy.context.scene.cursor.location, center, atol=1e-5)
    assert bpy.ops.object.body_moments_align_to_world() == {"FINISHED"}
    body = measure(obj).mass_properties
    assert np.abs(body.inertia - np.diag(np.diag(body.inertia))).max() <= 1e-6 * np.trace(
        body.inertia
    )
    assert body.center == pytest.approx(center, abs=1e-5)
    matrix = obj.matrix_world.copy()
    for operator in (
        bpy.ops.object.body_moments_origin_to_center,
        bpy.ops.object.body_moments_axes_to_principal,
    ):
        assert operator() == {"CANCELLED"}
    assert obj.matrix_world == matrix


def test_source_of_refused_values_is_named(tmp_path):
    volume = cloud(tmp_path, np.full((4, 4, 4), -1.0, np.float32))
    box = cube(location=(1.5, 1.5, 1.5))
    box.body_moments.density_from, box.body_moments.density_volume = "VOLUME", volume
    cause = finding("values_negative", density=-1.0).as_record()
    with refused("object_unreadable", box.name, object=volume.name, cause=cause):
        measure(box)
    box.data = strip_mesh()
    with refused("open_surface_of_grid", box.name):
        measure(box)


def test_overflowing_grid_density_is_refused(tmp_path):
    volume = cloud(tmp_path, np.full((9, 9, 9), 1e300))
    box = cube(location=(2.5, 3.5, 4.5))
    box.body_moments.density_from, box.body_moments.density_volume = "VOLUME", volume
    with refused("object_unreadable", box.name, cause=finding("mass_overflow").as_record()):
        measure(box)


def test_single_voxel_fills_its_inside(tmp_path):
    box = cube(location=(0, 0, 0), scale=(0.25, 0.25, 0.25))
    box.body_moments.density_from = "VOLUME"
    box.body_moments.density_volume = cloud(tmp_path, np.full((1, 1, 1), 7.0, np.float32))
    assert close(measure(box).mass_properties.mass, 7.0 / 8.0, rel=1e-12)
