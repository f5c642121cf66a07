# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A search goes on while the window lives, and Esc ends it."""

import pytest

SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.context.scene.body_moments_search.found.clear()
for i in range(12):
    bpy.ops.mesh.primitive_torus_add(major_segments=160, minor_segments=96, location=(3 * i, 0, 0))
"""
START = "bpy.ops.object.body_moments_find_similar('INVOKE_DEFAULT')"
OVER = "not [op for op in window.modal_operators if 'SIMILAR' in op.bl_idname.upper()]"
FOUND = "len(bpy.context.scene.body_moments_search.found)"
SELECTED = "len(bpy.context.selected_objects)"


@pytest.mark.parametrize("escape", [True, False])
def test_esc_ends_a_search_and_leaves_nothing(window, escape):
    window.ask(SCENE)
    window.ask(START)
    window.point_at_view()
    if escape:
        window.key("Escape")
    window.wait(OVER, limit=480.0)
    assert window.get(FOUND) == (0 if escape else 11)
    assert window.get(SELECTED) == (1 if escape else 12)
