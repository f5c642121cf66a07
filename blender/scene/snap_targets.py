# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Targets of snapping operators: the place of a body, in Blender units, the new frames for its
object, and matches.

Coordinates in float32 do not fix the directions of nearly equal moments: when a body is measured
again, they turn by about the rounding divided by the gap between the moments. Whether axes are
principal is therefore decided by the tensor, which must be diagonal in them to rounding, not from
the angle between two measured frames.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from bpy.types import Context, Object

from ...core.inertia import EQUAL_AXES, MassProperties, PrincipalFrame, zhang_chen_frame
from ...core.moments import affine_matrices
from ...core.numerics import Array, NDArray, polar_rotation
from ...core.shape import MAX_FIT_RTOL, RigidMatch
from ...core.verdict import EditRefusedError, Finding, Procedure
from ..bodies.measure_body import measure_body
from ..bodies.measure_object import measured_in_turn
from ..bodies.shape.object_shape import NoShapeError, shape_of_measured
from ..bodies.stack import Measured
from ..scale import meters_per_unit
from ..settings.given import COLLIDER
from . import reframe
from .changes import ancestors
from .findings import FOLLOWS_MOVED, MIRROR_IMAGE, OPEN_OBJECT
from .transforms import world

if TYPE_CHECKING:
    from ..bodies.flat.flat_shape import FlatShape
    from ..bodies.shape.object_shape import Shape

MAX_DIRECTION_NOISE = 1e-3  # rounding in float32 of directions fixed by moments of higher order
DIAGONAL_RTOL = 4e-7  # products of inertia by rounding in float32, relative to the trace
UNIT_SCALE = 1e-6  # largest deviation of the products of an object's axes from 1 and 0


@dataclass(frozen=True)
class SnapTarget:
    """An object as measured now, world axes, lengths in Blender units.

    center (3,), axes (3, 3) principal, as columns, det +1; inertia (3, 3) about the center in
    kg·m²; gyration (3,) radii; size: the largest of them; finding: about free choices. shape_axes:
    indices of axes of equal moments that the shape itself fixes; is_unique: whether it fixes all
    axes.
    """

    obj: Object
    center: Array
    axes: Array
    inertia: Array
    gyration: Array
    mass: float
    finding: Finding | None
    shape_axes: tuple[int, ...] = ()
    is_unique: bool = False

    @classmethod
    def of_body(
        cls, obj: Object, body: MassProperties, principal: PrincipalFrame, unit: float
    ) -> SnapTarget:
        """Return the target of a measured body; `unit` is the scene's scale."""
        return cls(
            obj=obj,
            center=body.center / unit,
            axes=principal.axes,
            inertia=body.inertia,
            gyration=body.radii_of_gyration / unit,
            mass=body.mass,
            finding=principal.finding,
            shape_axes=tuple(
                i for i in EQUAL_AXES[principal.symmetry] if i not in principal.undetermined_axes
            ),
            is_unique=principal.is_unique,
        )

    @property
    def size(self) -> float:
        return float(self.gyration.max())

    def is_principal(self, frame: NDArray) -> bool:
        """Return whether the columns of `frame` are this body's principal axes, as far as its
        coordinates can show.
        """
        tensor = frame.T @ self.inertia @ frame
        limit = DIAGONAL_RTOL * np.trace(tensor)
        moments = np.diag(tensor)
        largest_product = np.abs(tensor - np.diag(moments)).max()
        own_cosines = (frame * self.axes).sum(axis=0)  # of each column with the axis of its number
        # Axes of equal moments lie as the shape requires; a cube's may be swapped or reversed.
        cosines = (frame.T @ self.axes)[:, self.shape_axes]
        expected = np.eye(3)[:, self.shape_axes] if self.is_unique else np.round(cosines)
        return bool(
            largest_product <= limit
            and (np.diff(moments) >= -limit).all()
            and (np.abs(cosines - expected) <= MAX_DIRECTION_NOISE).all()
            # Otherwise no axis may be reversed: a cosine would be near -1.
            and (self.shape_axes or (own_cosines > -0.5).all())
        )


def targets_in_turn(context: Context, objects: Sequence[Object]) -> Callable[[Object], SnapTarget]:
    """Return a function that gives the `snap_target` of one object at a time, measured in batches,
    in a fixed scene.
    """
    measured = measured_in_turn(objects, context.evaluated_depsgraph_get())
    return lambda obj: target_of(context, obj, measured(obj))


def snap_target(context: Context, obj: Object, strict: bool = False) -> SnapTarget:
    """Measure an object for snapping, or raise EditRefusedError; strict: by Zhang and Chen's
    rule.
    """
    measured = measured_in_turn([obj], context.evaluated_depsgraph_get())(obj)
    return target_of(context, obj, measured, strict)


