# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import LABEL_ABSENT as LABEL_ABSENT
from .findings import SCAN_LABELS as SCAN_LABELS
from .findings import SCAN_UNSTATED as SCAN_UNSTATED
from .findings import UNIT_ASSUMED as UNIT_ASSUMED
from .formats import AXES as AXES
from .formats import EVEN as EVEN
from .formats import Positions as Positions
from .formats import place_samples as place_samples
from .formats import read_all_positions as read_all_positions
from .formats import read_scan as read_scan
from .formats import sample_matrix as sample_matrix
from .labels import Label as Label
from .labels import count_labels as count_labels
from .labels import read_label_table as read_label_table
from .nrrd import read_header as read_header
from .numpy_files import map_array as map_array
from .numpy_files import read_arrays as read_arrays
from .numpy_files import read_raw as read_raw
from .scan import Scan as Scan
from .scan_files import SAMPLE_TYPES as SAMPLE_TYPES
from .scan_files import SUFFIXES as SUFFIXES
from .scan_files import scan_suffix as scan_suffix

__all__ = [
    "Scan",
    "read_scan",
    "sample_matrix",
]

def __getattr__(name: str) -> Any: ...
