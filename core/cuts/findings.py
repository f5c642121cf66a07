# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/cuts`."""

from ..verdict import error, warning

NO_FACES_TO_CUT = "there are no faces"
SURFACE_NEEDED = "it needs a mesh with faces, and for a level a solid. Convert it, or set Kind"
PLANE_MISSES = "the plane misses it. Choose a plane through it"
CLOSED_SURFACE = "the surface is closed. Delete its bottom, or use Level"
NO_RIM = "the surface has no rim. Choose a height or an object"
RIM_UPRIGHT = "its rim stands upright or is too short for a plane. Choose a height or an object"
PLANE_FAR = "the plane is too far away for a volume. Choose a height nearer to it"
PLANE_UPRIGHT = "its plane stands upright or its scale is zero. Turn it, or choose a height"
OVERHANGS = (
    "faces overhang, so that there are several heights at one place. Remove them, or compare with "
    "a plane"
)
APART = "nowhere is one above the other. Move them over each other"
CUT_FILL_UNAVAILABLE = error("cut_fill_unavailable", "No cut and fill: {fault:word}.")
COMPARED_IN_PART = warning(
    "compared_in_part",
    "Only {share:percent} of its area is above or below the other surface; the rest is left out.",
)
NO_HOLLOW = (
    "it has neither a cavity nor a hollow that is open upward. Turn the opening up, or close leaks"
)
LIQUID_ABSENT = "the level is below the bottom. Raise it"
SHARED_SPACE = "its components overlap. Set Overlaps to Count as Union"
LEVEL_UNAVAILABLE = error("level_unavailable", "No level: {fault:word}.")
VESSEL_OVERFLOWS = error(
    "vessel_overflows",
    "It holds at most {capacity:.6g} m³, up to {level:length}. Choose a lower level or less "
    "liquid.",
)
