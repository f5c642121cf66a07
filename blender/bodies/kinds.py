# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of bodies: an object has the first kind that can read it.

Each kind is a module with MEASURED_AS, the values of the setting Kind (solid, shell, wire) with which it is tried, and
two functions: `read(request)` returns a reading, or None if the object is of another kind; `body(reading, request)`
returns the body. Both raise MeasureError if nothing can be measured.
"""

from __future__ import annotations

from . import nurbs, wire
from .flat import region
from .grids import grid
from .mesh import mesh

KINDS = (grid, wire, region, mesh, nurbs)
