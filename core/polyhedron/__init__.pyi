# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .any_order import extend_small_moments as extend_small_moments
from .faces import box_center as box_center
from .findings import BOUNDARY_OPEN as BOUNDARY_OPEN
from .integration import area_of_images as area_of_images
from .integration import polyhedron_moments as polyhedron_moments
from .integration import volume_and_center as volume_and_center
from .n_dimensions import SimplexMoments as SimplexMoments
from .n_dimensions import closes as closes
from .n_dimensions import enclosed_moments as enclosed_moments
from .n_dimensions import facet_moments as facet_moments
from .n_dimensions import facets_of as facets_of
from .n_dimensions import multi_indices as multi_indices
from .n_dimensions import outer_facets as outer_facets
from .third_order import MAX_SMALL_TRIANGLES as MAX_SMALL_TRIANGLES
from .third_order import MAX_TRIANGLES_EXACT_THIRD as MAX_TRIANGLES_EXACT_THIRD
from .third_order import MAX_UNSCALED_REACH as MAX_UNSCALED_REACH
from .third_order import integrate as integrate
from .third_order import nothing as nothing
from .third_order import small_moments as small_moments

__all__ = [
    "enclosed_moments",
    "facet_moments",
    "facets_of",
    "polyhedron_moments",
]

def __getattr__(name: str) -> Any: ...
