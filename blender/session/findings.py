# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/session`."""

from ...core.verdict import error, warning

MASS_MOMENTS_UNKNOWN = error(
    "mass_moments_unknown",
    "Moments of the mass are not available to order {order} for this object. Set Order to 3, or "
    "Domain to Volume.",
)
MOMENTS_OF_AREA_ONLY = error(
    "moments_of_area_only",
    "These numbers exist for the area of flat shapes alone. Set Domain to Area.",
)
INVARIANTS_ORDER = error(
    "invariants_order", "Invariants need order {order}. Set Order, and compute the moments."
)
LEFT_OUT_OF_ROBOT = warning(
    "left_out_of_robot", "{count} of {total} objects are no links: {causes}"
)
NO_SUCH_NAME = error(
    "no_such_name", "There is no {kind:word} “{name}” in the file or its scene. Choose another one."
)
BALANCE_GROUP_WITHOUT_CONTACTS = error(
    "balance_group_without_contacts",
    "“{collection}” has no object with a surface. Choose another collection.",
)
BALANCE_GROUP_EMPTY_GROUP = error(
    "balance_group_empty_group",
    "Nothing to follow. Select objects with a surface, or an armature that deforms some.",
)
