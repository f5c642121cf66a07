# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability and balance by mouse and keys: the buttons of the sub-panel, undo, the dialog, Esc on
the way.

The tests run in the order of the file and go on from one another.
"""

import pytest

from tests.window.harness import OPEN_STABILITY, PACKAGE

CUBE = "bpy.data.objects['Cube']"
SESSION = f"import sys\nstability = sys.modules['{PACKAGE}.blender.session.stored.stability']\n"
SUPPORT = (
    SESSION
    + f"found = stability.support({CUBE}, bpy.context.scene)\n"
    + "result = [found.stands, found.margin, found.height]"
)
# pixels right of and below the pointer where F9 was pressed: the arrow at the end of the Step
STEP_ARROW = (
    286,
    168,
)
KEYS = (
    "len(bpy.data.objects['Balance'].animation_data.action.layers[0].strips[0]"
    ".channelbags[0].fcurves[0]"
    ".keyframe_points)"
)
EMPTIES = "[obj.name for obj in bpy.context.scene.objects if 'body_balance_group' in obj]"


def test_button_computes_stability_of_a_leaning_box(window):
    window.ask(
        OPEN_STABILITY
        + f"{CUBE}.scale.z = 2.0\n{CUBE}.rotation_euler.x = 0.5\nbpy.context.view_layer.update()"
    )
    window.open_tab("Moments")
    window.press("object.body_moments_stability")
    window.wait(f"'body_mass' in {CUBE}")
    stands, margin, height = window.ask(SUPPORT)
    assert not stands and margin < 0.0 and height > 2.0
    window.point_at_view()
    window.picture("stability-tips")


def test_button_lays_body_on_the_ground_and_undo_restores_it(window):
    before = window.get(f"list(map(list, {CUBE}.matrix_world))")
    window.press("object.body_moments_rest_on_ground")
    window.wait(f"{CUBE}.location.z < 1.5")
    stands, margin, height = window.ask(SUPPORT)
    assert (
        stands and margin == pytest.approx(1.0, rel=1e-6) and height == pytest.approx(1.0, rel=1e-6)
    )
    window.point_at_view()
    window.picture("stability-rests")
    window.key("ctrl+z")
    window.wait(f"{CUBE}.location.z > 1.5")
    assert window.get(f"list(map(list, {CUBE}.matrix_world))") == before
    window.key("ctrl+shift+z")
    window.wait(f"{CUBE}.location.z < 1.5")


def test_a_balance_group_is_followed_after_its_dialog(window):
    window.ask(
        # no note: the dialog's fields are not below the mouse
        f"cube = {CUBE}\ncube.body_moments.density = 1000.0\n"
        "for frame in range(1, 31):\n    cube.location.x = 0.1 * frame\n"
        "    cube.keyframe_insert('location', frame=frame)\n"
        "bpy.context.scene.frame_end = "
        "30\nbpy.context.scene.frame_set(4)\nbpy.ops.ed.undo_push(message='Keys')"
    )
    window.press("object.body_moments_balance_group")
    window.key("Return")
    window.wait(EMPTIES)
    window.wait("bpy.context.scene.frame_current == 4")
    path = window.get(
        "[tuple(round(c, 5) for c in point) for point in [bpy.data.objects['Balance'].location]]"
    )
    assert path[0][0] == pytest.approx(0.4, rel=1e-5)
    window.point_at_view()
    window.picture("balance-path")
    window.key("ctrl+z")
    window.wait(f"not {EMPTIES}")
    window.key("ctrl+shift+z")
    window.wait(EMPTIES)


def test_its_redo_panel_changes_the_steps_of_the_path(window):
    """Blender executes the same operator again, which had been modal."""
    window.key("ctrl+z")
    window.wait(f"not {EMPTIES}")
    window.press("object.body_moments_balance_group")
    window.key("Return")
    window.wait(EMPTIES)
    window.wait("bpy.context.scene.frame_current == 4")
    assert window.get(KEYS) == 30
    window.redraw()
    window.move(500, 500)
    window.key("F9")
    window.redraw()
    window.click(500 + STEP_ARROW[0], 500 - STEP_ARROW[1])
    window.wait(f"{EMPTIES} and {KEYS} == 15")
    window.picture("balance-redo")
    window.key("Escape")


def test_esc_ends_it_and_nothing_is_changed(window):
    window.ask(
        f"cube = {CUBE}\ncube.select_set(False)\n"
        "bpy.ops.mesh.primitive_monkey_add()\n"
        "bpy.context.object.modifiers.new('Wave', 'WAVE')\n"
        "bpy.context.object.modifiers.new('Subdivision', 'SUBSURF').levels = 4\n"
        "bpy.context.scene.frame_end = 5000"
    )
    window.point_at_view()
    window.press("object.body_moments_balance_group")
    window.key("Return")
    window.wait("bpy.context.scene.frame_current != 4")
    window.key("Escape")
    window.wait("bpy.context.scene.frame_current == 4")
    assert len(window.get(EMPTIES)) == 1
