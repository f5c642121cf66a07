# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every subject computes with: vectors, exact sums, rotations, quadrature, splines, graphs, segments."""

from .bspline import SplineSpace, clamped_space
from .float32 import shortest_decimal
from .graph import connected_components
from .quadrature import gauss_legendre, triangle_rule
from .rotations import quaternion, rotation_matrix

__all__ = [
    "SplineSpace",
    "clamped_space",
    "connected_components",
    "gauss_legendre",
    "quaternion",
    "rotation_matrix",
    "shortest_decimal",
    "triangle_rule",
]