def target_of(
    context: Context,
    obj: Object,
    measured: Measured,
    strict: bool = False,
    by_shape: bool = True,
) -> SnapTarget:
    """Return the `snap_target` of a measured object; by_shape: moments to sixth order choose among
    axes of equal moments, in whose plane the object's own axes may lie anywhere. Signs that third
    moments leave open follow the object's own axes.
    """
    if measured.measurement.method.procedure == Procedure.OPEN:
        raise EditRefusedError(OPEN_OBJECT)
    body = measured.measurement.mass_properties
    principal = body.principal
    if strict or (by_shape and not principal.is_unique and EQUAL_AXES[principal.symmetry]):
        # Measured alone, a body gets exact third moments if they are doubtful.
        alone = (
            measured
            if measured.index is None
            else measure_body(obj, context.evaluated_depsgraph_get())
        )
        if strict:
            moments, _ = alone.measurement.mass_moments
            is_varying = alone.measurement.kind == "shell" or alone.body.mass is not None
            principal = zhang_chen_frame(moments, None if is_varying else alone.body.third_order)
        else:
            with suppress(NoShapeError):
                principal = shape_of_measured(alone, 1).principal_frame()
    return SnapTarget.of_body(obj, body, principal, meters_per_unit(context.scene))


def matrix_at_center(obj: Object, body: SnapTarget) -> NDArray | None:
    """Return the object's matrix with its origin at the body's center, or None if it is there
    already.
    """
    target = world(obj)
    if np.abs(target[:3, 3] - body.center).max() <= reframe.location_tolerance(obj, body.size):
        return None
    target[:3, 3] = body.center
    return target


def matrix_along_axes(obj: Object, body: SnapTarget) -> NDArray | None:
    """Return the matrix of the body's center and principal axes, or None if the object has them
    already.
    """
    linear = world(obj)[:3, :3]
    is_rotation = (
        np.abs(linear.T @ linear - np.eye(3)).max() <= UNIT_SCALE and np.linalg.det(linear) > 0.0
    )
    if is_rotation and matrix_at_center(obj, body) is None and body.is_principal(linear):
        return None
    return affine_matrices(body.axes, body.center)


def matrix_for_bullet(obj: Object, body: SnapTarget) -> NDArray | None:
    """Return the matrix of the body's center with the object's rotation, or None if the object has
    it already.

    A scale is applied if it mirrors or shears, or if the object has colliders: Bullet knows no
    mirrored or sheared bodies, and scales the margins of colliders. Of a mirrored object only the
    axes with a negative scale turn over.
    """
    linear = world(obj)[:3, :3]
    products = linear.T @ linear
    has_colliders = any(COLLIDER in child for child in obj.children)
    allowed = np.eye(3) if has_colliders else np.diag(np.diag(products))
    off = np.abs(products - allowed).max()
    determinant = np.linalg.det(linear)
    if determinant > 0.0 and off <= UNIT_SCALE * products.max():
        return matrix_at_center(obj, body)
    rotation = np.array(obj.matrix_world.to_quaternion().to_matrix())
    signs = np.sign(obj.scale)
    if determinant < 0.0 and signs.prod() < 0.0:
        rotation *= -signs  # the quaternion reverses all axes, and the scale mirrors some
    return affine_matrices(polar_rotation(rotation[None])[0][0], body.center)


def align_to_world(
    context: Context, obj: Object, order: str, at_origin: bool, strict: bool
) -> bool:
    """Turn an object's principal axes along the world's in an order; return whether it had to be
    moved.
    """
    frame = np.eye(3)[:, ["XYZ".index(letter) for letter in order]]
    frame[:, 2] *= np.linalg.det(frame)
    reframe.check_movable(obj)
    body = snap_target(context, obj, strict)
    goal = np.zeros(3) if at_origin else body.center
    aligned = body.is_principal(frame)
    if aligned and np.abs(body.center - goal).max() <= reframe.location_tolerance(obj, body.size):
        return False
    rotation = np.eye(3) if aligned else frame @ body.axes.T
    target = world(obj)
    target[:3, :3] = rotation @ target[:3, :3]
    target[:3, 3] = goal + rotation @ (target[:3, 3] - body.center)
    reframe.move(context, reframe.Plan(obj, target, body.size, move_only=aligned))
    return True


def require_matchable(context: Context, obj: Object) -> None:
    """Raise EditRefusedError if the object cannot be laid onto the active one."""
    reframe.check_movable(obj)
    if obj in ancestors(context.object):
        raise EditRefusedError(FOLLOWS_MOVED, follower=context.object.name, target=obj.name)


def plan_match(
    context: Context,
    obj: Object,
    shape: Shape | FlatShape,
    target: Shape | FlatShape,
    match: RigidMatch,
) -> reframe.Plan:
    """Return the plan that lays the object onto the target; raise EditRefusedError for a mirror
    image.
    """
    if match.is_mirror_image:
        raise EditRefusedError(MIRROR_IMAGE)
    unit = meters_per_unit(context.scene)
    matrix = world(obj)
    matrix[:3, :3] = match.rotation @ matrix[:3, :3]
    matrix[:3, 3] = (target.center + match.rotation @ (matrix[:3, 3] * unit - shape.center)) / unit
    return reframe.Plan(obj, matrix, shape.size / unit, move_only=False)


def is_copy(match: RigidMatch, size: float) -> bool:
    """Return whether the surfaces of a match lie on each other, by a tolerance relative to the
    body's size.
    """
    return match.max_distance <= MAX_FIT_RTOL * size


def move_to_match(context: Context, plan: reframe.Plan) -> bool:
    """Carry out a plan; return False if the object was in place already, to rounding in float32."""
    off = np.abs(plan.target - world(plan.obj))
    if off[:, :3].max() <= 1e-7 and off[:, 3].max() <= reframe.location_tolerance(
        plan.obj, plan.size
    ):
        return False
    reframe.move(context, plan)
    return True
