# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/verdict`."""

from .finding_types import error, note, repair, warning

NO_FACES = error("no_faces", "No surface. Add faces, or check whether a modifier removes them.")
TOO_LARGE = "Too large to be measured. Scale the object down"
TOO_SMALL = "Too small to be measured. Scale the object up"
OBJECT_SIZE = error("object_size", "{fault:word}.")
FLIPPED_FACES = repair(
    "flipped_faces",
    "Flipped face measured as reversed: {elements}. Use Mesh > Normals > Recalculate Outside.",
    "{count} flipped faces measured as reversed: {elements}. Use Mesh > Normals > Recalculate "
    "Outside.",
)
SELF_INTERSECTION = warning(
    "self_intersection",
    "The surface intersects itself: about {share:percent} of the volume counts twice or as "
    "negative. Set Overlaps "
    "to Count as Union, or repair the mesh.",
)
TOTAL_OF_OPEN_OBJECTS = warning(
    "total_of_open_objects",
    "The total depends on the reference point, as these are open: {objects}. Close them, or leave "
    "them out.",
)
LINKED_OBJECT = error(
    "linked_object",
    "Linked from another file, or an override of something linked, which would lose the change. "
    "Use Object > Relations "
    "> Make Local for the object and its data.",
)
OUT_OF_MEMORY = error(
    "out_of_memory", "Too little memory. Measure it alone, reduce it, or use a larger machine."
)
INTERNAL_ERROR = error(
    "internal_error", "Internal error: {type}: {error} ({where}). Please report it."
)
AND_MORE = note("and_more", "and {count} more")
