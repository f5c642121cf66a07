#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# OpenCascade 8.0.1 writes the size of an inch into a STEP file as LENGTH_MEASURE_WITH_UNIT(25.4,…).
# The attribute is a choice among measures, which ISO 10303-21 writes with the name of the type:
# LENGTH_MEASURE(25.4). So a reader that insists on the type knows no unit.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install -q cadquery-ocp==8.0.1.1.0
env/bin/python - <<'PYTHON'
import re
from importlib.metadata import version
from pathlib import Path

from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

writer = STEPControl_Writer()
Interface_Static.SetCVal_s("write.step.unit", "INCH")
writer.Transfer(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), STEPControl_AsIs)
writer.Write("box.step")
(line,) = re.findall(r"\w*MEASURE_WITH_UNIT\([^;]*25\.4[^;]*;", Path("box.step").read_text())
print("cadquery-ocp", version("cadquery-ocp"), line)
assert re.match(r"LENGTH_MEASURE_WITH_UNIT\(\s*25\.4\s*,", line)
PYTHON
