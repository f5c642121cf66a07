# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/robots`."""

from ..verdict import error, note, warning

ROBOT_LINKS_LEFT_OUT = warning(
    "robot_links_left_out",
    "{count} object without mass is no link: {links}. Give it a density or a mass.",
    "{count} objects without mass are no links: {links}. Give them densities or masses.",
)
ROBOT_WITHOUT_LINKS = error(
    "robot_without_links",
    "There is no link. Measure objects with mass, or for bones an armature with what it moves.",
)
ROBOT_BASE_ADDED = note(
    "robot_base_added",
    "{count} objects have no parent. They are fixed to an added link without mass, {name}. Parent "
    "them to one of "
    "them to avoid it.",
)
ROBOT_ELLIPSOID_AS_BOX = note(
    "robot_ellipsoid_as_box",
    "The format has no ellipsoid. The box of equal mass and inertia stands in its place: {links}.",
)
URDF_EFFORT_UNKNOWN = note(
    "urdf_effort_unknown",
    "Set effort and velocity of the joint to its motor's. They are placeholders: {joints}.",
    "Set effort and velocity of {count} joints to those of their motors. They are placeholders: "
    "{joints}.",
)
URDF_ROOT_WITHOUT_MASS = note(
    "urdf_root_without_mass",
    "PyBullet fixes the root {name} to the world, as it has no mass. Parent the parts to one of "
    "them, or load the file with a root of your own.",
)
JOINTS_LEFT_OUT = warning("joints_left_out", "Left out: {joints}. {cause:word}.")
CLOSE_LOOP = "A robot is a tree, and they would close a loop. Add them to the file as constraints"
WITHOUT_LINK = (
    "They hold an object that is no link. Set both objects of the constraint, and export them"
)
JOINTS_ALL_FIXED = note(
    "joints_all_fixed",
    "All joints are fixed: nothing moves. Add a rigid-body constraint between two objects, such as "
    "a hinge, or "
    "export bones as links.",
)
JOINT_VALUES_LOST = warning(
    "joint_values_lost",
    "{format} has no place for these values of a joint: {values}. They are lost for {joints}.",
)
JOINT_VALUE_UNUSABLE = warning(
    "joint_value_unusable",
    "{joint}: {key} is {value}, and is ignored. A mimic names another joint, and both have one "
    "axis. Other values are positive numbers.",
)
ROBOT_SCALED = warning(
    "robot_scaled",
    "Readers differ about bodies that are scaled or sheared. Apply the scale of {links} and of "
    "their parents (Object > "
    "Apply > Scale).",
)
GLTF_NODE_MISSING = warning(
    "gltf_node_missing",
    "{count} link has no node of its own in the file: {links}.",
    "{count} links have no nodes of their own in the file: {links}.",
)
UNIT_SCALE = note("unit_scale", "The file is in units of {scale:g} m: {cause:word}.")
GLTF_SCALED = (
    "a node above all others scales them to meters. Readers differ about bodies that are scaled"
)
USD_SCALED = (
    "Newton 1.8 reads metersPerUnit and converts nothing. Set the scene's unit scale to 1, or "
    "export with --links or --geometry of your own"
)
ROBOT_LINKS_BARE = note(
    "robot_links_bare",
    "{count} link has no geometry: {links}.",
    "{count} links have no geometry: {links}.",
)
SDF_FRAMES_ADDED = note(
    "sdf_frames_added",
    "SDF has no joint along such axes: {joints}. Added links, with {part:.3g} of the mass, stand "
    "between its axes.",
    "SDF has no joints along such axes: {joints}. Added links, with {part:.3g} of the mass, stand "
    "between their axes.",
)
INERTIA_TOO_SMALL = warning(
    "inertia_too_small",
    "The mass or a principal moment of {links} is below {limit:.3g} kg or kg·m², the least that "
    "{program} holds. {remedy:word}.",
)
RAISED = "It is raised. Fix the link to its parent, or model in larger units"
TOO_SMALL_FOR_SINGLE = "Read newton:inertia, or use a stage in smaller units"
DESCRIPTION_INVALID = error(
    "description_invalid", "The file is not {format}: line {line}, {error}."
)
USD_NOT_TEXT = error(
    "usd_not_text",
    "{name} is binary USD or refers to other files, which only the Python module usd-core reads. "
    "Install it (pip "
    "install usd-core), or convert the file: usdcat --flatten {name} -o robot.usda.",
)
XACRO_NOT_EXPANDED = error(
    "xacro_not_expanded",
    "xacro cannot expand the file ({error}). Correct it, or expand it where all packages are: "
    "xacro {name} > "
    "robot.urdf.",
)
DESCRIPTION_UNKNOWN = error(
    "description_unknown", "The file is no robot description. Its first element is {tag}."
)
INCLUDE_UNREADABLE = error(
    "include_unreadable", "A file that it includes cannot be read: {name}. {cause}"
)
DESCRIPTION_NUMBER = warning(
    "description_number",
    "Line {line}: <{element}> has “{text}”, which the audit cannot use. Correct it; nothing is "
    "compared.",
)
MESH_MISSING = warning(
    "mesh_missing",
    "A file is missing: {name}. If it is in another package, name the folder of the package with "
    "--package-path.",
)
MESH_OUTSIDE = warning(
    "mesh_outside",
    "A file is on a network, or outside of the folders that may be read: {name}. Download it, name "
    "its folder with --package-path, or allow all with --allow-outside.",
)
MESH_UNREADABLE = warning("mesh_unreadable", "A mesh cannot be read: {name}. {cause}")
INERTIAL_MISSING = warning(
    "inertial_missing",
    "No inertial. Readers differ: some take 1 kg, some none. Add mass and inertia.",
)
INERTIAL_NOT_FINITE = error(
    "inertial_not_finite", "Mass, center or inertia is not a number, or is too large."
)
INERTIAL_OF_FRAME = note(
    "inertial_of_frame",
    "Zero mass, inertia and no geometry: a mere frame. Keep the zeros: PyBullet and urchin take "
    "1 kg if they are missing. PyBullet fixes a root without mass to the world.",
)
INERTIAL_NOT_POSITIVE = error(
    "inertial_not_positive", "Impossible: the {part:word} is {value:.6g} {unit}."
)
INERTIAL_TRIANGLE = error(
    "inertial_triangle",
    "Impossible: the largest principal moment exceeds the sum of the others by {excess:percent}.",
)
INERTIAL_TRIANGLE_SLIGHTLY = warning(
    "inertial_triangle_slightly",
    "The largest principal moment exceeds the sum of the others by {excess:percent}, as rounding "
    "does. Some "
    "readers refuse it; state more digits.",
)
INERTIAL_CENTER_OUTSIDE = error(
    "inertial_center_outside",
    "Impossible: the center of mass is {distance:length} outside of the geometry.",
)
INERTIAL_SPREAD_OUTSIDE = error(
    "inertial_spread_outside",
    "Impossible: with this inertia, mass lies outside of the geometry (variance {factor:.3g} times "
    "too large).",
)
INERTIAL_TOO_DENSE = error(
    "inertial_too_dense",
    "Impossible: no matter is that dense. This mass with this inertia takes at least "
    "{density:.3g} kg/m³; osmium has {limit:g}.",
)
AUDIT_INSTEAD = warning("audit_instead", "State {source:word}.")
UNIFORM = "the inertia of the geometry, filled evenly with the stated mass. Keep a possible center"
AUDIT_NOT_UNIFORM = note(
    "audit_not_uniform",
    "Not an even filling of the {part:word}. Filled evenly, that has {volume:percent} of the drawn "
    "volume, and "
    "{first:.4g}, {second:.4g} and {third:.4g} times the principal moments; its center is "
    "{distance:length} and its "
    "axes are {turn:.3g}° off.",
)
AUDIT_UP_AXIS = warning(
    "audit_up_axis",
    "The mesh's file says that z is not up. Readers obey that or not; the inertial is right where "
    "they do. "
    "Export the mesh with z up.",
)
AUDIT_OVERRIDDEN = warning(
    "audit_overridden",
    "{program} uses another inertial, because of {cause}: {mass:.6g} kg, principal moments "
    "{first:.6g}, {second:.6g} and {third:.6g} kg·m². State that one, or remove the cause.",
)
AUDIT_JOINT = warning("audit_joint", "Joint {joint} is left out: {cause:word}.")
AUDIT_TWINS = warning(
    "audit_twins",
    "{first} and {second} are twins, but their {part:word} differ by {apart:percent}. Correct one.",
)
AUDIT_COPIED = warning(
    "audit_copied", "One inertial stands at links of different geometry: {links}. State their own."
)
AUDIT_TOTAL = error(
    "audit_total", "The {part:word} of the whole model is {value}, not {expected} as expected."
)
AUDIT_DENSITY = warning("audit_density", "The density is {density:.3g} kg/m³. Check mass and mesh.")
AUDIT_UNIT = warning(
    "audit_unit", "Multiply the {part:word} by {factor:g}: {agree:word} then agree."
)
AUDIT_INERTIA_OF_UNIT = warning(
    "audit_inertia_of_unit",
    "The inertia is that of {part:word} 1. Multiply it by the {part:word}, {factor:.6g}.",
)
AUDIT_INERTIA_ELSEWHERE = warning(
    "audit_inertia_elsewhere",
    "The inertia is about {part:word}. State it about the center of mass.",
)
AUDIT_ANGLES = warning(
    "audit_angles", "The angles of the {part:word} are in {unit:word}. State them in {wanted:word}."
)
AUDIT_FRAME_NOT_MEANT = warning(
    "audit_frame_not_meant",
    "The inertia is along the axes of the link, though the inertial is rotated. Remove the "
    "rotation.",
)
AUDIT_TRANSPOSED = warning("audit_transposed", "Rows taken for columns: {part:word}. Transpose it.")
AUDIT_SIGN = warning(
    "audit_sign",
    "Wrong sign: {part:word}, {axes}. Change it; products of inertia in a tensor are negative "
    "integrals, -∫xy dm.",
)
AUDIT_ORDER = warning("audit_order", "Wrong order: {part:word}. Put them in the order {order}.")
AUDIT_TURNED = warning("audit_turned", "The {part:word} is {change:word} {axis}. Undo that.")
