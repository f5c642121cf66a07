# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints on the command line and in Blender: weight, record, stored properties and refusals."""

import csv
import io

import bpy
import numpy as np
import pytest

from tests.blender.batch_files import document
from tests.blender.boxes import box_mesh
from tests.blender.objects import add
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
CORE = 18.32**2 * 18.4e-9


@pytest.fixture(params=["stl", "blend"])
def cube(request, tmp_path):
    path = tmp_path / ("cube." + request.param)
    obj = add(box_mesh(20, 20, 20), "cube")
    if request.param == "stl":
        bpy.ops.wm.stl_export(filepath=str(path))
    else:
        bpy.context.scene.unit_settings.scale_length = 1e-3
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
    scale = ["--unit-scale", "0.001"] if request.param == "stl" else []
    del obj
    return [path, *scale, "--kind", "printed", "--density", "1240"]


def test_printed_cube_has_weight_of_walls_and_infill(cube):
    (entry,) = document(*cube)["objects"]
    assert close(entry["mass"], 1240.0 * (8e-6 - 0.85 * CORE), 1e-6)
    assert entry["kind"] == "printed" and close(entry["volume"], 8e-6, 1e-6)
    assert "{:.3f}".format(1e3 * entry["mass"]) == "3.411"
    assert close(entry["print"]["core_volume"], CORE, 1e-6)
    assert close(entry["print"]["material_volume"], entry["mass"] / 1240.0, 1e-12)
    sides = np.array([20.0, 20.0, 20.0]) * 1e-3, np.array([18.32, 18.32, 18.4]) * 1e-3
    second = 8e-6 * sides[0] ** 2 / 12.0 - 0.85 * CORE * sides[1] ** 2 / 12.0
    assert close(np.diag(entry["inertia"]), 1240.0 * (second.sum() - second), 1e-5)


def test_given_settings_replace_those_of_objects(cube):
    text = "walls=3,line_width=0.0004,top=0,bottom=5,layer_height=0.0001,infill=40,price=20,spool=2"
    (entry,) = document(*cube, "--print", text)["objects"]
    core = (20 - 2.4) ** 2 * 19.5e-9
    assert close(entry["mass"], 1240.0 * (8e-6 - 0.6 * core), 1e-6)
    assert close(entry["print"]["price"], entry["mass"] / 2.0 * 20.0, 1e-12)


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("infill=101", "infill is not from 0 to 100"),
        ("infill=-1", "infill is not from 0 to 100"),
        ("walls=30", "thicker than the part"),
        ("line_width=0", "not positive"),
    ],
)
def test_settings_that_print_nothing_are_refused(cube, text, part):
    found = document(*cube, "--print", text)
    assert found["objects"] == [] and part in found["errors"][0]["reason"]
    assert found["errors"][0]["name"] == "cube"


def test_printed_object_stores_volume_of_material_and_price():
    obj = add(box_mesh(20, 20, 20), "cube")
    bpy.context.scene.unit_settings.scale_length = 1e-3
    settings = obj.body_moments
    settings.kind, settings.density, settings.spool_price = "PRINTED", 1240.0, 25.0
    bpy.ops.object.body_moments_measure()
    assert close(obj["body_mass"], 1240.0 * (8e-6 - 0.85 * CORE), 1e-6)
    assert close(obj["body_material_volume"], obj["body_mass"] / 1240.0, 1e-12)
    assert close(obj["body_price"], 25.0 * obj["body_mass"], 1e-6)
    settings.print_preset = "VASE"
    bpy.ops.object.body_moments_measure()
    vase = (20 - 0.84) ** 2 * 19.2e-9
    assert close(obj["body_material_volume"], 8e-6 - vase, 1e-6)
    settings.kind = "SOLID"
    bpy.ops.object.body_moments_measure()
    assert "body_material_volume" not in obj and "body_price" not in obj


def test_row_of_print_has_its_values(cube, tmp_path):
    from body_moments.core.measurement import to_csv

    (row,) = csv.DictReader(io.StringIO("".join(to_csv([document(*cube)]))))
    assert row["print_infill"] == "15.0" and close(float(row["print_core_volume"]), CORE, 1e-6)


def test_pocket_of_print_is_in_the_record(tmp_path):
    obj = add(box_mesh(20, 20, 20), "cube")
    bpy.context.scene.unit_settings.scale_length = 1e-3
    settings = obj.body_moments
    settings.kind, settings.density, settings.pocket_radius = "PRINTED", 1240.0, 5.0
    settings.pocket_center, settings.spool_price = (1.0, 2.0, -3.0), 25.0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "cube.blend"))
    (entry,) = document(tmp_path / "cube.blend", "--order", "4")["objects"]
    ball = 4.0 / 3.0 * np.pi * 5e-3**3
    filament = 1240.0 * (8e-6 - 0.85 * CORE - 0.15 * ball)
    assert close(entry["print"]["pocket_mass"], 7820.0 * ball, 1e-6)
    assert close(entry["print"]["pocket_center"], [1e-3, 2e-3, -3e-3], 1e-6)
    assert close(entry["print"]["price"], 25.0 * filament, 1e-6)
    assert close(entry["mass"], filament + 7820.0 * ball, 1e-6)


def test_tilted_print_is_out_of_date_but_not_a_moved_one():
    from body_moments.blender.session.tracking import staleness

    obj = add(box_mesh(20, 20, 20), "cube")
    obj.body_moments.kind = "PRINTED"
    bpy.ops.object.body_moments_measure()
    obj.location, obj.rotation_euler.z = (3.0, 4.0, 5.0), 0.7
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    obj.rotation_euler.x = 0.5
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene)
