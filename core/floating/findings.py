# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/floating`."""

from ..verdict import error, warning

OPEN_HULL = "its surface does not close. Close the holes, or set Kind to Solid"
SHARED_SPACE = "parts overlap, so that they would displace water twice. Unite them, or move them"
FLOODED_OUTSIDE = (
    "a flooded space reaches out of the hull or overlaps another. Keep it inside, or make its Part "
    "Body"
)
NO_BODY = "it has no volume that displaces the liquid. Use a mesh"
NO_MASS = "it has no mass. Set a Density or a Mass"
NO_GRAVITY = "the scene has no gravity. Turn on Gravity in the scene's properties"
NO_LIQUID_DENSITY = "the density of the liquid is zero. Choose another liquid"
NO_REST = "no position was found in which it rests. Turn it a little and try again"
FLOAT_UNAVAILABLE = error("float_unavailable", "It cannot float: {fault:word}.")
SINKS = error(
    "sinks",
    "It sinks: remove more than {excess:.6g} kg of its {mass:.6g} kg, or choose a denser liquid.",
)
LIQUID_ENTERS = error(
    "liquid_enters",
    "Liquid runs in through an opening {depth:length} below the waterline. Close the hole, raise "
    "the rim or reduce the mass.",
)
HOLLOW_FLOODED = warning(
    "hollow_flooded",
    "Its hollow counts as full of the liquid, which runs in {depth:length} over the rim. Raise the "
    "rim or reduce the mass to keep it dry.",
)
