# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/bodies`."""

from ...core.verdict.finding import error, note, warning

NON_PLANAR_FACES_OF_DISPLAY_MESH = note(
    "non_planar_faces_of_display_mesh",
    "Non-planar faces of the display mesh: their triangulation can change the volume by up to {share:percent}.",
)
UNION_BY_BOOLEAN = note(
    "union_by_boolean", "Overlapping components were united by Blender's exact Boolean, accurate to 7 digits."
)
UNION_FAILED = error(
    "union_failed",
    "Blender's Boolean cannot unite the components. Close and clean up the mesh, or set Overlaps to Count Each Shell.",
)
OPEN_COMPONENTS_UNITED = warning(
    "open_components_united", "Open components were united; the result may not be the intended body. Close the mesh."
)
DISPLAY_MESH_NEEDED = warning(
    "display_mesh_needed",
    "The display mesh was measured, as {purpose:word} needs polygons. Raise Resolution Preview for accuracy.",
)
ZERO_SCALE = error(
    "zero_scale",
    "A zero scale flattens the object or its instances. Set their scale and their parents', or set Kind to Shell.",
)
FLAT_SURFACES = warning(
    "flat_surfaces",
    "{count} of {total} surfaces is flat: its area counts, its volume does not.",
    "{count} of {total} surfaces are flat: their areas count, their volumes do not.",
)
INSTANCE_OVERLAP_UNCHECKED = warning(
    "instance_overlap_unchecked",
    "Overlap was not checked between instances whose bounding boxes overlap. Use Object > Apply > Make Instances Real "
    "and join them.",
)
CURVE_FILL_MEASURED = warning(
    "curve_fill_measured", "Blender's fill of the curves was measured, overlapping or not: {cause}"
)
WALL_UNORIENTED = warning(
    "wall_unoriented",
    "The surface is not closed; “inward” is behind its faces as they are. Use Mesh > Normals > Flip to change sides.",
)
WALL_THICKNESS_VARIES = warning(
    "wall_thickness_varies",
    "At corners of more than three planes the wall is {minimum:.6g} to {maximum:.6g} times as thick.",
)
WALL_FACES_WITHOUT_AREA = warning(
    "wall_faces_without_area",
    "{count} face without area moved with its neighbors.",
    "{count} faces without area moved with their neighbors.",
)
WALL_OVERLAP_UNCHECKED = warning(
    "wall_overlap_unchecked", "Overlap of the walls was not checked at this thickness. Press Measure."
)
WALLS_OVERLAP = warning(
    "walls_overlap", "The walls overlap; the shared space counts twice. Reduce Thickness, or change Wall."
)
WALL_FOLDS = error(
    "wall_folds",
    "A wall of {thickness:length} ({side:word}) folds over itself near {point:point}; the largest is "
    "{largest:length}. Reduce Thickness, change Wall, or set Wall to Thin.",
)
WALL_CREASES = warning(
    "wall_creases",
    "At creases of up to {angle:.0f}° the wall overlaps or gapes, as it is not mitered. Use Object > Convert > Mesh.",
)
MASS_OVERFLOW = error("mass_overflow", "The densities are too large. Lower them.")
DENSITY_ATTRIBUTE_OF_SOLID = error(
    "density_attribute_of_solid",
    "A vertex attribute holds densities on the surface only. Set Kind to Shell, or change Density From.",
)
ATTRIBUTE_VALUES = error(
    "attribute_values",
    "The attribute “{attribute}” is negative or not finite at {count} vertex: {elements}. Set its density.",
    "The attribute “{attribute}” is negative or not finite at {count} vertices: {elements}. Set their densities.",
)
UNION_LACKS = error(
    "union_lacks",
    "A union has no {data:word}. Set Overlaps to Count Each Shell, or change Density From or Coordinates.",
)
MATERIAL_WITHOUT_DENSITY = error(
    "material_without_density",
    "{count} of {total} faces has no material with a density, and Density is zero. Set Density.",
    "{count} of {total} faces have no material with a density, and Density is zero. Set Density.",
)
MIXED_MATERIALS = warning(
    "mixed_materials",
    "{count} of {total} components has several materials ({materials}) and takes their mean by area. Use Mesh > "
    "Separate > By Material.",
    "{count} of {total} components have several materials ({materials}) and take their means by area. Use Mesh > "
    "Separate > By Material.",
)
OVERLAPPING_DENSITIES = warning(
    "overlapping_densities", "Densities add up where components overlap. Cut a cavity for each insert."
)
CAVITY_MATERIAL_IGNORED = warning(
    "cavity_material_ignored", "Materials of cavity faces are ignored: a cavity removes the surrounding material."
)
SHEARED_DENSITY_AXES = warning(
    "sheared_density_axes",
    "The object is sheared; its density follows the nearest right-angled axes. Use Object > Apply > Scale.",
)
DENSITY_POSSIBLY_NEGATIVE = warning(
    "density_possibly_negative", "The density may be negative inside the object, though no tested point shows it."
)
DENSITY_NEGATIVE = error(
    "density_negative",
    "The density is negative: {density:.4g} kg/m³ at {point:point} in {frame:word} coordinates. Change Polynomial "
    "or Coordinates.",
)
DENSITY_FROM_SAMPLES = note("density_from_samples", "samples")
DENSITY_FROM_GRID = note("density_from_grid", "grid “{grid}”")
DENSITY_FROM_ATTRIBUTE = note("density_from_attribute", "vertex attribute “{attribute}”")
DENSITY_FROM_MATERIALS = note("density_from_materials", "materials: {materials}")
DENSITY_OF_MATERIAL = note("density_of_material", "{material} {density:.7g} kg/m³")
DENSITY_OF_OTHERS = note("density_of_others", "others {density:.7g} kg/m³")
GRID_DENSITY = note("grid_density", "Density from {samples:size} samples. {cause}")
GRID_WITHOUT_SURFACE = note(
    "grid_without_surface", "A grid has no surface: the area is 0, the volume is that of the voxels that are not empty."
)
LEVEL_SET_MEASURED = note(
    "level_set_measured",
    "The level set “{grid}” was measured as a solid of {polygons} polygons, within a fraction of a voxel.",
)
GRID_IS_LEVEL_SET = error(
    "grid_is_level_set",
    "The grid “{grid}” is a level set of distances, not densities. Set Measure As to Solid, or choose another grid.",
)
GRID_IS_NOT_LEVEL_SET = error(
    "grid_is_not_level_set", "The grid “{grid}” is not a level set. Set Measure As to Density."
)
GRID_EMPTY = error("grid_empty", "The grid is empty or flattened. Choose another grid, or check Values and the scale.")
DENSITY_GRID_ELSEWHERE = error(
    "density_grid_elsewhere", "The grid “{grid}” of “{object}” has no density inside the object. Check where both are."
)
OUTSIDE_GRID = warning(
    "outside_grid", "{share:percent} of the volume is outside the grid and counts as empty. Enlarge the grid."
)
THRESHOLD_MEASURED = note(
    "threshold_measured",
    "The body where the grid “{grid}” is at least {threshold}, by its interpolant. Its surface passes through "
    "{cells} cells.",
)
THRESHOLD_CLIPPED = warning(
    "threshold_clipped",
    "The body reaches the edge of the grid “{grid}” and is cut off there. Raise Threshold, or enlarge the grid.",
)
THRESHOLD_NOT_REACHED = error(
    "threshold_not_reached",
    "No value of the grid “{grid}” reaches the threshold {threshold}; the largest is {largest}. Lower Threshold.",
)
THRESHOLD_NEEDS_FACTOR = error(
    "threshold_needs_factor",
    "Within a threshold, values become densities by a factor alone. Set Values to Factor, or Filled With to Material.",
)
GRID_AS_SHELL = error("grid_as_shell", "A grid holds densities inside a solid only. Set Kind to Solid.")
OPEN_SURFACE_OF_GRID = error(
    "open_surface_of_grid", "The surface is open, so the inside of the grid is undefined. Close the mesh."
)
SAMPLES_POSITIONED = note("samples_positioned", "The samples stand at the given positions along {axes}.")
GIVEN_DENSITY_IGNORED = warning("given_density_ignored", "The samples are densities; the given density was not used.")
SHAPE_OF_GRID = warning("shape_of_grid", "A grid of densities has no shape for a pose or signature.")
WIRE_UNSUPPORTED = error(
    "wire_unsupported", "{quantity:word} is not available for wires. Set Kind to Solid or Shell, or convert to a mesh."
)
SHAPE_OF_OPEN_SURFACE = error(
    "shape_of_open_surface",
    "Pose and signature depend on the reference point, as the surface is open. Close it, or set Kind to Shell.",
)
SHAPE_FAR_FROM_ORIGIN = error(
    "shape_far_from_origin", "Too far from the world origin for an accurate shape. Move the object nearer."
)
SIGNATURE_NEEDS_POLYGONS = error(
    "signature_needs_polygons", "The signature needs polygons. Use Object > Convert > Mesh."
)
FOURIER_NO_EXTENT = error("fourier_no_extent", "The object has no extent. Set Max Frequency.")
FOURIER_APPROXIMATE = note(
    "fourier_approximate",
    "The fast Fourier transform of this grid is accurate to {share:g} of its value at 0. Use --q for the closed form.",
)
FOURIER_OF_UNIFORM_DENSITY = warning(
    "fourier_of_uniform_density", "The Fourier transform is that of the shape, with uniform density."
)
OUTLINES_CROSS = error(
    "outlines_cross",
    "Outlines cross or overlap, or faces cross themselves. Move them apart, or cut and unite the faces of a mesh.",
)
SECTION_FACES_REVERSED = warning(
    "section_faces_reversed",
    "{count} face points the other way and counts with the others.",
    "{count} faces point the other way and count with the others.",
)
SECTION_FACES_OVERLAP = warning(
    "section_faces_overlap", "Faces overlap or cross themselves; the shared area counts for each. Separate them."
)
SECTION_OVERLAP_UNCHECKED = warning("section_overlap_unchecked", "Too many edges to check all for overlap.")
SECTION_PROJECTED = warning(
    "section_projected", "Points up to {share:percent} of the size off the plane were projected. Flatten the faces."
)
SECTION_FILL_WRONG = warning(
    "section_fill_wrong",
    "Blender's fill covers {share:percent} of the area; the outlines were measured. Simplify them.",
)
MESH_STREAMED = warning(
    "mesh_streamed",
    "{count} face was read in blocks, without repair: self-intersection, nested and inside-out components were not "
    "looked for. Use --stream never where memory allows it.",
    "{count} faces were read in blocks, without repair: self-intersection, nested and inside-out components were "
    "not looked for. Use --stream never where memory allows it.",
)
STREAMED_OPEN = warning(
    "streamed_open",
    "The surface is not closed, or its faces disagree: the volume depends on the reference point. Repair the mesh, "
    "or use --stream never.",
)
RIG_WITHOUT_PARTS = error(
    "rig_without_parts",
    "No deforming bone moves a mesh that can be measured, and nothing is parented to bones. Turn on Deform, or add an "
    "Armature modifier to the mesh.",
)
BONE_MISSING = warning(
    "bone_missing", "Its parent bone “{bone}” does not exist, so it is not in the total. Choose another one."
)
BONE_PART_IMPOSSIBLE = error(
    "bone_part_impossible", "No body has the moments of the bone's part: {cause} Check weights and normals."
)
BONE_PARTS_IMPOSSIBLE = warning(
    "bone_parts_impossible",
    "{count} bone has a part whose moments no body has: {names}. Check weights and normals.",
    "{count} bones have parts whose moments no body has: {names}. Check weights and normals.",
)
UNWEIGHTED_VERTICES = warning(
    "unweighted_vertices",
    "{count} of {total} vertices has no weight on a deforming bone; faces with such vertices alone go with the "
    "nearest bone. Assign weights.",
    "{count} of {total} vertices have no weight on a deforming bone; faces with such vertices alone go with the "
    "nearest bone. Assign weights.",
)
RIG_WALL_THIN = note("rig_wall_thin", "The wall counts as a thin sheet: area times thickness.")
RIG_MEAN_DENSITY = warning(
    "rig_mean_density", "The density varies; every bone's part has the mean density of the mesh."
)
CENTER_GIVEN = note("center_given", "The center of mass is given.")
INERTIA_GIVEN = note("inertia_given", "The inertia is given.")
GIVEN_INERTIA_IMPOSSIBLE = error(
    "given_inertia_impossible",
    "No body has the given inertia: its principal moments are {moments}, and none may be negative or exceed the "
    "sum of the other two. Check signs and units.",
)
GIVEN_CENTER_OUTSIDE = warning(
    "given_center_outside", "The given center of mass is outside the object. Check Center of Mass."
)
GIVEN_CENTER_MISSING = warning(
    "given_center_missing", "The given mass is at the world origin, for no member has a mass. Turn on Given Center."
)
ASSEMBLY_MASS_GIVEN = note("assembly_mass_given", "The mass of the assembly is given: {mass:.7g} kg.")
ASSEMBLY_WITHOUT_MEMBERS = error(
    "assembly_without_members", "Nothing in the assembly has a mass. Add objects that can be measured, or set its mass."
)
MEMBERS_NOT_MEASURED = warning(
    "members_not_measured",
    "{count} member cannot be measured and is not in the total: {names}. Measure it alone to see why.",
    "{count} members cannot be measured and are not in the total: {names}. Measure them alone to see why.",
)
MEMBERS_COUNTED_BEFORE = note(
    "members_counted_before",
    "{count} member is in the assembly more than once and counts once: {names}.",
    "{count} members are in the assembly more than once and count once: {names}.",
)
MEMBERS_LEFT_OUT = note(
    "members_left_out",
    "{count} member is not rendered, or only an operand of Boolean modifiers, and is not in the total: {names}.",
    "{count} members are not rendered, or only operands of Boolean modifiers, and are not in the total: {names}.",
)
MEMBERS_EXCLUDED = warning(
    "members_excluded",
    "{count} member is excluded or disabled and is not in the total: {names}. Enable it in the Outliner.",
    "{count} members are excluded or disabled and are not in the total: {names}. Enable them in the Outliner.",
)
MEMBERS_HIDDEN = note(
    "members_hidden", "{count} member is hidden and counts: {names}.", "{count} members are hidden and count: {names}."
)
MEMBERS_DENSITY_UNSET = warning(
    "members_density_unset",
    "{count} member has no density or mass set and counts with the default: {names}. Set Density.",
    "{count} members have no density or mass set and count with the default: {names}. Set Density.",
)
INSTANCE_STRETCHES_SHEETS = error(
    "instance_stretches_sheets",
    "The instance stretches shells or wires unevenly, and their mass has no one factor. Give it a uniform scale.",
)
