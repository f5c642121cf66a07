# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Giving an object another origin and other axes while all that can be seen stays in place.

An object's matrix goes from W to W', its data from p to D p with D = W'⁻¹ W, its children's parent
inverses from P to W'⁻¹ W P. W' is read back after Blender has rounded it to float32, so that D
undoes the very matrix that is used, and D is applied in float64 with one rounding.

Nothing is assumed of modifiers: the change is first made on a copy of the data, the evaluated
surfaces in the world are compared with the earlier ones, and the change is kept only if they are
the same. Otherwise all is put back. Other users of the data keep it as it is; the objects that are
changed get a copy of their own, shared among them.

Meshes that one object alone shows unmodified need no trial: see `reframe_meshes`. Other unrelated
objects are changed side by side. An object that is refused is tried again alone, in case the change
of another object was the reason.
"""

from collections.abc import Callable, Iterable

import bpy
import numpy as np
from bpy.types import ID, Context, Object
from mathutils import Matrix

from ...core.numerics import Index
from ...core.verdict import LINKED_OBJECT, EditRefusedError, Finding, finding, internal_error
from ..read.findings import SCALE_ZERO_AXIS
from ..read.mesh import read_array
from ..settings.density import density_anchor
from .changes import (
    SceneChange,
    ancestors,
    dependents,
    independent_rounds,
    run_change,
    run_together,
)
from .dependents import (
    SAME_SHAPE_RTOL,
    DependentsGuard,
    Shape,
    referring,
    same_shape,
    shape,
    transform_shape,
)
from .findings import (
    BOUND_TO_ARMATURE,
    DATA_COPIED,
    DENSITY_COORDINATES,
    FOLLOWS_MOVED,
    MODIFIERS_CHANGE_SHAPE,
    OWN_AXES_USED,
    REFRAME_IMPOSSIBLE,
    SHOWS_INSTANCES,
    TRANSFORM_CONSTRAINED,
    WITHOUT_TRANSFORM,
)
from .reframe_meshes import (
    Plan,
    data_change,
    largest_move,
    location_tolerance,
    reframe_own_meshes,
    shows_own_mesh,
    transform_meshes,
)
from .transforms import (
    FLOAT32,
    MAX_SHEAR,
    Matrix4,
    TransformChannels,
    basis,
    set_location,
    set_rotation_and_scale,
    solve,
    world,
)

# Modifiers whose effect depends neither on an object's origin nor on its axes.
FRAME_INDEPENDENT_MODIFIERS = {
    "ARMATURE",
    "BOOLEAN",
    "DATA_TRANSFER",
    "EDGE_SPLIT",
    "MASK",
    "NORMAL_EDIT",
    "SUBSURF",
    "TRIANGULATE",
    "UV_PROJECT",
    "UV_WARP",
    "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX",
    "VERTEX_WEIGHT_PROXIMITY",
    "WEIGHTED_NORMAL",
}


def check(obj: Object) -> None:
    """Raise EditRefusedError if the object cannot be given another origin or other axes at all."""
    if obj.library is not None or (obj.data is not None and obj.data.library is not None):
        raise EditRefusedError(LINKED_OBJECT)
    if obj.data is None:
        raise EditRefusedError(REFRAME_IMPOSSIBLE, cause=SHOWS_INSTANCES)
    if obj.type not in {"MESH", "CURVE", "SURFACE", "META", "FONT"}:
        raise EditRefusedError(REFRAME_IMPOSSIBLE, cause=WITHOUT_TRANSFORM)
    if obj.instance_type in {"VERTS", "FACES"} and obj.children:
        raise EditRefusedError(REFRAME_IMPOSSIBLE, cause=SHOWS_INSTANCES)
    unseen = [
        modifier.name
        for modifier in obj.modifiers
        if modifier.show_render
        and not modifier.show_viewport
        and modifier.type not in FRAME_INDEPENDENT_MODIFIERS
    ]
    if unseen:
        raise EditRefusedError(OWN_AXES_USED, cause=unseen[0])
    if density_anchor(obj) == "own":
        raise EditRefusedError(DENSITY_COORDINATES, frame="object")
    if abs(np.linalg.det(world(obj)[:3, :3])) == 0.0:
        raise EditRefusedError(SCALE_ZERO_AXIS)


def reframe(
    context: Context, plans: list[Plan], progress: Callable[[float], None] = lambda done: None
) -> tuple[list[Plan], list[tuple[Object, Finding]]]:
    """Carry out the plans; return the successful ones, and the reason for each object that was left
    as it was.
    """
    objects = {plan.obj for plan in plans}
    users, touched = (referring(objects), dependents(objects)) if plans else ({}, {})
    refused: dict[Object, Finding] = {}
    # All objects of a mesh are changed with a trial if one needs it, so that they can go on sharing
    # the mesh.
    needs_trial = {
        plan.obj.data
        for plan in plans
        if plan.mesh is not None or not shows_own_mesh(plan.obj, users)
    }
    without_trial = [plan for plan in plans if plan.obj.data not in needs_trial]
    carried_out = set(reframe_own_meshes(context, without_trial))
    done = len(carried_out)
    progress(done)

    def attempt(group: list[Plan], failed: list[list[Plan]] | None = None) -> SceneChange:
        """Change a group; if it fails, add it to `failed`, or without this list to the refused."""
        nonlocal done
        try:
            yield from _reframe_group(group, users)
        except Exception as error:
            if failed is not None:
                failed.append(group)
                return
            reason = internal_error.finding_of(error)
            refused.update({plan.obj: reason for plan in group})
        done += len(group)
        progress(done)

    for groups in independent_rounds(
        (group, {plan.obj.data for plan in group}.union(*(touched[plan.obj] for plan in group)))
        for group in _groups(plan for plan in plans if plan.obj not in carried_out)
    ):
        failed: list[list[Plan]] = []
        run_change(context, run_together(attempt(group, failed) for group in groups))
        for group in failed:
            run_change(context, attempt(group))
    return [plan for plan in plans if plan.obj not in refused], list(refused.items())


def _groups(plans: Iterable[Plan]) -> list[list[Plan]]:
    """Return groups of plans that share data and want the same change of it; no group has a child
    and its parent.
    """
    groups: list[list[Plan]] = []
    by_data: dict[ID, list[tuple[Matrix4, list[Plan]]]] = {}  # changes of the data, with groups
    for plan in plans:
        change = solve(plan.target, world(plan.obj))
        reach = np.abs(np.array(plan.obj.bound_box)).max()
        tolerance = SAME_SHAPE_RTOL * plan.size
        above = set(ancestors(plan.obj))
        data_groups = by_data.setdefault(plan.obj.data, [])
        fitting = (
            group
            for group_change, group in data_groups
            if not above & {member.obj for member in group}
            and largest_move(change - group_change, reach) <= tolerance
        )
        group = next(fitting, None)
        if group is None:
            group = []
            groups.append(group)
            data_groups.append((change, group))
        group.append(plan)
    return groups


def _reframe_group(group: list[Plan], users: dict[Object, set[Object]]) -> SceneChange:
    """Move the frames of objects with common data while their shapes stay. Each `yield` waits for
    Blender to evaluate the scene, and gives the new depsgraph. An error puts all back.

    The objects show a changed copy of the data, or the mesh that the plans name, until it is known
    whether they look as before.
    """
    depsgraph = yield
    objects = [plan.obj for plan in group]
    data = group[0].obj.data
    shared_mesh = group[0].mesh
    before = {plan.obj: _in_order(shape(plan.obj, depsgraph), plan.order) for plan in group}
    guard = DependentsGuard(objects, users, depsgraph)
    first_matrix = world(objects[0])
    channels = [TransformChannels(obj) for obj in objects]
    trial = None
    change = np.eye(4)
    try:
        yield from run_together(set_world_matrix(plan) for plan in group)
        if shared_mesh is None:
            change = data_change(first_matrix, world(objects[0]), group[0].move_only)
            trial = data.copy()
            transform_data(trial, change)
        for obj in objects:
            obj.data = shared_mesh or trial
        guard.compensate()
        depsgraph = yield
        for plan in group:
            if not same_shape(before[plan.obj], shape(plan.obj, depsgraph), plan.size):
                raise EditRefusedError(_reason_of_change(plan.obj, FRAME_INDEPENDENT_MODIFIERS))
        guard.verify(depsgraph, min(plan.size for plan in group))
        if guard.findings and shared_mesh is not None:
            follower = guard.findings[0].values["object"]
            raise EditRefusedError(FOLLOWS_MOVED, follower=follower, target=objects[0].name)
    except BaseException:  # GeneratorExit, too, if a change beside this one fails
        for obj in objects:
            obj.data = data
        for saved in channels:
            saved.restore()
        guard.restore()
        if trial is not None:
            bpy.data.batch_remove([trial])
        raise
    group[0].findings += guard.findings
    if trial is None:
        return
    if data.users - data.use_fake_user:
        for plan in group:
            plan.findings.append(finding(DATA_COPIED))
        return
    # Nobody else uses the data: the change is made on the data itself.
    for obj in objects:
        obj.data = data
    transform_data(data, change)
    bpy.data.batch_remove([trial])


def _in_order(before: Shape | None, order: Index | None) -> Shape | None:
    """Return a shape with the points of its first surface in another order; without surfaces, so
    that it equals no other, if modifiers give this surface other points.
    """
    if before is None or order is None:
        return before
    (first, rest), *others = before
    return [(first[order], rest), *others] if len(first) == len(order) else []


def check_movable(obj: Object) -> None:
    """Raise EditRefusedError if the object cannot be moved as a whole with its body unchanged."""
    if obj.library is not None:
        raise EditRefusedError(LINKED_OBJECT)
    if density_anchor(obj) == "world":
        raise EditRefusedError(DENSITY_COORDINATES, frame="world")
    bound = [
        modifier.object
        for modifier in obj.modifiers
        if modifier.type == "ARMATURE" and modifier.show_viewport
    ]
    if obj.parent_type == "ARMATURE":
        bound.append(obj.parent)
    for armature in bound:  # in rest pose, too, though it deforms nothing yet
        if armature is not None and obj not in ancestors(armature):
            raise EditRefusedError(BOUND_TO_ARMATURE, armature=armature.name)


def move(context: Context, plan: Plan) -> None:
    """Move an object by `set_world_matrix`; put it back and raise the error if its shape or a lock
    prevents that.
    """
    obj = plan.obj
    saved = TransformChannels(plan.obj)
    was = world(obj)
    before = shape(obj, context.evaluated_depsgraph_get())
    try:
        run_change(context, set_world_matrix(plan))
        expected = transform_shape(before, was, world(obj))
        if not same_shape(expected, shape(obj, context.evaluated_depsgraph_get()), plan.size):
            raise EditRefusedError(_reason_of_change(obj, set()))
    except BaseException:
        saved.restore()
        context.view_layer.update()
        raise


def set_world_matrix(plan: Plan) -> SceneChange:
    """Set the channels so that the evaluated matrix becomes the target; EditRefusedError if
    something else holds it.
    """
    yield
    obj = plan.obj
    outer = _parent_matrix(obj)
    if not abs(np.linalg.det(outer[:3, :3])) > 0.0:
        raise EditRefusedError(SCALE_ZERO_AXIS)
    tolerance = location_tolerance(obj, plan.size) / np.cbrt(abs(np.linalg.det(outer[:3, :3])))
    target = plan.target
    # The rounding of the parents' float32 matrices is corrected once it is known; a third pass is
    # a margin.
    for _ in range(3):
        local = solve(outer, target)
        set_location(obj, local[:3, 3], tolerance)
        if not plan.move_only:
            set_rotation_and_scale(obj, local[:3, :3])
        yield
        missing = plan.target[:3, 3] - world(obj)[:3, 3]
        if np.abs(missing).max() <= FLOAT32 * np.abs(plan.target[:3, 3]).max():
            break
        target = target.copy()
        target[:3, 3] += missing
    now = world(obj)
    if np.abs(now[:3, 3] - plan.target[:3, 3]).max() > location_tolerance(obj, plan.size):
        raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location")
    scale = np.abs(plan.target[:3, :3]).max()
    if np.abs(now[:3, :3] - plan.target[:3, :3]).max() > MAX_SHEAR * scale:
        raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="rotation")


def _parent_matrix(obj: Object) -> Matrix4:
    """Return the (4, 4) matrix by which an object's parents multiply its basis."""
    if obj.parent is None:
        return np.eye(4)
    if obj.parent_type in {"OBJECT", "ARMATURE", "LATTICE"}:
        return world(obj.parent) @ np.array(obj.matrix_parent_inverse, np.float64)
    local = basis(obj)
    if abs(np.linalg.det(local[:3, :3])) == 0.0:
        raise EditRefusedError(SCALE_ZERO_AXIS)
    return solve(local.T, world(obj).T).T


