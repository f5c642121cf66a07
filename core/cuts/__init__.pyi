# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .hollow import Hollow as Hollow
from .hollow import find_hollow as find_hollow
from .hollow import spill_tilt as spill_tilt
from .part_below import PartBelow as PartBelow
from .part_below import below as below
from .part_below import measure_below as measure_below

__all__ = [
    "below",
    "find_hollow",
    "measure_below",
    "spill_tilt",
]

def __getattr__(name: str) -> Any: ...
