# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons stay where the hand is: before and after a press, an edit, undo and a selected bone."""

from tests.window.conftest import FIGURE, OPEN

TOLERANCE = 3  # pixels, to which the middle of a button is found; a row has 20
MEASURE = "object.body_moments_measure"
STABILITY = "object.body_moments_stability"
SCENE = """
cube = bpy.data.objects["Cube"]
bpy.ops.mesh.primitive_cube_add(size=1.0, location=(5, 0, 0))
bpy.context.scene.body_moments.units_answered = True
bpy.ops.object.select_all(action="DESELECT")
cube.select_set(True)
bpy.context.view_layer.objects.active = cube
bpy.ops.ed.undo_push(message="start")
"""
EDIT = """
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.select_all(action="SELECT")
bpy.ops.transform.resize(value=(1.5, 1.0, 1.0))
bpy.ops.object.mode_set(mode="OBJECT")
bpy.ops.ed.undo_push(message="edited")
"""
CLOSED = """
import bpy
panels = bpy.types.Panel.__subclasses__()
for cls in [cls for cls in panels if cls.__name__.startswith("VIEW3D_PT_body_moments_")]:
    if cls.__name__.split("_")[-1] not in {open}:
        bpy.utils.unregister_class(cls)
        cls.bl_options = cls.bl_options | {{"DEFAULT_CLOSED"}}
        bpy.utils.register_class(cls)
"""


def middles(window, buttons):
    window.redraw()
    window.buttons.clear()
    return {button: window.middle(button) for button in buttons}


def assert_in_place(window, before):
    after = middles(window, before)
    for button, (x, y) in after.items():
        # from the main panel's button, as the sidebar may be scrolled
        moved = y - after[MEASURE][1] - (before[button][1] - before[MEASURE][1])
        assert abs(before[button][0] - x) <= TOLERANCE and abs(moved) <= TOLERANCE, button


def test_buttons_stay_after_press_edit_and_undo(window):
    buttons = [MEASURE, STABILITY]
    window.ask(SCENE)
    window.ask(OPEN)
    window.ask(CLOSED.format(open={"stability", "weight"}))
    window.open_tab("Moments")
    before = middles(window, buttons)
    window.press(MEASURE)
    window.wait("'body_mass' in bpy.data.objects['Cube']")
    assert_in_place(window, before)
    window.press(buttons[1])
    assert_in_place(window, before)
    window.ask(EDIT)
    window.picture("positions")
    assert_in_place(window, before)
    window.point_at_view()
    window.key("ctrl+z")
    assert_in_place(window, before)
    window.point_at_view()
    window.key("ctrl+z")
    assert_in_place(window, before)


def test_buttons_stay_when_a_bone_is_selected(window):
    window.ask(FIGURE)
    window.open_tab("Moments")
    window.ask(
        "bpy.ops.object.mode_set(mode='POSE')\nbpy.ops.pose.body_moments_show_weight()\n"
        "bpy.ops.pose.select_all(action='DESELECT')\n"
        "bpy.context.object.data.bones.active = None"
    )
    buttons = [MEASURE, "pose.body_moments_balance_pose", "pose.body_moments_parabola"]
    before = middles(window, buttons)
    window.ask("bones = bpy.context.object.data.bones\nbones.active = bones[-1]")
    assert_in_place(window, before)
