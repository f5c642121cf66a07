# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay costs a redraw, in a real window:

    blender --factory-startup --python tests/window/benchmark.py

It prints milliseconds of our Python a redraw, median and most of many, of this thread's CPU, so a busy machine counts
little. The GPU's drawing of the batches is left out: a software renderer makes it slow. It asserts nothing.
Measured objects of 10,000 faces each, all drawn, by Blender as their bounds: at rest, while the view turns, while one
of them moves.
"""

import importlib.util
import statistics
import sys
import time
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parent.parent.parent
REDRAWS = 6
AT_REST = 200  # redraws between two looks at the clock
seconds, repeated = [], 1


def load_package():
    spec = importlib.util.spec_from_file_location(
        "body_moments", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["body_moments"] = module
    spec.loader.exec_module(module)
    return module


load_package().register()

from body_moments.panels.overlay import draw as overlay

drawn = overlay.draw


def timed():
    """Draw as often as what nothing changes is drawn to be timed, and note the time of one."""
    start = time.thread_time()
    for _ in range(repeated):
        drawn()
    seconds.append((time.thread_time() - start) / repeated)


def build(count):
    """Measured spheres of 10,000 faces, in rows."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=100, ring_count=100)
    first = bpy.context.object
    mesh, first.display_type = first.data, "BOUNDS"
    for place in range(count):
        obj = first.copy() if place else first
        if place:
            bpy.context.collection.objects.link(obj)
        obj.location = 3.0 * (place % 40), 3.0 * (place // 40), 0.0
        obj.rotation_euler = 0.1 * place, 0.2 * place, 0.0
    bpy.ops.object.select_all(action="DESELECT")
    first.select_set(True)
    bpy.ops.object.body_moments_measure()
    for obj in bpy.data.objects:
        for key in list(first.keys()):
            obj[key] = first[key]
    bpy.context.scene.body_moments.overlay.show_all = True
    return len(mesh.polygons)


def report(name, change=lambda step: None, count=1):
    """Redraw many times, with a change before each."""
    global repeated
    repeated = 1
    change(0)
    bpy.ops.wm.redraw_timer(type="DRAW", iterations=1)
    seconds.clear()
    repeated = count
    for step in range(REDRAWS):
        change(step + 1)
        bpy.ops.wm.redraw_timer(type="DRAW", iterations=1)
    values = statistics.median(seconds), max(seconds)
    print("{:20s} {:8.3f} ms {:8.3f} ms at most".format(name, *(1e3 * value for value in values)), flush=True)


def run():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    overlay.unregister()
    overlay.draw, overlay._draw_batch = timed, lambda batch, shader: None
    overlay.register()
    with bpy.context.temp_override(window=window, area=area, region=region):
        for count in (100, 1000):
            faces = build(count)
            view = area.spaces.active.region_3d
            view.view_distance = 60.0

            def turn(step, view=view):
                view.view_location.x = 0.01 * step

            def move(step):
                bpy.context.view_layer.objects.active.location.z = 0.01 * step
                bpy.context.view_layer.update()

            print("{:d} objects of {:d} faces".format(count, faces))
            report("  at rest", count=AT_REST)
            report("  the view moves", turn)
            report("  an object moves", move)
    bpy.ops.wm.quit_blender()


bpy.app.timers.register(run, first_interval=2.0)
