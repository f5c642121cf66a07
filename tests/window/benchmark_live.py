# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What Live and staleness cost a frame and a redraw, in a real window:

    blender --factory-startup --python tests/window/benchmark_live.py

It prints milliseconds of our handlers, of this thread's CPU, median and most of many, and says whether the numbers were
those of the frame. It asserts nothing: a busy machine is no failure. A character of 100,000 faces with Live on that an
armature deforms while it plays; 1,000 measured objects at rest, moved and played with Live off.
"""

import importlib.util
import math
import statistics
import sys
import time
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parent.parent.parent
COUNT = 316  # quads around and along the character
FRAMES = 60
seconds, differences = [], []


def load_package():
    spec = importlib.util.spec_from_file_location(
        "body_moments", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["body_moments"] = module
    spec.loader.exec_module(module)
    return module


load_package().register()

from body_moments.blender.session.live import live
from body_moments.blender.session.stored import results
from body_moments.blender.session.tracking import handlers

noted = handlers._note_update


def timed(*args, **options):
    start = time.thread_time()
    noted(*args, **options)
    seconds.append(time.thread_time() - start)


handlers._note_update = timed


def told(text):
    done = sorted(seconds)
    print(
        "{:s}: {:.2f} ms, at most {:.2f} ms, of {:d}".format(
            text, 1e3 * statistics.median(done), 1e3 * done[-1], len(done)
        ),
        flush=True,
    )
    seconds.clear()


def clear():
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.context.view_layer.update()


def character():
    """A closed tube of 100,000 quads on two bones, the upper of which swings."""
    i, j = np.meshgrid(np.arange(COUNT), np.arange(COUNT), indexing="ij")
    u, v = 2.0 * math.pi * i / COUNT, 2.0 * math.pi * j / COUNT
    points = np.stack([(2.0 + np.cos(v)) * np.cos(u), np.sin(v), (2.0 + np.cos(v)) * np.sin(u)], axis=-1)
    up, across = (i + 1) % COUNT, (j + 1) % COUNT
    faces = np.stack([i * COUNT + across, up * COUNT + across, up * COUNT + j, i * COUNT + j], axis=-1)
    mesh = bpy.data.meshes.new("Character")
    mesh.from_pydata(points.reshape(-1, 3).tolist(), [], faces.reshape(-1, 4).tolist())
    obj = bpy.data.objects.new("Character", mesh)
    bpy.context.scene.collection.objects.link(obj)
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    lower, upper = (rig.data.edit_bones.new(name) for name in ("Lower", "Upper"))
    lower.head, lower.tail, upper.tail = (0, 0, -3), (0, 0, 0), (0, 0, 3)
    upper.parent, upper.use_connect = lower, True
    bpy.ops.object.mode_set(mode="OBJECT")
    heights = points.reshape(-1, 3)[:, 2]
    for name, weights in (("Lower", heights < 0.0), ("Upper", heights >= 0.0)):
        group = obj.vertex_groups.new(name=name)
        group.add(np.flatnonzero(weights).tolist(), 1.0, "REPLACE")
    obj.modifiers.new("Armature", "ARMATURE").object = rig
    bone = rig.pose.bones["Upper"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((1, 0.0), (FRAMES, 0.6)):
        bone.rotation_euler.x = angle
        bone.keyframe_insert("rotation_euler", frame=frame)
    return obj


def difference(obj, scene, depsgraph):
    """How far volume and center that are shown are from those of a full measurement, of the size."""
    shown, truth = results.in_world(obj, scene), live.measure_body(obj, depsgraph).measurement
    apart = np.linalg.norm(shown.body.center - truth.mass_properties.center)
    return max(abs(shown.volume / truth.volume - 1.0), apart / truth.mass_properties.radii_of_gyration.max())


def compare(scene, depsgraph):
    differences.append(difference(bpy.data.objects["Character"], scene, depsgraph))


def played():
    clear()
    scene, obj = bpy.context.scene, character()
    scene.frame_end = FRAMES
    scene.frame_set(1)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.body_moments_live()
    print("full measurement: {:.0f} ms".format(1e3 * live.current_numbers(obj).seconds))
    seconds.clear()
    worst = 0.0
    for frame in range(2, FRAMES, 6):
        scene.frame_set(frame)
        worst = max(worst, difference(obj, scene, bpy.context.evaluated_depsgraph_get()))
    told("character of {:d} faces, a frame with Live".format(COUNT * COUNT))
    print("volume and center of these frames are right to {:.1e} of the size".format(worst), flush=True)
    bpy.app.handlers.frame_change_post.append(compare)  # after ours, and not counted
    bpy.ops.screen.animation_play()


def stopped():
    bpy.ops.screen.animation_cancel()
    bpy.app.handlers.frame_change_post.remove(compare)
    told("the same, played in the window")
    print("of {:d} played frames, right to {:.1e} of the size".format(len(differences), max(differences)), flush=True)


def settled():
    obj = bpy.data.objects["Character"]
    print("lag some seconds after the end: {!r}".format(str(live.lag(obj))), flush=True)


def many():
    clear()
    bpy.ops.mesh.primitive_cube_add()
    first = bpy.context.object
    objects = [first]
    for number in range(1, 1000):
        obj = bpy.data.objects.new(str(number), first.data.copy())
        bpy.context.scene.collection.objects.link(obj)
        obj.location = (3 * (number % 32), 3 * (number // 32), 0)
        objects.append(obj)
    bpy.context.view_layer.update()
    for obj in objects:
        obj.select_set(True)
    bpy.ops.object.body_moments_measure()
    bpy.context.view_layer.update()
    seconds.clear()
    for _ in range(12):
        for obj in objects:
            obj.location.z += 0.1
        bpy.context.view_layer.update()
    told("1000 measured objects moved")
    for obj in objects[::2]:
        for frame, height in ((1, 0.0), (FRAMES, 5.0)):
            obj.location.z = height
            obj.keyframe_insert("location", frame=frame)
    for obj in objects[1::2]:
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="Key")
        key.data[0].co.x -= 1.0
        for frame, value in ((1, 0.0), (FRAMES, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
    seconds.clear()
    for frame in range(2, FRAMES):
        bpy.context.scene.frame_set(frame)
    told("1000 measured objects, half of them reshaped and half moved, a frame with Live off")
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    seconds.append(0.0)
    told("our handlers while the window is redrawn and nothing changes")
    bpy.ops.wm.quit_blender()


STEPS = [(2.0, played), (12.0, stopped), (4.0, settled), (0.1, many)]


def run():
    _, step = STEPS.pop(0)
    step()
    return STEPS[0][0] if STEPS else None


bpy.app.timers.register(run, first_interval=STEPS[0][0])
