#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) clamps a weight of a glTF's morph target at 10, the limit of
# its shape keys, and an animated one at the larger of 1 and its first key. Seen, for weights of 20,
# and of 4 after a first key of 0: [10.0, 1.0]. So our import reads the weights of the file itself.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.13 -m venv env
env/bin/pip install -q bpy==5.2.3
env/bin/python - <<'PYTHON' 2> /dev/null
import base64
import json
import struct

import bpy

corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
moves = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 0, 0)
keys = struct.pack("<4f", 0, 1, 0, 4)
uri = "data:application/octet-stream;base64," + base64.b64encode(corners + moves + keys).decode()
views = [(0, 36), (36, 36), (72, 8), (80, 8)]
vector = {"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}
scalar = {"componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]}
values = {"componentType": 5126, "count": 2, "type": "SCALAR"}
part = {"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}
file = {
    "asset": {"version": "2.0"},
    "buffers": [{"byteLength": 88, "uri": uri}],
    "bufferViews": [{"buffer": 0, "byteOffset": a, "byteLength": n} for a, n in views],
    "accessors": [
        {"bufferView": number, **accessor}
        for number, accessor in enumerate((vector, vector, scalar, values))
    ],
    "meshes": [{"primitives": [part], "weights": [20]}],
    "nodes": [{"mesh": 0}],
    "scenes": [{"nodes": [0]}],
    "scene": 0,
}
channel = {"sampler": 0, "target": {"node": 0, "path": "weights"}}
animation = {"samplers": [{"input": 2, "output": 3}], "channels": [channel]}
moving = file | {"animations": [animation], "meshes": [{"primitives": [part], "weights": [0]}]}
seen = []
for content, frame in ((file, 0), (moving, 24)):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with open("a.gltf", "w") as out:
        json.dump(content, out)
    bpy.ops.import_scene.gltf(filepath="a.gltf")
    bpy.context.scene.frame_set(frame)
    (keys,) = bpy.data.shape_keys
    seen.append(keys.key_blocks[1].value)
print("bpy", bpy.app.version_string, seen)
assert seen == [10.0, 1.0]
PYTHON
