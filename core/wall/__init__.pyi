# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import NO_FACE_AREA as NO_FACE_AREA
from .findings import PRINT_UNFIT as PRINT_UNFIT
from .findings import WALL_MEASURED as WALL_MEASURED
from .moments import wall_moments as wall_moments
from .printed import PrintCore as PrintCore
from .printed import find_core as find_core
from .walls import OffsetSolid as OffsetSolid
from .walls import first_positive_root as first_positive_root
from .walls import offset_solid as offset_solid
from .walls import split_thickness as split_thickness

__all__ = [
    "offset_solid",
    "wall_moments",
]

def __getattr__(name: str) -> Any: ...
