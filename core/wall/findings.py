# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/wall`."""

from ..verdict import error, note

NO_FACE_AREA = error(
    "no_face_area", "All faces have zero area. Move their vertices apart, or select another object."
)
WALL_NON_MANIFOLD = error(
    "wall_non_manifold",
    "{count} edge has more than two faces. Separate the parts, or set Wall to Thin.",
    "{count} edges have more than two faces. Separate the parts, or set Wall to Thin.",
)
WALL_INCONSISTENT_FACES = error(
    "wall_inconsistent_faces",
    "{count} edge joins faces with opposite normals. Use Mesh > Normals > Recalculate Outside, or "
    "set Wall to Thin.",
    "{count} edges join faces with opposite normals. Use Mesh > Normals > Recalculate Outside, or "
    "set Wall to Thin.",
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
