# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that B-spline curves and patches bound (Soldea, Elber and Rivlin, sections 2 and 3)."""

from .bezier_form import bezier_patches
from .blender_knots import blender_space
from .curve import Curve
from .curve_moments import length_moments
from .patch import Patch
from .planar_regions import planar_region
from .solid import measure_patches, measure_sheet
from .tracked_solid import TrackedSolid

__all__ = [
    "Curve",
    "Patch",
    "TrackedSolid",
    "bezier_patches",
    "blender_space",
    "length_moments",
    "measure_patches",
    "measure_sheet",
    "planar_region",
]
