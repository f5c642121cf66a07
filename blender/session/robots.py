# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as a robot: the choice of objects, the links made from them, their parents and their joints."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf, isfinite
from types import MappingProxyType
from typing import Any

import bpy
import numpy as np
from bpy.types import Collection, Context, Depsgraph, Object, PoseBone, RigidBodyConstraint, Scene
from numpy.typing import NDArray

from ...core.bodies.reading import float64_matrix
from ...core.measurement.measurement import Measurement
from ...core.mesh.surface import Surface, join_surfaces
from ...core.numerics.rotations import polar_rotation, rotation_matrix
from ...core.robots.findings import JOINT_VALUE_UNUSABLE, ROBOT_WITHOUT_LINKS
from ...core.robots.links import Candidate, Connection, assemble_robot, make_candidate
from ...core.robots.model import VALUES, FreeAxis, Link, Mimic, Pose, Robot, Shape
from ...core.robots.write.shapes import with_colliders
from ...core.verdict.finding import EditRefusedError, Finding, MeasureError, finding
from ..bodies.assembly.assembly import measure_assembly
from ..bodies.rig import measure_rig
from ..bodies.stacks.many import measured_in_turn
from ..read.objects import read_object
from ..read.visibility import measurable
from ..scene.colliders import colliders_by_body, read_colliders
from ..settings.given import COLLIDER
from ..settings.options import AS_SET, MeasureOptions
from ..write import reports
from .findings import LEFT_OUT_OF_ROBOT


@dataclass(frozen=True)
class SceneLinks:
    """A robot made from the scene, with findings about its links and omitted objects. unit: meters per Blender unit.

    members: the objects of each link. pieces: the surfaces of each bone's link, with maps into the world in meters.
    """

    robot: Robot
    findings: list[Finding]
    unit: float
    members: dict[str, list[Object]] = field(default_factory=dict)
    pieces: dict[str, tuple[tuple[Surface, NDArray[np.float64]], ...]] = field(default_factory=dict)

    def with_colliders(self) -> SceneLinks:
        """Return the links with the colliders of their objects in place of their geometry as collision shapes."""
        by_body = colliders_by_body(bpy.data.objects)

        def colliders_of(link: Link) -> list[Shape]:
            placed: list[Shape] = []
            for obj in self.members.get(link.name, ()):
                location, turn, _scale = obj.matrix_world.decompose()
                frame = Pose(np.array(location, np.float64) * self.unit, rotation_matrix(turn))
                shapes = read_colliders(by_body.get(obj, ()), frame.rotation, self.unit)
                is_own = np.array_equal(frame.rotation, link.pose.rotation) and len(self.members[link.name]) == 1
                to_link = Pose() if is_own else link.pose.inverse() @ frame  # equal frames without rounding
                placed += [replace(shape, pose=to_link @ shape.pose) for shape in shapes]
            return placed

        return replace(self, robot=with_colliders(self.robot, colliders_of))

    def surface(self, context: Context, label: str) -> Surface | None:
        """Return a link's surface, in meters along the link's axes; None if the link shows no faces."""
        pose = self.robot.link(label).pose
        if label not in self.pieces:
            depsgraph = context.evaluated_depsgraph_get()
            return link_surface(self.members.get(label, ()), depsgraph, pose, self.unit)
        to_link = pose.inverse()
        return join_surfaces(
            [
                surface.transform(
                    to_link.rotation @ matrix[:3, :3], to_link.rotation @ matrix[:3, 3] + to_link.position
                )
                for surface, matrix in self.pieces[label]
            ]
        )


def candidates(context: Context, collection: str, selected: bool) -> list[Object]:
    """Return the objects of the named collection, else the selected ones, else all rendered ones; no colliders."""
    chosen = [obj for obj in context.view_layer.objects if not obj.hide_render]
    if collection:
        chosen = bpy.data.collections[collection].all_objects
    elif selected:
        chosen = context.view_layer.objects.selected
    return [obj for obj in chosen if COLLIDER not in obj]


def jointed_robot(
    context: Context, name: str, made: Sequence[Candidate], labels: Mapping[Object, str], unit: float
) -> tuple[Robot, list[Finding]]:
    """Return a robot of candidates with the joints of the scene's rigid-body constraints, and findings."""
    connections, bases, findings = constraint_connections(context.scene, labels, unit)
    robot, more = assemble_robot(name, [*made, *bases], connections)
    return robot, [*findings, *more]


