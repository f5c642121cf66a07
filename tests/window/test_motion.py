# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A floaty jump in the real window: its momentum from nothing is listed, and Put on Parabola takes it away."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = """
import sys
sys.path.insert(0, {!r})
from tests.blender.figure import figure
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
rig, body = figure()
root, scene = rig.pose.bones["root"], bpy.context.scene
scene.frame_start, scene.frame_end = 1, 32
for frame, place in ((1, (0, 0, 0)), (8, (0, 0, 0)), (16, (0, -0.9, 0.9)), (24, (0, -1.8, 0)), (32, (0, -1.8, 0))):
    root.location = place
    root.keyframe_insert("location", frame=frame)
scene.frame_set(1)
rig.data.display_type = "STICK"
view = area.spaces.active.region_3d
view.view_rotation = (0.50, 0.46, 0.50, 0.53)
view.view_location, view.view_distance = (0.0, -0.6, 1.0), 5.0
"""
CURVES = "bpy.data.objects['Figure'].animation_data.action.layers[0].strips[0].channelbags[0].fcurves"
EMPTY = "next(obj for obj in bpy.data.objects if 'body_balance_group' in obj)"


@pytest.fixture(scope="module")
def jump(window):
    window.ask(BUILD.format(str(ROOT)))
    window.open_tab("Moments")
    window.point_at_view()
    window.key("ctrl+Tab")
    window.wait("bpy.context.mode == 'POSE'")
    window.press("pose.body_moments_show_weight")
    return window


def test_floaty_jump_is_listed_and_a_click_goes_there(jump):
    window = jump
    window.press("pose.body_moments_bake_curves")
    window.wait("any('body_balance_group' in obj for obj in bpy.data.objects)")
    window.redraw()
    window.picture("motion")
    assert window.get(f"len({EMPTY}['body_balance_spans'])") == 4
    window.press("wm.context_set_int")
    window.wait("bpy.context.scene.frame_current > 8")


def test_parabola_explains_the_momentum(jump):
    window = jump
    window.press("pose.body_moments_parabola")
    window.key("Return")
    window.wait(f"len({CURVES}[2].keyframe_points) > 10")
    window.press("pose.body_moments_bake_curves")
    window.wait(f"'body_balance_spans' not in {EMPTY}")
    window.redraw()
    window.picture("motion-parabola")
    assert "Traceback" not in window.output()


def test_spin_is_keyed_and_the_path_is_traced(jump):
    window = jump
    window.press("pose.body_moments_keep_spin")
    window.key("Return")
    window.wait(f"any('rotation' in curve.data_path for curve in {CURVES})")
    window.press("pose.body_moments_trace")
    window.wait(f"'body_balance_momentum' not in {EMPTY}")
    assert "Traceback" not in window.output()