# Data


def transform_data(data: ID, change: Matrix4) -> None:
    """Map every control point of the data and its shape keys, p → change · p, or raise
    EditRefusedError.
    """
    if isinstance(data, bpy.types.Mesh):
        if data.vertices:
            _transform_mesh(data, change)
    elif isinstance(data, bpy.types.TextCurve):
        offset = change[:3, 3]
        is_turned = np.abs(change[:3, :3] - np.eye(3)).max() > 1e-6
        if is_turned or abs(offset[2]) > 1e-6 * max(np.abs(offset).max(), data.size):
            raise EditRefusedError(REFRAME_IMPOSSIBLE, cause=WITHOUT_TRANSFORM)
        data.offset_x += offset[0]
        data.offset_y += offset[1]
    elif isinstance(data, bpy.types.Curve):
        data.transform(Matrix(change), shape_keys=True)
    else:
        data.transform(Matrix(change))


def _transform_mesh(mesh: bpy.types.Mesh, change: Matrix4) -> None:
    keys = [block.data for block in mesh.shape_keys.key_blocks] if mesh.shape_keys else []
    key_points = [read_array(key, "co", (len(key), 3), np.float32) for key in keys]
    transform_meshes([mesh], change[None])
    for key, points in zip(keys, key_points):
        moved = points.astype(np.float64) @ change[:3, :3].T + change[:3, 3]
        key.foreach_set("co", np.ascontiguousarray(moved, np.float32).ravel())


def _reason_of_change(obj: Object, harmless: set[str]) -> Finding:
    """Return the finding that modifiers of no `harmless` type would change the shape, or without
    any that the object itself would.
    """
    names = [
        modifier.name
        for modifier in obj.modifiers
        if modifier.show_viewport and modifier.type not in harmless
    ]
    return (
        finding(MODIFIERS_CHANGE_SHAPE, modifiers=names)
        if names
        else finding(
            REFRAME_IMPOSSIBLE,
            cause="the shape would change. Apply the scale, or use Object > Convert > Mesh",
        )
    )
