# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/statics`."""

from ...core.verdict.finding import error, note, warning

HULL_SIMPLIFIED = note(
    "hull_simplified",
    "“{object}” is finely divided: its convex hull is taken with {corners} corners, to {share:percent} of its size",
)
STABILITY_COMPUTED = note("stability_computed", "{count} of {total} object stands", "{count} of {total} objects stand")
OBJECTS_TIP = warning("objects_tip", "{names} tips over", "{names} tip over")
LAID_ON_GROUND = note("laid_on_ground", "Laid {count} object on the ground", "Laid {count} objects on the ground")
ALREADY_ON_GROUND = note("already_on_ground", "already on the ground")
POLL_OBJECT_OR_POSE_MODE = note("poll_object_or_pose_mode", "Switch to Object Mode or Pose Mode")
PROGRESS_BALANCE = note("progress_balance", "Following the center of mass: {share:percent}. Esc to cancel")
CANCELED_BALANCE = note("canceled_balance", "Balance Group canceled; nothing was changed")
NO_SUCH_COLLECTION = error("no_such_collection", "There is no collection “{collection}”. Choose another one.")
BALANCE_GROUP_WITHOUT_CONTACTS = error(
    "balance_group_without_contacts", "“{collection}” has no object with a surface. Choose another collection."
)
BALANCE_GROUP_EMPTY_GROUP = error(
    "balance_group_empty_group", "Nothing to follow. Select objects with a surface, or an armature that deforms some."
)
BALANCE_GROUP_MADE = note(
    "balance_group_made",
    "“{empty}” has {count} key of the center of mass; objects: {objects_count}",
    "“{empty}” has {count} keys of the center of mass; objects: {objects_count}",
)
BALANCE_GROUP_INSIDE = note("balance_group_inside", "It is over the support polygon at {count} of {total} frames")
