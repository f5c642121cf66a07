# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/wall`."""

from ..verdict import error, note

NO_FACE_AREA = error(
    "no_face_area", "All faces have zero area. Move their vertices apart, or select another object."
)
WALL_WITHOUT_SIDES = error(
    "wall_without_sides",
    "No sides at {count} edge: {fault:word}, or set Wall to Thin.",
    "No sides at {count} edges: {fault:word}, or set Wall to Thin.",
)
WALL_PRECISION_LOST = error(
    "wall_precision_lost",
    "{share:percent} of the area is in faces too small, so far from the origin, to have a "
    "direction in float32. Model "
    "nearer to the origin, or set Wall to Thin.",
)
WALL_MEASURED = note(
    "wall_measured",
    "The wall was measured with real thickness: {thickness:length}, {side:word}, mitered corners.",
)
PRINT_UNFIT = error(
    "print_unfit",
    "It cannot be printed like this: {fault:word}. See Kind: Printed in the panel Density, or "
    "--print.",
)
