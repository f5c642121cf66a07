# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/polyhedron`."""

from ..verdict import error

BOUNDARY_OPEN = error(
    "boundary_open",
    "The faces do not close, and the moments of what they enclose depend on the reference point. "
    "Add the missing ones, "
    "and turn those that face the other way: measure_solid repairs a surface, “signs” turn "
    "simplices.",
)
