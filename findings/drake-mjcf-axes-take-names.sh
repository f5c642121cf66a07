#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Drake 1.58.0 names the bodies that it adds between two joints of an MJCF body like that body with
# a digit behind it, so that a file with the bodies l1 (two joints) and l10 is refused. Seen:
# "already contains a body named 'l10'". MuJoCo reads the file. So names of such links are best
# told apart by more than a final 0.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q drake==1.58.0 mujoco==4.0.0
env/bin/python - <<'PYTHON'
import importlib.metadata

import mujoco
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

with open("robot.xml", "w") as file:
    file.write(
        '<mujoco model="r"><worldbody><body name="l1"><joint name="x" axis="1 0 0"/><joint name="y" '
        'axis="0 1 0"/><geom size="1"/></body><body name="l10" pos="5 0 0"><geom size="1"/></body>'
        "</worldbody></mujoco>"
    )
assert mujoco.MjModel.from_xml_path("robot.xml").nbody == 3
plant = MultibodyPlant(0.0)
reason = ""
try:
    Parser(plant).AddModels("robot.xml")
except RuntimeError as error:
    reason = str(error)
print("drake", importlib.metadata.version("drake"), reason)
assert "already contains a body named 'l10'" in reason
PYTHON
