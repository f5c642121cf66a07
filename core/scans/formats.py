# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans and arrays of samples in files, by their suffix, and where their samples stand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

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


def suffix(path: str | Path) -> str:
    """What the file's name ends with, in lower case; "" where it is no scan's."""
    name = str(path).lower()
    return next((end for end in sorted(SUFFIXES, key=len, reverse=True) if name.endswith(end)), "")


def read_scan(path: str | Path) -> Scan:
    """The scan in a file, by its suffix. ValueError where it is none or damaged, OSError where it cannot be opened."""
    path = Path(path)
    read = READERS.get(suffix(path))
    if read is None:
        raise ValueError("Files of this kind are no scans; these are: {:s}.".format(" ".join(SUFFIXES)))
    if not path.is_file():
        raise ValueError("There is no such file." if not path.exists() else "This is not a regular file.")
    with open(path, "rb"):
        pass  # where it cannot be opened this says why; what reads it would take it for damaged
    try:
        scan = read(path)
    except MemoryError as error:
        raise ValueError("The samples do not fit into memory; unpack the file, then they need not.") from error
    if not np.isfinite(scan.matrix).all() or not abs(np.linalg.det(scan.matrix[:3, :3])) > 0.0:
        raise ValueError(
            "The header places all samples in one plane, or nowhere: its spacing or directions are zero or not finite."
        )
    if not (math.isfinite(scan.slope) and math.isfinite(scan.intercept)):
        raise ValueError("The header scales the samples by numbers that are not finite.")
    return scan


def placed(
    scan: Scan, spacing: Sequence[float] | None, origin: Sequence[float] | None, unit_scale: float | None
) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """(4, 4) where the samples stand in metres, and a sentence for each decision.

    spacing, origin: in place of the header's, in units of `unit_scale` metres, by default 1; axes x, y, z.
    """
    notes = []
    matrix = scan.matrix.copy()
    own = (unit_scale or 1.0) if scan.unit is None else scan.unit
    if scan.unit is not None and unit_scale is not None:
        notes.append("The file carries its own unit, which its own spacing and origin keep.")
    given = unit_scale or 1.0
    matrix[:3] *= own
    if spacing is not None:
        matrix[:3, :3] = np.diag(spacing) * given
    if origin is not None:
        matrix[:3, 3] = np.asarray(origin, float) * given
    if scan.placed and (spacing is not None or origin is not None):
        notes.append(
            "The given {:s} took the place of the header's.".format(
                " and ".join(name for name, value in (("spacing", spacing), ("origin", origin)) if value is not None)
            )
        )
    if not scan.placed and spacing is None:
        notes.append("The file does not say how far its samples are apart; 1 unit is taken (give a spacing).")
    elif scan.unit is None and unit_scale is None and spacing is None:
        notes.append("The file carries no unit; 1 unit is taken as 1 m (give a unit scale).")
    return matrix, tuple(notes)
