#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Newton 1.8.0 makes an inertia that no body can have, 1 1 9, possible by adding 7 to all three
# moments. Seen: 8 8 16. The largest moment, which alone may be the typing mistake, grows, too. So
# the audit proposes a change from the geometry.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q "newton[importers]==1.8.0"
env/bin/python - <<'PYTHON'
import importlib.metadata

import newton

builder = newton.ModelBuilder()
builder.add_urdf(
    '<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="9" '
    'ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
)
inertia = builder.finalize(device="cpu").body_inertia.numpy()[0]
moments = [round(float(inertia[i, i]), 4) for i in range(3)]
print("newton", importlib.metadata.version("newton"), moments)
assert moments == [8.0, 8.0, 16.0]
PYTHON
