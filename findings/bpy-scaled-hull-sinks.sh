#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) shrinks a convex hull by the collision margin of 0.04 before
# the object's scale, and Bullet adds the margin after it: a cube of scale (1, 1, 3) sinks 0.08 m
# into the floor; with the scale applied to its mesh, or with a margin of 0, it does not. Seen, in m:
# {'scaled': 0.08, 'meshed': 0.0, 'margin 0': 0.0}. So *Make Rigid Bodies* sets the margin of hulls
# to 0.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.13 -m venv env
env/bin/pip install -q bpy==5.2.3
env/bin/python - <<'PYTHON' 2> /dev/null
import bpy

depths = {}
for kind in ("scaled", "meshed", "margin 0"):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0, 0, 2))
    body = bpy.context.object
    body.scale.z = 3.0
    if kind == "meshed":
        bpy.ops.object.transform_apply(location=False)
    bpy.ops.rigidbody.object_add(type="ACTIVE")
    body.rigid_body.collision_shape = "CONVEX_HULL"
    if kind == "margin 0":
        body.rigid_body.use_margin, body.rigid_body.collision_margin = True, 0.0
    bpy.ops.mesh.primitive_plane_add(size=40.0)
    bpy.ops.rigidbody.object_add(type="PASSIVE")
    bpy.context.object.rigid_body.collision_shape = "CONVEX_HULL"
    for frame in range(1, 101):
        bpy.context.scene.frame_set(frame)
    depths[kind] = round(1.5 - body.matrix_world.translation.z, 3)
print("bpy", bpy.app.version_string, depths)
assert depths["scaled"] > 0.07 and abs(depths["meshed"]) < 0.002 and abs(depths["margin 0"]) < 0.002
PYTHON
