#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) draws a rigid body of negative scale as its mirror image
# from the second frame of the simulation on. Seen: determinants of the matrix in frames 1 and 2,
# {1: -2.0, 2: 2.0}. So *Make Rigid Bodies* applies a scale that mirrors.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.13 -m venv env
env/bin/pip install -q bpy==5.2.3
env/bin/python - <<'PYTHON' 2> /dev/null
import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_cone_add(location=(0, 0, 5))
body = bpy.context.object
body.scale = (-2.0, 1.0, 1.0)
bpy.ops.rigidbody.object_add(type="ACTIVE")
signs = {}
for frame in (1, 2):
    bpy.context.scene.frame_set(frame)
    signs[frame] = round(body.matrix_world.determinant(), 3)
print("bpy", bpy.app.version_string, signs)
assert signs == {1: -2.0, 2: 2.0}
PYTHON
