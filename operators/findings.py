# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of the operators, by subject."""

from ..core.verdict.finding import error, note, warning

# assembly

MEMBERS_NOT_STORED = note(
    "members_not_stored",
    "{count} member cannot hold results: {names}.",
    "{count} members cannot hold results: {names}.",
)
NO_ACTIVE_COLLECTION = error("no_active_collection", "No collection is active. Click one in the Outliner.")
NO_ACTIVE_ASSEMBLY_EMPTY = error(
    "no_active_assembly_empty", "The active object is not an empty with children. Select one."
)
ASSEMBLY_MEASURED = note(
    "assembly_measured",
    "{assembly}: {mass:.7g} kg from {count} object",
    "{assembly}: {mass:.7g} kg from {count} objects",
)
ASSEMBLY_HAS_OPEN_MEMBERS = error(
    "assembly_has_open_members",
    "A member is open, and its center depends on a reference point. Close its mesh, or set Kind to Shell.",
)
CURSOR_TO_ASSEMBLY = note("cursor_to_assembly", "Moved the 3D cursor to the center of mass of “{assembly}”")
EMPTY_AT_ASSEMBLY = note("empty_at_assembly", "Placed an empty at the principal frame of “{assembly}”")
ASSEMBLY_OFFSET_SET = note("assembly_offset_set", "Instances of “{assembly}” are placed by its center of mass")
ASSEMBLY_ORIGIN_MOVED = note("assembly_origin_moved", "Moved “{assembly}” to the center of mass; its children stay")
CHILDREN_WOULD_MOVE = error(
    "children_would_move",
    "These would move with it: {names}. Remove what holds them, such as constraints or animation.",
)
BILL_WRITTEN = note(
    "bill_written", "Wrote the masses of {count} member to “{file}”", "Wrote the masses of {count} members to “{file}”"
)

# export

ROBOT_EXPORTED = note("robot_exported", "{count} link exported to {file}.", "{count} links exported to {file}.")
ROBOT_SHEARED = warning(
    "robot_sheared", "Bodies must not be sheared. Apply the scale of the parents of {links} (Object > Apply > Scale)."
)
ROBOT_NAMES_ALIKE = error("robot_names_alike", "Blender gives {names} one name in USD. Rename one of them.")
ROBOT_GEOMETRY_NOT_WRITTEN = error("robot_geometry_not_written", "Blender's exporter failed: {error}.")
ROBOT_NOT_WRITTEN = error("robot_not_written", "The file cannot be written: {error}.")
ROBOT_COPIED = note("robot_copied", "Inertial of {count} link copied.", "Inertials of {count} links copied.")
PRIMITIVES_ADDED = note("primitives_added", "{count} shape added", "{count} shapes added")
PRIMITIVE_HAS_PARENT = error("primitive_has_parent", "It has a parent, or is linked. Clear the parent to simulate it.")
AUDIT_TEXT = note("audit_text", "See the text “{text}” in the Text Editor")

LIBRARY_OVERRIDE_MASS = error(
    "library_override_mass",
    "A library override, which would lose its rigid body mass. Use Object > Relations > Make Local.",
)
RIGID_BODY_NEEDS_MESH = error("rigid_body_needs_mesh", "Only meshes can be rigid bodies. Use Object > Convert > Mesh.")
RIGID_BODY_MASS_TOO_SMALL = error(
    "rigid_body_mass_too_small", "The mass {mass:.3g} kg is below the {limit:.3g} kg of a rigid body. Raise Density."
)
RIGID_BODY_DISPLAY_SCALED = note(
    "rigid_body_display_scaled",
    "Physics properties show masses times {factor:.6g} (unit scale cubed); the physics engine uses kilograms.",
)
FILE_EXISTS = error("file_exists", "The file “{file}” exists. Turn on Overwrite.")
NO_EXPORT_FILE = error("no_export_file", "No file is named. Choose one.")
FILE_NOT_WRITTEN = error("file_not_written", "The file cannot be written: {error}")
NOTHING_MEASURABLE = note("nothing_measurable", "Nothing selected can be measured")
NOTHING_TO_DO = note("nothing_to_do", "Nothing to do: {cause}")
LEFT_UNCHANGED = warning("left_unchanged", "{count} of {total} left unchanged: {causes}")
RESULTS_REMOVED = note(
    "results_removed", "Removed the results of {count} object", "Removed the results of {count} objects"
)
NO_RESULTS_TO_REMOVE = note("no_results_to_remove", "The selected objects have no results")

