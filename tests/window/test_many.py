# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many parts in the window: Esc leaves nothing half-written, and masses follow their densities at once."""

import pytest

from tests.close import close

COUNT = 1000
SCENE = f"""
import random
random.seed(1)
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
for number in range({COUNT}):
    mesh = bpy.data.meshes.new("Part")
    a, b, c = (random.uniform(0.5, 1.5) for _ in range(3))
    corners = [(x * a, y * b, z * c + 0.1 * x * y) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], sides)
    obj = bpy.data.objects.new("Part", mesh)
    obj.location = (3 * (number % 60), 3 * (number // 60), 0)
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
bpy.context.view_layer.objects.active = obj
bpy.context.view_layer.update()
bpy.ops.ed.undo_push(message="Parts")
"""
RUNNING = "[op.bl_idname for op in window.modal_operators if 'body_moments' in op.bl_idname.lower()]"
MEASURED = "sum('body_mass' in obj for obj in bpy.data.objects)"
MASS = "sum(obj['body_mass'] for obj in bpy.data.objects)"


@pytest.fixture(scope="module")
def parts(window):
    window.ask(SCENE, limit=200.0)
    window.open_tab("Moments")
    window.redraw()
    return window


def test_esc_during_measure_leaves_nothing(parts):
    window = parts
    window.point_at_view()
    window.ask("bpy.ops.object.body_moments_measure('INVOKE_DEFAULT')")
    window.key("Escape")
    window.wait("not " + RUNNING, limit=200.0)
    assert window.get(MEASURED) == 0
    window.ask("bpy.ops.object.body_moments_measure('INVOKE_DEFAULT', True)")
    window.wait("not " + RUNNING, limit=200.0)
    assert window.get(MEASURED) == COUNT
    window.redraw()
    window.picture("many-measured")
    mass = window.get(MASS)
    window.ask("for obj in bpy.context.selected_objects:\n    obj.body_moments.density = 2000.0", limit=200.0)
    window.redraw()
    assert close(window.get(MASS), 2.0 * mass, 1e-12)


def test_esc_during_rigid_body_masses_changes_no_object(parts):
    window = parts
    window.point_at_view()
    window.ask("bpy.ops.object.body_moments_set_rigid_body_mass('INVOKE_DEFAULT', True, add=True, axes=True)")
    window.key("Escape")
    window.wait("not " + RUNNING, limit=200.0)
    assert window.get("sum(obj.rigid_body is not None for obj in bpy.data.objects)") == 0
    assert window.get("[tuple(obj.rotation_euler) for obj in bpy.data.objects if any(obj.rotation_euler)]") == []
