# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Empties at the principal frames of objects, and the moving of empties whose children stay."""

from collections.abc import Callable, Generator, Sequence

import bpy
import numpy as np
from bpy.types import Context, Depsgraph, Object
from mathutils import Matrix

from ...core.moments import affine_matrices
from ...core.verdict import EditRefusedError
from ..read.findings import SCALE_ZERO_AXIS
from ..read.tracking import tracking_paused
from .changes import (
    SceneChange,
    ancestors,
    dependents,
    independent_rounds,
    require_editable,
    run_change,
    run_together,
)
from .findings import CHILD_NOT_HELD, FOLLOWS_MOVED, TRANSFORM_CONSTRAINED
from .snap_targets import SnapTarget, targets_in_turn
from .transforms import TransformChannels, basis, world

OBJECT_KEY = "principal_frame_of"  # ID property of such an empty: the object whose frame it shows
RESTORED_PROPERTIES = ("parent", "parent_type", "parent_bone", "empty_display_size")
PLACE_RTOL = 4e-6  # rounding of places in float32 matrices


def place_empties(
    context: Context,
    objects: Sequence[Object],
    is_parent: bool,
    display: str,
    size: float,
    progress: Callable[[float], None],
) -> tuple[list[SnapTarget], dict[Object, Exception]]:
    """Put or move empties to objects' principal frames; return the bodies whose empties were
    elsewhere, and errors.
    """
    existing = {
        empty[OBJECT_KEY]: empty
        for empty in context.scene.objects
        if empty.type == "EMPTY" and OBJECT_KEY in empty
    }
    placed: list[SnapTarget] = []
    failures: dict[Object, Exception] = {}
    count = 0

    def add(obj: Object, measure: Callable[[Object], SnapTarget]) -> SceneChange:
        nonlocal count
        yield
        try:
            if is_parent and abs(np.linalg.det(world(obj)[:3, :3])) == 0.0:
                raise EditRefusedError(SCALE_ZERO_AXIS)
            body = measure(obj)
            count += 1
            progress(count)
            yield  # all are measured before the scene changes
            if (yield from _place(existing.get(obj), context, body, is_parent, display, size)):
                placed.append(body)
        except Exception as error:
            failures[obj] = error

    # objects that move with an empty are measured after it
    followers = dependents(existing.values())
    for independent in independent_rounds(
        (obj, {obj, *followers.get(existing.get(obj), ())}) for obj in objects
    ):
        measure = targets_in_turn(context, independent)
        run_change(context, run_together(add(obj, measure) for obj in independent))
    return placed, failures


def _place(
    existing: Object | None,
    context: Context,
    body: SnapTarget,
    is_parent: bool,
    display: str,
    size: float,
) -> Generator[None, Depsgraph, bool]:
    """Move the empty, or a new one, to the body's frame; return whether it was elsewhere.

    Raises EditRefusedError.
    """
    parent = body.obj if is_parent else None
    if existing is not None:
        return (yield from _move(existing, body, parent, size))
    empty = _new_empty(context, body.obj)
    empty.empty_display_type = display
    try:
        return (yield from _move(empty, body, parent, size))
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


def _move(
    empty: Object, body: SnapTarget, parent: Object | None, size: float
) -> Generator[None, Depsgraph, bool]:
    """Parent the empty, move it to the body's frame and give it a size of display, relative to the
    body's; return whether it was elsewhere, else leave it as it is.

    EditRefusedError if it cannot be there.
    """
    for ancestor in ancestors(body.obj):
        targets = [getattr(each, "target", None) for each in ancestor.constraints]
        if any(each == empty for each in (ancestor, *targets)):
            raise EditRefusedError(FOLLOWS_MOVED, follower=body.obj.name, target=empty.name)
    if _is_there(empty, body) and empty.parent == parent:
        return False
    saved = TransformChannels(empty)
    before = {name: getattr(empty, name) for name in RESTORED_PROPERTIES}
    before["matrix_parent_inverse"] = empty.matrix_parent_inverse.copy()
    was = world(body.obj)
    frame = affine_matrices(body.axes, body.center)
    try:
        empty.parent = parent
        if parent is not None:
            empty.parent_type = "OBJECT"
            empty.matrix_parent_inverse = Matrix(np.linalg.inv(world(parent)))
        empty.empty_display_size = size * body.size
        empty.matrix_world = Matrix(frame)
        yield
        # A curve also lays its children along its path, so that the parent inverse does not undo
        # the whole effect of the parent. World = effect · basis, and the effect ends with the
        # parent inverse: times the inverse of the effect, it leaves world = basis.
        if parent is not None and not _is_there(empty, body):
            parent_effect = np.linalg.solve(basis(empty).T, world(empty).T).T
            inverse = np.array(empty.matrix_parent_inverse, np.float64)
            inverse = inverse @ np.linalg.inv(parent_effect)
            empty.matrix_parent_inverse = Matrix(inverse)
            empty.matrix_basis = Matrix(frame)
            yield
        if (world(body.obj) != was).any():
            raise EditRefusedError(FOLLOWS_MOVED, follower=body.obj.name, target=empty.name)
        if not _is_there(empty, body):
            raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location", sources=[empty.name])
    except BaseException:
        for name, value in before.items():
            setattr(empty, name, value)
        saved.restore()
        raise
    return True


def _is_there(empty: Object, body: SnapTarget) -> bool:
    """Return whether an empty is at a body's principal frame, to a few roundings in float32."""
    now = world(empty)
    off = np.abs(now[:3, 3] - body.center).max()
    return bool(
        off <= 1e-6 * body.size + 1e-6 * np.abs(body.center).max()
        and body.is_principal(now[:3, :3])
    )


def move_parent(context: Context, empty: Object, center: Sequence[float]) -> None:
    """Put an empty at a (3,) point, in Blender units, while its children, at least one, stay; raise
    EditRefusedError if constraints or locks prevent it.
    """
    require_editable(empty)
    children = [child for child in empty.children if child.parent_type == "OBJECT"]
    saved = TransformChannels(empty)
    inverses = {child: child.matrix_parent_inverse.copy() for child in children}
    places = {child: world(child) for child in empty.children_recursive}
    was = world(empty)
    size = float(np.abs([place[:3, 3] - center for place in places.values()]).max())
    tolerance = PLACE_RTOL * max(size, float(np.abs(center).max()))
    with tracking_paused():
        try:
            target = was.copy()
            target[:3, 3] = center
            empty.matrix_world = Matrix(target)
            context.view_layer.update()
            change = np.linalg.solve(world(empty), was)
            for child in children:
                child.matrix_parent_inverse = Matrix(change @ np.array(inverses[child], np.float64))
            context.view_layer.update()
            if np.abs(world(empty)[:3, 3] - center).max() > tolerance:
                raise EditRefusedError(
                    TRANSFORM_CONSTRAINED, channel="location", subject=empty.name
                )
            for child, place in places.items():
                off = np.abs(world(child) - place)
                turned = off[:, :3].max() > PLACE_RTOL * np.abs(place[:, :3]).max()
                if turned or off[:, 3].max() > tolerance:
                    raise EditRefusedError(CHILD_NOT_HELD, subject=empty.name, object=child.name)
        except BaseException:
            for child, inverse in inverses.items():
                child.matrix_parent_inverse = inverse
            saved.restore()
            context.view_layer.update()
            raise
