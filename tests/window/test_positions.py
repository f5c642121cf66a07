# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Buttons stay where the hand is: before and after a press, an edit, undo, with any number of
warnings, however a character stands, and when a bone is selected.
"""

import pytest

from tests.window.conftest import FIGURE, OPEN, open_window

STEP = 5  # pixels; a row has 20
INSIDE = 6  # pixels from the middle of a button
HEIGHT = 1800  # of a screen on which nothing scrolls
MEASURE = "object.body_moments_measure"
STABILITY = "object.body_moments_stability"
REST = "object.body_moments_rest_on_ground"
BUTTONS = [
    MEASURE,
    "object.body_moments_clear",
    "object.body_moments_origin_to_center",
    "object.body_moments_copy_settings",
    STABILITY,
    REST,
    "object.body_moments_make_colliders",
]
SHOWN = {"apply", "selection", "stability", "colliders", "findings", "weight"}
SCENE = """
import bmesh
cube = bpy.data.objects["Cube"]
bpy.ops.mesh.primitive_cube_add(size=1.0, location=(5, 0, 0))
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
# a hole, a second shell within the first, a triangle through both
DAMAGE = """
import bmesh
mesh = bpy.data.objects["Cube"].data
faults = bmesh.new()
faults.from_mesh(mesh)
faults.faces.ensure_lookup_table()
if {step} == 1:
    faults.faces.remove(faults.faces[0])
else:
    bmesh.ops.create_cube(faults, size=1.5)
    corners = [faults.verts.new(place) for place in ((-3, 0, 0), (3, 0.1, 0), (0, 0, 3))]
    faults.faces.new(corners)
faults.to_mesh(mesh)
mesh.update()
bpy.context.view_layer.update()
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


@pytest.fixture(scope="module")
def window(run_blender, cube_file, tmp_path_factory):
    """Blender's window, high enough for all opened panels."""
    folder = tmp_path_factory.mktemp("log")
    with open_window(run_blender, cube_file, folder, size=(1000, HEIGHT)) as opened:
        opened.ask(SCENE)
        opened.ask(OPEN)
        opened.ask(CLOSED.format(open=SHOWN))
        opened.open_tab("Moments")
        yield opened


def middles(window, buttons):
    """Find the first button of each operator in one pass down the sidebar, to half a step."""
    window.redraw()
    x, y, width, height = window.region("UI")
    rows = {}
    for share in (0.25, 0.84):
        column = x + (width - 20) * share
        for down in range(30, height, STEP):
            operator = window.button_at(column, y + height - down)
            first, last, _ = rows.get(operator, (down, down - STEP, column))
            if down - last == STEP:
                rows[operator] = first, down, column
    return {button: (rows[button][2], y + height - sum(rows[button][:2]) / 2) for button in buttons}


def assert_in_place(window, before):
    window.redraw()
    for button, (x, y) in before.items():
        window.button_at(x, y)  # the first look after a jump of the pointer may find nothing
        # near both edges of the button, which is 20 pixels high
        found = {window.button_at(x, y + INSIDE), window.button_at(x, y - INSIDE)}
        if found != {button}:
            window.picture("positions-moved")
        assert found == {button}


def test_buttons_stay_after_press_edit_and_undo(window):
    before = middles(window, BUTTONS)
    window.press(MEASURE)
    window.wait("'body_mass' in bpy.data.objects['Cube']")
    assert_in_place(window, before)
    window.press(STABILITY)
    window.picture("positions-stands")
    assert_in_place(window, before)
    window.press(REST)
    assert_in_place(window, before)
    window.ask(EDIT)
    window.picture("positions-edited")
    assert_in_place(window, before)
    for _ in range(2):
        window.undo()
        assert_in_place(window, before)


def test_buttons_stay_with_any_number_of_warnings(window):
    before = middles(window, BUTTONS)
    counts = []
    for step in (1, 2):
        window.ask(DAMAGE.format(step=step))
        window.press(MEASURE)
        window.press(STABILITY)
        counts.append(window.get("bpy.data.objects['Cube']['body_warnings'].count(chr(10)) + 1"))
        window.picture(f"positions-warnings-{step}")
        assert_in_place(window, before)
    assert counts[0] < counts[1]
    window.press("object.body_moments_make_colliders")
    window.wait("len(bpy.data.objects['Cube'].children) > 0")
    assert_in_place(window, before)
    window.ask("bpy.data.objects['Cube.001'].select_set(True)")
    assert_in_place(window, before)


def test_buttons_stay_when_a_bone_is_selected_or_leaves_the_ground(window):
    window.ask(FIGURE)
    window.ask(
        "bpy.ops.object.mode_set(mode='POSE')\nbpy.ops.pose.body_moments_show_weight()\n"
        "bpy.ops.pose.select_all(action='DESELECT')\n"
        "bpy.context.object.data.bones.active = None"
    )
    buttons = [MEASURE, "pose.body_moments_balance_pose", "pose.body_moments_parabola", STABILITY]
    before = middles(window, buttons)
    window.ask("bones = bpy.context.object.data.bones\nbones.active = bones[-1]")
    assert_in_place(window, before)
    window.ask("bpy.context.object.location.z += 1\nbpy.context.view_layer.update()")
    window.picture("positions-in-the-air")
    assert_in_place(window, before)