def object_links(
    context: Context, name: str, objects: list[Object], step: Callable[[float], None] = lambda done: None
) -> SceneLinks:
    """Return a robot with a link for each measurable object; a finding names the others. step: gets finished counts."""
    depsgraph = context.evaluated_depsgraph_get()
    chosen = [obj for obj in objects if measurable(obj)]
    measured: dict[Object, Measurement] = {}
    in_turn, failures = measured_in_turn(chosen, depsgraph), []
    for done, obj in enumerate(chosen, 1):
        try:
            measured[obj] = in_turn(obj).measurement
        except Exception as error:
            failures.append(reports.failure(obj.name_full, error))
        step(done)
    if not measured:
        raise EditRefusedError(failures[0] if failures else finding(ROBOT_WITHOUT_LINKS))
    labels = {obj: obj.name_full for obj in measured}
    made = [object_candidate(labels[obj], obj, measurement, labels) for obj, measurement in measured.items()]
    unit = AS_SET.meters_per_unit(context.scene)
    robot, findings = jointed_robot(context, name, made, labels, unit)
    members = {label: [obj] for obj, label in labels.items()}
    return SceneLinks(robot, [*findings, *left_out(failures, len(chosen))], unit, members)


def collection_links(
    context: Context, name: str, root: Collection, objects: list[Object], options: MeasureOptions = AS_SET
) -> SceneLinks:
    """Return a robot with a link along the world's axes for each child collection of `root`, or for `root` alone."""
    depsgraph = context.evaluated_depsgraph_get()
    made, failures, members, labels = [], [], {}, {}
    collections = list(root.children) or [root]
    for collection in collections:
        label = collection.name_full
        try:
            measurement = measure_assembly(collection, depsgraph, options).measurement
        except MeasureError as error:
            failures.append(reports.failure(label, error.finding))
            continue
        held = {*collection.all_objects}
        labels.update(dict.fromkeys(held, label))
        members[label] = [obj for obj in objects if obj in held and measurable(obj)]
        made.append(make_candidate(label, measurement, is_fixed=any(map(is_passive, held))))
    if not made:
        raise EditRefusedError(failures[0])
    unit = options.meters_per_unit(context.scene)
    robot, findings = jointed_robot(context, name, made, labels, unit)
    return SceneLinks(robot, [*findings, *left_out(failures, len(collections))], unit, members)


def bone_links(context: Context, name: str, objects: list[Object], options: MeasureOptions = AS_SET) -> SceneLinks:
    """Return a robot with a link in rest frame for each bone that has a part; joints have the limits of the bones."""
    made, connections, findings, pieces = [], [], [], {}
    unit = options.meters_per_unit(context.scene)
    armatures = [obj for obj in objects if obj.type == "ARMATURE"]
    for armature in armatures:
        rig = measure_rig(context, armature, options)
        findings += rig.measurement.findings
        several = len(armatures) > 1
        labels = {
            part.name: "{}:{}".format(armature.name, part.name) if several else part.name
            for part in rig.parts
            if part.measurement is not None
        }
        for part in rig.parts:
            if part.measurement is None:
                continue
            bone, label = armature.pose.bones[part.name], labels[part.name]
            parents = bone_parents(bone, labels)
            values, mimic, unusable = joint_values(bone)
            findings += unusable
            free = bone_freedom(bone, values, unit)
            made.append(make_candidate(label, part.measurement))
            if parents:
                connections.append(Connection("{}_joint".format(label), parents[0], label, None, free, mimic))
            pieces[label] = part.surfaces
    if not made:
        raise EditRefusedError(ROBOT_WITHOUT_LINKS)
    robot, left = assemble_robot(name, made, connections)
    return SceneLinks(robot, [*findings, *left], unit, pieces=pieces)


def left_out(failures: list[Finding], total: int) -> list[Finding]:
    """Return a list with one finding about all objects that could not be measured, empty if there are none."""
    if not failures:
        return []
    causes = [failure.as_record() for failure in reports.first(failures)]
    return [finding(LEFT_OUT_OF_ROBOT, count=len(failures), total=total, causes=causes)]


