# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of scans: their suffixes, and the names of the sample types."""

from __future__ import annotations

from pathlib import Path

# No suffix ends with another one.
SUFFIXES = (
    ".npy",
    ".npz",
    ".nrrd",
    ".nhdr",
    ".nii",
    ".nii.gz",
    ".raw",
)
SAMPLE_TYPES = (
    *("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64"),
    *("float32", "float64"),
)


def scan_suffix(path: str | Path) -> str:
    """Return the suffix of a scan's file in lower case, one of `SUFFIXES`; "" if it is no
    scan's.
    """
    name = str(path).lower()
    return next((end for end in SUFFIXES if name.endswith(end)), "")
