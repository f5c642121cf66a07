# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies whose density varies: by part, by face, as a polynomial, as a grid or spline of samples."""

from .materials import MATERIALS
from .piecewise_mass import solid_mass_moments
from .polynomial import parse_polynomial
from .spline_grid import TrivariateSpline, density_moments, grid_moments
from .spline_tables import SplineAxis
from .threshold import threshold_body
from .voxel_fill import inside_moments

__all__ = [
    "MATERIALS",
    "SplineAxis",
    "TrivariateSpline",
    "density_moments",
    "grid_moments",
    "inside_moments",
    "parse_polynomial",
    "solid_mass_moments",
    "threshold_body",
]
