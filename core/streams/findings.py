# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/streams`."""

from ..verdict import error, note

STL_CUT_SHORT = error(
    "stl_cut_short", "The STL file is cut short or damaged: it does not end {end:word}."
)
THREEMF_EXTENSION = error(
    "threemf_extension",
    "The 3MF file needs an extension that is not read, and that may change its shape: {name}. "
    "Export it as plain meshes.",
)
NEGATIVE_PARTS_CUT = note(
    "negative_parts_cut", "Negative parts of the project were cut away by Boolean: {names}."
)
NEGATIVE_PARTS_UNFIT = error(
    "negative_parts_unfit",
    "The negative parts {names} cannot be cut from “{object}”: {cause:word}. Correct them in the "
    "slicer, or cut there and export the result.",
)
