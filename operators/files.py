# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""File paths of operators that write a file, as set in the file browser."""

from __future__ import annotations

import os
from collections.abc import Collection

import bpy
from bpy.types import Context, Operator


def ask_for_table(operator: Operator, context: Context) -> set[str]:
    """Open the file browser, at first on a table beside the .blend and of its name."""
    if not operator.filepath:
        operator.filepath = bpy.path.ensure_ext(bpy.data.filepath.removesuffix(".blend") or "masses", ".csv")
    context.window_manager.fileselect_add(operator)
    return {"RUNNING_MODAL"}


def ensure_suffix(operator: Operator, suffix: str, others: Collection[str] = ()) -> bool:
    """Give the path the suffix, unless it has one of the others or no name at all.

    Return whether the path was changed, as `check` does.
    """
    path, name = operator.filepath, os.path.basename(operator.filepath)
    if name and os.path.splitext(name)[1].lower() not in others:
        operator.filepath = bpy.path.ensure_ext(path, suffix)
    return operator.filepath != path
