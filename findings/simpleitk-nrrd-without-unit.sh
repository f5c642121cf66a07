#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# SimpleITK 2.5.7 writes NRRD without space units, though its spacing is in millimeters. Seen: no
# field with units. So our reader takes NRRD with an anatomical space and no unit as millimeters,
# with a finding.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q simpleitk==2.5.7 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import numpy as np
import SimpleITK as sitk

sitk.WriteImage(sitk.GetImageFromArray(np.ones((6, 5, 4), np.int16)), "scan.nrrd")
with open("scan.nrrd", "rb") as file:
    fields = [line.partition(b":")[0] for line in file.read().splitlines()]
print("SimpleITK", sitk.Version.VersionString(), [field for field in fields if b"unit" in field])
assert b"space" in fields and not any(b"unit" in field for field in fields)
PYTHON
