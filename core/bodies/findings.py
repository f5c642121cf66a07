# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/bodies`."""

from ..verdict import error, note, warning

NON_PLANAR_FACES_OF_DISPLAY_MESH = note(
    "non_planar_faces_of_display_mesh",
    "Non-planar faces of the display mesh: their triangulation can change the volume by up to "
    "{share:percent}.",
)
FLAT_SURFACES = warning(
    "flat_surfaces",
    "{count} of {total} surfaces is flat: its area counts, its volume does not.",
    "{count} of {total} surfaces are flat: their areas count, their volumes do not.",
)
WALL_UNORIENTED = warning(
    "wall_unoriented",
    "The surface is not closed; “inward” is behind its faces as they are. Use Mesh > Normals > "
    "Flip to change sides.",
)
WALL_THICKNESS_VARIES = warning(
    "wall_thickness_varies",
    "At corners of more than three planes the wall is {minimum:.6g} to {maximum:.6g} times as "
    "thick.",
)
WALL_FACES_WITHOUT_AREA = warning(
    "wall_faces_without_area",
    "{count} face without area moved with its neighbors.",
    "{count} faces without area moved with their neighbors.",
)
WALLS_OVERLAP = warning(
    "walls_overlap",
    "The walls overlap; the shared space counts twice. Reduce Thickness, or change Wall.",
)
WALL_FOLDS = error(
    "wall_folds",
    "A wall of {thickness:length} ({side:word}) folds over itself near {point:point}; the largest "
    "is "
    "{largest:length}. Reduce Thickness, change Wall, or set Wall to Thin.",
)
MASS_OVERFLOW = error("mass_overflow", "The densities are too large. Lower them.")
DENSITY_FROM_GRID = note("density_from_grid", "grid “{grid}”")
GRID_DENSITY = note("grid_density", "Density from {samples:size} samples. {cause}")
GRID_WITHOUT_SURFACE = note(
    "grid_without_surface",
    "A grid has no surface: the area is 0, the volume is that of the voxels that are not empty.",
)
GRID_EMPTY = error(
    "grid_empty",
    "The grid is empty or flattened. Choose another grid, or check Values and the scale.",
)
THRESHOLD_MEASURED = note(
    "threshold_measured",
    "The body where the grid “{grid}” is at least {threshold}, by its interpolant. Its surface "
    "passes through "
    "{cells} cells.",
)
THRESHOLD_CLIPPED = warning(
    "threshold_clipped",
    "The body reaches the edge of the grid “{grid}” and is cut off there. Raise Threshold, or "
    "enlarge the grid.",
)
THRESHOLD_NOT_REACHED = error(
    "threshold_not_reached",
    "No value of the grid “{grid}” reaches the threshold {threshold}; the largest is {largest}. "
    "Lower Threshold.",
)
THRESHOLD_NEEDS_FACTOR = error(
    "threshold_needs_factor",
    "Within a threshold, values become densities by a factor alone. Set Values to Factor, or "
    "Filled With to Material.",
)
GRID_AS_SHELL = error(
    "grid_as_shell", "A grid holds densities inside a solid only. Set Kind to Solid."
)
SAMPLES_POSITIONED = note(
    "samples_positioned", "The samples stand at the given positions along {axes}."
)
GIVEN_DENSITY_IGNORED = warning(
    "given_density_ignored", "The samples are densities; the given density was not used."
)
SHAPE_OF_GRID = warning(
    "shape_of_grid", "A grid of densities has no shape for a pose or signature."
)
WIRE_UNSUPPORTED = error(
    "wire_unsupported",
    "{quantity:word} is not available for wires. Set Kind to Solid or Shell, or convert to a mesh.",
)
SHAPE_OF_OPEN_SURFACE = error(
    "shape_of_open_surface",
    "Pose and signature depend on the reference point, as the surface is open. Close it, or set "
    "Kind to Shell.",
)
FAR_FROM_ORIGIN = "the object is too far from the world origin. Move it nearer"
NEEDS_POLYGONS = "a signature needs polygons. Use Object > Convert > Mesh"
SHAPE_UNAVAILABLE = error("shape_unavailable", "No pose or signature: {cause:word}.")
MESH_STREAMED = warning(
    "mesh_streamed",
    "{count} face was read in blocks, without repair: self-intersection, nested and inside-out "
    "components were not "
    "looked for. Use --stream never where memory allows it.",
    "{count} faces were read in blocks, without repair: self-intersection, nested and inside-out "
    "components were "
    "not looked for. Use --stream never where memory allows it.",
)
STREAMED_OPEN = warning(
    "streamed_open",
    "The surface is not closed, or its faces disagree: the volume depends on the reference point. "
    "Repair the mesh, "
    "or use --stream never.",
)
DRAWN_AS_POLYGONS = note(
    "drawn_as_polygons",
    "The round shape was measured as drawn polygons. Doubling the resolution makes the error four "
    "times smaller.",
)
GRID_TOO_LARGE = error(
    "grid_too_large",
    "The grid “{grid}” spans too many voxels, {samples:size}. Crop it, or use a coarser one.",
)
DENSITY_DEFAULTED = warning(
    "density_defaulted", "No density is set: {density} was used. Set Density or a material."
)
