#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Blender 5.2.3 (bpy; needs Python 3.13) scales a model of an FBX file by its unit twice if it does
# not inherit the scale of its parent (InheritType 2, as joints of Maya): in a file in centimeters
# without any scale, the child is 100 times too small. Seen, the scales of both in the world:
# [0.01, 0.0001]. So our import takes the places from the file itself.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.13 -m venv env
env/bin/pip install -q bpy==5.2.3
env/bin/python - <<'PYTHON' 2> /dev/null
import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
axes = {"UpAxis": 2, "UpAxisSign": 1, "FrontAxis": 1, "FrontAxisSign": -1, "CoordAxis": 0}
axes["CoordAxisSign"] = 1
lines = "".join('P: "{}", "int", "Integer", "",{}\n'.format(*pair) for pair in axes.items())
model = 'Model: {}, "Model::{}", "Null" {{\nVersion: 232\nProperties70: {{\n{}}}\n}}\n'
text = "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\n"
text += "GlobalSettings: {\nProperties70: {\n" + lines + "}\n}\nObjects: {\n"
text += model.format(2, "parent", "")
text += model.format(3, "child", 'P: "InheritType", "enum", "", "",2\n')
text += '}\nConnections: {\nC: "OO",2,0\nC: "OO",3,2\n}\n'
with open("a.fbx", "w") as out:
    out.write(text)
bpy.ops.wm.fbx_import(filepath="a.fbx")
bpy.context.view_layer.update()
objects = bpy.data.objects
seen = [round(objects[name].matrix_world.to_scale().x, 8) for name in ("parent", "child")]
print("bpy", bpy.app.version_string, seen)
assert seen == [0.01, 0.0001]
PYTHON
