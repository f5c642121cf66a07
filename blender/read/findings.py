# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/read`."""

from ...core.verdict import error, note, warning

INSTANCES_VANISHED = note(
    "instances_vanished",
    "Left out: {count} instance scaled to zero.",
    "Left out: {count} instances scaled to zero.",
)
NON_FINITE_INSTANCES = error(
    "non_finite_instances",
    "{count} of {total} instance transforms is not finite. Fix what makes NaN or infinity.",
    "{count} of {total} instance transforms are not finite. Fix what makes NaN or infinity.",
)
NO_INSTANCES = (
    "the empty instances nothing with a surface. Choose a collection with one in Object "
    "Properties > Instancing"
)
NOT_SHOWN = error("not_shown", "Nothing is shown: {cause:word}.")
OBJECT_UNREADABLE = error("object_unreadable", "“{object}” cannot be read: {cause}")
INSTANCED_BY_PARENT = note(
    "instanced_by_parent",
    "Shown only as instances of “{parent}”; measured once, at its own location.",
)
NOT_IN_SCENE = error(
    "not_in_scene", "Not in the scene “{scene}”. Link the object to a collection of the scene."
)
HIDDEN_IN_VIEWPORT = error(
    "hidden_in_viewport",
    "“{name}” is not shown in the viewport. Turn on its {switch:word} in the Outliner.",
)
HIDDEN_OBJECT_MEASURED = warning("hidden_object_measured", "Measured although not shown: {cause}")
OBJECT_WITHOUT_GEOMETRY = error(
    "object_without_geometry",
    "Objects of type {type} have no geometry. Select an object with a surface.",
)
NON_FINITE_TRANSFORM = error(
    "non_finite_transform",
    "The transform is not finite. Reset location, rotation and scale, of the parents too.",
)
NOT_RENDERED = note(
    "not_rendered", "Not rendered. Turn on the camera icon in the Outliner, or use --all."
)
BOOLEAN_OPERAND = note(
    "boolean_operand", "Only an operand of Boolean modifiers. Use --all to measure it."
)
READ_IN_MODE = note("read_in_mode", "Read as shown in {mode:word}.")
EDIT_MODE_SINGLE_SHAPE_KEY = warning(
    "edit_mode_single_shape_key",
    "Only the edited shape key “{shape_key}” was read. Leave Edit Mode to blend all.",
)
MODIFIERS_LEFT_OUT = warning(
    "modifiers_left_out", "Modifiers were left out in Edit Mode: {modifiers}. Leave Edit Mode."
)
SCULPTED_MESH = error(
    "sculpted_mesh", "Dyntopo or sculpted levels cannot be read in Sculpt Mode. Leave it."
)
MODIFIER_ERROR = warning("modifier_error", "The modifier “{modifier}” reports an error: {error}")
RENDER_DIFFERS = warning(
    "render_differs", "Measured as in the viewport; the render differs: {differences}."
)
MEMBERS_DIFFER_IN_RENDER = warning("members_differ_in_render", "{treatment:word}: {objects}.")
RENDER_MODIFIER_DIFFERS = note(
    "render_modifier_differs", "“{modifier}” is only in the {place:word}"
)
RENDER_LEVELS_DIFFER = note(
    "render_levels_differ", "{name:word}: {viewport} in the viewport, {render} in the render"
)
ONLY_WITHOUT_SURFACE = error(
    "only_without_surface",
    "No surface, only {kinds}. Fill faces, or add a surface with a modifier.",
)
SURFACELESS_LEFT_OUT = warning("surfaceless_left_out", "Left out: {kinds}.")
LINES_ONLY = (
    "lines without a surface. Add a bevel or extrusion, fill the curve or text, or set Kind to Wire"
)
NO_SPLINE_LENGTH = "no spline has a length. Add points, or move them apart"
NO_SPLINE_SURFACE = (
    "no spline has a surface: too few points for the order or for Bézier ends. Add points, "
    "lower Order, or turn off Bézier in Active Spline"
)
NOTHING_TO_MEASURE = error("nothing_to_measure", "Nothing to measure: {cause:word}.")
METABALL_OF_FAMILY = error(
    "metaball_of_family",
    "“{object}” holds the polygons of this metaball family. Measure that object.",
)
METABALL_FAMILY = note("metaball_family", "Holds the polygons of its metaball family: {objects}.")
KIND_COUNT = note("kind_count", "{kind:word}: {count}")
CURVE_MEASURED_WHOLE = warning(
    "curve_measured_whole", "The curve was measured without {ignored:word}."
)
SPLINES_LEFT_OUT = warning(
    "splines_left_out",
    "{count} of {total} splines is left out: too few points for its order or for Bézier ends.",
    "{count} of {total} splines are left out: too few points for their order or for Bézier ends.",
)
UNKNOWN_KNOTS = error(
    "unknown_knots",
    "Blender does not expose the imported knots. Turn Endpoint off and on in Active Spline to make "
    "known ones.",
)
ONLY_CURVES_ARE_WIRES = error(
    "only_curves_are_wires", "Only curves can be wires. Set Kind to Solid or Shell."
)
SHAPE_KEYS_OF_OTHER_POINTS = error(
    "shape_keys_of_other_points",
    "The shape keys were made for another number of points. Remove them, or undo what added or "
    "removed points.",
)
CONTROL_POINTS_RECOVERED = warning(
    "control_points_recovered",
    "Control points were recovered from the display mesh, accurate to 6 digits, as modifiers or "
    "keys move them.",
)
DISPLAY_MESH_FOR_MODIFIERS = warning(
    "display_mesh_for_modifiers",
    "The display mesh was measured, as modifiers work on it: {modifiers}. Raise Resolution Preview "
    "for accuracy.",
)
DISPLAY_MESH_MEASURED = warning(
    "display_mesh_measured",
    "The display mesh was measured, as {cause:word}. Raise Resolution Preview for accuracy.",
)
ATTRIBUTE_MISSING = error(
    "attribute_missing",
    "No attribute “{attribute}” with a float per vertex. Create it, use Convert Attribute, or "
    "change Attribute.",
)
GRID_MISSING = error("grid_missing", "No grid “{grid}”; the volume has {grids}. Change Grid.")
NO_SCALARS = "does not hold scalar numbers. Choose another grid"
NEEDS_OPENVDB = (
    "can only be read with the openvdb module, which this Blender was built without. Use a "
    "Blender of blender.org, or turn the grid into a mesh by a modifier"
)
IS_LEVEL_SET = (
    "is a level set of distances, not densities. Set Measure As to Solid, or choose another grid"
)
GRID_UNSUPPORTED = error("grid_unsupported", "The grid “{grid}” {fault:word}.")
NO_SCALAR_GRID = error(
    "no_scalar_grid",
    "No grid holds scalar numbers; the volume has {grids:word}. Choose another file, or add a "
    "modifier that makes grids.",
)
GRID_UNREADABLE = error(
    "grid_unreadable",
    "The grid “{grid}” is missing or cannot be read: {error}. Choose another file or grid.",
)
GRID_NAMES_REPEATED = warning(
    "grid_names_repeated",
    "Several grids have the same name; only the first counts. Rename the others.",
)
GRID_SIMPLIFIED = warning(
    "grid_simplified",
    "Simplify reduces the voxels to {share:percent} of their resolution. Turn off Simplify in "
    "Render Properties.",
)
TEMPORARY_FOLDER_FULL = error(
    "temporary_folder_full",
    "Voxels cannot be written to the temporary folder. Free some disk space.",
)
WRONG_TYPE = "Only meshes, 2D curves and texts can be flat shapes. Convert the object to a mesh"
EXTRUDED = (
    "The curve is 3D, extruded, beveled or offset. Set it to 2D, and Extrude, Bevel Depth and "
    "Offset to 0, or use Object > Convert > Mesh"
)
FLAT_UNSUITABLE = error("flat_unsuitable", "{fault:word}.")
FILL_MODIFIED = "Blender's fill with its modifiers was measured"
NOT_FILLED = "The curve is not filled; its outlines were measured as if filled"
SECTION_FILL = note("section_fill", "{treatment:word}.")
SECTION_SPLINES_OPEN = warning(
    "section_splines_open",
    "{count} open spline encloses nothing and was left out. Use Toggle Cyclic.",
    "{count} open splines enclose nothing and were left out. Use Toggle Cyclic.",
)
SOLID_CHANGED = error(
    "solid_changed",
    "The shape was changed after it came from a CAD file, which holds its exact surfaces. Undo "
    "the change, or import the file again.",
)
SCALE_ZERO_AXIS = error(
    "scale_zero_axis", "A scale is zero along an axis: its own, a delta or a parent's. Set it."
)
TOTAL_DOUBTFUL_PARTS = warning(
    "total_doubtful_parts", "{kind:word} count as bodies: {objects}. Leave out what is not a part."
)
TOTAL_COPIES_IN_PLACE = warning(
    "total_copies_in_place",
    "Copies at an equal place count again: {objects}. Delete or move those that were left behind.",
)
ARMATURE_UNAVAILABLE = error("armature_unavailable", "No armature to measure: {cause:word}.")
REFERENCE_OBJECT_MISSING = error(
    "reference_object_missing", "No object is chosen as the reference. Choose one in Object."
)
MEMBER_COUNTED_BEFORE = note("member_counted_before", "Counted already, in “{assembly}”.")
