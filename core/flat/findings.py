# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/flat`."""

from ..verdict import error

OUTLINES_ENCLOSE_NONE = "the outlines enclose none. Close them"
NO_SECTION_AREA = error("no_section_area", "No area: {fault:word}.")
SECTION_NOT_FLAT = error(
    "section_not_flat",
    "Not flat: points are up to {share:percent} of the size off a plane. Select faces of one "
    "plane, or flatten them.",
)
OUTLINES_COINCIDE = error("outlines_coincide", "Two outlines coincide. Delete one.")
OUTLINE_OPEN = error(
    "outline_open",
    "The outline is open at {count} corner. Close it.",
    "The outline is open at {count} corners. Close it.",
)
