# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating by mouse: a hull from an empty scene afloat in four clicks, the panel, undo, the
overlay of a heeled boat, Live.

The tests run in the order of the file and go on from one another.
"""

import pytest

from tests.window.harness import OPEN_STABILITY, PACKAGE

HULL = "bpy.data.objects['Cube']"
SESSION = f"__import__('sys').modules['{PACKAGE}.blender.session.stored.floating']"
HELD = (
    f"found = {SESSION}.held_body({HULL}, bpy.context.scene)\n"
    "result = found and [found.is_at_rest, found.state.draught, found.heel]"
)
EMPTY = "for obj in list(bpy.data.objects):\n    bpy.data.objects.remove(obj)\n"


def test_hull_is_afloat_after_four_clicks(window):
    window.ask(EMPTY)
    window.choose("VIEW3D_MT_mesh_add", "mesh.primitive_cube_add")  # Add, Cube
    window.wait("len(bpy.data.objects) == 1")
    window.choose("VIEW3D_MT_body_moments_shape", "object.body_moments_float")  # Object, Float
    window.wait(f"{HULL}.location.z < 0.0")
    at_rest, draught, _ = window.ask(HELD)
    assert at_rest and draught == pytest.approx(2.0 * 1000.0 / 1023.343, rel=1e-6)


def test_button_floats_a_turned_hull_and_undo_restores_it(window):
    window.ask(
        OPEN_STABILITY.replace("stability", "floating")
        + f"hull = {HULL}\nhull.scale = (3.0, 1.0, 0.4)\nhull.location.z = 2.0\n"
        "hull.rotation_euler.x = 0.4\nhull.body_moments.density = 500.0\n"
        "bpy.context.view_layer.update()\nbpy.ops.ed.undo_push()"
    )
    window.open_tab("Moments")
    window.press("object.body_moments_float")
    window.wait(f"abs({HULL}.location.z) < 0.1")
    assert window.get(f"abs({HULL}.rotation_euler.x)") < 1e-5
    window.point_at_view()
    window.picture("floating-rests")
    window.key("ctrl+z")
    window.wait(f"{HULL}.location.z > 1.0")
    window.key("ctrl+shift+z")
    window.wait(f"abs({HULL}.location.z) < 0.1")


def test_waterline_follows_a_heeled_hull(window):
    window.ask(f"{HULL}.rotation_euler.x = 0.3\nbpy.context.view_layer.update()")
    window.redraw()
    at_rest, _, heel = window.ask(HELD)
    assert not at_rest and heel == pytest.approx(0.3, abs=1e-6)
    window.picture("floating-heeled")


def test_buttons_list_positions_and_righting_arms(window):
    window.press("object.body_moments_float_positions")
    window.wait(f"{SESSION}.memory.afloat[{HULL}].rests != ()")
    window.press("object.body_moments_righting_arms")
    window.wait(f"{SESSION}.memory.afloat[{HULL}].curve is not None")
    window.point_at_view()
    window.picture("floating-arms")


def test_live_waterline_follows_an_edit(window):
    window.ask(
        f"bpy.ops.object.body_moments_live()\n{HULL}.rotation_euler.x = 0.0\n"
        f"mesh = {HULL}.data\nfor vertex in mesh.vertices:\n    vertex.co.z *= 2.0\n"
        "mesh.update()"
    )
    window.wait(f"{SESSION}.held_body({HULL}, bpy.context.scene) is not None")
    _, draught, _ = window.ask(HELD)
    assert draught == pytest.approx(0.8 * 2.0 * 500.0 / 1023.343, rel=1e-5)


BOAT = """
from math import cos, pi, sin
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
points, faces = [], []
for i in range(13):
    x = i / 12.0 * 2.0 - 1.0
    beam = 0.9 * (1.0 - 0.98 * max(x, 0.0) ** 2) * (1.0 - 0.25 * min(x, 0.0) ** 2)
    for j in range(9):
        turn = (j / 8.0 - 0.5) * pi
        height = 0.9 * (1.0 - cos(turn) ** 0.7) + 0.2 * x * x
        points.append((2.5 * x, beam * sin(turn), height))
for i in range(12):
    for j in range(8):
        a = 9 * i + j
        faces.append((a, a + 1, a + 10, a + 9))
faces.append(tuple(range(8, -1, -1)))
mesh = bpy.data.meshes.new("Boat")
mesh.from_pydata(points, [], faces)
mesh.flip_normals()
boat = bpy.data.objects.new("Boat", mesh)
bpy.context.collection.objects.link(boat)
bpy.context.view_layer.objects.active = boat
boat.select_set(True)
boat.location.z = 1.0
settings = boat.body_moments
settings.kind, settings.wall, settings.thickness, settings.density = "SHELL", "INWARD", 0.04, 650.0
bpy.ops.view3d.view_selected()
"""


def test_open_boat_floats_and_shows_its_range(window):
    window.ask(BOAT)
    window.press("object.body_moments_float")
    window.wait("bpy.data.objects['Boat'].location.z < 0.5")
    window.press("object.body_moments_righting_arms")
    held = HELD.replace("'Cube'", "'Boat'")
    window.wait(f"{SESSION}.memory.afloat[bpy.data.objects['Boat']].curve is not None")
    at_rest, draught, heel = window.ask(held)
    assert at_rest and abs(heel) < 1e-3 and 0.1 < draught < 0.5
    window.ask("bpy.data.objects['Boat'].rotation_euler.x = 0.3")
    window.point_at_view()
    window.picture("floating-boat")
