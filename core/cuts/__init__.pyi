# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .below import PartBelow as PartBelow
from .below import measure_below as measure_below

__all__ = [
    "measure_below",
]

def __getattr__(name: str) -> Any: ...