# imports

SCAN_NON_FINITE = error("scan_non_finite", "Some samples are not finite. Remove them.")
SCAN_DRAWN_EVENLY = note(
    "scan_drawn_evenly",
    "Blender draws samples evenly. They are measured where they stand; the ends along {axes} are in their places.",
)
SCAN_CT_NUMBERS = note("scan_ct_numbers", "Negative values are taken as CT numbers, by the transfer table.")
SURFACES_IMPORTED = note(
    "surfaces_imported",
    "Imported {count} patch of order {order} from {file}.",
    "Imported {count} patches of order {order} at most from {file}.",
)
NOT_IMPORTED = warning("not_imported", "Not imported: {cause}")
NO_SURFACE_FILE = error("no_surface_file", "No file is chosen. Choose IGES or .obj files.")
VOLUME_NOT_WRITTEN = error("volume_not_written", "The volume cannot be written: {error}")
OPENVDB_MISSING = error("openvdb_missing", "This Python has no openvdb module. Use Blender.")
NO_IMPORT_FILE = error("no_import_file", "No file is chosen. Choose a scan.")
SCAN_IMPORTED = note("scan_imported", "Imported {samples:size} samples as “{file}”")

# measure

FOURIER_FOLDER_MISSING = error(
    "fourier_folder_missing", "The folder “{folder}” does not exist. Choose another File Path."
)
FOURIER_PATH_MISSING = error("fourier_path_missing", "No file is chosen. Set File Path.")
MODIFIED_MESH = error(
    "modified_mesh",
    "Modifiers change the mesh, so its defects are not those of what is measured. Apply or hide {modifiers}.",
)
AXIS_NEEDS_TWO_POINTS = error(
    "axis_needs_two_points", "{count} points are selected. Select two vertices, or two objects."
)
REFERENCE_STORED = note(
    "reference_stored",
    "Stored the inertia of {count} object about the reference",
    "Stored the inertia of {count} objects about the reference",
)
MEASURED_ONE = note("measured_one", "Measured {object}")
MEASURED_ONE_WITH_WARNINGS = warning("measured_one_with_warnings", "Measured {object}, with warnings")
MEASURED_SEVERAL = note("measured_several", "Measured {count} of {total} objects")
WITH_WARNINGS = warning("with_warnings", "{count} with warnings: {objects}")
OBJECT_WARNINGS = warning("object_warnings", "{object}: {causes}")
MEASURED_SECTION = note("measured_section", "Measured the section of {object}")
MEASURED_SECTION_WITH_WARNINGS = warning(
    "measured_section_with_warnings", "Measured the section of {object}, with warnings"
)
MEASURED_SECTIONS = note("measured_sections", "Measured {count} section", "Measured {count} sections")
NO_DEFECTS = note("no_defects", "Measured {count} object: no defects", "Measured {count} objects: no defects")
WITH_DEFECTS = warning(
    "with_defects",
    "{count} of {total} measured objects has defects",
    "{count} of {total} measured objects have defects",
)
OBJECT_DEFECTS = warning("object_defects", "{object}: {defects}")
VALUE_COPIED = note("value_copied", "Copied {value}")
NO_VALUE_TO_COPY = warning("no_value_to_copy", "No value to copy")
CSV_COPIED = note("csv_copied", "Copied {count} row.", "Copied {count} rows.")
NUMBERS_SAVED = note("numbers_saved", "Saved {count} object to “{file}”.", "Saved {count} objects to “{file}”.")
NUMBERS_SUFFIX = error(
    "numbers_suffix", "The format of “{file}” is unknown. Let its name end in .csv, .json or .jsonl."
)
REPORT_COPIED = note("report_copied", "Copied the report of {count} object", "Copied the report of {count} objects")
SECTION_COPIED = note("section_copied", "Copied the section of {object}")
MOMENTS_COMPUTED = note("moments_computed", "Computed {count} moments of {object}")
MOMENTS_COPIED = note("moments_copied", "Copied {count} moments")
WIRE_WITHOUT_MOMENTS = warning(
    "wire_without_moments",
    "{object}: a wire has no volume or surface. Set Kind to Solid or Shell; measure --order gives moments of length.",
)
FOURIER_WRITTEN = note(
    "fourier_written", "Wrote {count} frequencies to {file}; the image {image} shows slices of their magnitude"
)
LIBRARY_NOT_STARTED = error("library_not_started", "No process can be started: {error}.")
LIBRARY_FAILED = error(
    "library_failed", "Measuring the library failed with exit code {code}. Use the command line to see why."
)
LIBRARY_MEASURED = note(
    "library_measured", "{count} file measured; report: {file}", "{count} files measured; report: {file}"
)
LIBRARY_MEASURED_WITH_FAILURES = warning(
    "library_measured_with_failures",
    "{count} file measured, {failed} without a result; report: {file}",
    "{count} files measured, {failed} of them not or not fully; report: {file}",
)
PANEL_FOURIER_DEFAULT = note("panel_fourier_default", "0 rad/m: from the object's size")

