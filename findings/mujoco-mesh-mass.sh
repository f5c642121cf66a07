#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# MuJoCo 4.0.0 weighs a mesh by its legacy rule unless told otherwise: a closed U of 7 m³ and
# density 1 weighs 8.6175 kg; with inertia="exact" it weighs 7 kg. Seen: {'legacy': 8.6175,
# 'exact': 7.0}. So our MJCF states every inertial, and the audit computes masses of shapes by the
# kind that the file names.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q mujoco==4.0.0
cd "$folder"
env/bin/python - <<'PYTHON'
import mujoco

OUTLINE = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
FACES = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
count = len(OUTLINE)
points = [(x, y, z) for z in (0, 1) for x, y in OUTLINE]
triangles = []
for a, b, c in FACES:
    triangles += [(a, c, b), (a + count, b + count, c + count)]
for i in range(count):
    j = (i + 1) % count
    triangles += [(i, j, j + count), (i, j + count, i + count)]
vertex = " ".join(str(x) for point in points for x in point)
face = " ".join(str(i) for triangle in triangles for i in triangle)
MODEL = """<mujoco><asset><mesh name="m" vertex="{}" face="{}" {}/></asset><worldbody><body>
<freejoint/><geom type="mesh" mesh="m" density="1"/></body></worldbody></mujoco>"""
masses = {}
for name, kind in (("legacy", ""), ("exact", 'inertia="exact"')):
    model = mujoco.MjModel.from_xml_string(MODEL.format(vertex, face, kind))
    masses[name] = round(float(model.body_mass[1]), 4)
print("mujoco", mujoco.__version__, masses)
assert masses == {"legacy": 8.6175, "exact": 7.0}
PYTHON
