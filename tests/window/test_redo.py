# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The redo panel (F9) by mouse: a click in it does the action again, and one Ctrl Z takes all of it back."""

import pytest

from tests.window.test_every_operator import BRICK, MENU, PART

TURNED = f"{PART}.rotation_euler = (0.3, 0.2, 0.1)"
EMPTIES = "[obj.parent is not None for obj in bpy.data.objects if obj.type == 'EMPTY']"
PLACE = f"[round(value, 3) for value in {PART}.location]"
MASS = f"[{PART}.rigid_body.mass, *{PLACE}]"
CHECKBOX, TITLE, ROW = 144, 56, 23  # pixels from the pointer where F9 was pressed, and between settings
# operator: which setting is clicked, what is there before, what is looked at, after the action, after the click
CLICKED = {
    "object.body_moments_add_empty": (0, "", EMPTIES, [True], [False]),
    "object.body_moments_add_nodes": (
        0,
        "",
        "[group.name for group in bpy.data.node_groups]",
        ["Center of Mass", "Center of Mass Marker"],
        ["Center of Mass"],
    ),
    "object.body_moments_axes_to_principal": (0, TURNED, PLACE, [1.488, 2.049, 2.901], [1.488, 2.049, 2.901]),
    "object.body_moments_set_rigid_body_mass": (
        1,
        "bpy.ops.rigidbody.object_add()",
        MASS,
        [48000.0, 1.0, 2.0, 3.0],
        [48000.0, 1.5, 2.0, 3.0],
    ),
}


@pytest.mark.parametrize("operator", CLICKED)
def test_redo_panel_repeats_the_action_and_undo_takes_it_back(window, operator):
    row, before, looked_at, acted, clicked = CLICKED[operator]
    update = "\nbpy.context.view_layer.update()\nbpy.ops.ed.undo_push(message='Start')"
    window.ask(BRICK + before + update)
    start = window.get(looked_at)
    window.choose(MENU, operator)
    window.wait(f"{looked_at} == {acted!r}", limit=60.0)
    window.move(500, 500)
    window.key("F9")
    window.redraw()
    window.click(500 + CHECKBOX, 500 - TITLE - ROW * row)
    window.wait(f"{looked_at} == {clicked!r}", limit=60.0)
    window.redraw()
    window.key("Escape")
    window.point_at_view()
    window.key("ctrl+z")
    window.wait(f"{looked_at} == {start!r}", limit=60.0)
    assert "Traceback" not in window.output()
