# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A human figure in the real window: from its pose to a balanced one with a key and two clicks."""

import pytest

from tests.window.conftest import FIGURE

POSE = """
rig.pose.bones["spine"].rotation_euler = 0.55, 0.0, 0.15
rig.pose.bones["arm.L"].rotation_euler = 0.0, 0.0, 0.9
view.view_rotation = (0.80, 0.46, 0.17, 0.33)
view.view_location, view.view_distance = (0.35, 0.0, 0.75), 3.0
"""
RIG = "bpy.data.objects['Figure']"


@pytest.fixture(scope="module")
def figure(window):
    window.ask(FIGURE + POSE)
    window.open_tab("Moments")
    return window


def test_figure_is_balanced_with_one_key_and_two_clicks(figure):
    window = figure
    window.point_at_view()
    window.key("ctrl+Tab")
    window.wait("bpy.context.mode == 'POSE'")
    window.press("pose.body_moments_show_weight")
    window.wait(f"{RIG}.body_moments_weight.show")
    window.picture("weight-shown")
    assert window.get(f"tuple({RIG}.pose.bones['hips'].location)") == [0.0, 0.0, 0.0]
    window.press("pose.body_moments_balance_pose")
    window.wait(f"any({RIG}.pose.bones['hips'].location)")
    window.picture("weight")


def test_one_undo_takes_the_balance_back(figure):
    window = figure
    window.undo()
    window.wait(f"not any({RIG}.pose.bones['hips'].location)")
    assert window.get(f"{RIG}.body_moments_weight.show")
    window.picture("weight-undone")


def test_weight_follows_a_bone_that_is_dragged(figure):
    window = figure
    window.ask(
        f"bone = {RIG}.pose.bones['spine']\n{RIG}.data.bones.active = bone.bone\nbone.select = True"
    )
    window.point_at_view()
    window.key("r")
    x, y, width, height = window.region("WINDOW")
    window.move(x + width * 0.6, y + height * 0.6)
    window.picture("weight-dragged")
    window.key("Escape")
    window.wait(f"abs({RIG}.pose.bones['spine'].rotation_euler.x - 0.55) < 1e-6")
