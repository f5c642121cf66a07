# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's bracket is measured and snapped as the README tells it; the README's pictures are taken on the way.

They are left among the artefacts; the README shows copies of them (tests/window/pictures).
"""


import pytest

from tests import demo
from tests.window.conftest import ROOT, open_window

BRACKET = "bpy.data.objects['Bracket']"


@pytest.fixture(scope="module")
def bracket_file(run_blender, tmp_path_factory):
    file = tmp_path_factory.mktemp("demo") / "bracket.blend"
    script = ROOT / "tests" / "demo.py"
    run_blender("--background", "--python-exit-code", "1", "--python", script, "--", "build", file)
    return file


@pytest.fixture(scope="module")
def window(run_blender, bracket_file, tmp_path_factory):
    with open_window(run_blender, bracket_file, tmp_path_factory.mktemp("log")) as opened:
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
    window.redraw()
    window.picture("readme-measured")


def test_an_empty_shows_the_principal_frame(window):
    window.press("object.body_moments_add_empty")
    window.wait("any(obj.type == 'EMPTY' for obj in bpy.data.objects)")
    window.point_at_view()
    window.redraw()
    window.picture("readme-principal-frame")
    assert window.get(f"{BRACKET}['body_method']") == "exact"


def test_nothing_was_printed_by_a_failing_panel(window):
    assert "Traceback" not in window.output()
