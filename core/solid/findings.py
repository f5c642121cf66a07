# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/solid`."""

from ..verdict import error, note, repair, warning

INVALID_FACES = error(
    "invalid_faces",
    "Faces use vertices that do not exist. Run mesh.validate() in the Python Console.",
)
NON_FINITE_VERTICES = error(
    "non_finite_vertices",
    "{count} of {total} vertices has no finite coordinates. Delete it, or fix the modifier, driver "
    "or import that "
    "made it.",
    "{count} of {total} vertices have no finite coordinates. Delete them, or fix the modifier, "
    "driver or import "
    "that made them.",
)
VERTICES_WELDED = repair(
    "vertices_welded",
    "Open edges were welded: vertices moved by up to {share:percent} of the size. Use Mesh > Merge "
    "> By Distance.",
)
DUPLICATE_FACES_IGNORED = repair(
    "duplicate_faces_ignored",
    "Duplicate face left out: {elements}. Delete it.",
    "{count} duplicate faces left out: {elements}. Delete them.",
)
DUPLICATE_FACES_COUNTED = warning(
    "duplicate_faces_counted",
    "Duplicate face counted twice: {elements}. Delete it.",
    "{count} duplicate faces counted twice: {elements}. Delete them.",
)
T_JUNCTIONS = note(
    "t_junctions",
    "{count} gap without area (T-junction) was taken as closed.",
    "{count} gaps without area (T-junctions) were taken as closed.",
)
INVERTED_COMPONENTS = repair(
    "inverted_components",
    "Inside-out components measured as reversed: {count} of {total}. Use Mesh > Normals > "
    "Recalculate Outside.",
)
HOLES_CAPPED = repair(
    "holes_capped",
    "Holes capped: {count} ({flat} flat, {curved} curved; {share:percent} of the area). Use Mesh > "
    "Clean Up > Fill "
    "Holes.",
)
ONE_SIDED_COMPONENTS = warning(
    "one_sided_components",
    "One-sided components cannot be closed: {count} of {total}. Volume, center of mass and inertia "
    "depend on the "
    "reference point. Set Kind to Shell.",
)
NON_MANIFOLD_COMPONENTS = warning(
    "non_manifold_components",
    "Components cannot be closed where more than two faces meet at an edge: {count} of {total}. "
    "Volume, center of mass "
    "and inertia depend on the reference point. Delete interior faces and fill holes, or set Kind "
    "to Shell.",
)
CAVITIES_SUBTRACTED = note(
    "cavities_subtracted",
    "{count} cavity was subtracted: an inward component inside another.",
    "{count} cavities were subtracted: inward components inside others.",
)
CAVITIES_BREAK_THROUGH = warning(
    "cavities_break_through",
    "{count} cavity breaks through its wall, by up to {share:percent} of the size; what lies "
    "outside counts as "
    "negative. Make the cavity smaller or the wall thicker.",
    "{count} cavities break through their walls, by up to {share:percent} of the size; what lies "
    "outside counts as "
    "negative. Make the cavities smaller or the walls thicker.",
)
COMPONENTS_NESTED = warning(
    "components_nested",
    "{count} outward component lies inside another; the shared space counts twice. Flip cavities, "
    "or set Overlaps to "
    "Count as Union.",
    "{count} outward components lie inside others; the shared space counts twice. Flip cavities, "
    "or set Overlaps to "
    "Count as Union.",
)
COMPONENTS_OVERLAP = warning(
    "components_overlap",
    "{count} components overlap; the shared space counts twice. Set Overlaps to Count as Union.",
)
OVERLAP_OF_INSTANCES = (
    "the overlap of instances whose bounding boxes overlap. Use Object > Apply > Make "
    "Instances Real and join them"
)
OVERLAP_OF_COMPONENTS = "the overlap of some components, which would take too long"
UNCHECKED = warning("unchecked", "Not checked: {subject:word}.")
FLAT_COMPONENTS = warning(
    "flat_components",
    "{count} of {total} components is flat and has no volume. Delete it, or set Kind to Shell.",
    "{count} of {total} components are flat and have no volume. Delete them, or set Kind to Shell.",
)
FLAT_SURFACE = warning(
    "flat_surface", "The surface is flat and encloses no volume. Set Kind to Shell."
)
SELF_INTERSECTING = warning(
    "self_intersecting",
    "The surface intersects itself and regions count as negative. Set Overlaps to Count as Union, "
    "or repair the mesh.",
)
NON_PLANAR_FACES = warning(
    "non_planar_faces",
    "Non-planar faces: their triangulation can change the volume by up to {share:percent}. Use "
    "Face > Triangulate "
    "Faces.",
)
