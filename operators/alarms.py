# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the sentences that numbers come with are alarms. The others say what was measured, of which no person who
asked for it would doubt the numbers.

The text decides, for that is all that is stored with the numbers.
"""

from collections.abc import Iterable

PLAIN = (
    "measured as the polygons that Blender draws",
    "Read from the mesh being edited.",
    "Read in Edit Mode, with the modifiers that act there",
    "Read in Sculpt Mode, with the modifiers that act there",
    "Its shells were united by Blender's exact boolean",
    "Its wall was measured as real material",
)


def alarms(sentences: Iterable[str]) -> list[str]:
    """Those that are more than plain statements."""
    return [one for one in sentences if not any(plain in one for plain in PLAIN)]
