#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Pinocchio 4.1.0 reads an inertia that no body can have, 1 1 9, without a word. Seen: [1. 1. 9.].
# So a file that Pinocchio loads proves nothing about its inertials, and the audit checks the
# triangle inequality itself.
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
    'ixx="1" iyy="1" izz="9" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" '
    'type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
)
moments = model.inertias[1].inertia.diagonal()
print("pinocchio", pinocchio.__version__, moments)
assert moments.tolist() == [1.0, 1.0, 9.0]
PYTHON
