#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# trimesh 5.2.0 calls a box of 6 m³ with one side turned inside out watertight, and gives it half
# the volume; only is_winding_consistent tells. Seen: watertight, 3.0 m³. So our measurement turns
# such faces on a copy, and says so.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q trimesh==5.2.0 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import trimesh

box = trimesh.creation.box((1, 2, 3))
faces = box.faces.copy()
faces[:2] = faces[:2, ::-1]
mesh = trimesh.Trimesh(box.vertices, faces, process=False)
print("trimesh", trimesh.__version__, mesh.is_watertight, mesh.is_winding_consistent, mesh.volume)
assert mesh.is_watertight and not mesh.is_winding_consistent and round(mesh.volume, 9) == 3.0
PYTHON
