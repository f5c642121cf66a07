#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) imports stepped and cubic keys of an FBX curve as linear
# ones, and of two additive layers only the first. Halfway from 8 to 0, a step is still 8, and a
# cubic with slopes of 0 and -24 is 7. Seen: 4.0 for both, and 4.0 for linear keys below a layer
# that adds 3. So our import evaluates the curves and layers of the file.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.13 -m venv env
env/bin/pip install -q bpy==5.2.3
cat > a.fbx <<'FBX'
; FBX 7.4.0 project file
FBXHeaderExtension: {
FBXVersion: 7400
}
Objects: {
Geometry: 1, "Geometry::g", "Mesh" {
Vertices: *9 {
a: 0,0,0,1,0,0,0,1,0
}
PolygonVertexIndex: *3 {
a: 0,1,-3
}
GeometryVersion: 124
}
Model: 2, "Model::part", "Mesh" {
Version: 232
}
@
}
Connections: {
C: "OO",2,0
C: "OO",1,2
&
}
FBX
env/bin/python - <<'PYTHON' 2> /dev/null
import bpy

curve = """AnimationCurveNode: {0}8, "AnimCurveNode::T", "" {{
Properties70: {{
P: "d|X", "Number", "", "A",0
P: "d|Y", "Number", "", "A",0
P: "d|Z", "Number", "", "A",0
}}
}}
AnimationCurve: {0}9, "AnimCurve::", "" {{
KeyTime: *2 {{
a: 0,46186158000
}}
KeyValueFloat: *2 {{
a: {1}
}}
KeyAttrFlags: *1 {{
a: {2}
}}
KeyAttrDataFloat: *4 {{
a: 0,-1044381696,0,0
}}
KeyAttrRefCount: *1 {{
a: 2
}}
}}
AnimationLayer: {0}7, "AnimLayer::l{0}", "" {{
}}
"""
stack = 'AnimationStack: 6, "AnimStack::a", "" {\n}\n'
links = """C: "OO",{0}7,6
C: "OO",{0}8,{0}7
C: "OP",{0}8,2, "Lcl Translation"
C: "OP",{0}9,{0}8, "d|X"
"""
with open("a.fbx") as file:
    text = file.read()
seen = []
for layers in ([("8,0", 2)], [("8,0", 1032)], [("8,0", 4), ("3,3", 4)]):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    more = "".join(curve.format(number, *layer) for number, layer in enumerate(layers, 1))
    link = "".join(links.format(number) for number, _ in enumerate(layers, 1))
    with open("b.fbx", "w") as file:
        file.write(text.replace("@", stack + more).replace("&", link))
    bpy.ops.wm.fbx_import(filepath="b.fbx")
    scene = bpy.context.scene
    scene.frame_set(1 + round(scene.render.fps / scene.render.fps_base) // 2)
    (part,) = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    seen.append(round(100 * part.matrix_world.translation.x, 4))
print("bpy", bpy.app.version_string, seen)
assert seen == [4.0, 4.0, 4.0]
PYTHON
