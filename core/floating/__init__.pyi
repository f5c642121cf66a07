# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import FLOAT_UNAVAILABLE as FLOAT_UNAVAILABLE
from .findings import NO_GRAVITY as NO_GRAVITY
from .flotation import FloatingBody as FloatingBody
from .flotation import Flotation as Flotation
from .flotation import Tank as Tank
from .flotation import Vessel as Vessel
from .hulls import Hull as Hull
from .hulls import find_hull as find_hull
from .record import float_record as float_record
from .record import heel_and_trim as heel_and_trim
from .record import settle as settle
from .righting import RightingCurve as RightingCurve
from .righting import righting_curve as righting_curve

__all__ = [
    "FloatingBody",
    "righting_curve",
]

def __getattr__(name: str) -> Any: ...
