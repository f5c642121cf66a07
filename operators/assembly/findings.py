# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `operators/assembly`."""

from ...core.verdict.finding import error, note

MEMBERS_NOT_STORED = note(
    "members_not_stored",
    "{count} member cannot hold results: {names}.",
    "{count} members cannot hold results: {names}.",
)
NO_ACTIVE_COLLECTION = error("no_active_collection", "No collection is active. Click one in the Outliner.")
NO_ACTIVE_ASSEMBLY_EMPTY = error(
    "no_active_assembly_empty", "The active object is not an empty with children. Select one."
)
ASSEMBLY_MEASURED = note(
    "assembly_measured",
    "{assembly}: {mass:.7g} kg from {count} object",
    "{assembly}: {mass:.7g} kg from {count} objects",
)
ASSEMBLY_HAS_OPEN_MEMBERS = error(
    "assembly_has_open_members",
    "A member is open, and its center depends on a reference point. Close its mesh, or set Kind to Shell.",
)
CURSOR_TO_ASSEMBLY = note("cursor_to_assembly", "Moved the 3D cursor to the center of mass of “{assembly}”")
EMPTY_AT_ASSEMBLY = note("empty_at_assembly", "Placed an empty at the principal frame of “{assembly}”")
ASSEMBLY_OFFSET_SET = note("assembly_offset_set", "Instances of “{assembly}” are placed by its center of mass")
ASSEMBLY_ORIGIN_MOVED = note("assembly_origin_moved", "Moved “{assembly}” to the center of mass; its children stay")
CHILDREN_WOULD_MOVE = error(
    "children_would_move",
    "These would move with it: {names}. Remove what holds them, such as constraints or animation.",
)
BILL_WRITTEN = note(
    "bill_written", "Wrote the masses of {count} member to “{file}”", "Wrote the masses of {count} members to “{file}”"
)
