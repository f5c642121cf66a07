# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Empty at the Principal Frame: something to parent, constrain and look at."""

from collections.abc import Generator

import bpy
import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Depsgraph, Object, Operator
from mathutils import Matrix

from ....core.verdict import internal_error
from ...scene.changes import Change, carry_out, dependents, rounds, side_by_side
from ...scene.transforms import Channels, Refused, basis, world
from .. import selection
from . import base as snapping

OF = "principal_frame_of"  # ID property of such an empty: the object whose frame it shows
KEPT = ("parent", "parent_type", "parent_bone", "empty_display_size")
FOLLOWS = "it follows its empty {:s}, as its child or by a constraint, and would move along; clear that first"


class OBJECT_OT_body_moments_add_empty(Operator):
    """Add an empty at the center of mass"""

    bl_idname = "object.body_moments_add_empty"
    bl_label = "Add Empty at Principal Frame"
    bl_description = (
        "Add an empty at the center of mass, with the principal axes as its own and "
        "arrows as long as the largest radius of gyration. An empty that was added "
        "before is moved"
    )
    bl_options = {"REGISTER", "UNDO"}

    parent: BoolProperty(
        name="Parent to Object",
        description="Make the object the parent of its empty, so that the empty moves with it",
        default=True,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selected(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected(context)
        existing = {empty[OF]: empty for empty in context.scene.objects if empty.type == "EMPTY" and OF in empty}
        notes: list[str] = []

        failures: list[tuple[str, str]] = []
        placed: list[Object] = []

        def add(obj: Object) -> Change:
            yield
            try:
                if self.parent and abs(np.linalg.det(world(obj)[:3, :3])) == 0.0:
                    raise Refused("its scale is zero along an axis; set the scale first, or turn off Parent to Object")
                body = snapping.body_of(context, obj)
                step(len(placed) + len(failures))
                yield  # all are measured before the scene changes
                if (yield from _placed(existing.get(obj), context, body, obj if self.parent else None)):
                    notes.extend(["{:s}: {:s}".format(obj.name, body.note)] if body.note else [])
                    placed.append(obj)
            except Exception as error:
                failures.append((obj.name_full, internal_error.reason(error, snapping.REFUSALS)))

        followers = dependents(existing.values())  # what moves with an empty is measured after that
        with selection.progress(len(objects)) as step:
            for several in rounds((obj, {obj, *followers.get(existing.get(obj), ())}) for obj in objects):
                carry_out(context, side_by_side(map(add, several)))
        return selection.summarise(
            self,
            len(placed),
            len(objects),
            "Placed an empty at the principal frame of {count}",
            failures,
            notes,
            idle="the empties are there already",
        )


def _new_empty(context: Context, obj: Object) -> Object:
    empty = bpy.data.objects.new("{:s} Principal Frame".format(obj.name), None)
    empty.empty_display_type = "ARROWS"
    empty.show_in_front = True  # the center of mass is mostly inside
    empty.rotation_mode = "QUATERNION"
    empty[OF] = obj
    own = [
        collection
        for collection in obj.users_collection
        if collection.library is None
        and collection.override_library is None  # others take no objects
        and collection in context.scene.collection.children_recursive
    ]
    (own[0] if own else context.scene.collection).objects.link(empty)
    return empty


def _placed(
    existing: Object | None, context: Context, body: snapping.Body, parent: Object | None
) -> Generator[None, Depsgraph, bool]:
    """Move the empty, or a new one, to the body's frame; returns whether it was elsewhere. Refused where it cannot be
    there: then all is as it was."""
    if existing is not None:
        return (yield from _moved(existing, body, parent))
    empty = _new_empty(context, body.obj)
    try:
        return (yield from _moved(empty, body, parent))
    except BaseException:
        bpy.data.objects.remove(empty)
        raise


def _moved(empty: Object, body: snapping.Body, parent: Object | None) -> Generator[None, Depsgraph, bool]:
    """Move the empty to the body's frame; returns whether it was elsewhere. Refused where it cannot be there."""
    if _follows(body.obj, empty):
        raise Refused(FOLLOWS.format(empty.name))
    if _is_there(empty, body) and empty.parent == parent:
        return False
    saved = Channels(empty)
    before = {name: getattr(empty, name) for name in KEPT}
    before["matrix_parent_inverse"] = empty.matrix_parent_inverse.copy()
    was = world(body.obj)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = body.axes, body.center
    try:
        empty.parent = parent
        if parent is not None:
            empty.parent_type = "OBJECT"
            empty.matrix_parent_inverse = Matrix(np.linalg.inv(world(parent)))
        empty.empty_display_size = body.size
        empty.matrix_world = Matrix(frame)
        yield
        if parent is not None and not _is_there(empty, body):  # a curve also lays its children along its path
            outer = np.linalg.solve(basis(empty).T, world(empty).T).T
            inverse = np.array(empty.matrix_parent_inverse, np.float64) @ np.linalg.inv(outer)
            empty.matrix_parent_inverse, empty.matrix_basis = Matrix(inverse), Matrix(frame)
            yield
        held, follows = not _is_there(empty, body), (world(body.obj) != was).any()
        if held or follows:
            raise Refused(
                (FOLLOWS if follows else "a constraint holds its empty {:s}; remove that first").format(empty.name)
            )
    except BaseException:
        for name, value in before.items():
            setattr(empty, name, value)
        saved.restore()
        raise
    return True


def _follows(obj: Object, empty: Object) -> bool:
    return any(
        one == empty or any(getattr(constraint, "target", None) == empty for constraint in one.constraints)
        for one in selection.lineage(obj)
    )


def _is_there(empty: Object, body: snapping.Body) -> bool:
    now = world(empty)
    off = np.abs(now[:3, 3] - body.center).max()
    return bool(off <= 1e-6 * body.size + 1e-6 * np.abs(body.center).max() and body.is_principal(now[:3, :3]))


CLASSES = (OBJECT_OT_body_moments_add_empty,)
