#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# nibabel 5.4.2 saves an image without a unit of length, though its users mean millimeters. Seen:
# ('unknown', 'unknown'). So our reader takes an anatomical scan without a unit as millimeters,
# with a finding.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q nibabel==5.4.2 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import nibabel
import numpy as np

image = nibabel.Nifti1Image(np.ones((4, 5, 6), np.int16), np.diag([2.0, 3.0, 4.0, 1.0]))
nibabel.save(image, "scan.nii")
units = nibabel.load("scan.nii").header.get_xyzt_units()
print("nibabel", nibabel.__version__, units)
assert units == ("unknown", "unknown")
PYTHON
