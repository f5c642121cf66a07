#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# MuJoCo 4.0.0 refuses the inertia of a thin plate that was written with seven digits, 1 1
# 2.0000001, because A + B >= C must hold without tolerance. Seen: ValueError, inertia must
# satisfy A + B >= C. So our exporters write moments that keep the inequality after rounding.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q mujoco==4.0.0
cd "$folder"
env/bin/python - <<'PYTHON'
import mujoco

MODEL = """<mujoco><worldbody><body><freejoint/><geom size=".1"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 {}"/></body></worldbody></mujoco>"""
mujoco.MjModel.from_xml_string(MODEL.format("2"))
try:
    mujoco.MjModel.from_xml_string(MODEL.format("2.0000001"))
except ValueError as error:
    print("mujoco", mujoco.__version__, str(error).splitlines()[0])
    assert "A + B >= C" in str(error)
else:
    raise SystemExit("it is read")
PYTHON
