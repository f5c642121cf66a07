# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the sentences that numbers come with are alarms. The others say what was measured, of which no person who
asked for it would doubt the numbers.

The text decides, for that is all that is stored with the numbers.
"""

from collections.abc import Iterable

DRAWN = "measured as the polygons that Blender draws"
PLAIN = (
    DRAWN,
    "Read from the mesh being edited.",
    "Read in Edit Mode, with the modifiers that act there",
    "Read in Sculpt Mode, with the modifiers that act there",
    "Its shells were united by Blender's exact boolean",
    "Its wall was measured as real material",
    "Its density is the grid “",
    "It has no surface, and its area is told as 0",
)


def alarms(sentences: Iterable[str]) -> list[str]:
    """Those that are more than plain statements."""
    sentences = list(sentences)
    # How polygons are cut that stand for something round matters less than that they do.
    drawn = any(DRAWN in one for one in sentences)
    plain = (*PLAIN, "Faces that are not flat: the choice of their diagonals") if drawn else PLAIN
    return [one for one in sentences if not any(part in one for part in plain)]
