# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells of real thickness: where their vertices go, and their moments as polynomials in the thickness."""

from .moments import wall_moments
from .walls import OffsetSolid, offset_solid, split_thickness

__all__ = [
    "OffsetSolid",
    "offset_solid",
    "split_thickness",
    "wall_moments",
]
