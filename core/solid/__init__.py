# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a surface bounds a solid, what has to be repaired to measure it, and its moments."""

from .measure import measure_solid
from .solid_verdict import SolidIntegrals

__all__ = [
    "SolidIntegrals",
    "measure_solid",
]
