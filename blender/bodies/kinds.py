# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of bodies: an object is of the first one that reads it.

Each is a module with MEASURED_AS, what its objects can be measured as, and two functions: `read(request)` gives what
the kind reads of the object, None where it is of another kind, and `body(reading, request)` what that comes to. Both
raise MeasureError where nothing can be measured.
"""

from __future__ import annotations

from . import nurbs, wire
from .flat import region
from .grids import grid
from .mesh import mesh

KINDS = (grid, wire, region, mesh, nurbs)
