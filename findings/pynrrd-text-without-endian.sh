#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# pynrrd 1.1.3 writes NRRD with text encoding without the field endian, which text does not need.
# Seen: no field. So our reader asks for a byte order only where bytes have one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q pynrrd==1.1.3 numpy==2.4.6
cd "$folder"
env/bin/python - <<'PYTHON'
import nrrd
import numpy as np

nrrd.write("scan.nrrd", np.ones((4, 5, 6), np.int16), {"encoding": "ascii"})
with open("scan.nrrd", "rb") as file:
    fields = [line.partition(b":")[0] for line in file.read().splitlines()]
print("pynrrd", nrrd.__version__ if hasattr(nrrd, "__version__") else "1.1.3", b"endian" in fields)
assert b"encoding" in fields and b"endian" not in fields
PYTHON
