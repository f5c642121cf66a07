#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) never lets a compound of one convex hull rest on a plane
# whose collision shape is Mesh: it rocks by centimeters. On the same plane as Convex Hull it rests.
# Seen over frames 200 to 250, in m: {'MESH': above 0.03, 'CONVEX_HULL': below 1e-6}. So *Make Rigid
# Bodies* gives flat convex floors their hull.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.13 -m venv env
env/bin/pip install -q bpy==5.2.3
env/bin/python - <<'PYTHON' 2> /dev/null
import bpy

travel = {}
for shape in ("MESH", "CONVEX_HULL"):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0, 0, 3), rotation=(0.2, 0.1, 0.3))
    body = bpy.context.object
    bpy.ops.rigidbody.object_add(type="ACTIVE")
    body.rigid_body.collision_shape = "COMPOUND"
    bpy.ops.mesh.primitive_cube_add(size=1.0)
    part = bpy.context.object
    part.parent = body
    bpy.ops.rigidbody.object_add(type="ACTIVE")
    part.rigid_body.collision_shape = "CONVEX_HULL"
    bpy.ops.mesh.primitive_plane_add(size=40.0)
    bpy.ops.rigidbody.object_add(type="PASSIVE")
    bpy.context.object.rigid_body.collision_shape = shape
    heights = []
    for frame in range(1, 251):
        bpy.context.scene.frame_set(frame)
        heights.append(body.matrix_world.translation.z)
    travel[shape] = max(heights[199:]) - min(heights[199:])
print("bpy", bpy.app.version_string, travel)
assert travel["MESH"] > 0.03 and travel["CONVEX_HULL"] < 1e-6
PYTHON
