# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans and arrays of samples in files, by their suffix, and where their samples stand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import FileError, Finding, finding
from .limits import DEFAULT_LIMITS, Limits
from .nifti import read_nifti
from .nrrd import read_nrrd
from .numpy_files import read_named_raw, read_npy, read_npz
from .scan import Scan

READERS = {
    ".npy": read_npy,
    ".npz": read_npz,
    ".nrrd": read_nrrd,
    ".nhdr": read_nrrd,
    ".nii": read_nifti,
    ".nii.gz": read_nifti,
    ".raw": read_named_raw,
}
SUFFIXES = tuple(READERS)


def scan_suffix(path: str | Path) -> str:
    """What the file's name ends with, in lower case; "" where it is no scan's."""
    name = str(path).lower()
    return next((end for end in sorted(SUFFIXES, key=len, reverse=True) if name.endswith(end)), "")


def read_scan(path: str | Path, limits: Limits = DEFAULT_LIMITS) -> Scan:
    """The scan in a file, by its suffix. FileError where it is none, damaged or beyond a limit, OSError where it cannot
    be opened."""
    path = Path(path)
    read = READERS.get(scan_suffix(path))
    if read is None:
        raise FileError("scan_file_type", suffixes=" ".join(SUFFIXES))
    if not path.is_file():
        raise FileError("file_not_regular" if path.exists() else "file_missing")
    with open(path, "rb"):
        pass  # where it cannot be opened this says why; what reads it would take it for damaged
    try:
        scan = read(path, limits)
    except MemoryError as error:
        raise FileError("scan_out_of_memory") from error
    limits.check(path, "samples", scan.samples.size)
    if not np.isfinite(scan.matrix).all() or not abs(np.linalg.det(scan.matrix[:3, :3])) > 0.0:
        raise FileError("scan_placement")
    if not (math.isfinite(scan.slope) and math.isfinite(scan.intercept)):
        raise FileError("scan_scaling")
    return scan


def sample_matrix(
    scan: Scan, spacing: Sequence[float] | None, origin: Sequence[float] | None, unit_scale: float | None
) -> tuple[NDArray[np.float64], tuple[Finding, ...]]:
    """(4, 4) where the samples stand in metres, and what was decided on the way.

    spacing, origin: in place of the header's, in units of `unit_scale` metres, by default 1; axes x, y, z.
    """
    findings = []
    matrix = scan.matrix.copy()
    meters_per_unit = (unit_scale or 1.0) if scan.unit is None else scan.unit
    if scan.unit is not None and unit_scale is not None:
        findings.append(finding("scan_own_unit"))
    given = unit_scale or 1.0
    matrix[:3] *= meters_per_unit
    if spacing is not None:
        matrix[:3, :3] = np.diag(spacing) * given
    if origin is not None:
        matrix[:3, 3] = np.asarray(origin, float) * given
    if scan.is_placed and (spacing is not None or origin is not None):
        fields = [name for name, value in (("spacing", spacing), ("origin", origin)) if value is not None]
        findings.append(finding("scan_placement_overridden", fields=fields))
    if not scan.is_placed and spacing is None:
        findings.append(finding("scan_without_spacing"))
    elif scan.unit is None and unit_scale is None and spacing is None:
        findings.append(finding("scan_without_unit"))
    return matrix, tuple(findings)
