# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as a robot: the choice of objects, the links made from them, their parents and their
joints.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import bpy
import numpy as np
from bpy.types import Collection, Context, Depsgraph, Object

from ...core import bodies, mesh, numerics, robots, verdict
from ...core.measurement import Measurement
from ...core.robots.write.shapes import with_colliders
from .. import read, scene, settings, write
from ..bodies import measure_object, overlaps
from ..bodies.assembly.measure import measure_assembly
from ..bodies.rig import measure_rig
from .findings import LEFT_OUT_OF_ROBOT


@dataclass(frozen=True)
class SceneLinks:
    """A robot made from the scene, with findings about its links and omitted objects. unit: meters
    per Blender unit.

    members: the objects of each link. pieces: the surfaces of each bone's link, with maps into the
    world in meters.
    """

    robot: robots.Robot
    findings: list[verdict.Finding]
    unit: float
    members: dict[str, list[Object]] = field(default_factory=dict)
    pieces: dict[str, tuple[tuple[mesh.Surface, numerics.Array], ...]] = field(default_factory=dict)

    def with_colliders(self) -> SceneLinks:
        """Return the links with the colliders of their objects in place of their geometry as
        collision shapes.
        """
        by_body = scene.colliders.colliders_by_body(bpy.data.objects)

        def colliders_of(link: robots.Link) -> list[robots.Shape]:
            placed: list[robots.Shape] = []
            for obj in self.members.get(link.name, ()):
                location, turn, _scale = obj.matrix_world.decompose()
                frame = robots.Pose(
                    np.array(location, np.float64) * self.unit, numerics.rotation_matrix(turn)
                )
                shapes = scene.colliders.read_colliders(
                    by_body.get(obj, ()), frame.rotation, self.unit
                )
                is_own = (
                    np.array_equal(frame.rotation, link.pose.rotation)
                    and len(self.members[link.name]) == 1
                )
                # The product of two equal frames would only add rounding.
                to_link = robots.Pose() if is_own else link.pose.inverse() @ frame
                placed += [replace(shape, pose=to_link @ shape.pose) for shape in shapes]
            return placed

        return replace(self, robot=with_colliders(self.robot, colliders_of))

    def surface(self, context: Context, label: str) -> mesh.Surface | None:
        """Return a link's surface, in meters along the link's axes; None if the link shows no
        faces.
        """
        pose = self.robot.link(label).pose
        if label not in self.pieces:
            return link_surface(
                self.members.get(label, ()), context.evaluated_depsgraph_get(), pose, self.unit
            )
        to_link = pose.inverse()
        return mesh.join_surfaces(
            [
                surface.transform(
                    to_link.rotation @ matrix[:3, :3],
                    to_link.rotation @ matrix[:3, 3] + to_link.position,
                )
                for surface, matrix in self.pieces[label]
            ]
        )


def candidates(context: Context, collection: str, selected: bool) -> list[Object]:
    """Return the objects of the named collection, else the selected ones if `selected`, else all
    rendered ones of the view layer; no colliders.
    """
    objects = [obj for obj in context.view_layer.objects if not obj.hide_render]
    if collection:
        objects = bpy.data.collections[collection].all_objects
    elif selected:
        objects = context.view_layer.objects.selected
    return [obj for obj in objects if settings.given.COLLIDER not in obj]


def jointed_robot(
    context: Context,
    name: str,
    link_candidates: Sequence[robots.Candidate],
    labels: Mapping[Object, str],
    unit: float,
) -> tuple[robots.Robot, list[verdict.Finding]]:
    """Return a robot of candidates with the joints of the scene's rigid-body constraints, and
    findings. labels: the names of the links, by their objects. unit: meters per Blender unit.
    """
    connections, bases, findings = read.joints.constraint_connections(context.scene, labels, unit)
    robot, robot_findings = robots.assemble_robot(name, [*link_candidates, *bases], connections)
    caveats = overlaps.shared_space_caveats(
        sorted(labels, key=lambda obj: obj.name), context.evaluated_depsgraph_get()
    )
    return robot, [*findings, *robot_findings, *caveats]


def object_links(
    context: Context,
    name: str,
    objects: list[Object],
    step: Callable[[float], None] = lambda finished: None,
) -> SceneLinks:
    """Return a robot with a link for each measurable object; a finding counts those that could not
    be measured. step: called with the number of finished objects.
    """
    depsgraph = context.evaluated_depsgraph_get()
    measurable = [obj for obj in objects if read.visibility.measurable(obj)]
    measured: dict[Object, Measurement] = {}
    in_turn = measure_object.measured_in_turn(measurable, depsgraph)
    failures = []
    for finished, obj in enumerate(measurable, 1):
        try:
            measured[obj] = in_turn(obj).measurement
        except Exception as error:
            failures.append(write.reports.failure(obj.name_full, error))
        step(finished)
    if not measured:
        raise verdict.EditRefusedError(
            failures[0] if failures else verdict.finding(robots.ROBOT_WITHOUT_LINKS)
        )
    labels = {obj: obj.name_full for obj in measured}
    link_candidates = [
        object_candidate(labels[obj], obj, measurement, labels)
        for obj, measurement in measured.items()
    ]
    unit = settings.options.AS_SET.meters_per_unit(context.scene)
    robot, findings = jointed_robot(context, name, link_candidates, labels, unit)
    return SceneLinks(
        robot,
        [*findings, *left_out(failures, len(measurable))],
        unit,
        {label: [obj] for obj, label in labels.items()},
    )


