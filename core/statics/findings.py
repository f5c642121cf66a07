# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/statics`."""

from ..verdict import error

BALANCE_NO_EFFECT = error(
    "balance_no_effect",
    "Moving these vertices cannot bring the center of mass there. Select more, or others.",
)
BALANCE_SHORT = error(
    "balance_short",
    "The center of mass stays {distance:length} short. Select more vertices, a nearer point or, if "
    "moves of at most "
    "{limit:length} do not suffice, a larger Max Distance.",
)
BALANCE_FOLDS_FACES = error(
    "balance_folds_faces",
    "{count} face would turn over. Select more vertices, or a nearer point.",
    "{count} faces would turn over. Select more vertices, or a nearer point.",
)
CENTER_OUTSIDE_HULL = error(
    "center_outside_hull",
    "The center of mass is outside the convex hull: no body can have it there. Check the surface "
    "and the density.",
)
NO_STABLE_POSE = error("no_stable_pose", "There is no pose in which it rests: it rolls on.")
