#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# urchin 0.0.30 gives a link without an inertial 1 kg and a unit inertia. Seen: 1.0 kg, [1. 1. 1.]
# for a mere frame. So frames without mass are named in the docs of our URDF, and the audit names
# links without an inertial.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q urchin==0.0.30
cd "$folder"
env/bin/python - <<'PYTHON'
import importlib.metadata

import urchin

with open("robot.urdf", "w") as file:
    file.write(
        '<robot name="r"><link name="base"/><link name="frame"/><joint name="j" type="fixed">'
        '<parent link="base"/><child link="frame"/></joint></robot>'
    )
frame = urchin.URDF.load("robot.urdf").link_map["frame"]
moments = frame.inertial.inertia.diagonal()
print("urchin", importlib.metadata.version("urchin"), frame.inertial.mass, moments)
assert frame.inertial.mass == 1.0 and moments.tolist() == [1.0, 1.0, 1.0]
PYTHON
