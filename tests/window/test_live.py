# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a NURBS object follow its control points while they are dragged, and go back with them."""

import math

import pytest

SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.context.scene.unit_settings.scale_length = 1.0
bpy.ops.surface.primitive_nurbs_surface_torus_add()
bpy.ops.view3d.view_selected()
"""
MODULE = "__import__('sys').modules['bl_ext.user_default.body_moments.blender.session.live.following']"
LIVE = MODULE + ".current_numbers(bpy.context.object)"
VOLUME = f"getattr({LIVE}, 'measurement', None) and {LIVE}.measurement.volume"
TORUS = 2.0 * math.pi**2 * 0.75 * 0.0625 * (1.0 - 1.9e-7)


def test_live_numbers_follow_drag_escape_undo_and_animation(window):
    def follows(factor):
        window.wait(f"abs(({VOLUME} or 0.0) / {TORUS * factor} - 1.0) <= 1e-6")

    window.ask(SCENE)
    window.open_tab("Moments")
    window.press("object.body_moments_live")
    follows(1.0)
    window.ask(
        "bpy.ops.object.mode_set(mode='EDIT')\nbpy.ops.curve.select_all(action='SELECT')\n"
        "bpy.ops.ed.undo_push(message='Edit')"
    )
    window.point_at_view()
    window.type("s", "2")
    follows(8.0)  # while it is dragged
    window.key("Escape")
    follows(1.0)
    window.type("s", "3")
    follows(27.0)
    window.type("Return")
    follows(27.0)
    window.redraw()
    window.picture("live")
    window.type("ctrl+z")
    follows(1.0)
    window.ask("bpy.ops.object.mode_set(mode='OBJECT')")
    window.ask(
        "obj = bpy.context.object\nfor frame, size in ((1, 1.0), (21, 3.0)):\n"
        "    obj.scale = (size, 1.0, 1.0)\n    obj.keyframe_insert('scale', frame=frame)"
    )
    window.ask("bpy.context.scene.frame_set(21)")
    follows(3.0)
    assert "body_volume" not in window.get("list(bpy.context.object.keys())")
    assert window.get(VOLUME) == pytest.approx(3.0 * TORUS, rel=1e-6)
