# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid body constraints, which Blender adds to and removes from the view layer's active object alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
from bpy.types import Context, Object, RigidBodyConstraint

from ...core.verdict.finding import EditRefusedError


def add_joint(context: Context, obj: Object, type: str) -> RigidBodyConstraint:
    """Make an object a rigid body constraint. EditRefusedError where Blender does not."""
    with _active(context, obj):
        bpy.ops.rigidbody.constraint_add(type=type)
    if obj.rigid_body_constraint is None:
        raise EditRefusedError("joint_not_added", subject=obj.name)
    return obj.rigid_body_constraint


def remove_joint(context: Context, obj: Object) -> None:
    """Let an object be no rigid body constraint any more."""
    with _active(context, obj):
        bpy.ops.rigidbody.constraint_remove()


@contextmanager
def _active(context: Context, obj: Object) -> Iterator[None]:
    objects = context.view_layer.objects
    before = objects.active
    objects.active = obj
    try:
        with context.temp_override(object=obj, active_object=obj, selected_objects=[obj]):
            yield
    except RuntimeError as error:
        raise EditRefusedError("joint_not_added", subject=obj.name) from error
    finally:
        objects.active = before
