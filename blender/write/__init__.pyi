# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from . import properties as properties
from . import section as section
from . import spectrum as spectrum
from . import text_report as text_report
from . import thumbnail as thumbnail

__all__ = []

def __getattr__(name: str) -> Any: ...
