# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/scene`."""

from ...core.verdict import error, note, warning

OPEN_OBJECT = error(
    "open_object",
    "The surface is open and cannot be capped, so it has no center of mass. Close it, or set Kind "
    "to Shell.",
)
BALANCE_SETTINGS = (
    "it needs uniform density and a thin shell or a solid. Set Density From to One "
    "Value, and Wall to Thin"
)
BALANCE_IMPOSSIBLE = error("balance_impossible", "Cannot be balanced: {cause:word}.")
OTHER_SHAPES = "shape keys, animation, constraints or instances"
SHAPE_NOT_OF_MESH = error(
    "shape_not_of_mesh",
    "The measured shape is made by {makers:word}, not by the mesh alone. Apply, hide or remove "
    "them.",
)
FOLLOWS_MOVED = error(
    "follows_moved",
    "“{follower}” follows “{target}” and would move along. Clear that parent or constraint.",
)
MIRROR_IMAGE = error(
    "mirror_image",
    "A mirror image of the active object, which it cannot match. Mirror it, or turn a flat shape "
    "over.",
)
SURFACES_ROUNDED = note(
    "surfaces_rounded",
    "Blender stores control points as 32-bit numbers: points of the surfaces moved by up to "
    "{share:percent} of the "
    "size.",
)
PARENT_SHEARS = error(
    "parent_shears", "The parent shears the object. Clear the parent, or apply its scale."
)
CHANNEL_LOCKED = error(
    "channel_locked",
    "The {channel:word} is locked, animated or driven. Unlock it in Object Properties > Transform, "
    "or remove the "
    "animation.",
)
TRANSFORM_CONSTRAINED = error(
    "transform_constrained",
    "A constraint or the parent holds the {channel:word}. Apply or remove it.",
)
SHOWS_INSTANCES = (
    "it shows instances in place of its own geometry. Use Object > Apply > Make Instances Real"
)
WITHOUT_TRANSFORM = (
    "geometry of this type stays where it is. Use Object > Convert > Mesh, Add Empty, or "
    "Align Object to World"
)
REFRAME_IMPOSSIBLE = error("reframe_impossible", "Cannot be moved inside its object: {cause:word}.")
DENSITY_COORDINATES = error(
    "density_coordinates",
    "The density polynomial uses {frame:word} coordinates, so the density would change. Change "
    "Coordinates.",
)
BOUND_TO_ARMATURE = error(
    "bound_to_armature",
    "Bound to the armature “{armature}”, which would not move along. Rotate the armature, or apply "
    "its modifier.",
)
OWN_AXES_USED = error(
    "own_axes_used",
    "“{cause}” may depend on the object's own origin or axes, which would change. Show and apply "
    "it, or remove it.",
)
COPY_DIFFERS = error(
    "copy_differs",
    "Equal to “{object}” in shape, but not in {aspects}. Allow that under May Differ, or make it "
    "equal.",
)
MODIFIERS_CHANGE_SHAPE = error(
    "modifiers_change_shape",
    "The shape would change, by {modifiers}. Apply or remove these modifiers.",
)
CHILD_NOT_HELD = error(
    "child_not_held",
    "The child “{object}” cannot be held in place. Use Object > Parent > Clear Parent on it, or "
    "make it local.",
)
DEPENDENT_SHAPE_CHANGES = error(
    "dependent_shape_changes",
    "“{object}” would change shape, as it uses this object. Apply its modifier, or use Object > "
    "Convert > Mesh on it.",
)
DATA_COPIED = note("data_copied", "The data was copied, as other objects use it.")
FOLLOWER_MOVED = warning("follower_moved", "“{object}” follows by a constraint and moved along.")
RIGID_BODY_NEEDS_MESH = "Only meshes can be rigid bodies. Use Object > Convert > Mesh"
RIGID_BODY_UNFIT = error("rigid_body_unfit", "{fault:word}.")
RIGID_BODY_MASS_TOO_SMALL = error(
    "rigid_body_mass_too_small",
    "The mass {mass:.3g} kg is below the {limit:.3g} kg of a rigid body. Raise Density.",
)
RIGID_WORLD_LINKED = error(
    "rigid_world_linked",
    "The rigid body world uses the collection “{collection}”, which is linked. Give it one of this "
    "file.",
)
INTERPOLATION_UNCUT = error(
    "interpolation_uncut",
    "“{curve}” eases from frame {start} to {end} and cannot be divided at {frame}. Insert a key "
    "there, or set its interpolation to Bézier.",
)
