# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependents of an object whose origin and axes change: its shape, its children and all other users
must not move.

Surfaces are compared as they are evaluated, point by point in the world, because no list of
modifiers could say how each of them depends on an origin.
"""

import numpy as np
from bpy.types import ID, Depsgraph, Object
from mathutils import Matrix

from ...core.numerics import Array, NDArray
from ...core.verdict import EditRefusedError, Finding, ReadError, finding
from ..read.objects import read_object
from ..read.visibility import measurable
from .changes import LINKING_TYPES, users_of
from .findings import CHILD_NOT_HELD, DEPENDENT_SHAPE_CHANGES, FOLLOWER_MOVED
from .transforms import FLOAT32, Matrix4, world

# Relative to the size: more than the rounding in a chain of modifiers, and far less than anyone can
# see.
SAME_SHAPE_RTOL = 1e-5
# Points compared in each of many instances; the first instance is compared point by point.
SAMPLES = 64
# a direction along which hardly anything is symmetric
SORT_DIRECTION = np.array([1.0, 0.7548776662, 0.5698402910])

# of each surface, the (n, 3) points of the first instance, and (k, s, 3) samples of the k others
Shape = list[tuple[Array, Array]]


def referring(objects: set[Object]) -> dict[Object, set[Object]]:
    """Return for each object the objects that use it, directly or through data and collections."""
    users = users_of(objects, LINKING_TYPES)

    def through(data: ID, visited: set[ID]) -> set[Object]:
        reached = set()
        for user in users[data] - visited:
            if isinstance(user, Object):
                reached.add(user)
            else:
                visited.add(user)
                reached |= through(user, visited)
        return reached

    return {obj: through(obj, {obj}) for obj in objects}


def shape(obj: Object, depsgraph: Depsgraph) -> Shape | None:
    """Return the world points of an object's surfaces: all of the first instance, samples of
    others; None if none.
    """
    try:
        reading = read_object(obj, depsgraph, edges=False)
    except ReadError:
        return None
    shapes = []
    for part in reading.parts:
        points = np.asarray(part.surface.points, np.float64)
        sample_index = np.linspace(0, len(points) - 1, min(SAMPLES, len(points))).astype(int)
        linear = part.matrices[:, :3, :3]
        offset = part.matrices[:, :3, 3]
        first = points @ linear[0].T + offset[0]
        rest = np.einsum("kij,nj->kni", linear[1:], points[sample_index]) + offset[1:, None]
        shapes.append((first, rest))
    return shapes


def transform_shape(before: Shape | None, was: Matrix4, now: Matrix4) -> Shape | None:
    """Return the shape after a rigid move of its object from one (4, 4) matrix to another."""
    if before is None:
        return None
    motion = now @ np.linalg.pinv(was)  # the matrix may be singular
    linear = motion[:3, :3].T
    offset = motion[:3, 3]
    return [(first @ linear + offset, rest @ linear + offset) for first, rest in before]


def same_shape(before: Shape | None, after: Shape | None, size: float) -> bool:
    """Return whether two shapes are the same, to rounding in a body of this size."""
    if before is None or after is None:
        return before is None and after is None
    pairs = [pair for first, second in zip(before, after) for pair in zip(first, second)]
    if len(before) == len(after) and all(first.shape == second.shape for first, second in pairs):
        return all(_nearly_equal(*pair, size) for pair in pairs)
    # Objects that shared a mesh are separate parts once one of them has a copy.
    samples_before = _sample_instances(before)
    samples_after = _sample_instances(after)
    return samples_before.keys() == samples_after.keys() and all(
        _nearly_equal(samples, samples_after[count], size)
        for count, samples in samples_before.items()
    )


def _sample_instances(shape: Shape) -> dict[int, Array]:
    """Return a dict from numbers of points to (k, s, 3) samples of k instances, sorted by center
    along a line.
    """
    by_count: dict[int, list[Array]] = {}
    for first, rest in shape:
        sample_index = np.linspace(0, len(first) - 1, rest.shape[1]).astype(int)
        by_count.setdefault(len(first), []).append(
            np.concatenate([first[sample_index][None], rest])
        )
    sorted_samples = {}
    for count, points_of_parts in by_count.items():
        samples = np.concatenate(points_of_parts)
        sorted_samples[count] = samples[np.argsort(samples.mean(axis=1) @ SORT_DIRECTION)]
    return sorted_samples


def _nearly_equal(first: NDArray, second: NDArray, size: float) -> bool:
    """Return whether (..., 3) points agree to the tolerance of a body of this size, or to 16
    roundings in float32, a margin for a chain of modifiers far from the origin.
    """
    if first.shape != second.shape:
        return False  # more or fewer places
    if not first.size:
        return True
    limit = SAME_SHAPE_RTOL * size + 16.0 * FLOAT32 * np.abs(first).max()
    return bool(np.abs(first - second).max() <= limit)


class DependentsGuard:
    """Objects that refer to the changed ones: children are held in place, the others are
    watched.
    """

    def __init__(
        self,
        objects: list[Object],
        users: dict[Object, set[Object]],
        depsgraph: Depsgraph,
    ) -> None:
        self.findings: list[Finding] = []
        self.changed = {obj: world(obj) for obj in objects}
        dependents = sorted(
            {user for obj in objects for user in users.get(obj, ())} - set(objects),
            key=lambda dependent: dependent.name_full,
        )
        for dependent in dependents:
            if dependent.library is not None and dependent.parent in self.changed:
                raise EditRefusedError(CHILD_NOT_HELD, object=dependent.name)
        self.children = {
            dependent: np.array(dependent.matrix_parent_inverse, np.float64)
            for dependent in dependents
            if dependent.parent in self.changed
        }
        bones = [bone for each in dependents if each.pose is not None for bone in each.pose.bones]
        self.anchors = [
            (constraint, np.array(constraint.inverse_matrix, np.float64))
            for owner in (*dependents, *bones)
            for constraint in owner.constraints
            if constraint.type == "CHILD_OF" and constraint.target in self.changed
        ]
        self.places = {dependent: world(dependent) for dependent in dependents}
        self.shapes = {
            dependent: shape(dependent, depsgraph)
            for dependent in dependents
            # Objects of other types without modifiers have a shape of their own.
            if (
                dependent.modifiers
                or dependent.type in {"CURVE", "FONT"}
                or getattr(dependent.data, "shape_keys", None)
            )
            and measurable(dependent)
        }

    def compensate(self) -> None:
        """Set the inverses of children and of Child Of constraints so that the children stay in
        place.
        """
        # A child stays if its inverse absorbs the change of the parent's matrix, W'⁻¹ W.
        held = {parent: np.linalg.solve(world(parent), was) for parent, was in self.changed.items()}
        for child, inverse in self.children.items():
            child.matrix_parent_inverse = Matrix(held[child.parent] @ inverse)
        for constraint, inverse in self.anchors:
            constraint.inverse_matrix = Matrix(held[constraint.target] @ inverse)

    def verify(self, depsgraph: Depsgraph, size: float) -> None:
        """Raise EditRefusedError if a child or another object's shape moved; followers by
        constraint are only noted.
        """
        for dependent, place in self.places.items():
            moved = self._moved(place, world(dependent), size)
            if moved and dependent in self.children:
                raise EditRefusedError(CHILD_NOT_HELD, object=dependent.name)
            if moved:
                self.findings.append(finding(FOLLOWER_MOVED, object=dependent.name))
        for dependent, before in self.shapes.items():
            if self._moved(self.places[dependent], world(dependent), size):
                continue
            if not same_shape(before, shape(dependent, depsgraph), size):
                raise EditRefusedError(DEPENDENT_SHAPE_CHANGES, object=dependent.name)

    def _moved(self, before: NDArray, now: NDArray, size: float) -> bool:
        """Return whether two (4, 4) matrices differ by more than rounding in a body of this size,
        or by 16 roundings of the farthest location, as in `_nearly_equal`.
        """
        changed = [np.abs(was[:3, 3]).max() for was in self.changed.values()]
        reach = max(np.abs(before[:3, 3]).max(), *changed)
        off = np.abs(now - before)
        return bool(
            off[:3, 3].max() > SAME_SHAPE_RTOL * size + 16.0 * FLOAT32 * reach
            or off[:3, :3].max() > SAME_SHAPE_RTOL * np.abs(before[:3, :3]).max()
        )

    def restore(self) -> None:
        for child, inverse in self.children.items():
            child.matrix_parent_inverse = Matrix(inverse)
        for constraint, inverse in self.anchors:
            constraint.inverse_matrix = Matrix(inverse)
