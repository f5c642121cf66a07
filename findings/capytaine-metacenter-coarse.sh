#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# capytaine 3.0.0 takes a waterplane's second moments at the centers of panels. A box of 4 by 2 by 1,
# half immersed, has BM = 2/3 m however it is divided; with 1, 2, 4 and 8 panels across it shows
# 0, 0.5, 0.625 and 0.656 m. So the benchmark beside it compares moments on fine meshes only.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q capytaine==3.0.0
env/bin/python - <<'PYTHON'
import capytaine

capytaine.set_logging("ERROR")
shown = []
for count in (1, 2, 4, 8):
    mesh = capytaine.mesh_parallelepiped(size=(4, 2, 1), resolution=(2 * count, count, count))
    body = capytaine.FloatingBody(mesh=mesh, center_of_mass=(0, 0, 0))
    found = body.compute_hydrostatics(rho=1000.0)
    assert abs(found["waterplane_area"] - 8.0) < 1e-9
    shown.append(round(float(found["transversal_metacentric_radius"]) + 0.0, 5))
print("capytaine", capytaine.__version__, shown, "exact 0.66667")
assert shown == [0.0, 0.5, 0.625, 0.65625]
PYTHON
