# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle and quad surfaces: arrays, edges, welding, planarity, boxes, bounding-volume hierarchy."""

from .hulls import ConvexHull, convex_hull, convex_polygon
from .surface import Surface, join_surfaces, normals
from .winding import winding_number

__all__ = [
    "ConvexHull",
    "Surface",
    "convex_hull",
    "convex_polygon",
    "join_surfaces",
    "normals",
    "winding_number",
]
