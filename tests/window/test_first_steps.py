# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The first ten minutes of the manual, step by step, with the picture of each step (see
test_pictures.py).
"""

import pytest

from tests.window.conftest import open_window
from tests.window.harness import OPEN_STABILITY

EMPTY_SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.context.scene.cursor.location = (0, 0, 0)
"""
ADD_CUBE = """
bpy.ops.mesh.primitive_cube_add('EXEC_DEFAULT', True, size=0.1)
bpy.ops.view3d.view_selected()
area.spaces.active.region_3d.view_distance *= 2.0
"""
CUBE = "bpy.data.objects['Cube']"
SUPPORT = """
import sys
stability = sys.modules['bl_ext.user_default.body_moments.blender.session.stored.stability']
found = stability.support(bpy.data.objects['Cube'], bpy.context.scene)
result = found and [found.stands, found.margin]
"""


@pytest.fixture(scope="module")
def window(run_blender, cube_file, tmp_path_factory):
    with open_window(
        run_blender, cube_file, tmp_path_factory.mktemp("log"), size=(1280, 800)
    ) as opened:
        opened.ask(
            "bpy.context.preferences.system.viewport_aa = '8'\n"
            + EMPTY_SCENE
            + OPEN_STABILITY
            + ADD_CUBE
        )
        yield opened


def take_picture(window, name: str) -> None:
    x, y, width, height = window.region("WINDOW")
    window.move(x + 0.6 * width, y + 0.1 * height)  # beside Blender's panel Add Cube
    window.picture(name)


def test_cube_of_ten_centimeters_in_pla_weighs_1_24_kg(window):
    x, y, _, height = window.region("HUD")
    window.click(x + 60, y + height - 16)  # opens Blender's panel Add Cube
    take_picture(window, "first-cube")
    window.ask("area.spaces.active.show_region_ui = True")
    window.open_tab("Moments")
    take_picture(window, "first-tab")
    window.ask("bpy.ops.object.body_moments_set_material(material='PLA')")
    window.press("object.body_moments_measure")
    window.wait(f"'body_mass' in {CUBE}")
    take_picture(window, "first-mass")
    assert window.get(f"{CUBE}['body_mass']") == pytest.approx(1.24, rel=1e-6)


def test_upright_cube_stands_and_leaning_cube_tips(window):
    window.press("object.body_moments_stability")
    stands, margin = window.ask(SUPPORT)
    assert stands and margin == pytest.approx(0.05, rel=1e-6)
    take_picture(window, "first-stands")
    window.ask(f"{CUBE}.rotation_euler.y = 0.35\nbpy.ops.ed.undo_push(message='Turn')")
    stands, margin = window.ask(SUPPORT)
    assert not stands and margin < 0.0
    take_picture(window, "first-tips")
