# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The animated picture of the docs, taken from the real window while a person's hands are imitated:

    .envs/blender-5.2/bin/python -m tests.window.record_live OUTPUT.png

A tower with Live on leans more and more while its top is dragged in Edit Mode; center, axes and numbers follow. It is
an animated PNG of some 0.3 MB.
"""

import sys
import tempfile
import zipfile
from pathlib import Path

from tests.package import extension
from tests.window import harness, png

ROOT = Path(__file__).resolve().parent.parent.parent
STEPS = 14  # Steps of the drag.
PIXELS = 9  # to the right in each
SCENE = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.context.preferences.view.show_splash = False
bpy.ops.mesh.primitive_cube_add(size=2.0, location=(0.0, 0.0, 2.0))
tower = bpy.context.object
tower.name, tower.scale.z = "Tower", 2.0
bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
bpy.ops.object.body_moments_measure()
bpy.ops.object.body_moments_live()
bpy.ops.object.mode_set(mode="EDIT")
import bmesh
mesh = bmesh.from_edit_mesh(tower.data)
for vertex in mesh.verts:
    vertex.select_set(vertex.co.z > 0.0)
mesh.select_flush_mode()
bmesh.update_edit_mesh(tower.data)
view = area.spaces.active.region_3d
from mathutils import Euler
view.view_rotation = Euler((1.25, 0.0, 0.35)).to_quaternion()
view.view_perspective, view.view_distance = "ORTHO", 12.0
view.view_location = (1.3, 0.0, 1.9)
area.spaces.active.show_region_toolbar = False
"""
LIVE = "__import__('sys').modules['bl_ext.user_default.body_moments.blender.session.live.following']"
CURRENT = f"not {LIVE}.followed[bpy.context.object].is_pending"  # Blender draws slowly without a graphics card
CROP = (slice(80, 700), slice(300, 1300))  # rows and columns of the window


def record(blender: str, output: Path) -> None:
    """Start Blender with the add-on in a folder of its own, drag, and write the animation."""
    with tempfile.TemporaryDirectory() as folder:
        user, file, log = Path(folder) / "user", Path(folder) / "empty.blend", Path(folder) / "blender.log"
        home = user / "extensions" / "user_default"
        home.mkdir(parents=True)
        archive = extension.build(ROOT, Path(folder) / "dist")
        with zipfile.ZipFile(archive) as packed:
            packed.extractall(home / "body_moments")
        with harness.Window(blender, user, file, log, Path(folder)) as window:
            frames = drag(window)
    seconds = [1.0, *[0.12] * (len(frames) - 2), 2.0]
    png.write_animation(output, frames, seconds)
    print(f"{output}: {len(frames)} frames, {output.stat().st_size / 1e6:.2f} MB")


def drag(window: harness.Window) -> list:
    """Grab the tower's top along X, and take a picture after each step of the mouse."""
    window.ask(f"import addon_utils\naddon_utils.enable('bl_ext.user_default.body_moments', default_set=True)\n{SCENE}")
    window.point_at_view()
    window.type("Escape")  # the splash screen
    window.open_tab("Moments")
    window.point_at_view()
    x, y, width, height = window.region("WINDOW")
    start = x + width * 0.3, y + height * 0.2
    window.redraw()
    frames = [window.pixels("frame")[CROP]]
    window.type("g", "x")
    for step in range(1, STEPS + 1):
        window.move(start[0] + PIXELS * step, start[1])
        window.get("True")
        window.wait(CURRENT)
        window.redraw()
        frames.append(window.pixels("frame")[CROP])
    window.key("Return")
    return frames


if __name__ == "__main__":
    record(harness.blender_command() or sys.exit("no real Blender"), Path(sys.argv[1]))
