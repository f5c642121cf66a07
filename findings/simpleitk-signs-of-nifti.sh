#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# SimpleITK 2.5.7 turns the first two axes when it writes NIfTI, whose axes are right, anterior,
# superior: the origin (10, 20, 30) of an image reads as (-10, -20, 30) elsewhere, while its NRRD
# keeps (10, 20, 30) and states left, posterior, superior. Seen so. So our readers take the space
# of either format into account, and both files stand at one place.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q simpleitk==2.5.7 nibabel==5.4.2 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import nibabel
import numpy as np
import SimpleITK as sitk

image = sitk.GetImageFromArray(np.ones((6, 5, 4), np.int16))
image.SetOrigin((10, 20, 30))
sitk.WriteImage(image, "scan.nii")
sitk.WriteImage(image, "scan.nrrd")
origin = nibabel.load("scan.nii").affine[:3, 3].tolist()
with open("scan.nrrd", "rb") as file:
    lines = file.read().splitlines()
print("SimpleITK", sitk.Version.VersionString(), origin)
assert origin == [-10.0, -20.0, 30.0]
assert b"space: left-posterior-superior" in lines and b"space origin: (10,20,30)" in lines
PYTHON
