# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A cup of wine and a pit, by mouse: the level of a volume, and cut and fill against the rim."""

import pytest

from tests.window.harness import PACKAGE

CUP = """
import math
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
scene = bpy.context.scene
scene.unit_settings.length_unit = 'CENTIMETERS'
n = 64
profile = ((0, 0), (.03, 0), (.04, .1), (.037, .1), (.027, .004), (0, .004))
points, faces = [], []
for r, z in profile:
    points += [(r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n), z)
               for i in range(n)]
for k in range(1, 4):
    faces += [[k * n + i, k * n + (i + 1) % n, (k + 1) * n + (i + 1) % n, (k + 1) * n + i]
              for i in range(n)]
faces += [[n + i for i in range(n)][::-1], [4 * n + i for i in range(n)]]
mesh = bpy.data.meshes.new('Cup')
mesh.from_pydata(points, [], faces)
cup = bpy.data.objects.new('Cup', mesh)
"""
PIT = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
scene = bpy.context.scene
scene.unit_settings.length_unit = 'METERS'
bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=40, size=20)
cup = bpy.context.object
cup.name = 'Pit'
for vertex in cup.data.vertices:
    x, y, _ = vertex.co / 10
    vertex.co.z = -6 * max(0, 1 - x * x) * max(0, 1 - y * y)
"""
SHOW = """
if not cup.users_collection:
    scene.collection.objects.link(cup)
cup.select_set(True)
bpy.context.view_layer.objects.active = cup
view = area.spaces.active.region_3d
from mathutils import Euler
view.view_rotation = Euler((1.0, 0.0, 0.75)).to_quaternion()
area.spaces.active.shading.show_xray = True
bpy.ops.view3d.view_selected()
view.view_distance *= 1.6
panel = bpy.types.VIEW3D_PT_body_moments_section
if 'DEFAULT_CLOSED' in panel.bl_options:
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)
    inner = bpy.types.VIEW3D_PT_body_moments_cuts
    bpy.utils.unregister_class(inner)
    bpy.utils.register_class(inner)
"""
CUTS = f"import sys\ncuts = sys.modules['{PACKAGE}.blender.session.stored.cuts']\n"


def field(window, x, y):
    """Return the place of the dialog's number near the pointer, which Ctrl C over it copies."""
    manager = "bpy.context.window_manager"
    for up in range(-120, 240, 8):
        window.move(x - 60, y + up, "key", "ctrl+c")
        copied = window.ask(f"result = {manager}.clipboard\n{manager}.clipboard = '-'")
        if "250" in copied or "0.00025" in copied:
            return x - 60, y + up
    raise LookupError(window.output())


def test_level_of_a_volume_takes_three_clicks(window):
    window.ask(CUP + SHOW)
    window.open_tab("Moments")
    x, y = window.place("object.body_moments_level")
    window.press("object.body_moments_level")
    window.click(*field(window, x, y))
    window.type("ctrl+a", "1", "5", "0", "Return")  # cm³
    window.key("Return")
    window.wait(f"'{PACKAGE}.blender.session.stored.cuts' in __import__('sys').modules")
    window.point_at_view()
    window.picture("level-cup")
    level = CUTS + "level = cuts.level_of(bpy.data.objects['Cup'], bpy.context.scene)\n"
    assert window.ask(level + "result = level.volume") == pytest.approx(0.00015)
    window.press("object.body_moments_show_level")
    window.wait("'Cup Level' in bpy.data.objects")


def test_pit_below_its_rim(window):
    window.ask(PIT + SHOW)
    window.press("object.body_moments_cut_fill")
    window.redraw()
    window.picture("cut-fill-dialog")
    window.key("Return")
    memory = f"__import__('sys').modules['{PACKAGE}.blender.session.memory']"
    window.wait(f"bpy.data.objects['Pit'] in {memory}.cut_fills")
    window.ask("bpy.ops.object.body_moments_cut_fill(against='RIM')")
    window.point_at_view()
    window.picture("cut-fill-pit")
    found = window.get(f"{memory}.cut_fills[bpy.data.objects['Pit']].cut_fill.fill.total")
    assert found == pytest.approx(6 * 400 * (2 / 3) ** 2, rel=0.01)
