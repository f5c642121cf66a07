# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import CUT_FILL_UNAVAILABLE as CUT_FILL_UNAVAILABLE
from .findings import LEVEL_UNAVAILABLE as LEVEL_UNAVAILABLE
from .findings import PLANE_UPRIGHT as PLANE_UPRIGHT
from .findings import SHARED_SPACE as SHARED_SPACE
from .findings import SURFACE_NEEDED as SURFACE_NEEDED
from .hollow import Hollow as Hollow
from .hollow import find_hollow as find_hollow
from .hollow import spill_tilt as spill_tilt
from .open_surfaces import MIN_RIM_SPREAD as MIN_RIM_SPREAD
from .open_surfaces import CutFill as CutFill
from .open_surfaces import cut_fill as cut_fill
from .open_surfaces import cut_fill_between as cut_fill_between
from .open_surfaces import fit_rim as fit_rim
from .open_surfaces import surface_cut_fill as surface_cut_fill
from .part_below import PartBelow as PartBelow
from .part_below import below as below
from .part_below import cut_outline as cut_outline
from .part_below import measure_below as measure_below
from .record import TABLE_ROWS as TABLE_ROWS
from .record import below_record as below_record
from .record import contents_record as contents_record
from .record import cut_fill_record as cut_fill_record
from .record import partly_compared as partly_compared

__all__ = [
    "below",
    "cut_fill",
    "cut_fill_between",
    "find_hollow",
    "fit_rim",
    "measure_below",
    "spill_tilt",
]

def __getattr__(name: str) -> Any: ...
