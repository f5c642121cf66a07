#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# PyBullet 3.2.7 ignores the inertia in a URDF file unless URDF_USE_INERTIA_FROM_FILE is given,
# and computes it from the collision shape. Seen: 0.333 for a stated 5, 6, 7. So our tests and
# docs load robots with that flag, and colliders have the exported mass.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q pybullet==3.2.7 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import pybullet

with open("robot.urdf", "w") as file:
    file.write(
        '<robot name="r"><link name="body"><inertial><mass value="2"/><inertia ixx="5" iyy="6" '
        'izz="7" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><box size="1 1 1"/>'
        "</geometry></collision></link></robot>"
    )
pybullet.connect(pybullet.DIRECT)
moments = []
for flags in (0, pybullet.URDF_USE_INERTIA_FROM_FILE):
    body = pybullet.loadURDF("robot.urdf", flags=flags)
    moments.append([round(value, 3) for value in pybullet.getDynamicsInfo(body, -1)[2]])
print("pybullet", pybullet.getAPIVersion(), moments)
assert moments == [[0.333, 0.333, 0.333], [5.0, 6.0, 7.0]]
PYTHON
