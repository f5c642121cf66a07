# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of bodies: an object is of the first one that reads it.

Each is a module with MEASURED_AS, the possible "measure as" settings of its objects, and two functions: `read(request)`
returns the kind's reading of the object, None for another kind, and `body(reading, request)` its body. Both raise
MeasureError if nothing can be measured.
"""

from __future__ import annotations

from . import nurbs, wire
from .flat import region
from .grids import grid
from .mesh import mesh

KINDS = (grid, wire, region, mesh, nurbs)
