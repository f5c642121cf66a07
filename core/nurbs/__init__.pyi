# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .bezier import halves as halves
from .blender_knots import bezier_curves as bezier_curves
from .blender_knots import bezier_patches as bezier_patches
from .blender_knots import bezier_space as bezier_space
from .blender_knots import blender_space as blender_space
from .blender_knots import display_parameters as display_parameters
from .blender_knots import display_table as display_table
from .curve_moments import length_moments as length_moments
from .curve_moments import plane_moments as plane_moments
from .findings import CONTROL_POINTS_INVALID as CONTROL_POINTS_INVALID
from .findings import ERROR_ESTIMATE_LARGE as ERROR_ESTIMATE_LARGE
from .findings import NON_FINITE as NON_FINITE
from .findings import NON_POSITIVE_WEIGHTS as NON_POSITIVE_WEIGHTS
from .flat_face import FlatFace as FlatFace
from .flat_face import chords_cross as chords_cross
from .flat_face import planar_region as planar_region
from .flat_face import self_intersects as self_intersects
from .patch_moments import area_moments as area_moments
from .patch_moments import stored_area_moments as stored_area_moments
from .patch_moments import vector_area as vector_area
from .patch_moments import volume_moments as volume_moments
from .patch_topology import closed_parts as closed_parts
from .piece_nets import bezier_nets as bezier_nets
from .piece_nets import evaluate_nets as evaluate_nets
from .piece_nets import sample_pieces as sample_pieces
from .quadric import TURN as TURN
from .quadric import Quadric as Quadric
from .seams import close_pairs as close_pairs
from .seams import nearest_parameters as nearest_parameters
from .seams import sharpest_crease as sharpest_crease
from .solid import PatchIntegrals as PatchIntegrals
from .solid import measure_patches as measure_patches
from .solid import measure_sheet as measure_sheet
from .spline_chart import SplineChart as SplineChart
from .splines import Curve as Curve
from .splines import Face as Face
from .splines import Patch as Patch
from .splines import patches_size as patches_size
from .splines import reverse_curves as reverse_curves
from .tracked_solid import TrackedSolid as TrackedSolid
from .trimmed_face import TrimmedFace as TrimmedFace

__all__ = [
    "Curve",
    "Patch",
    "length_moments",
    "measure_patches",
]

def __getattr__(name: str) -> Any: ...
