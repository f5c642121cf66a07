# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of samples, and the samples in them: NRRD, NIfTI, numpy's formats."""

from .formats import SUFFIXES, read_scan, sample_matrix, scan_suffix
from .positions import read_positions
from .scan import Scan

__all__ = [
    "SUFFIXES",
    "Scan",
    "read_positions",
    "read_scan",
    "sample_matrix",
    "scan_suffix",
]
