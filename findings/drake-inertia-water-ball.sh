#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Drake 1.58.0 replaces moments 1, 2, 3 of which the largest is too large by 1e-12 of itself, as
# rounding leaves it, by those of a ball of water of the same mass: a warning, and an inertia 2000
# times too small. Seen: 0.00154 three times. So the largest moment of a flat body is written
# smaller by rounding.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q drake==1.58.0
env/bin/python - <<'PYTHON'
import importlib.metadata

from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

with open("robot.urdf", "w") as file:
    file.write(
        '<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="2" '
        'izz="3.000000000003" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
    )
plant = MultibodyPlant(0.0)
Parser(plant).AddModels("robot.urdf")
inertia = plant.GetBodyByName("a").default_spatial_inertia().CalcRotationalInertia()
moments = [round(float(value), 5) for value in inertia.get_moments()]
print("drake", importlib.metadata.version("drake"), moments)
assert moments == [0.00154, 0.00154, 0.00154]
PYTHON
