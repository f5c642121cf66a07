# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .boundary_loops import vertex_pairs as vertex_pairs
from .findings import CAVITIES_BREAK_THROUGH as CAVITIES_BREAK_THROUGH
from .findings import CAVITIES_SUBTRACTED as CAVITIES_SUBTRACTED
from .findings import COMPONENTS_NESTED as COMPONENTS_NESTED
from .findings import COMPONENTS_OVERLAP as COMPONENTS_OVERLAP
from .findings import DUPLICATE_FACES_COUNTED as DUPLICATE_FACES_COUNTED
from .findings import DUPLICATE_FACES_IGNORED as DUPLICATE_FACES_IGNORED
from .findings import FLAT_COMPONENTS as FLAT_COMPONENTS
from .findings import FLAT_SURFACE as FLAT_SURFACE
from .findings import HOLES_CAPPED as HOLES_CAPPED
from .findings import INVERTED_COMPONENTS as INVERTED_COMPONENTS
from .findings import NON_FINITE_VERTICES as NON_FINITE_VERTICES
from .findings import NON_MANIFOLD_COMPONENTS as NON_MANIFOLD_COMPONENTS
from .findings import NON_PLANAR_FACES as NON_PLANAR_FACES
from .findings import ONE_SIDED_COMPONENTS as ONE_SIDED_COMPONENTS
from .findings import OVERLAP_OF_COMPONENTS as OVERLAP_OF_COMPONENTS
from .findings import OVERLAP_OF_INSTANCES as OVERLAP_OF_INSTANCES
from .findings import SELF_INTERSECTING as SELF_INTERSECTING
from .findings import UNCHECKED as UNCHECKED
from .findings import VERTICES_WELDED as VERTICES_WELDED
from .measure import SolidStack as SolidStack
from .measure import measure_again as measure_again
from .measure import measure_solid as measure_solid
from .measure import measure_stack as measure_stack
from .nesting import ComponentRelations as ComponentRelations
from .nesting import classify_pairs as classify_pairs
from .nesting import self_overlaps as self_overlaps
from .nesting import surfaces_intersect as surfaces_intersect
from .orientation import ClosedParts as ClosedParts
from .orientation import ComponentComparison as ComponentComparison
from .orientation import zero_volume as zero_volume
from .solid_method import SolidIntegrals as SolidIntegrals
from .solid_stack import SmallSolid as SmallSolid

__all__ = [
    "SolidIntegrals",
    "measure_solid",
]

def __getattr__(name: str) -> Any: ...