# rig

BONES_MEASURED = note(
    "bones_measured",
    "{armature}: {mass:.7g} kg in the parts of {count} bone",
    "{armature}: {mass:.7g} kg in the parts of {count} bones",
)
PHYSICS_RIG_CREATED = note("physics_rig_created", "Rigid bodies created: {count}, joints: {joints}")
PHYSICS_RIG_TOO_LIGHT = error(
    "physics_rig_too_light",
    "Rigid bodies weigh {limit:.3g} kg at least, and these parts less: {names}. Scale the character, or set masses.",
)
RIG_CENTER_ADDED = note("rig_center_added", "Added the center of mass of “{armature}”, which follows its pose")

# setup

LIBRARY_OVERRIDE_SETTINGS = error(
    "library_override_settings",
    "A library override, which would lose its settings. Use Object > Relations > Make Local.",
)
MATERIAL_NOT_LOCAL = error("material_not_local", "No local material “{material}”. Make it local.")
RIGID_BODIES_MADE = note(
    "rigid_bodies_made",
    "{count} rigid body of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
    "{count} rigid bodies of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
)
NODE_GROUP_ADDED = note("node_group_added", "Added the node group “{group}”")
NODE_MARKER_ADDED = note("node_marker_added", "Added the node group “{group}” and the marker “{object}”")
NODE_MARKER_IS_OF_SOLID = note("node_marker_is_of_solid", "nodes take the object as a solid of one density")
NO_REVERSED_FACES = note("no_reversed_faces", "no faces were measured as reversed")
FACES_REVERSED = note("faces_reversed", "Reversed {count} face", "Reversed {count} faces")
MATERIAL_SET = note("material_set", "Set {count} object to {material}", "Set {count} objects to {material}")
MATERIAL_SET_ALREADY = note("material_set_already", "already set to {material}")
BLENDER_MATERIAL_SET = note("blender_material_set", "Set “{target}” to {material}")
SETTINGS_COPIED = note(
    "settings_copied", "Copied the settings to {count} object", "Copied the settings to {count} objects"
)
SETTINGS_EQUAL = note("settings_equal", "the settings are equal")

# shape

