# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from . import audit as audit
from . import simplex as simplex
from .results import gather as gather
from .results import similar as similar

__all__ = []

def __getattr__(name: str) -> Any: ...
