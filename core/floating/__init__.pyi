# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .flotation import FloatingBody as FloatingBody
from .flotation import Flotation as Flotation
from .flotation import Tank as Tank
from .flotation import Vessel as Vessel
from .righting import RightingCurve as RightingCurve
from .righting import righting_curve as righting_curve

__all__ = [
    "FloatingBody",
    "righting_curve",
]

def __getattr__(name: str) -> Any: ...
