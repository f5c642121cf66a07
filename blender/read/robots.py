# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A measured object as a link of a robot: its place, and its parents."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from math import inf

import bpy
import numpy as np

from ...core.measurement.measurement import Measurement
from ...core.mesh.surface import Surface, join_surfaces
from ...core.numerics.rotations import polar_rotation
from ...core.robots.links import Candidate, make_candidate
from ...core.robots.model import FreeAxis, Pose
from ...core.verdict.finding import MeasureError
from .objects import read_object
from .reading import float64_matrix


def object_candidate(
    label: str, obj: bpy.types.Object | None, measurement: Measurement, labels: Mapping[bpy.types.Object, str]
) -> Candidate:
    """Return a measured object as a possible link, with its labeled parents; `obj` is None for instances."""
    if obj is None:
        return make_candidate(label, measurement)
    parents, above = [], obj.parent
    while above is not None:
        parents += [labels[above]] if above in labels else []
        above = above.parent
    return make_candidate(label, measurement, parents, obj.matrix_world.to_scale())


def link_surface(
    objects: Iterable[bpy.types.Object], depsgraph: bpy.types.Depsgraph, pose: Pose, unit: float
) -> Surface | None:
    """Return the surfaces of a link's objects as triangles in m, in the link's frame; None if they show no faces."""
    pieces, to_link = [], pose.inverse()
    for obj in objects:
        try:
            surface = read_object(obj, depsgraph, edges=False).join()
        except MeasureError:  # such as a grid of densities
            continue
        pieces.append(surface.transform(unit * to_link.rotation, to_link.position))
    return join_surfaces(pieces) if len(pieces) > 1 else pieces[0] if pieces else None


def sheared_objects(objects: Iterable[bpy.types.Object]) -> list[str]:
    """Return the names of objects with a matrix that does more than move, turn, scale and mirror."""
    located = list(objects)
    if not located:
        return []
    _, sheared = polar_rotation(np.array([float64_matrix(obj.matrix_world) for obj in located]))
    return [obj.name_full for obj, skew in zip(located, sheared) if skew]


def bone_freedom(bone: bpy.types.PoseBone) -> tuple[FreeAxis, ...]:
    """Return a bone's axes about which it may turn in its parent, with limits, in the order z, y, x.

    The limits are those of a Limit Rotation constraint in local space, else those for inverse kinematics. Axes are left
    out if they are locked, or if their limits leave no room.
    """
    limits: dict[str, tuple[float | None, float | None]] = {}
    for axis in "xyz":
        if getattr(bone, "use_ik_limit_" + axis):
            limits[axis] = getattr(bone, "ik_min_" + axis), getattr(bone, "ik_max_" + axis)
    for constraint in bone.constraints:
        if constraint.type == "LIMIT_ROTATION" and constraint.owner_space == "LOCAL" and constraint.enabled:
            for axis in "xyz":
                if getattr(constraint, "use_limit_" + axis):
                    limits[axis] = getattr(constraint, "min_" + axis), getattr(constraint, "max_" + axis)
    free = []
    for index in (2, 1, 0):
        axis = "xyz"[index]
        lower, upper = limits.get(axis, (None, None))
        no_room = lower is not None and upper is not None and not lower < upper
        if no_room or bone.lock_rotation[index] or getattr(bone, "lock_ik_" + axis):
            continue
        limited = -inf if lower is None else lower, inf if upper is None else upper
        free.append(FreeAxis("rotate", np.eye(3)[index], *limited))
    return tuple(free)


def bone_parents(bone: bpy.types.PoseBone, labels: Mapping[str, str]) -> list[str]:
    """Return the labels of a bone's parents, the nearest first; `labels` maps the names of bones that are links."""
    return [labels[above.name] for above in bone.parent_recursive if above.name in labels]


USD_ROOT = "root"  # Blender's exporter puts everything under it


def usd_path(obj: bpy.types.Object, identifier: Callable[[str], str]) -> list[str]:
    """Return the names of the prims from the root to an object's; `identifier` converts names as the exporter does."""
    names, above = [], obj
    while above is not None:
        names.append(identifier(above.name))
        above = above.parent
    return [USD_ROOT, *reversed(names)]
