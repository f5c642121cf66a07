# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints of robots, read from rigid-body constraints, from bones, and from the custom properties of
both.
"""

from collections.abc import Mapping
from math import inf, isfinite
from types import MappingProxyType
from typing import Any

import numpy as np
from bpy.types import Object, PoseBone, RigidBodyConstraint, Scene

from ...core.bodies import float64_matrix
from ...core.numerics import polar_rotation
from ...core.robots import (
    JOINT_VALUE_UNUSABLE,
    VALUES,
    Candidate,
    Connection,
    FreeAxis,
    Link,
    Mimic,
    Pose,
)
from ...core.verdict import Finding, finding


def is_passive(obj: Object) -> bool:
    """Return whether an object is a passive rigid body, which nothing moves."""
    return obj.rigid_body is not None and obj.rigid_body.type == "PASSIVE"


# For each kind of constraint, its free axes: the kind, the index of an axis of the constraint, the
# sign of the limits. Blender counts angles of the first object relative to the second, but a
# piston's and all lengths of the second relative to the first. A generic constraint moves along its
# axes, then turns about z, y and x.
_ROTATIONS = (("rotate", 2, -1.0), ("rotate", 1, -1.0), ("rotate", 0, -1.0))
_GENERIC = (*(("translate", axis, 1.0) for axis in range(3)), *_ROTATIONS)
CONSTRAINTS: dict[str, tuple[tuple[str, int, float], ...]] = {
    "FIXED": (),
    "POINT": _ROTATIONS,
    "HINGE": (("rotate", 2, -1.0),),
    "SLIDER": (("translate", 0, 1.0),),
    "PISTON": (("translate", 0, 1.0), ("rotate", 0, 1.0)),
    "GENERIC": _GENERIC,
    "GENERIC_SPRING": _GENERIC,
}


def constraint_connections(
    scene: Scene, labels: Mapping[Object, str], unit: float
) -> tuple[list[Connection], list[Candidate], list[Finding]]:
    """Return the constraints of labeled objects as joints, frames of unlabeled passive objects, and
    findings.
    """
    connections: list[Connection] = []
    bases: dict[str, Candidate] = {}
    findings: list[Finding] = []
    for holder in scene.objects:
        constraint = holder.rigid_body_constraint
        if constraint is None or not constraint.enabled or constraint.type not in CONSTRAINTS:
            continue
        sides = [constraint.object1, constraint.object2]
        names = [labels.get(side, "") for side in sides]
        if not any(names):
            continue
        for index, side in enumerate(sides):
            if side is not None and not names[index] and is_passive(side):
                names[index] = name = side.name_full
                bases[name] = Candidate(name, Link(name, pose=_pose(side, unit), is_fixed=True))
        values, mimic, unusable = joint_values(holder)
        findings += unusable
        free = _freedom(constraint, values, unit)
        connections.append(
            Connection(holder.name_full, names[0], names[1], _pose(holder, unit), free, mimic)
        )
    connections.sort(key=lambda connection: connection.name)
    return connections, [bases[name] for name in sorted(bases)], findings


def _pose(obj: Object, unit: float) -> Pose:
    """Return an object's place in m and nearest rotation; of a mirror image the opposite matrix."""
    matrix = float64_matrix(obj.matrix_world)
    rotation_or_mirror = polar_rotation(matrix[None])[0][0]
    rotation = rotation_or_mirror * np.sign(np.linalg.det(rotation_or_mirror))
    return Pose(matrix[:3, 3] * unit, rotation)


def _freedom(
    constraint: RigidBodyConstraint, values: Mapping[str, float], unit: float
) -> tuple[FreeAxis, ...]:
    """Return the free axes of a constraint, with the values of its springs unless `values` states
    them.
    """
    free = []
    # Springs of the other type have a damping without a unit.
    has_springs = constraint.type == "GENERIC_SPRING" and constraint.spring_type == "SPRING2"
    for kind, index, sign in CONSTRAINTS[constraint.type]:
        turns = kind == "rotate"
        axis = "xyz"[index]
        lower = -inf
        upper = inf
        limit = ("ang_" if turns else "lin_") + axis
        if constraint.type != "POINT" and getattr(constraint, "use_limit_" + limit):
            first = getattr(constraint, f"limit_{limit}_lower")
            last = getattr(constraint, f"limit_{limit}_upper")
            if first == last:
                continue
            # Equal limits lock the axis; a lower limit above the upper one is none for Bullet.
            if first < last:
                length = 1.0 if turns else unit
                lower, upper = sorted((sign * first * length, sign * last * length))
        spring = {}
        name = ("ang_" if turns else "") + axis
        if has_springs and getattr(constraint, "use_spring_" + name):
            # A torque has the square of a length in Blender units, a force per length has none.
            factor = unit**2 if turns else 1.0
            spring["stiffness"] = getattr(constraint, "spring_stiffness_" + name) * factor
            spring["damping"] = getattr(constraint, "spring_damping_" + name) * factor
        free.append(FreeAxis(kind, np.eye(3)[index], lower, upper, {**spring, **values}))
    return tuple(free)


