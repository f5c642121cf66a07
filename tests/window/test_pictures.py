# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's bracket is measured and snapped as the manual tells it; pictures of the manual are
taken on the way.

They are left among the artefacts; the documents show copies of them (tests/window/pictures).
"""

import math

import numpy as np
import pytest

from tests.window.conftest import ROOT, open_window
from tools import demo

BRACKET = "bpy.data.objects['Bracket']"


@pytest.fixture(scope="module")
def bracket_file(run_blender, tmp_path_factory):
    file = tmp_path_factory.mktemp("demo") / "bracket.blend"
    script = ROOT / "tools" / "demo.py"
    run_blender("--background", "--python-exit-code", "1", "--python", script, "--", "build", file)
    return file


@pytest.fixture(scope="module")
def window(run_blender, bracket_file, tmp_path_factory):
    with open_window(
        run_blender, bracket_file, tmp_path_factory.mktemp("log"), size=(1600, 1000)
    ) as opened:
        opened.ask("bpy.context.preferences.system.viewport_aa = '8'")
        yield opened


def test_the_bracket_is_measured_in_aluminium(window):
    window.ask(
        "from mathutils import Euler\n"
        "view = area.spaces.active.region_3d\n"
        "view.view_rotation = Euler((1.1, 0.0, 0.75)).to_quaternion()\n"
        "bpy.ops.view3d.view_selected()\n"
        "view.view_distance *= 1.35\n"
        "view.view_location.x += 12\n"
        "bpy.ops.object.body_moments_set_material(material='Aluminum 6061')"
    )
    window.open_tab("Moments")
    window.press("object.body_moments_measure")
    window.wait(f"'body_mass' in {BRACKET}")
    assert window.get(f"{BRACKET}['body_volume']") == pytest.approx(demo.volume_by_hand(), rel=1e-6)
    assert window.get(f"{BRACKET}['body_density']") == 2700.0
    window.point_at_view()
    window.picture("measured")


def test_an_empty_shows_the_principal_frame(window):
    window.choose("VIEW3D_MT_body_moments_shape", "object.body_moments_add_empty")
    window.wait("any(obj.type == 'EMPTY' for obj in bpy.data.objects)")
    window.point_at_view()
    window.picture("principal-frame")
    assert window.get(f"{BRACKET}['body_method']") == "exact"


def test_a_nurbs_sphere_is_the_ball_that_it_is(window):
    window.ask(
        "bpy.context.scene.unit_settings.scale_length = "
        "1.0\nbpy.context.scene.unit_settings.length_unit = 'METERS'\n"
        "for obj in list(bpy.data.objects):\n    bpy.data.objects.remove(obj)\n"
        "bpy.ops.surface.primitive_nurbs_surface_sphere_add()\nbpy.ops.view3d.view_selected()"
    )
    window.press("object.body_moments_measure")
    sphere = "bpy.context.object"
    window.wait(f"'body_volume' in {sphere}")
    window.point_at_view()
    window.picture("nurbs")
    assert window.get(f"{sphere}['body_method']") == "NURBS exact"
    assert window.get(f"{sphere}['body_volume']") == pytest.approx(
        4.0 * math.pi / 3.0 * (1.0 - 1.95e-7), rel=1e-8
    )


def test_a_scan_is_imported_and_measured(window, tmp_path):
    samples = np.zeros((24, 24, 24), np.float32)
    samples[4:20, 6:18, 8:16] = 900.0
    np.save(tmp_path / "scan.npy", samples)
    window.ask(
        "bpy.data.objects.remove(bpy.context.object)\n"
        "bpy.ops.object.body_moments_import_scan("
        f"'EXEC_DEFAULT', True, filepath={str(tmp_path / 'scan.npy')!r})\n"
        "bpy.ops.view3d.view_selected()"
    )
    window.press("object.body_moments_measure")
    window.wait("'body_mass' in bpy.context.object")
    window.point_at_view()
    window.picture("volume")
    assert window.get("bpy.context.object['body_mass']") == pytest.approx(
        16 * 12 * 8 * 900.0, rel=1e-12
    )
