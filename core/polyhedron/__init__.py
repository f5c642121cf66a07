# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of what triangles and quads bound: to third order, to any order, in n dimensions."""

from .integration import MAX_ORDER, polyhedron_moments
from .n_dimensions import SimplexMoments, enclosed_moments, facet_moments
from .sheared_areas import area_of_images
from .simplices import facets_of

__all__ = [
    "MAX_ORDER",
    "SimplexMoments",
    "area_of_images",
    "enclosed_moments",
    "facet_moments",
    "facets_of",
    "polyhedron_moments",
]
