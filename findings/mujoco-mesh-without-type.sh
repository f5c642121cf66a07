#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# MuJoCo 4.0.0 makes a sphere of a geom that names a mesh but no type, fitted to the inertia of the
# mesh: a bar of 10 m³ and density 1 then weighs 33.5 kg. Seen: {'mesh': 10.0, 'none': 33.5103}. So
# the audit fits a sphere, too.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q mujoco==4.0.0
env/bin/python - <<'PYTHON'
import mujoco

corners = " ".join("{} {} {}".format(x, y, z) for x in (0, 10) for y in (0, 1) for z in (0, 1))
MODEL = """<mujoco><asset><mesh name="bar" vertex="{}"/></asset><worldbody><body>
<freejoint/><geom {} mesh="bar" density="1"/></body></worldbody></mujoco>"""
masses = {}
for name, kind in (("mesh", 'type="mesh"'), ("none", "")):
    model = mujoco.MjModel.from_xml_string(MODEL.format(corners, kind))
    masses[name] = round(float(model.body_mass[1]), 4)
print("mujoco", mujoco.__version__, masses)
assert masses == {"mesh": 10.0, "none": 33.5103}
PYTHON
