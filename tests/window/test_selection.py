# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of measured objects in the window: a click on a line selects, buttons copy and save, Live follows a drag."""

import csv
import io

import pytest

from tests.window.test_subpanels import OPEN

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
CLOSE_OTHERS = """
for name in ("inertia", "density", "apply", "stability", "assembly", "advanced"):
    cls = getattr(bpy.types, "VIEW3D_PT_body_moments_" + name, None)
    if cls is not None:
        panels = bpy.types.Panel.__subclasses__()
        for child in [panel for panel in panels if getattr(panel, "bl_parent_id", "") == cls.__name__]:
            bpy.utils.unregister_class(child)
        bpy.utils.unregister_class(cls)
"""
SELECTED = "sorted(obj.name for obj in bpy.context.selected_objects)"
LINE_HEIGHT = 20  # pixels


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
    window.press("object.body_moments_copy_csv")
    window.wait("'Small' in bpy.context.window_manager.clipboard")
    rows = list(csv.DictReader(io.StringIO(window.get("bpy.context.window_manager.clipboard"))))
    assert [(row["name"], row["method"]) for row in rows] == [
        ("Large", "exact"),
        ("Open", "capped"),
        ("Small", "exact"),
    ]
    x, y = window.buttons["object.body_moments_copy_csv"]
    found = set()
    for line in range(1, 9):
        window.click(x, y + 10 + line * LINE_HEIGHT)
        window.redraw()
        selected = window.get(SELECTED)
        if len(selected) == 1:
            found.add(selected[0])
    assert len(found) > 1  # the panel above the list changes with the active object, and moves it
    window.picture("list-clicked")
    window.point_at_view()
    window.key("ctrl+z")
    window.redraw()


def test_live_follows_a_drag_in_the_list_and_the_panel(listed):
    window = listed
    window.ask(
        "bpy.ops.object.select_all(action='DESELECT')\nobj = bpy.data.objects['Large']\nobj.select_set(True)\n"
        "bpy.context.view_layer.objects.active = obj"
    )
    window.press("object.body_moments_live")
    module = "__import__('sys').modules['bl_ext.user_default.body_moments.operators.session.results']"
    volume = f"{module}.in_world(bpy.data.objects['Large'], bpy.context.scene).volume"
    window.wait(f"abs({volume} - 27.0) < 1e-4")
    window.ask("bpy.ops.object.mode_set(mode='EDIT')\nbpy.ops.mesh.select_all(action='SELECT')")
    window.point_at_view()
    window.type("s", "2")
    window.wait(f"abs({volume} - 216.0) < 1e-3")
    window.redraw()
    window.picture("list-live")
    window.key("Escape")
    window.wait(f"abs({volume} - 27.0) < 1e-4")
    window.ask("bpy.ops.object.mode_set(mode='OBJECT')")
    assert window.get("bpy.data.objects['Large']['body_volume']") == pytest.approx(27.0, rel=1e-6)
