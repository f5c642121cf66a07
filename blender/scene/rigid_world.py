# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gravity, rigid bodies and joints of a scene.

Blender adds joints to the view layer's active object alone.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np
from bpy.types import Context, Object, RigidBodyConstraint, Scene

from ...core.numerics import Array
from ...core.verdict import EditRefusedError
from .findings import RIGID_WORLD_LINKED

MIN_MASS = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min  # kg


def has_gravity(scene: Scene) -> bool:
    """Return whether anything falls in a scene."""
    return scene.use_gravity and any(scene.gravity)


def down(scene: Scene) -> Array:
    """Return the direction of gravity, (3,); -Z if the scene has none."""
    gravity = np.array(scene.gravity, np.float64) if scene.use_gravity else np.zeros(3)
    length = np.linalg.norm(gravity)
    return gravity / length if length > 0.0 else np.array((0.0, 0.0, -1.0))


def require_rigid_world(scene: Scene, joints: bool = False) -> None:
    """Raise EditRefusedError if the scene takes no new rigid bodies or, with `joints`, no new
    joints.
    """
    world = scene.rigidbody_world
    if world is None:
        return
    for collection in (world.collection, world.constraints if joints else None):
        if collection is not None and (
            not collection.is_editable or collection.override_library is not None
        ):
            raise EditRefusedError(RIGID_WORLD_LINKED, collection=collection.name)


def add_rigid_bodies(context: Context, objects: Sequence[Object], type: str = "ACTIVE") -> None:
    """Make all objects rigid bodies by one call of Blender's operator."""
    if objects:
        with context.temp_override(object=objects[0], selected_objects=objects):
            bpy.ops.rigidbody.objects_add(type=type)


def add_joint(context: Context, obj: Object, type: str) -> RigidBodyConstraint:
    """Make an object a rigid body constraint and return the constraint."""
    if context.scene.rigidbody_world is None:
        bpy.ops.rigidbody.world_add()
    with _active(context, obj):
        bpy.ops.rigidbody.constraint_add(type=type)
    joint = obj.rigid_body_constraint
    assert joint is not None
    return joint


def remove_joint(context: Context, obj: Object) -> None:
    """Remove the rigid body constraint of an object."""
    with _active(context, obj):
        bpy.ops.rigidbody.constraint_remove()


@contextmanager
def _active(context: Context, obj: Object) -> Iterator[None]:
    objects = context.view_layer.objects
    before = objects.active
    objects.active = obj
    try:
        with context.temp_override(object=obj):
            yield
    finally:
        objects.active = before