def collection_links(
    context: Context,
    name: str,
    root: Collection,
    objects: list[Object],
    options: settings.options.MeasureOptions = settings.options.AS_SET,
) -> SceneLinks:
    """Return a robot with a link along the world's axes for each child collection of `root`, or for
    `root` if it has none. objects: the candidates for the members of the links.
    """
    depsgraph = context.evaluated_depsgraph_get()
    link_candidates = []
    failures = []
    members = {}
    labels = {}
    collections = list(root.children) or [root]
    for collection in collections:
        label = collection.name_full
        try:
            measurement = measure_assembly(collection, depsgraph, options).measurement
        except verdict.MeasureError as error:
            failures.append(write.reports.failure(label, error.finding))
            continue
        members_of_link = {*collection.all_objects}
        labels.update(dict.fromkeys(members_of_link, label))
        members[label] = [
            obj for obj in objects if obj in members_of_link and read.visibility.measurable(obj)
        ]
        link_candidates.append(
            robots.make_candidate(
                label, measurement, is_fixed=any(map(read.joints.is_passive, members_of_link))
            )
        )
    if not link_candidates:
        raise verdict.EditRefusedError(failures[0])
    unit = options.meters_per_unit(context.scene)
    robot, findings = jointed_robot(context, name, link_candidates, labels, unit)
    return SceneLinks(robot, [*findings, *left_out(failures, len(collections))], unit, members)


def bone_links(
    context: Context,
    name: str,
    objects: list[Object],
    options: settings.options.MeasureOptions = settings.options.AS_SET,
) -> SceneLinks:
    """Return a robot with a link in its rest frame for each bone that has a part, of all armatures
    among the objects; joints have the limits of the bones.
    """
    link_candidates = []
    connections = []
    findings = []
    pieces = {}
    unit = options.meters_per_unit(context.scene)
    armatures = [obj for obj in objects if obj.type == "ARMATURE"]
    for armature in armatures:
        rig = measure_rig(context, armature, options)
        findings += rig.measurement.findings
        # Bones of two armatures may have the same name.
        labels = {
            part.name: "{}:{}".format(armature.name, part.name) if len(armatures) > 1 else part.name
            for part in rig.parts
            if part.measurement is not None
        }
        for part in rig.parts:
            if part.measurement is None:
                continue
            bone = armature.pose.bones[part.name]
            label = labels[part.name]
            parents = read.joints.bone_parents(bone, labels)
            values, mimic, unusable = read.joints.joint_values(bone)
            findings += unusable
            free = read.joints.bone_freedom(bone, values, unit)
            link_candidates.append(robots.make_candidate(label, part.measurement))
            if parents:
                connections.append(
                    robots.Connection(
                        "{}_joint".format(label), parents[0], label, None, free, mimic
                    )
                )
            pieces[label] = part.surfaces
    if not link_candidates:
        raise verdict.EditRefusedError(robots.ROBOT_WITHOUT_LINKS)
    robot, robot_findings = robots.assemble_robot(name, link_candidates, connections)
    return SceneLinks(robot, [*findings, *robot_findings], unit, pieces=pieces)


def left_out(failures: list[verdict.Finding], total: int) -> list[verdict.Finding]:
    """Return a list with one finding about all objects that could not be measured, empty if there
    are none.
    """
    if not failures:
        return []
    causes = [failure.as_record() for failure in write.reports.first(failures)]
    return [verdict.finding(LEFT_OUT_OF_ROBOT, count=len(failures), total=total, causes=causes)]


def object_candidate(
    label: str, obj: Object | None, measurement: Measurement, labels: Mapping[Object, str]
) -> robots.Candidate:
    """Return a measured object as a possible link, with the labels of its parents, the nearest
    first; `obj` is None for instances.
    """
    if obj is None:
        return robots.make_candidate(label, measurement)
    parents = []
    above = obj.parent
    while above is not None:
        parents += [labels[above]] if above in labels else []
        above = above.parent
    return robots.make_candidate(
        label,
        measurement,
        parents,
        obj.matrix_world.to_scale(),
        is_fixed=read.joints.is_passive(obj),
    )


def link_surface(
    objects: Iterable[Object], depsgraph: Depsgraph, pose: robots.Pose, unit: float
) -> mesh.Surface | None:
    """Return the surface of a link's objects as triangles in m, in the link's frame; None without
    visible faces.
    """
    pieces = []
    to_link = pose.inverse()
    for obj in objects:
        try:
            surface = read.objects.read_object(obj, depsgraph, edges=False).join()
        except verdict.MeasureError:  # such as a grid of densities
            continue
        pieces.append(surface.transform(unit * to_link.rotation, to_link.position))
    if len(pieces) > 1:
        return mesh.join_surfaces(pieces)
    return pieces[0] if pieces else None


def sheared_objects(objects: Iterable[Object]) -> list[str]:
    """Return the names of objects whose matrix is sheared."""
    located = list(objects)
    if not located:
        return []
    _, sheared = numerics.polar_rotation(
        np.array([bodies.float64_matrix(obj.matrix_world) for obj in located])
    )
    return [obj.name_full for obj, skew in zip(located, sheared) if skew]


USD_ROOT = "root"  # Blender's exporter puts everything under it


def usd_path(obj: Object, identifier: Callable[[str], str]) -> list[str]:
    """Return the names of the prims from the root to an object's; `identifier` converts names as
    the exporter does.
    """
    names = []
    above = obj
    while above is not None:
        names.append(identifier(above.name))
        above = above.parent
    return [USD_ROOT, *reversed(names)]
