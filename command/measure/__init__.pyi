# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from . import robots as robots
from . import scene as scene

__all__ = []

def __getattr__(name: str) -> Any: ...
