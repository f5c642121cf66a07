# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/statics`."""

from ..verdict.finding import error

BALANCE_NO_AREA = error("balance_no_area", "No movable vertex belongs to a face with area. Select others.")
BALANCE_ZERO_VOLUME = error("balance_zero_volume", "The faces enclose no volume. Close the mesh, or set Kind to Shell.")
BALANCE_NO_EFFECT = error(
    "balance_no_effect", "Moving these vertices cannot bring the center of mass there. Select more."
)
BALANCE_SHORT = error(
    "balance_short", "The center of mass stays {distance:length} short. Select more vertices, or a nearer point."
)
BALANCE_SHORT_BY_LIMIT = error(
    "balance_short_by_limit",
    "With Max Distance {limit:length} the center of mass stays {distance:length} short. Raise Max Distance, "
    "or select more vertices.",
)
BALANCE_FOLDS_FACES = error(
    "balance_folds_faces",
    "{count} face would turn over. Select more vertices, or a nearer point.",
    "{count} faces would turn over. Select more vertices, or a nearer point.",
)
CENTER_OUTSIDE_HULL = error(
    "center_outside_hull",
    "The center of mass is outside the convex hull: no body can have it there. Check the surface and the density.",
)
NO_STABLE_POSE = error("no_stable_pose", "There is no pose in which it rests: it rolls on.")