def joint_values(
    owner: Object | PoseBone,
) -> tuple[dict[str, float], Mimic | None, list[Finding]]:
    """Return the values of a joint that are custom properties, its mimic, and findings about
    unusable properties.
    """
    values: dict[str, float] = {}
    findings: list[Finding] = []
    for name in (*VALUES, "mimic_multiplier", "mimic_offset"):
        value: Any = owner.get("joint_" + name)
        if value is None:
            continue
        is_usable = isinstance(value, (int, float)) and isfinite(value)
        if is_usable and not name.startswith("mimic"):
            # A motor without effort or velocity would not move.
            is_usable = value > 0 if name in ("effort", "velocity") else value >= 0
        if is_usable:
            values[name] = float(value)
        else:
            findings.append(
                finding(
                    JOINT_VALUE_UNUSABLE, joint=owner.name, key="joint_" + name, value=str(value)
                )
            )
    factors = values.pop("mimic_multiplier", 1.0), values.pop("mimic_offset", 0.0)
    leader = owner.get("joint_mimic")
    return values, None if leader is None else Mimic(str(leader), *factors), findings


def bone_freedom(
    bone: PoseBone, values: Mapping[str, float] = MappingProxyType({}), unit: float = 1.0
) -> tuple[FreeAxis, ...]:
    """Return a bone's unlocked axes of movement and of rotation with limits, in m, by constraints
    and IK.
    """
    rotation_limits = {
        axis: (getattr(bone, "ik_min_" + axis), getattr(bone, "ik_max_" + axis))
        for axis in "xyz"
        if getattr(bone, "use_ik_limit_" + axis)
    } | _bone_limits(bone, "LIMIT_ROTATION", "use_limit_")
    location_limits = {}
    if bone.parent is None or not bone.bone.use_connect:
        location_limits = _bone_limits(bone, "LIMIT_LOCATION", "use_min_", "use_max_")
    world_axes = (
        float64_matrix(bone.id_data.matrix_world)[:3, :3]
        @ float64_matrix(bone.bone.matrix_local)[:3, :3]
    )
    lengths = (unit * np.linalg.norm(world_axes, axis=0)).tolist()  # m per unit of the bone
    free = []  # kind, index of the axis, limits
    for index, axis in enumerate("xyz"):
        if axis in location_limits and not bone.lock_location[index]:
            lower, upper = (lengths[index] * end for end in location_limits[axis])
            free.append(("translate", index, lower, upper))
    for index in (2, 1, 0):  # a bone turns about z first
        axis = "xyz"[index]
        if not bone.lock_rotation[index] and not getattr(bone, "lock_ik_" + axis):
            free.append(("rotate", index, *rotation_limits.get(axis, (-inf, inf))))
    return tuple(
        FreeAxis(kind, np.eye(3)[index], lower, upper, values)
        for kind, index, lower, upper in free
        if lower < upper
    )


def _bone_limits(bone: PoseBone, kind: str, *uses: str) -> dict[str, tuple[float, float]]:
    """Return the limits of a bone's constraints of a kind in local space, by axis. uses: beginnings
    of the switches of the lower and the upper end, or of one switch for both.
    """
    limits = {}
    for constraint in bone.constraints:
        is_limit = constraint.type == kind and constraint.owner_space == "LOCAL"
        for axis in "xyz" if is_limit and constraint.enabled else "":
            used = [getattr(constraint, use + axis) for use in uses]
            if any(used):
                lower = getattr(constraint, "min_" + axis) if used[0] else -inf
                limits[axis] = lower, getattr(constraint, "max_" + axis) if used[-1] else inf
    return limits


def bone_parents(bone: PoseBone, labels: Mapping[str, str]) -> list[str]:
    """Return the labels of a bone's parents, the nearest first; `labels` maps the names of bones
    that are links.
    """
    return [labels[above.name] for above in bone.parent_recursive if above.name in labels]
