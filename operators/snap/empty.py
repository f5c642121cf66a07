# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Empty at the Principal Frame: something to parent, constrain and look at."""

from collections.abc import Generator
from itertools import count

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty
from bpy.types import Context, Depsgraph, Object, Operator
from mathutils import Matrix

from ...blender.scene.changes import SceneChange, dependents, independent_rounds, run_change, run_together
from ...blender.scene.transforms import TransformChannels, basis, world
from ...blender.write import reports
from ...core.verdict.finding import EditRefusedError, Finding, finding
from .. import selection
from ..findings import (
    EMPTIES_IN_PLACE,
    EMPTIES_PLACED,
    EMPTY_CONSTRAINED,
    EMPTY_FOLLOWED,
    SCALE_ZERO_AXIS_OF_PARENT_TARGET,
)
from ..modal import progress
from . import base as snapping

OBJECT_KEY = "principal_frame_of"  # ID property of such an empty: the object whose frame it shows
RESTORED_PROPERTIES = ("parent", "parent_type", "parent_bone", "empty_display_size")


class OBJECT_OT_body_moments_add_empty(Operator):
    """Add an empty at the center of mass, along the principal axes."""

    bl_idname = "object.body_moments_add_empty"
    bl_label = "Add Empty at Principal Frame"
    bl_description = (
        "Add an empty at the center of mass, along the principal axes, with arrows as long as the largest radius of "
        "gyration. An empty added before is moved"
    )
    bl_options = {"REGISTER", "UNDO"}

    parent: BoolProperty(
        name="Parent to Object",
        description="Parent the empty to the object, so that it moves along",
        default=True,
    )

    display: EnumProperty(
        name="Display As",
        description="How a new empty is drawn",
        items=(
            ("ARROWS", "Arrows", "Arrows along the principal axes"),
            ("PLAIN_AXES", "Plain Axes", "Lines along the principal axes"),
            ("SPHERE", "Sphere", "Sphere around the center of mass"),
            ("CUBE", "Cube", "Cube along the principal axes"),
        ),
        default="ARROWS",
    )
    size: FloatProperty(
        name="Size",
        description="Length of the axes as a multiple of the largest radius of gyration",
        default=1.0,
        min=0.001,
        soft_max=10.0,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        existing = {
            empty[OBJECT_KEY]: empty for empty in context.scene.objects if empty.type == "EMPTY" and OBJECT_KEY in empty
        }
        findings: list[Finding] = []
        failures: list[Finding] = []
        placed: list[Object] = []
        measured = count(1)

        def add(obj: Object) -> SceneChange:
            yield
            try:
                if self.parent and abs(np.linalg.det(world(obj)[:3, :3])) == 0.0:
                    raise EditRefusedError(SCALE_ZERO_AXIS_OF_PARENT_TARGET)
                body = target_in_turn(obj)
                step(next(measured))
                yield  # all are measured before the scene changes
                if (yield from self._place(existing.get(obj), context, body)):
                    findings.extend([body.finding.of_sources([obj.name])] if body.finding is not None else [])
                    placed.append(obj)
            except Exception as error:
                failures.append(reports.failure(obj.name_full, error))

        followers = dependents(existing.values())  # objects that move with an empty are measured after it
        with progress(len(objects)) as step:
            for several in independent_rounds((obj, {obj, *followers.get(existing.get(obj), ())}) for obj in objects):
                target_in_turn = snapping.targets_in_turn(context, several)
                run_change(context, run_together(map(add, several)))
        done, idle = finding(EMPTIES_PLACED, count=len(placed)), finding(EMPTIES_IN_PLACE)
        return selection.summarize(self, len(placed), len(objects), done, failures, findings, idle)

    def _place(
        self, existing: Object | None, context: Context, body: snapping.SnapTarget
    ) -> Generator[None, Depsgraph, bool]:
        """Move the empty, or a new one, to the body's frame; return whether it was elsewhere.

        Raises EditRefusedError if the empty cannot be there: then nothing has changed.
        """
        parent = body.obj if self.parent else None
        if existing is not None:
            return (yield from _moved(existing, body, parent, self.size))
        empty = _new_empty(context, body.obj)
        empty.empty_display_type = self.display
        try:
            return (yield from _moved(empty, body, parent, self.size))
        except BaseException:
            bpy.data.objects.remove(empty)
            raise


def _new_empty(context: Context, obj: Object) -> Object:
    empty = bpy.data.objects.new("{:s} Principal Frame".format(obj.name), None)
    empty.show_in_front = True  # the center of mass is mostly inside
    empty.rotation_mode = "QUATERNION"
    empty[OBJECT_KEY] = obj
    collections = [
        collection
        for collection in obj.users_collection
        if collection.library is None
        and collection.override_library is None  # others take no objects
        and collection in context.scene.collection.children_recursive
    ]
    (collections[0] if collections else context.scene.collection).objects.link(empty)
    return empty


def _moved(
    empty: Object, body: snapping.SnapTarget, parent: Object | None, size: float
) -> Generator[None, Depsgraph, bool]:
    """Move the empty to the body's frame; return whether it was elsewhere. EditRefusedError if it cannot be there."""
    if _follows(body.obj, empty):
        raise EditRefusedError(EMPTY_FOLLOWED, empty=empty.name)
    if _is_there(empty, body) and empty.parent == parent:
        return False
    saved = TransformChannels(empty)
    before = {name: getattr(empty, name) for name in RESTORED_PROPERTIES}
    before["matrix_parent_inverse"] = empty.matrix_parent_inverse.copy()
    was = world(body.obj)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = body.axes, body.center
    try:
        empty.parent = parent
        if parent is not None:
            empty.parent_type = "OBJECT"
            empty.matrix_parent_inverse = Matrix(np.linalg.inv(world(parent)))
        empty.empty_display_size = size * body.size
        empty.matrix_world = Matrix(frame)
        yield
        if parent is not None and not _is_there(empty, body):  # a curve also lays its children along its path
            outer = np.linalg.solve(basis(empty).T, world(empty).T).T
            inverse = np.array(empty.matrix_parent_inverse, np.float64) @ np.linalg.inv(outer)
            empty.matrix_parent_inverse, empty.matrix_basis = Matrix(inverse), Matrix(frame)
            yield
        held, follows = not _is_there(empty, body), (world(body.obj) != was).any()
        if held or follows:
            raise EditRefusedError(EMPTY_FOLLOWED if follows else EMPTY_CONSTRAINED, empty=empty.name)
    except BaseException:
        for name, value in before.items():
            setattr(empty, name, value)
        saved.restore()
        raise
    return True


def _follows(obj: Object, empty: Object) -> bool:
    return any(
        ancestor == empty or any(getattr(constraint, "target", None) == empty for constraint in ancestor.constraints)
        for ancestor in selection.ancestors(obj)
    )


def _is_there(empty: Object, body: snapping.SnapTarget) -> bool:
    now = world(empty)
    off = np.abs(now[:3, 3] - body.center).max()
    return bool(off <= 1e-6 * body.size + 1e-6 * np.abs(body.center).max() and body.is_principal(now[:3, :3]))


CLASSES = (OBJECT_OT_body_moments_add_empty,)
