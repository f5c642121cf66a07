#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) imports an animated weight of an FBX shape with the limits 0
# to 1 of a new shape key: a key of 400 % counts as 100 %, one of -50 % as 0, though the curve has
# the file's values. A weight that is not animated is not clamped. Seen: [4.0, 1.0, 0.0]. So our
# import widens the limits before it measures.
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
Geometry: 3, "Geometry::s", "Shape" {
Version: 100
Indexes: *1 {
a: 1
}
Vertices: *3 {
a: 1,0,0
}
}
Deformer: 4, "Deformer::b", "BlendShape" {
Version: 100
}
Deformer: 5, "SubDeformer::s", "BlendShapeChannel" {
Version: 100
FullWeights: *1 {
a: 100
}
Properties70: {
P: "DeformPercent", "Number", "", "A",0
}
}
@
}
Connections: {
C: "OO",2,0
C: "OO",1,2
C: "OO",4,1
C: "OO",5,4
C: "OO",3,5
&
}
FBX
env/bin/python - <<'PYTHON' 2> /dev/null
import bpy

objects = """AnimationStack: 6, "AnimStack::a", "" {
}
AnimationLayer: 7, "AnimLayer::l", "" {
}
AnimationCurveNode: 8, "AnimCurveNode::DeformPercent", "" {
Properties70: {
P: "d|DeformPercent", "Number", "", "A",400
}
}
AnimationCurve: 9, "AnimCurve::", "" {
KeyTime: *2 {
a: 0,46186158000
}
KeyValueFloat: *2 {
a: 400,-50
}
KeyAttrFlags: *1 {
a: 260
}
KeyAttrDataFloat: *4 {
a: 0,0,0,0
}
KeyAttrRefCount: *1 {
a: 2
}
}"""
links = """C: "OO",7,6
C: "OO",8,7
C: "OP",8,5, "DeformPercent"
C: "OP",9,8, "d|DeformPercent\""""
with open("a.fbx") as file:
    text = file.read()
seen = []
for more, link, frames in (("", "", [1]), (objects, links, [1, 10**6])):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with open("b.fbx", "w") as file:
        still = text.replace('"A",0', '"A",{}'.format(0 if more else 400))
        file.write(still.replace("@", more).replace("&", link))
    bpy.ops.wm.fbx_import(filepath="b.fbx")
    (keys,) = bpy.data.shape_keys
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        seen.append(keys.key_blocks[1].value)
print("bpy", bpy.app.version_string, seen)
assert seen == [4.0, 1.0, 0.0]
PYTHON
