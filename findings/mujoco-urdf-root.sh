#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# MuJoCo 4.0.0 fuses links of URDF that are fixed to the root into the world, with their masses: a
# robot of 5 kg and 1 kg on a fixed joint has one body and weighs 0 kg. Seen: 1 body, 0.0 kg. So
# the audit names the root, and our totals count it.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q mujoco==4.0.0
cd "$folder"
env/bin/python - <<'PYTHON'
import mujoco

INERTIAL = """<inertial><mass value="{}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>"""
model = mujoco.MjModel.from_xml_string(
    '<robot name="r"><link name="base">{}</link><link name="tip">{}</link><joint name="j" '
    'type="fixed"><parent link="base"/><child link="tip"/></joint></robot>'.format(
        INERTIAL.format(5), INERTIAL.format(1)
    )
)
print("mujoco", mujoco.__version__, model.nbody, "body,", float(model.body_mass.sum()), "kg")
assert model.nbody == 1 and model.body_mass.sum() == 0.0
PYTHON
