# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/inertia`."""

from ..verdict import error, note

NO_CERTAIN_VOLUME = error(
    "no_certain_volume",
    "The volume is zero within rounding, or float32 coordinates may change more than a tenth of "
    "it. Close the surface, "
    "move vertices nearer to the object's origin, set Kind to Shell, or use Measure Section for a "
    "flat shape.",
)
MOMENTS_OVERFLOW = error(
    "moments_overflow",
    "Moments of order {order} exceed the range of numbers. Scale the object, or choose a lower "
    "order.",
)
NEGATIVE_INERTIA = error(
    "negative_inertia",
    "The surface intersects itself or cannot be closed, and regions count as negative. Set "
    "Overlaps to Count as "
    "Union, repair the mesh, or set Kind to Shell.",
)
AXES_FREE = note(
    "axes_free",
    "Principal moments {axes} are equal; the {choice:word} nearest to the object's axes are used.",
)
ANY_DIRECTIONS = "directions"
DIRECTIONS_OF_SHAPE = "shape's own directions"
AXES_AMBIGUOUS = note(
    "axes_ambiguous",
    "The moments are the same after half a turn; the directions nearest to the object's axes are "
    "used.",
)
STRICT_RULE_UNDEFINED = error(
    "strict_rule_undefined", "Zhang and Chen's rule is undefined {where:word}. Turn it off."
)
AXIS_POINTS_COINCIDE = error(
    "axis_points_coincide",
    "The two points of the axis are too near to each other. Move one of them.",
)
