# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay costs a redraw, in a real window:

    blender --factory-startup --python tests/window/benchmark.py

It prints milliseconds a redraw, median and most of many: of our Python, and of the GPU's calls that it makes (which a
software renderer makes slow). It asserts nothing: a busy machine is no failure.
Measured objects of 10,000 faces each, all drawn, by Blender as their bounds: at rest, while the view turns, while one
of them moves. Milliseconds are those of this thread's CPU, so a busy machine counts little.
"""

import importlib.util
import statistics
import sys
import time
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parent.parent.parent
REDRAWS = 12
seconds, drawing = [], []


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

drawn, draw_batch = overlay.draw, overlay._draw_batch


def timed():
    start = time.thread_time()
    drawing.append(0.0)
    drawn()
    seconds.append(time.thread_time() - start - drawing[-1])


def timed_batch(batch, shader):
    start = time.thread_time()
    draw_batch(batch, shader)
    drawing[-1] += time.thread_time() - start


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


def report(name, change=lambda step: None):
    """Redraw many times, with a change before each."""
    change(0)
    bpy.ops.wm.redraw_timer(type="DRAW", iterations=1)
    seconds.clear()
    drawing.clear()
    for step in range(REDRAWS):
        change(step + 1)
        bpy.ops.wm.redraw_timer(type="DRAW", iterations=1)
    values = statistics.median(seconds), max(seconds), statistics.median(drawing)
    print("{:20s} {:8.3f} ms {:8.3f} ms at most {:8.3f} ms of the GPU".format(name, *(1e3 * value for value in values)))


def run():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    overlay.unregister()
    overlay.draw, overlay._draw_batch = timed, timed_batch
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
            report("  at rest")
            report("  the view moves", turn)
            report("  an object moves", move)
    sys.stdout.flush()
    bpy.ops.wm.quit_blender()


bpy.app.timers.register(run, first_interval=2.0)
