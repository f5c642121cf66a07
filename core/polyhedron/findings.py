# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/polyhedron`."""

from ..verdict.finding import error

SURFACE_NOT_CLOSED = error(
    "surface_not_closed",
    "The surface does not close, and its volume depends on the reference point. Use the moments of the body that "
    "measure_solid makes of it.",
)
BOUNDARY_OPEN = error(
    "boundary_open",
    "The facets do not close, and the moments of what they enclose depend on the reference point. Add the missing "
    "ones, or turn those that face the other way by “signs”.",
)
