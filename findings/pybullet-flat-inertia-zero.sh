#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# PyBullet 3.2.7 reads moments 1, 2, 3 of which the largest is too large by 1e-12 of itself, as
# rounding leaves it, as zero, with a warning: such a link cannot be turned. Seen: (0, 0, 0), and
# (1, 2, 3) if all is right. So the largest moment of a flat body is written smaller by rounding.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q pybullet==3.2.7 numpy==2.4.6
env/bin/python - <<'PYTHON'
import importlib.metadata

import pybullet

pybullet.connect(pybullet.DIRECT)
moments = []
for largest in ("3", "3.000000000003"):
    name = "robot{}.urdf".format(largest)  # It caches files by their names.
    with open(name, "w") as file:
        file.write(
            '<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/><inertia '
            'ixx="1" iyy="2" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" '
            'type="fixed"><parent link="a"/><child link="b"/></joint></robot>'.format(largest)
        )
    body = pybullet.loadURDF(name, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    moments.append(pybullet.getDynamicsInfo(body, 0)[2])
print("pybullet", importlib.metadata.version("pybullet"), moments)
assert moments == [(1.0, 2.0, 3.0), (0.0, 0.0, 0.0)]
PYTHON