MIRROR_IMAGE = error("mirror_image", "A mirror image of the active object, which no rotation can match.")
FLAT_MIRROR_IMAGE = error(
    "flat_mirror_image", "A mirror image of the active object, seen from the front. Turn it over, or mirror it."
)
FLAT_AND_BODY = error(
    "flat_and_body", "A flat shape and a body cannot match. Select objects of one kind, or set Kind to Shell."
)
LIBRARY_OVERRIDE_SYMMETRY = error(
    "library_override_symmetry",
    "A library override, which would lose its symmetry. Use Object > Relations > Make Local.",
)
ACTIVE_IS_CHILD = error(
    "active_is_child", "The active object is a child of this one and would move along. Clear the parent."
)
POSES_MATCHED = note("poses_matched", "Moved {count} object onto {object}", "Moved {count} objects onto {object}")
POSE_DISTANCE = note("pose_distance", "{object}: surfaces at most {maximum:length} apart, {mean:length} on average")
POSE_NOT_A_COPY = warning(
    "pose_not_a_copy",
    "{object}: surfaces at most {maximum:length} apart, {mean:length} on average; not a copy, or cut off",
)
OBJECT_NOT_IN_VIEW_LAYER = error("object_not_in_view_layer", "No object {object} in the view layer")
RECORDS_LEFT_OUT = warning("records_left_out", "Left out: {causes}")
LIBRARY_FILE_UNREADABLE = error("library_file_unreadable", "{file} cannot be read: {error}")
SYMMETRY_FOUND = note("symmetry_found", "{object}: {group}, {description}")
SYMMETRY_FOUND_OF_DISPLAY_MESH = note(
    "symmetry_found_of_display_mesh", "{object}: {group}, {description}, of the display mesh"
)
SYMMETRY_SEARCHED = note("symmetry_searched", "Searched {count} object", "Searched {count} objects")
SYMMETRY_SPHERE = note("symmetry_sphere", "sphere")
SYMMETRY_REVOLUTION = note("symmetry_revolution", "body of revolution")
SYMMETRY_REVOLUTION_REVERSIBLE = note("symmetry_revolution_reversible", "body of revolution, symmetric end to end")
SYMMETRY_AXES = note(
    "symmetry_axes", "{count} rotation axis, {order}-fold", "{count} rotation axes, up to {order}-fold"
)
SYMMETRY_PLANES = note("symmetry_planes", "{count} mirror plane", "{count} mirror planes")
SYMMETRY_INVERSION = note("symmetry_inversion", "center of inversion")
SYMMETRY_NONE = note("symmetry_none", "no symmetry")

# snap

