# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/session`."""

from ...core.verdict import error, warning

MASS_MOMENTS_UNKNOWN = (
    "Moments of the mass are not available to this order for this object. Set Order to 3, or "
    "Domain to Volume"
)
MOMENTS_OF_AREA_ONLY = "These numbers exist for the area of flat shapes alone. Set Domain to Area"
INVARIANTS_ORDER = "Invariants need a higher order. Set Order, and compute the moments"
MOMENTS_UNAVAILABLE = error("moments_unavailable", "{fault:word}.")
LEFT_OUT_OF_ROBOT = warning(
    "left_out_of_robot", "{count} of {total} objects are no links: {causes}"
)
NO_SUCH_NAME = error(
    "no_such_name", "There is no {kind:word} “{name}” in the file or its scene. Choose another one."
)
BALANCE_GROUP_EMPTY = error(
    "balance_group_empty",
    "No object with a surface: {place:word}. Choose another collection, or select objects with a "
    "surface or an armature that deforms some.",
)
