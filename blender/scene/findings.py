# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/scene`."""

from ...core.verdict.finding import error, note, warning

LINKED_OBJECT = error("linked_object", "Linked from another file. Use Object > Relations > Make Local.")
LIBRARY_OVERRIDE = error(
    "library_override", "A library override, which would lose the change. Use Object > Relations > Make Local."
)
LINKED_OBJECT_DATA = error(
    "linked_object_data", "Linked from another file. Use Object > Relations > Make Local for the object and its data."
)
OPEN_OBJECT = error(
    "open_object",
    "The surface is open and cannot be capped, so it has no center of mass. Close it, or set Kind to Shell.",
)
BALANCE_NO_VERTICES = error(
    "balance_no_vertices", "No vertices may move. Select some in Edit Mode, or assign some to the vertex group."
)
BALANCE_NO_GROUP = error("balance_no_group", "No vertex group. Choose or add one with the vertices that may move.")
BALANCE_TRIANGULATION_VARIES = error(
    "balance_triangulation_varies", "The triangulation changes with every move. Use Face > Triangulate Faces."
)
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
BALANCE_MODIFIED = error("balance_modified", "The measured shape is made by {modifiers}. Apply or hide them.")
BALANCE_MODIFIED_UNKNOWN = error(
    "balance_modified_unknown", "The measured shape is made by animation, constraints or instances. Apply them."
)
EMPTY_FOLLOWED = error(
    "empty_followed", "The object follows its empty “{empty}” and would move along. Clear that parent or constraint."
)
EMPTY_CONSTRAINED = error("empty_constrained", "A constraint holds the empty “{empty}”. Remove it.")
PARENT_TARGET_SCALE_ZERO = error(
    "parent_target_scale_zero", "The scale is zero along an axis. Set the scale, or turn off Parent to Object."
)
MODIFIED_MESH = error(
    "modified_mesh",
    "Modifiers change the mesh, so its defects are not those of what is measured. Apply or hide {modifiers}.",
)
MIRROR_IMAGE = error(
    "mirror_image", "A mirror image of the active object, which it cannot match. Mirror it, or turn a flat shape over."
)
ACTIVE_IS_CHILD = error(
    "active_is_child", "The active object is a child of this one and would move along. Clear the parent."
)
SCAN_NON_FINITE = error("scan_non_finite", "Some samples are not finite. Remove them.")
SURFACES_ROUNDED = note(
    "surfaces_rounded",
    "Blender stores control points as 32-bit numbers: points of the surfaces moved by up to {share:percent} of the "
    "size.",
)
PARENT_SCALE_ZERO = error("parent_scale_zero", "The parent has a zero scale. Set it.")
PARENT_OR_DELTA_SCALE_ZERO = error(
    "parent_or_delta_scale_zero", "The parent's scale or the delta scale is zero. Clear it."
)
PARENT_SHEARS = error("parent_shears", "The parent shears the object. Clear the parent, or apply its scale.")
CHANNEL_LOCKED = error("channel_locked", "The {channel:word} is locked. Unlock it in Object Properties > Transform.")
CHANNEL_ANIMATED = error("channel_animated", "The {channel:word} is animated or driven. Remove the animation.")
LOCATION_CONSTRAINED = error(
    "location_constrained", "A constraint or the parent holds the location. Apply or remove it."
)
ROTATION_CONSTRAINED = error(
    "rotation_constrained", "A constraint or the parent holds the rotation or scale. Apply or remove it."
)
COLLECTION_INSTANCE = error(
    "collection_instance", "A collection instance has no geometry of its own. Use Object > Apply > Make Instances Real."
)
VOLUME_NOT_REFRAMED = error(
    "volume_not_reframed",
    "The voxels of a volume cannot be moved inside the object. Use Add Empty or Align Object to World.",
)
DATA_WITHOUT_TRANSFORM = error(
    "data_without_transform", "Geometry of this type cannot be transformed. Use Object > Convert > Mesh."
)
INSTANCES_ON_OWN_GEOMETRY = error(
    "instances_on_own_geometry",
    "Children are instanced on its vertices or faces. Use Object > Apply > Make Instances Real.",
)
RENDER_ONLY_MODIFIER = error(
    "render_only_modifier",
    "The modifier “{modifier}” is not shown in viewports and may depend on the origin. Show or remove it.",
)
DENSITY_IN_OBJECT_COORDINATES = error(
    "density_in_object_coordinates",
    "The density polynomial uses object coordinates, which would change. Set Coordinates to World.",
)
DENSITY_IN_WORLD_COORDINATES = error(
    "density_in_world_coordinates",
    "The density polynomial uses world coordinates and does not move along. Set Coordinates to Object.",
)
BOUND_TO_ARMATURE = error(
    "bound_to_armature",
    "Bound to the armature “{armature}”, which would not move along. Rotate the armature, or apply its modifier.",
)
SHAPE_DEPENDS_ON_LOCATION = error(
    "shape_depends_on_location",
    "The shape would change, as it depends on the location through {modifiers}. Apply them.",
)
SHAPE_DEPENDS_ON_LOCATION_UNKNOWN = error(
    "shape_depends_on_location_unknown",
    "The shape would change, as it depends on the location. Use Object > Convert > Mesh.",
)
SHAPE_DEPENDS_ON_ORIGIN = error(
    "shape_depends_on_origin",
    "The shape would change, as it depends on the origin or axes through {modifiers}. Apply or remove them.",
)
SHAPE_DEPENDS_ON_ORIGIN_UNKNOWN = error(
    "shape_depends_on_origin_unknown", "The shape would change. Apply the scale, or use Object > Convert > Mesh."
)
TEXT_OFF_PLANE = error("text_off_plane", "Text can only move in its own plane. Use Object > Convert > Mesh.")
CHILD_LINKED = error(
    "child_linked", "The child “{object}” is linked from another file and cannot be held in place. Make it local."
)
CHILD_NOT_HELD = error(
    "child_not_held", "The child “{object}” cannot be held in place. Use Object > Parent > Clear Parent on it."
)
DEPENDENT_SHAPE_CHANGES = error(
    "dependent_shape_changes",
    "“{object}” would change shape, as a modifier refers to this object. Apply that modifier.",
)
DEPENDENT_CURVE_CHANGES = error(
    "dependent_curve_changes",
    "“{object}” would change shape, as it uses this object. Use Object > Convert > Mesh on it.",
)
DATA_COPIED = note("data_copied", "The data was copied, as other objects use it.")
FOLLOWER_MOVED = warning("follower_moved", "“{object}” follows by a constraint and moved along.")
RIGID_BODY_NEEDS_MESH = error("rigid_body_needs_mesh", "Only meshes can be rigid bodies. Use Object > Convert > Mesh.")
RIGID_BODY_MASS_TOO_SMALL = error(
    "rigid_body_mass_too_small", "The mass {mass:.3g} kg is below the {limit:.3g} kg of a rigid body. Raise Density."
)
RIGID_WORLD_LINKED = error(
    "rigid_world_linked",
    "The rigid body world uses the collection “{collection}”, which is linked. Give it one of this file.",
)