SCALE_ZERO_AXIS_OF_PARENT_TARGET = error(
    "scale_zero_axis_of_parent_target", "The scale is zero along an axis. Set the scale, or turn off Parent to Object."
)
EMPTY_FOLLOWED = error(
    "empty_followed", "The object follows its empty “{empty}” and would move along. Clear that parent or constraint."
)
EMPTY_CONSTRAINED = error("empty_constrained", "A constraint holds the empty “{empty}”. Remove it.")
NOT_A_RIGID_BODY = error("not_a_rigid_body", "Not a rigid body. Turn on Add Rigid Bodies.")
RIGID_BODY_CENTER_ELSEWHERE = warning(
    "rigid_body_center_elsewhere",
    "Physics uses the origin as center of mass, which differs for {objects}. Use Axes to Principal Axes.",
)
BALANCE_NO_SELECTION = error("balance_no_selection", "No vertex is selected. Select the vertices that may move.")
BALANCE_NO_GROUP = error("balance_no_group", "No vertex group “{group}”. Choose one in Vertex Group.")
BALANCE_NO_ACTIVE_GROUP = error("balance_no_active_group", "No vertex group. Add one with the vertices that may move.")
BALANCE_GROUP_EMPTY = error(
    "balance_group_empty", "No vertex has a weight in the vertex group “{group}”. Assign the vertices that may move."
)
BALANCE_TRIANGULATION_VARIES = error(
    "balance_triangulation_varies", "The triangulation changes with every move. Use Face > Triangulate Faces."
)
BALANCE_LINKED_MESH = error("balance_linked_mesh", "The mesh is linked from another file. Make it local.")
BALANCE_SHAPE_KEYS = error("balance_shape_keys", "The mesh has shape keys. Apply or remove them.")
BALANCE_WALL = error("balance_wall", "Balancing needs a thin shell. Set Wall to Thin.")
BALANCE_VARYING_DENSITY = error(
    "balance_varying_density", "Balancing needs uniform density. Set Density From to One Value."
)
BALANCE_UNCLEAN = error(
    "balance_unclean",
    "The mesh is not closed with all faces outward. Merge by distance, fill holes and recalculate normals, or"
    " set Kind to Shell.",
)
BALANCE_ZERO_SCALE = error("balance_zero_scale", "A zero scale flattens the object. Set the scale.")
BALANCE_INSTANCES = error("balance_instances", "The object shows instances. Use Object > Apply > Make Instances Real.")
BALANCE_MODIFIED = error("balance_modified", "The measured shape is made by {modifiers}. Apply or hide them.")
BALANCE_MODIFIED_UNKNOWN = error(
    "balance_modified_unknown", "The measured shape is made by animation, constraints or instances. Apply them."
)
BALANCE_MESH_SHARED = note("balance_mesh_shared", "Other objects use this mesh and changed too.")
BALANCE_ONLY_ACTIVE = note(
    "balance_only_active", "Only “{object}” was balanced; the other meshes in Edit Mode are unchanged."
)
ORIENTATION_NEEDS_VIEWPORT = warning("orientation_needs_viewport", "A transform orientation needs an open 3D Viewport.")
ALIGNED_TO_WORLD = note(
    "aligned_to_world", "Aligned {count} object to the world axes", "Aligned {count} objects to the world axes"
)
ALREADY_ALIGNED = note("already_aligned", "already aligned")
CURSOR_MOVED = note(
    "cursor_moved",
    "Moved the 3D cursor to the center of mass of {count} object",
    "Moved the 3D cursor to the center of mass of {count} objects",
)
EMPTIES_PLACED = note(
    "empties_placed",
    "Placed an empty at the principal frame of {count} object",
    "Placed empties at the principal frames of {count} objects",
)
EMPTIES_IN_PLACE = note("empties_in_place", "the empties are in place")
ORIGINS_MOVED = note(
    "origins_moved",
    "Moved the origin of {count} object to the center of mass",
    "Moved the origins of {count} objects to the center of mass",
)
AXES_MADE_PRINCIPAL = note(
    "axes_made_principal",
    "Aligned the axes of {count} object to its principal axes",
    "Aligned the axes of {count} objects to their principal axes",
)
ALREADY_IN_PLACE = note("already_in_place", "already in place")
ORIENTATION_CREATED = note("orientation_created", "Created the transform orientation “{name}”")
RIGID_BODY_MASSES_SET = note(
    "rigid_body_masses_set", "Set the rigid body mass of {count} object", "Set the rigid body mass of {count} objects"
)
RIGID_BODY_MASSES_EQUAL = note("rigid_body_masses_equal", "the masses are equal")
BALANCED = note(
    "balanced",
    "Moved {count} vertex by at most {distance:length}; the center of mass went from {start:point} to {end:point}",
    "Moved {count} vertices by at most {distance:length}; the center of mass went from {start:point} to {end:point}",
)

# statics

HULL_SIMPLIFIED = note(
    "hull_simplified",
    "“{object}” is finely divided: its convex hull is taken with {corners} corners, to {share:percent} of its size",
)
STABILITY_COMPUTED = note("stability_computed", "{count} of {total} object stands", "{count} of {total} objects stand")
OBJECTS_TIP = warning("objects_tip", "{names} tips over", "{names} tip over")
LAID_ON_GROUND = note("laid_on_ground", "Laid {count} object on the ground", "Laid {count} objects on the ground")
ALREADY_ON_GROUND = note("already_on_ground", "already on the ground")
NO_SUCH_COLLECTION = error("no_such_collection", "There is no collection “{collection}”. Choose another one.")
BALANCE_GROUP_WITHOUT_CONTACTS = error(
    "balance_group_without_contacts", "“{collection}” has no object with a surface. Choose another collection."
)
BALANCE_GROUP_EMPTY_GROUP = error(
    "balance_group_empty_group", "Nothing to follow. Select objects with a surface, or an armature that deforms some."
)
BALANCE_GROUP_MADE = note(
    "balance_group_made",
    "“{empty}” has {count} key of the center of mass; objects: {objects_count}",
    "“{empty}” has {count} keys of the center of mass; objects: {objects_count}",
)
BALANCE_GROUP_INSIDE = note("balance_group_inside", "It is over the support polygon at {count} of {total} frames")
