#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# trimesh 5.2.0 halves two of the three moments of a unit cube that stands 1,000 km from the
# origin, because it sums about the origin. Seen: 0.0834 instead of 0.1667. So our sums are about
# the middle of the box of the body.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q trimesh==5.2.0 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import trimesh

cube = trimesh.creation.box((1, 1, 1))
cube.apply_translation((1e6, 0, 0))
moments = cube.moment_inertia.diagonal()
print("trimesh", trimesh.__version__, moments)
assert abs(moments[0] - 1 / 6) < 1e-6 and abs(moments[1] - 1 / 6) > 0.01
PYTHON
