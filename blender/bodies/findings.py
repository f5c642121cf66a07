# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/bodies`."""

from ...core.verdict import error, note, warning

BODIES_OVERLAP = note(
    "bodies_overlap",
    "“{first}” and “{second}” share space, which counts twice.",
    "{count} pairs of bodies share space, which counts twice, such as “{first}” and “{second}”.",
)
UNION_BY_BOOLEAN = note(
    "union_by_boolean",
    "Overlapping components were united by Blender's Boolean, accurate to 7 digits.",
)
UNION_FAILED = error(
    "union_failed",
    "Blender's Boolean cannot unite the components. Close and clean up the mesh, or set Overlaps "
    "to Count Each Shell.",
)
OPEN_COMPONENTS_UNITED = warning(
    "open_components_united",
    "Open components were united; the result may not be the intended body. Close the mesh.",
)
ZERO_SCALE = error(
    "zero_scale",
    "A zero scale flattens the object or its instances. Set their scale and their parents', or set "
    "Kind to Shell.",
)
CURVE_FILL_MEASURED = warning(
    "curve_fill_measured", "Blender's fill of the curves was measured, overlapping or not: {cause}"
)
WALL_CREASES = warning(
    "wall_creases",
    "At creases of up to {angle:.0f}° the wall overlaps or gapes, as it is not mitered. Use Object "
    "> Convert > Mesh.",
)
DENSITY_ATTRIBUTE_OF_SOLID = error(
    "density_attribute_of_solid",
    "A vertex attribute holds densities on the surface only. Set Kind to Shell, or change Density "
    "From.",
)
ATTRIBUTE_VALUES = error(
    "attribute_values",
    "The attribute “{attribute}” is negative or not finite at {count} vertex: {elements}. Set its "
    "density.",
    "The attribute “{attribute}” is negative or not finite at {count} vertices: {elements}. Set "
    "their densities.",
)
UNION_LACKS = error(
    "union_lacks",
    "A union has no {data:word}. Set Overlaps to Count Each Shell, or change Density From or "
    "Coordinates.",
)
MATERIAL_WITHOUT_DENSITY = error(
    "material_without_density",
    "{count} of {total} faces has no material with a density, and Density is zero. Set Density.",
    "{count} of {total} faces have no material with a density, and Density is zero. Set Density.",
)
MIXED_MATERIALS = warning(
    "mixed_materials",
    "{count} of {total} components has several materials ({materials}) and takes their mean by "
    "area. Use Mesh > "
    "Separate > By Material.",
    "{count} of {total} components have several materials ({materials}) and take their means by "
    "area. Use Mesh > "
    "Separate > By Material.",
)
OVERLAPPING_DENSITIES = warning(
    "overlapping_densities",
    "Densities add up where components overlap. Cut a cavity for each insert.",
)
CAVITY_MATERIAL_IGNORED = warning(
    "cavity_material_ignored",
    "Materials of cavity faces are ignored: a cavity removes the surrounding material.",
)
SHEARED_DENSITY_AXES = warning(
    "sheared_density_axes",
    "The object is sheared; its density follows the nearest right-angled axes. Use Object > Apply "
    "> Scale.",
)
DENSITY_POSSIBLY_NEGATIVE = warning(
    "density_possibly_negative",
    "The density may be negative inside the object, though no tested point shows it.",
)
DENSITY_NEGATIVE = error(
    "density_negative",
    "The density is negative: {density:.4g} kg/m³ at {point:point} in {frame:word} coordinates. "
    "Change Polynomial "
    "or Coordinates.",
)
DENSITY_FROM_ATTRIBUTE = note("density_from_attribute", "vertex attribute “{attribute}”")
DENSITY_FROM_MATERIALS = note("density_from_materials", "materials: {materials}")
DENSITY_OF_MATERIAL = note("density_of_material", "{material} {density:.7g} kg/m³")
DENSITY_OF_OTHERS = note("density_of_others", "others {density:.7g} kg/m³")
LEVEL_SET_MEASURED = note(
    "level_set_measured",
    "The level set “{grid}” was measured as a solid of {polygons} polygons, within a fraction of a "
    "voxel.",
)
DENSITY_GRID_ELSEWHERE = error(
    "density_grid_elsewhere",
    "The grid “{grid}” of “{object}” has no density inside the object. Check where both are.",
)
OUTSIDE_GRID = warning(
    "outside_grid",
    "{share:percent} of the volume is outside the grid and counts as empty. Enlarge the grid.",
)
OPEN_SURFACE_OF_GRID = error(
    "open_surface_of_grid",
    "The surface is open, so the inside of the grid is undefined. Close the mesh.",
)
FOURIER_NO_EXTENT = error("fourier_no_extent", "The object has no extent. Set Max Frequency.")
FOURIER_APPROXIMATE = note(
    "fourier_approximate",
    "The fast Fourier transform of this grid is accurate to {share:g} of its value at 0. Use --q "
    "for the closed form.",
)
FOURIER_OF_UNIFORM_DENSITY = warning(
    "fourier_of_uniform_density",
    "The Fourier transform is that of the shape, with uniform density.",
)
OUTLINES_CROSS = error(
    "outlines_cross",
    "Outlines cross or overlap, or faces cross themselves. Move them apart, or cut and unite the "
    "faces of a mesh.",
)
SECTION_FACES_REVERSED = warning(
    "section_faces_reversed",
    "{count} face points the other way and counts with the others.",
    "{count} faces point the other way and count with the others.",
)
SECTION_FACES_OVERLAP = warning(
    "section_faces_overlap",
    "Faces overlap or cross themselves; the shared area counts for each. Separate them.",
)
SECTION_PROJECTED = warning(
    "section_projected",
    "Points up to {share:percent} of the size off the plane were projected. Flatten the faces.",
)
SECTION_FILL_WRONG = warning(
    "section_fill_wrong",
    "Blender's fill covers {share:percent} of the area; the outlines were measured. Simplify them.",
)
RIG_WITHOUT_PARTS = error(
    "rig_without_parts",
    "No deforming bone moves a mesh that can be measured, and nothing is parented to bones. Turn "
    "on Deform, add an "
    "Armature modifier to the mesh, or assign weights with Object > Parent > With Automatic "
    "Weights.",
)
BONE_MISSING = warning(
    "bone_missing",
    "Its parent bone “{bone}” does not exist, so it is not in the total. Choose another one.",
)
BONE_PART_IMPOSSIBLE = error(
    "bone_part_impossible",
    "No body has the moments of the bone's part: {cause} Check weights and normals.",
)
BONE_PARTS_IMPOSSIBLE = warning(
    "bone_parts_impossible",
    "{count} bone has a part whose moments no body has: {names}. Check weights and normals.",
    "{count} bones have parts whose moments no body has: {names}. Check weights and normals.",
)
UNWEIGHTED_VERTICES = warning(
    "unweighted_vertices",
    "{count} of {total} vertices has no weight on a deforming bone; faces with such vertices alone "
    "go with the "
    "nearest bone. Assign weights.",
    "{count} of {total} vertices have no weight on a deforming bone; faces with such vertices "
    "alone go with the "
    "nearest bone. Assign weights.",
)
RIG_WALL_THIN = note("rig_wall_thin", "The wall counts as a thin sheet: area times thickness.")
RIG_MEAN_DENSITY = warning(
    "rig_mean_density", "The density varies; every bone's part has the mean density of the mesh."
)
INERTIA = "inertia"
GIVEN = note("given", "Given: {quantity:word}.")
GIVEN_INERTIA_IMPOSSIBLE = error(
    "given_inertia_impossible",
    "No body has the given inertia: its principal moments are {moments}, and none may be negative "
    "or exceed the "
    "sum of the other two. Check signs and units.",
)
CENTER_OUTSIDE = "The given center of mass is outside the object. Check Center of Mass"
CENTER_MISSING = (
    "The given mass is at the world origin, for no member has a mass. Turn on Given Center"
)
GIVEN_CENTER = warning("given_center", "{fault:word}.")
ASSEMBLY_MASS_GIVEN = note(
    "assembly_mass_given", "The mass of the assembly is given: {mass:.7g} kg."
)
ASSEMBLY_WITHOUT_MEMBERS = error(
    "assembly_without_members",
    "Nothing in the assembly has a mass. Add objects that can be measured, or set its mass.",
)
MEMBERS_NOT_MEASURED = warning(
    "members_not_measured",
    "{count} member cannot be measured and is not in the total: {names}. Measure it alone to see "
    "why.",
    "{count} members cannot be measured and are not in the total: {names}. Measure them alone to "
    "see why.",
)
MEMBERS_COUNTED_BEFORE = note(
    "members_counted_before",
    "{count} member is in the assembly more than once and counts once: {names}.",
    "{count} members are in the assembly more than once and count once: {names}.",
)
MEMBERS_LEFT_OUT = note(
    "members_left_out",
    "{count} member is not rendered, or only an operand of Boolean modifiers, and is not in the "
    "total: {names}.",
    "{count} members are not rendered, or only operands of Boolean modifiers, and are not in the "
    "total: {names}.",
)
MEMBERS_EXCLUDED = warning(
    "members_excluded",
    "{count} member is excluded or disabled and is not in the total: {names}. Enable it in the "
    "Outliner.",
    "{count} members are excluded or disabled and are not in the total: {names}. Enable them in "
    "the Outliner.",
)
MEMBERS_HIDDEN = note(
    "members_hidden",
    "{count} member is hidden and counts: {names}.",
    "{count} members are hidden and count: {names}.",
)
MEMBERS_DENSITY_UNSET = warning(
    "members_density_unset",
    "{count} member has the default density: {names}. Set Density.",
    "{count} members have the default density: {names}. Set Density.",
)
INSTANCE_STRETCHES_SHEETS = error(
    "instance_stretches_sheets",
    "The instance stretches shells or wires unevenly, and their mass has no one factor. Give it a "
    "uniform scale.",
)
