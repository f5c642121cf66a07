# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A floaty jump in the real window: its momentum from nothing is listed, and Put on Parabola takes
it away.
"""

import os

import pytest

from tests.window.conftest import FIGURE, open_window

JUMP = """
root, hips, scene = rig.pose.bones["root"], rig.pose.bones["hips"], bpy.context.scene
scene.frame_start, scene.frame_end = 1, 32
places = {1: (0, 0, 0), 8: (0, 0, 0), 16: (0, -0.9, 0.9), 24: (0, -1.8, 0), 32: (0, -1.8, 0)}
for frame, place in places.items():
    root.location = place
    root.keyframe_insert("location", frame=frame)
lows, swings = (0, -0.25, 0, 0, 0, -0.25, 0), (-1.2, -1.0, -0.6, 0.7, -0.6, -1.0, -1.2)
for frame, low, swing in zip((1, 5, 8, 16, 24, 27, 32), lows, swings):
    hips.location.y = low
    hips.keyframe_insert("location", frame=frame)
    for name, sign in (("arm.L", 1), ("arm.R", -1)):
        rig.pose.bones[name].rotation_euler.x = swing
        rig.pose.bones[name].keyframe_insert("rotation_euler", frame=frame)
scene.frame_set(1)
view.view_rotation = (0.50, 0.46, 0.50, 0.53)
view.view_location, view.view_distance = (0.0, -0.6, 1.0), 5.0
"""
CURVES = (
    "bpy.data.objects['Figure'].animation_data.action.layers[0].strips[0].channelbags[0].fcurves"
)
EMPTY = "next(obj for obj in bpy.data.objects if 'body_balance_group' in obj)"


@pytest.fixture(scope="module")
def jump(window):
    window.ask(FIGURE + JUMP)
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
    window.picture("motion")
    assert window.get(f"len({EMPTY}['body_balance_spans'])") == 4
    window.choose("VIEW3D_MT_body_moments_spans", "wm.context_set_int")
    window.wait("bpy.context.scene.frame_current > 8")


def test_parabola_explains_the_momentum(jump):
    window = jump
    window.press("pose.body_moments_parabola")
    window.picture("motion-dialog")
    window.key("Return")
    window.wait(f"len({CURVES}[2].keyframe_points) > 10")
    window.wait(f"'body_balance_spans' not in {EMPTY}")
    found = "bpy.context.window_manager.operators[-1].properties"
    assert window.get(f"({found}.take_off, {found}.landing)") == [8, 24]
    window.picture("motion-parabola")


def test_spin_is_keyed_and_the_path_is_traced(jump):
    window = jump
    window.press("pose.body_moments_keep_spin")
    window.key("Return")
    window.wait(f"any('rotation' in curve.data_path for curve in {CURVES})")
    window.press("pose.body_moments_trace")
    window.wait(f"'body_balance_momentum' not in {EMPTY}")


@pytest.mark.skipif(
    "BODY_MOMENTS_FILM" not in os.environ,
    reason="needs BODY_MOMENTS_FILM: makes the film, in minutes",
)
def test_jump_is_filmed_floaty_and_falling(run_blender, cube_file, tmp_path):
    """Ten seconds for docs/weight.md, left among the artefacts as jump.webp."""
    image = pytest.importorskip("PIL.Image")
    with open_window(run_blender, cube_file, tmp_path) as window:
        window.ask(FIGURE + JUMP)
        window.ask(
            "view = area.spaces.active.region_3d\nview.view_location.y, view.view_distance = "
            "-0.65, 4.6"
        )
        window.ask("bpy.context.preferences.system.viewport_aa = '8'")
        window.open_tab("Moments")
        window.point_at_view()
        window.key("ctrl+Tab")
        window.wait("bpy.context.mode == 'POSE'")
        window.press("pose.body_moments_show_weight")
        files = []
        for part in ("floaty", "falling"):
            window.open_tab("Moments")
            if part == "falling":
                window.press("pose.body_moments_parabola")
                window.key("Return")
                window.wait(f"len({CURVES}[2].keyframe_points) > 10")
            window.press("pose.body_moments_bake_curves")
            window.wait("any('body_balance_group' in obj for obj in bpy.data.objects)")
            window.wait(f"('body_balance_spans' in {EMPTY}) == {part == 'floaty'}")
            window.ask("area.spaces.active.show_region_ui = False")
            window.point_at_view()
            for frame in range(1, 33):
                window.ask(f"bpy.context.scene.frame_set({frame})")
                files.append(window.picture(f"film-{part}-{frame:02d}", "png"))
    several = [
        image.open(file).convert("RGB").crop((60, 130, 820, 690)).resize((570, 420))
        for file in files
    ]
    film, milliseconds = files[0].with_name("jump.webp"), [*[150] * 31, 350] * 2
    several[0].save(
        film, save_all=True, append_images=several[1:], duration=milliseconds, loop=0, quality=60
    )
    assert film.stat().st_size <= 700_000
