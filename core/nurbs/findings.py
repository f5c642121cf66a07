# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/nurbs`."""

from ..verdict import error, warning

NON_FINITE = "no finite coordinates. Delete them, or fix the modifier or driver that moves them"
NON_POSITIVE_WEIGHTS = "weights that are not positive. Set their weights above zero"
CONTROL_POINTS_INVALID = error("control_points_invalid", "Some control points have {fault:word}.")
CURVES_BOUND_NOTHING = error("curves_bound_nothing", "{fault:word}, or set Kind to Wire.")
NO_EXTENT = error("no_extent", "All control points coincide. Move them apart.")
DISCONTINUOUS_PATCH = error(
    "discontinuous_patch",
    "A patch can be discontinuous at a knot repeated as often as its order. Split the patch there.",
)
ERROR_ESTIMATE_LARGE = warning(
    "error_estimate_large",
    "The estimated error of the {quantity:word} is above the target; extreme weights or folds are "
    "the cause.",
)
FLIPPED_PATCHES = warning(
    "flipped_patches",
    "{count} patch faces against the others and was measured as reversed. Use Segments > Switch "
    "Direction.",
    "{count} patches face against the others and were measured as reversed. Use Segments > Switch "
    "Direction.",
)
AMBIGUOUS_PATCH_SIDES = warning(
    "ambiguous_patch_sides",
    "{count} patch side meets more than one other, so the orientation is a guess. Make all patches "
    "face outward.",
    "{count} patch sides meet more than one other, so the orientation is a guess. Make all patches "
    "face outward.",
)
INVERTED_PATCH_COMPONENTS = warning(
    "inverted_patch_components",
    "Inside-out components measured as reversed: {count} of {total}. Use Segments > Switch "
    "Direction.",
)
OPEN_PATCH_SIDES = warning(
    "open_patch_sides",
    "Open patch sides form no loops to cap, or the surface is one-sided. Volume, center of mass "
    "and inertia "
    "depend on "
    "the reference point. Close the surface, or set Kind to Shell.",
)
PATCH_HOLES_CAPPED = warning(
    "patch_holes_capped",
    "Holes capped: {flat} flat, exactly, and {curved} curved, by a cone ({share:percent} of the "
    "area). Close the "
    "surface.",
)
PATCH_BOUNDARY_CROSSES_ITSELF = warning(
    "patch_boundary_crosses_itself",
    "{count} boundary crosses itself; the region beyond the crossing counts as negative.",
    "{count} boundaries cross themselves; the regions beyond the crossings count as negative.",
)
WALL_THICKER_THAN_CURVATURE = error(
    "wall_thicker_than_curvature",
    "The wall is thicker than the radius of curvature of its surface. Reduce Thickness.",
)
