# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sub-panels with the demo's bracket, each after its operator has run in the window."""

import pytest

from tests.window.conftest import ROOT, open_window

BRACKET = "bpy.data.objects['Bracket']"
# A person opens them with a click on their headers; here they are registered anew, as panels that start open.
OPEN = """
import bpy
for cls in [cls for cls in bpy.types.Panel.__subclasses__() if cls.__name__.startswith("VIEW3D_PT_body_moments_")]:
    if "DEFAULT_CLOSED" in getattr(cls, "bl_options", set()):
        bpy.utils.unregister_class(cls)
        cls.bl_options = cls.bl_options - {"DEFAULT_CLOSED"}
        bpy.utils.register_class(cls)
"""


@pytest.fixture(scope="module")
def window(run_blender, tmp_path_factory):
    file = tmp_path_factory.mktemp("demo") / "bracket.blend"
    script = ROOT / "tests" / "demo.py"
    run_blender("--background", "--python-exit-code", "1", "--python", script, "--", "build", file)
    with open_window(run_blender, file, tmp_path_factory.mktemp("log")) as opened:
        yield opened


def run(window, operator):
    window.ask(f"bpy.ops.{operator}('EXEC_DEFAULT', True)")


def shown(window, name, down=0):
    """A picture, after the sidebar was scrolled by so many steps of the wheel."""
    x, y, width, height = window.region("UI")
    window.move(x + width / 2, y + height / 2)
    for _ in range(down):
        window._xdotool("click", 5)
    window.redraw()
    window.picture(name)


def test_moments_of_any_order_are_computed_and_shown(window):
    window.ask(OPEN)
    window.open_tab("Moments")
    run(window, "object.body_moments_measure")
    run(window, "object.body_moments_compute_moments")
    shown(window, "subpanel-moments", 25)
    run(window, "object.body_moments_copy_moments")
    assert len(window.get("bpy.context.window_manager.clipboard").splitlines()) > 35


def test_a_wall_of_real_thickness_slides(window):
    window.ask(f"s = {BRACKET}.body_moments\ns.kind, s.wall, s.thickness = 'SHELL', 'INWARD', 0.001")
    run(window, "object.body_moments_measure")
    window.wait(f"{BRACKET}['body_method'] == 'shell'")
    thin = window.get(f"{BRACKET}['body_mass']")
    window.ask(f"{BRACKET}.body_moments.thickness = 0.0005")
    window.wait(f"0.4 < {BRACKET}['body_mass'] / {thin!r} < 0.6")
    shown(window, "subpanel-wall")


def test_nothing_went_wrong_while_the_panels_were_drawn(window):
    assert "Traceback" not in window.output()
