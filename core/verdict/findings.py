# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/verdict`."""

from .finding import error, note, warning

NO_FACES = error("no_faces", "No faces. Add faces, or select another object.")
OBJECT_TOO_LARGE = error("object_too_large", "Too large to be measured. Scale the object down.")
OBJECT_TOO_SMALL = error("object_too_small", "Too small to be measured. Scale the object up.")
FLIPPED_FACES = warning(
    "flipped_faces",
    "Flipped face measured as reversed: {elements}. Use Mesh > Normals > Recalculate Outside.",
    "{count} flipped faces measured as reversed: {elements}. Use Mesh > Normals > Recalculate Outside.",
)
SELF_INTERSECTION = warning(
    "self_intersection",
    "The surface intersects itself: about {share:percent} of the volume counts twice or as negative. Set Overlaps "
    "to Count as Union, or repair the mesh.",
)
OUT_OF_MEMORY = error("out_of_memory", "Too little memory. Measure it alone, reduce it, or use a larger machine.")
INTERNAL_ERROR = error("internal_error", "Internal error: {type}: {error} ({where}). Please report it.")
AND_MORE = note("and_more", "and {count} more")

# Clauses of a list of defects.
DEFECT_BOUNDARY_EDGES = note("defect_boundary_edges", "{count} boundary edge", "{count} boundary edges")
DEFECT_NON_MANIFOLD_EDGES = note("defect_non_manifold_edges", "{count} non-manifold edge", "{count} non-manifold edges")
DEFECT_INCONSISTENT_EDGES = note(
    "defect_inconsistent_edges", "{count} edge with opposite normals", "{count} edges with opposite normals"
)
DEFECT_DUPLICATE_FACES = note("defect_duplicate_faces", "{count} duplicate face", "{count} duplicate faces")
DEFECT_DEGENERATE_FACES = note("defect_degenerate_faces", "{count} zero-area face", "{count} zero-area faces")
DEFECT_FLIPPED_FACES = note("defect_flipped_faces", "{count} flipped face", "{count} flipped faces")
