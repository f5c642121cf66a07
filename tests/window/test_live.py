# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Live numbers by mouse and keys: they follow the control points of a NURBS object while they are
dragged, lag behind strokes of a brush and say so, and go back with them.
"""

import math

import pytest

TORUS_SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.context.scene.unit_settings.scale_length = 1.0
bpy.ops.surface.primitive_nurbs_surface_torus_add()
bpy.ops.view3d.view_selected()
"""
SESSION = "__import__('sys').modules['bl_ext.user_default.body_moments.blender.session.{}']"
LIVE = SESSION.format("memory") + ".followed.get(bpy.context.object)"
TORUS_VOLUME = f"getattr({LIVE}, 'measurement', None) and {LIVE}.measurement.volume"
TORUS = 2.0 * math.pi**2 * 0.75 * 0.0625 * (1.0 - 1.9e-7)


def test_live_numbers_follow_drag_escape_undo_and_animation(window):
    def follows(factor):
        window.wait(f"abs(({TORUS_VOLUME} or 0.0) / {TORUS * factor} - 1.0) <= 1e-6")

    window.ask(TORUS_SCENE)
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
    assert window.get(TORUS_VOLUME) == pytest.approx(3.0 * TORUS, rel=1e-6)


def test_live_numbers_follow_a_face_that_is_dragged(window):
    window.ask(TOWER_SCENE)
    window.point_at_view()
    window.type("g", "z", "2")
    window.wait(f"abs({LIVE}.measurement.volume - 16.0) <= 1e-5")
    window.picture("live")
    window.key("Return")


TOWER_SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.ops.mesh.primitive_cube_add(location=(0, 0, 1))
bpy.context.object.name = "Tower"
view = area.spaces.active.region_3d
view.view_location, view.view_distance = (0.8, 0.0, 1.6), 11.0
bpy.ops.object.body_moments_live()
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.select_mode(type="FACE")
bpy.ops.mesh.select_all(action="DESELECT")
mesh = __import__("bmesh").from_edit_mesh(bpy.context.object.data)
max(mesh.faces, key=lambda face: face.calc_center_median().z).select_set(True)
mesh.select_flush(True)
"""
SPHERE_SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
bpy.ops.view3d.view_selected()
bpy.ops.object.body_moments_measure()
bpy.ops.object.body_moments_live()
bpy.ops.object.mode_set(mode="SCULPT")
"""
MAPPING, STALENESS, OUTCOME = (
    SESSION.format(name) for name in ("live.mapping", "tracking.staleness", "stored.outcome")
)
SPHERE = "bpy.context.object"
VOLUME = f"{LIVE}.measurement.volume"
TRUTH = (
    f"import bmesh\nb = bmesh.new()\nb.from_mesh({SPHERE}.data)\nresult = b.calc_volume()\nb.free()"
)


def stroke(window):
    """Draw across the sphere; how far the numbers lag before the button is released."""
    x, y, width, height = window.region("WINDOW")
    x, y = x + width / 2, y + height / 2
    window.move(x - 60, y)
    window.get("True")
    window._xdotool("mousedown", 1)
    for step in range(8):
        window.move(x - 60 + 15 * step, y + 8 * step)
        window.get("True")
    lag = window.get(f"str({MAPPING}.lag({SPHERE}))")
    window._xdotool("mouseup", 1)
    return lag


def test_numbers_follow_a_stroke_when_it_stops(window):
    window.ask(SPHERE_SCENE)
    before = window.get(VOLUME)
    assert stroke(window) == "behind"
    window.wait(f"not {MAPPING}.lag({SPHERE}) and {VOLUME} != {before!r}")
    truth = window.ask(TRUTH)
    assert abs(truth / before - 1.0) > 1e-5
    assert window.get(VOLUME) == pytest.approx(truth, rel=1e-6)
    assert (
        window.ask(f"result = {STALENESS}.stale_reason({SPHERE}, bpy.context.scene)")
        == "Geometry changed"
    )
    window.ask("bpy.ops.object.mode_set(mode='OBJECT')")


def test_dynamic_topology_is_refused(window):
    """The mesh that is drawn is then Sculpt Mode's own: numbers of the object's mesh are not those
    of what is seen.
    """
    window.ask(SPHERE_SCENE)
    window.open_tab("Moments")
    window.ask("bpy.ops.sculpt.dynamic_topology_toggle()")
    window.wait(f"{SPHERE}.use_dynamic_topology_sculpting")
    stroke(window)
    window.wait(f"{LIVE}.refusal is not None")
    assert window.get(f"{LIVE}.refusal.code") == "sculpted_mesh"
    window.press("object.body_moments_measure")
    window.wait(f"{OUTCOME}.last() is not None")
    assert "Dyntopo" in window.get(f"str({OUTCOME}.last().groups[0].finding)")
    window.picture("sculpt-dyntopo")
    window.ask("bpy.ops.object.mode_set(mode='OBJECT')")
    truth = window.ask(TRUTH)
    window.press("object.body_moments_measure")
    window.wait(f"{STALENESS}.stale_reason({SPHERE}, bpy.context.scene) is None")
    assert window.get(VOLUME) == pytest.approx(truth, rel=1e-6)