def object_candidate(
    label: str, obj: Object | None, measurement: Measurement, labels: Mapping[Object, str]
) -> Candidate:
    """Return a measured object as a possible link, with the labels of its parents; `obj` is None for instances."""
    if obj is None:
        return make_candidate(label, measurement)
    parents, above = [], obj.parent
    while above is not None:
        parents += [labels[above]] if above in labels else []
        above = above.parent
    return make_candidate(label, measurement, parents, obj.matrix_world.to_scale(), is_fixed=is_passive(obj))


def is_passive(obj: Object) -> bool:
    """Return whether an object is a passive rigid body, which nothing moves."""
    return obj.rigid_body is not None and obj.rigid_body.type == "PASSIVE"


# For each kind of constraint, its free axes: the kind, the index of an axis of the constraint, the sign of the limits.
# Blender counts angles of the first object relative to the second, but a piston's and all lengths of the second
# relative to the first. A generic constraint moves along its axes, then turns about z, y and x.
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
    """Return the constraints of labeled objects as joints, frames of unlabeled passive objects, and findings."""
    connections: list[Connection] = []
    bases: dict[str, Candidate] = {}
    findings: list[Finding] = []
    for holder in scene.objects:
        constraint = holder.rigid_body_constraint
        if constraint is None or not constraint.enabled or constraint.type not in CONSTRAINTS:
            continue
        sides = [constraint.object1, constraint.object2]
        names = ["" if side is None else labels.get(side, "") for side in sides]
        if not any(names):
            continue
        for index, side in enumerate(sides):
            if side is not None and not names[index] and is_passive(side):
                names[index] = name = side.name_full
                bases[name] = Candidate(name, Link(name, pose=_pose(side, unit), is_fixed=True))
        values, mimic, unusable = joint_values(holder)
        findings += unusable
        free = _freedom(constraint, values, unit)
        connections.append(Connection(holder.name_full, names[0], names[1], _pose(holder, unit), free, mimic))
    connections.sort(key=lambda one: one.name)
    return connections, [bases[name] for name in sorted(bases)], findings


def _pose(obj: Object, unit: float) -> Pose:
    """Return an object's location and rotation, m."""
    matrix = float64_matrix(obj.matrix_world)
    turn = polar_rotation(matrix[None])[0][0]
    return Pose(matrix[:3, 3] * unit, turn * np.sign(np.linalg.det(turn)))


def _freedom(constraint: RigidBodyConstraint, values: Mapping[str, float], unit: float) -> tuple[FreeAxis, ...]:
    """Return the free axes of a constraint, with the values of its springs unless `values` states them."""
    free = []
    for kind, index, sign in CONSTRAINTS[constraint.type]:
        turns, axis, lower, upper = kind == "rotate", "xyz"[index], -inf, inf
        name, length = ("ang_" if turns else "lin_") + axis, 1.0 if turns else unit
        if constraint.type != "POINT" and getattr(constraint, "use_limit_" + name):
            lower, upper = (getattr(constraint, "limit_{}_{}".format(name, end)) for end in ("lower", "upper"))
            if lower == upper:
                continue
            # Bullet takes a lower limit above the upper one as none.
            ends = sorted((sign * lower * length, sign * upper * length))
            lower, upper = ends if lower < upper else (-inf, inf)
        spring = {}
        name, torque = ("ang_" if turns else "") + axis, unit**2 if turns else 1.0
        # Springs of the other type have a damping without a unit.
        is_spring = constraint.type == "GENERIC_SPRING" and constraint.spring_type == "SPRING2"
        if is_spring and getattr(constraint, "use_spring_" + name):
            spring["stiffness"] = getattr(constraint, "spring_stiffness_" + name) * torque
            spring["damping"] = getattr(constraint, "spring_damping_" + name) * torque
        free.append(FreeAxis(kind, np.eye(3)[index], lower, upper, {**spring, **values}))
    return tuple(free)


def joint_values(
    owner: Object | PoseBone,
) -> tuple[dict[str, float], Mimic | None, list[Finding]]:
    """Return the values of a joint that are custom properties, its mimic, and findings about unusable properties."""
    values: dict[str, float] = {}
    findings: list[Finding] = []
    for name in (*VALUES, "mimic_multiplier", "mimic_offset"):
        value: Any = owner.get("joint_" + name)
        is_number = isinstance(value, (int, float)) and isfinite(value)
        # A motor without effort or velocity would not move.
        if is_number and (name.startswith("mimic") or value > 0 or value == 0 and name not in ("effort", "velocity")):
            values[name] = float(value)
        elif value is not None:
            findings.append(finding(JOINT_VALUE_UNUSABLE, joint=owner.name, key="joint_" + name, value=str(value)))
    factors = values.pop("mimic_multiplier", 1.0), values.pop("mimic_offset", 0.0)
    leader = owner.get("joint_mimic")
    return values, None if leader is None else Mimic(str(leader), *factors), findings


