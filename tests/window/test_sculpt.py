# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strokes of a brush with Live on: the numbers lag while it is drawn, say so, and are right when it stops."""

import pytest

SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
bpy.ops.view3d.view_selected()
bpy.ops.object.body_moments_measure()
bpy.ops.object.body_moments_live()
bpy.ops.object.mode_set(mode="SCULPT")
"""
SESSION = "__import__('sys').modules['bl_ext.user_default.body_moments.blender.session.{}']"
LIVE, STALENESS, RESULTS = (SESSION.format(name) for name in ("live.following", "tracking.staleness", "displayed"))
SPHERE = "bpy.context.object"
VOLUME = f"{LIVE}.current_numbers({SPHERE}).measurement.volume"
TRUTH = f"import bmesh\nb = bmesh.new()\nb.from_mesh({SPHERE}.data)\nresult = b.calc_volume()\nb.free()"


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
    lag = window.get(f"str({LIVE}.lag({SPHERE}))")
    window._xdotool("mouseup", 1)
    return lag


def test_numbers_follow_a_stroke_when_it_stops(window):
    window.ask(SCENE)
    before = window.get(VOLUME)
    assert stroke(window) == "behind"
    window.wait(f"not {LIVE}.lag({SPHERE}) and {VOLUME} != {before!r}")
    truth = window.ask(TRUTH)
    assert abs(truth / before - 1.0) > 1e-5
    assert window.get(VOLUME) == pytest.approx(truth, rel=1e-6)
    assert window.ask(f"result = {STALENESS}.stale_reason({SPHERE}, bpy.context.scene)") == "Geometry changed"
    window.ask("bpy.ops.object.mode_set(mode='OBJECT')")
    assert "Traceback" not in window.output()


def test_dynamic_topology_is_refused_as_its_mesh_cannot_be_seen(window):
    """The mesh that is drawn is then Sculpt Mode's own: numbers of the object's mesh are not those of what is seen."""
    window.ask(SCENE)
    window.open_tab("Moments")
    window.ask("bpy.ops.sculpt.dynamic_topology_toggle()")
    window.wait(f"{SPHERE}.use_dynamic_topology_sculpting")
    stroke(window)
    window.wait(f"{LIVE}.current_numbers({SPHERE}).refusal is not None")
    assert window.get(f"{LIVE}.current_numbers({SPHERE}).refusal.code") == "sculpted_mesh"
    window.press("object.body_moments_measure")
    window.wait(f"{RESULTS}.failure({SPHERE}) is not None")
    assert "Dyntopo" in window.get(f"str({RESULTS}.failure({SPHERE}))")
    window.redraw()
    window.picture("sculpt-dyntopo")
    window.ask("bpy.ops.object.mode_set(mode='OBJECT')")
    truth = window.ask(TRUTH)
    window.press("object.body_moments_measure")
    window.wait(f"{STALENESS}.stale_reason({SPHERE}, bpy.context.scene) is None")
    assert window.get(VOLUME) == pytest.approx(truth, rel=1e-6)
    assert "Traceback" not in window.output()
