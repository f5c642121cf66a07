# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of measured objects in the window: a click on a line selects, one on a column sorts, a
button copies.
"""

import csv
import io

import pytest

from tests.window.conftest import OPEN
from tests.window.harness import CLOSE_OTHERS

SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.context.scene.unit_settings.scale_length = 1.0
for name, size in (("Small", 1.0), ("Large", 3.0), ("Open", 2.0)):
    bpy.ops.mesh.primitive_cube_add(size=size, location=(4 * len(bpy.data.objects), 0, 0))
    bpy.context.object.name = name
mesh = bpy.data.objects["Open"].data
import bmesh
edited = bmesh.new()
edited.from_mesh(mesh)
edited.faces.ensure_lookup_table()
bmesh.ops.delete(edited, geom=[edited.faces[0]], context="FACES")
edited.to_mesh(mesh)
bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.body_moments_measure("EXEC_DEFAULT", True)
bpy.ops.view3d.view_selected()
"""
SELECTED = "sorted(obj.name for obj in bpy.context.selected_objects)"
# Names in the order of their letters; by mass, C before B before A; B is repaired.
THREE = (
    SCENE.replace("Small", "A").replace("Open", "B").replace("Large", "C")
    + """
for cls in bpy.types.Panel.__subclasses__():
    if cls.__name__ == "VIEW3D_PT_body_moments":
        # the rows above the list, which differ from object to object
        cls.draw = lambda self, context: None
"""
)
# pixels, the first above the button under the list, with its filters open
FIRST_LINE, LINE_STEP = (
    172,
    20.7,
)
FIRST_OF_CLOSED = 125
FILTERS = {  # Pixels from the left of the sidebar and above that button.
    "opened": (31, 27),
    "Name": (58, 31),
    "Mass": (133, 31),
    "Verdict": (209, 31),
    "warnings first": (217, 54),
    "reversed": (242, 54),
}


@pytest.fixture(scope="module")
def listed(window):
    window.ask(SCENE)
    window.ask(OPEN + CLOSE_OTHERS)
    window.open_tab("Moments")
    window.redraw()
    return window


def test_a_click_on_a_line_selects_that_object(listed):
    window = listed
    window.picture("list")
    assert window.get(SELECTED) == ["Large", "Open", "Small"]
    window.press("object.body_moments_copy")
    window.wait("'Small' in bpy.context.window_manager.clipboard")
    rows = list(csv.DictReader(io.StringIO(window.get("bpy.context.window_manager.clipboard"))))
    assert [(row["name"], row["method"]) for row in rows] == [
        ("Large", "exact"),
        ("Open", "capped"),
        ("Small", "exact"),
    ]
    found = []
    for line in range(3):
        # the panel above the list changes with the active object, and moves it
        window.buttons.clear()
        x, y = window.middle("object.body_moments_copy")
        window.click(x, y + FIRST_OF_CLOSED - line * LINE_STEP)
        window.redraw()
        found += window.get(SELECTED)
    assert found == ["Large", "Open", "Small"]
    window.picture("list-clicked")
    window.undo()
    window.redraw()


def click_filter(window, name, button):
    right, above = FILTERS[name]
    window.click(window.region("UI")[0] + right, button[1] + above)
    window.redraw()


def lines(window, button):
    """The objects that clicks on the lines select, from top to bottom."""
    found = []
    for number in range(3):
        window.click(button[0], button[1] + FIRST_LINE - number * LINE_STEP)
        window.redraw()
        (selected,) = window.get(SELECTED)
        assert window.get("bpy.context.view_layer.objects.active.name") == selected
        found.append(selected)
    return "".join(found)


@pytest.fixture(scope="module")
def three(listed):
    listed.ask(THREE)
    listed.point_at_view()
    listed.redraw()
    return listed


def test_columns_sort_and_warnings_come_first_on_request(three):
    window, button_name = three, "object.body_moments_copy"
    window.ask(
        "bpy.ops.object.select_all(action='DESELECT')\nbpy.data.objects['A'].select_set(True)"
    )
    window.redraw()
    button = window.middle(button_name)
    click_filter(window, "opened", button)
    window.buttons.clear()
    button = window.middle(button_name)
    assert lines(window, button) == "ABC"
    for column, order in (("Mass", "CBA"), ("Verdict", "BAC"), ("Name", "ABC")):
        click_filter(window, column, button)
        assert lines(window, button) == order, column
        window.picture("list-by-" + column.lower())
    click_filter(window, "reversed", button)
    assert lines(window, button) == "CBA"
    click_filter(window, "reversed", button)
    window.ask(
        "bpy.data.objects['C'].data.vertices[0].co.x -= 1.0\nbpy.data.objects['C'].data.update()"
    )
    window.redraw()
    assert lines(window, button) == "ABC"
    click_filter(window, "warnings first", button)
    assert lines(window, button) == "CAB"
    window.ask("bpy.ops.object.select_all(action='SELECT')")
    window.picture("list-warnings-first")
    results = "bl_ext.user_default.body_moments.blender.session.displayed"
    total = f"__import__('sys').modules['{results}'].total(bpy.context)"
    assert window.get(f"[{total}.count, {total}.stale]") == [3, ["C"]]
