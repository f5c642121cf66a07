# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of the operators: refusals and warnings that stay in the panel.

Other texts stand beside their reports.
"""

from ..core.verdict import error, warning

NO_ACTIVE_ASSEMBLY = error(
    "no_active_assembly",
    "There is no assembly. Click a collection in the Outliner, or select an empty with children.",
)

ROBOT_NAMES_ALIKE = error(
    "robot_names_alike", "Blender gives {names} one name in USD. Rename one of them."
)
ROBOT_GEOMETRY_NOT_WRITTEN = error(
    "robot_geometry_not_written", "Blender's exporter failed: {error}."
)
PRIMITIVE_HAS_PARENT = "It has a parent, or is linked. Clear the parent to simulate it"
FILE_EXISTS = error("file_exists", "The file “{file}” exists. Turn on Overwrite.")

OBJECT_WARNINGS = warning("object_warnings", "{object}: {causes}")
FLAT_AND_BODY = error(
    "flat_and_body",
    "A flat shape and a body cannot match. Select objects of one kind, or set Kind to Shell.",
)
COLLIDERS_BEYOND_TOLERANCE = warning(
    "colliders_beyond_tolerance",
    "{object}: the tolerance is not kept: the colliders stand out by {outward:length}, the object "
    "by {inward:length}. {remedy:word}",
)
POSE_NOT_A_COPY = warning(
    "pose_not_a_copy",
    "{object}: surfaces at most {maximum:length} apart, {mean:length} on average; not a copy, or "
    "cut off",
)
NOT_A_RIGID_BODY = "Not a rigid body. Turn on Add Rigid Bodies"
RIGID_BODY_CENTER_ELSEWHERE = warning(
    "rigid_body_center_elsewhere",
    "Physics uses the origin as center of mass, which differs for {objects}. Use Axes to Principal "
    "Axes.",
)
OBJECTS_TIP = warning("objects_tip", "{names} tips over", "{names} tip over")