def link_surface(objects: Iterable[Object], depsgraph: Depsgraph, pose: Pose, unit: float) -> Surface | None:
    """Return the surface of a link's objects as triangles in m, in the link's frame; None without visible faces."""
    pieces, to_link = [], pose.inverse()
    for obj in objects:
        try:
            surface = read_object(obj, depsgraph, edges=False).join()
        except MeasureError:  # such as a grid of densities
            continue
        pieces.append(surface.transform(unit * to_link.rotation, to_link.position))
    return join_surfaces(pieces) if len(pieces) > 1 else pieces[0] if pieces else None


def sheared_objects(objects: Iterable[Object]) -> list[str]:
    """Return the names of objects whose matrix is sheared."""
    located = list(objects)
    if not located:
        return []
    _, sheared = polar_rotation(np.array([float64_matrix(obj.matrix_world) for obj in located]))
    return [obj.name_full for obj, skew in zip(located, sheared) if skew]


def bone_freedom(
    bone: PoseBone, values: Mapping[str, float] = MappingProxyType({}), unit: float = 1.0
) -> tuple[FreeAxis, ...]:
    """Return a bone's unlocked axes of movement and of rotation with limits, in m, by constraints and IK."""
    turns = {
        axis: (getattr(bone, "ik_min_" + axis), getattr(bone, "ik_max_" + axis))
        for axis in "xyz"
        if getattr(bone, "use_ik_limit_" + axis)
    } | _bone_limits(bone, "LIMIT_ROTATION", "use_limit_")
    is_connected = bone.parent is not None and bone.bone.use_connect
    slides = {} if is_connected else _bone_limits(bone, "LIMIT_LOCATION", "use_min_", "use_max_")
    rest = float64_matrix(bone.id_data.matrix_world)[:3, :3] @ float64_matrix(bone.bone.matrix_local)[:3, :3]
    free = []
    for index, axis in enumerate("xyz"):
        lower, upper = slides.get(axis, (0.0, 0.0))
        if lower < upper and not bone.lock_location[index]:
            length = unit * float(np.linalg.norm(rest[:, index]))
            free.append(FreeAxis("translate", np.eye(3)[index], lower * length, upper * length, values))
    for index, axis in reversed([*enumerate("xyz")]):
        lower, upper = turns.get(axis, (-inf, inf))
        if lower < upper and not bone.lock_rotation[index] and not getattr(bone, "lock_ik_" + axis):
            free.append(FreeAxis("rotate", np.eye(3)[index], lower, upper, values))
    return tuple(free)


def _bone_limits(bone: PoseBone, kind: str, *uses: str) -> dict[str, tuple[float, float]]:
    """Return the limits of a bone's constraints of a kind in local space, by axis. uses: switches of both ends."""
    limits = {}
    for constraint in bone.constraints:
        if constraint.type != kind or constraint.owner_space != "LOCAL" or not constraint.enabled:
            continue
        for axis in "xyz":
            used = [getattr(constraint, use + axis) for use in uses]
            if any(used):
                lower = getattr(constraint, "min_" + axis) if used[0] else -inf
                limits[axis] = lower, getattr(constraint, "max_" + axis) if used[-1] else inf
    return limits


def bone_parents(bone: PoseBone, labels: Mapping[str, str]) -> list[str]:
    """Return the labels of a bone's parents, the nearest first; `labels` maps the names of bones that are links."""
    return [labels[above.name] for above in bone.parent_recursive if above.name in labels]


USD_ROOT = "root"  # Blender's exporter puts everything under it


def usd_path(obj: Object, identifier: Callable[[str], str]) -> list[str]:
    """Return the names of the prims from the root to an object's; `identifier` converts names as the exporter does."""
    names, above = [], obj
    while above is not None:
        names.append(identifier(above.name))
        above = above.parent
    return [USD_ROOT, *reversed(names)]
