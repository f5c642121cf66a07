#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Pinocchio 4.1.0 leaves links that are fixed to the root out of computeTotalMass, though the
# model keeps their inertia under the universe. Seen: total 0.0 kg, universe 1.0 kg. So our
# comparison of totals adds inertias[0].
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q pin==4.1.0
cd "$folder"
env/bin/python - <<'PYTHON'
import pinocchio

model = pinocchio.buildModelFromXML(
    '<robot name="r"><link name="base"/><link name="tip"><inertial><mass value="1"/><inertia '
    'ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" '
    'type="fixed"><parent link="base"/><child link="tip"/></joint></robot>'
)
total = pinocchio.computeTotalMass(model)
print("pinocchio", pinocchio.__version__, "total", total, "universe", model.inertias[0].mass)
assert total == 0.0 and model.inertias[0].mass == 1.0
PYTHON
