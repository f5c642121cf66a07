# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as a robot: which objects are measured, and what of them becomes a link."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.types import Collection, Context, Object

from ....core.inertia.mass_properties import combine
from ....core.measurement import Measurement
from ....core.mesh.surface import Surface, join_surfaces
from ....core.numerics.float32 import shortest_decimal
from ....core.robots.model import Inertial, Joint, Link, Robot, Shape
from ....core.verdict.finding import EditRefusedError, Finding, finding
from ...bodies.many import measured_in_turn
from ...read import measurable
from ...read.links import link_entry, link_surface
from ...write import record, reports
from ...write.robots.from_records import mesh_files, robot_of_records
from .. import selection


@dataclass
class MeasuredScene:
    """Objects that were measured, and why others were not.

    measured: by object. failures: one for each object that could not be measured. unit: meters per Blender unit.
    """

    depsgraph: bpy.types.Depsgraph
    unit: float
    measured: dict[Object, Measurement] = field(default_factory=dict)
    failures: list[Finding] = field(default_factory=list)

    def surface(self, obj: Object) -> Surface | None:
        """Return what an object shows, in meters along its own axes."""
        return link_surface(obj, self.depsgraph, self.measured[obj], self.unit)


def objects_to_export(context: Context, collection: str, selected: bool) -> list[Object]:
    """Return the objects that are to be links.

    Parameters
    ----------
    context : Context
    collection : str
        The name of the collection that is exported; "" for none.
    selected : bool
        Only the selected ones; else all that are rendered.

    Returns
    -------
    list of Object

    Raises
    ------
    EditRefusedError
        If there is none.
    """
    chosen: list[Object] = list(context.view_layer.objects)
    if collection:
        chosen = list(bpy.data.collections[collection].all_objects)
    elif selected:
        chosen = list(context.view_layer.objects.selected)
    else:
        chosen = [obj for obj in chosen if not obj.hide_render]
    chosen = [obj for obj in chosen if measurable(obj)]
    if not chosen:
        raise EditRefusedError("robot_without_links")
    return chosen


def measure_scene(context: Context, objects: list[Object]) -> MeasuredScene:
    """Measure objects as their settings say."""
    depsgraph = context.evaluated_depsgraph_get()
    scene = MeasuredScene(depsgraph, shortest_decimal(context.scene.unit_settings.scale_length))

    measured = measured_in_turn(objects, depsgraph)

    def measure(obj: Object) -> bool:
        scene.measured[obj] = measured(obj).measurement
        return True

    _, scene.failures = selection.apply_to_all(objects, measure)
    return scene


def object_links(name: str, scene: MeasuredScene) -> tuple[Robot, list[Finding], dict[str, list[Object]]]:
    """Return a robot with a link for each object, what was left out, and the objects of each link."""
    labels = {obj: obj.name_full for obj in scene.measured}
    records = []
    for obj, measurement in scene.measured.items():
        entry = record.record(measurement, "object")
        records.append({**entry, "name": labels[obj], "link": link_entry(obj, measurement, labels)})
    robot, findings = robot_of_records(name, records)
    return robot, findings, {label: [obj] for obj, label in labels.items()}


def collection_links(
    name: str, scene: MeasuredScene, root: Collection
) -> tuple[Robot, list[Finding], dict[str, list[Object]]]:
    """Return a robot with a link for each collection that holds objects itself, along the world's axes; a collection
    in another one is fixed to it."""
    members: dict[str, list[Object]] = {}
    joints: list[Joint] = []
    claimed: set[Object] = set()

    def visit(collection: Collection, parent: str | None) -> None:
        own = [obj for obj in collection.objects if obj in scene.measured and obj not in claimed]
        claimed.update(own)
        if own and collection.name_full not in members:
            members[collection.name_full] = own
            if parent is not None:
                joints.append(Joint("{}_joint".format(collection.name_full), parent, collection.name_full))
            parent = collection.name_full
        for child in collection.children:
            visit(child, parent)

    visit(root, None)
    files = mesh_files(members)
    links = []
    for label, objects in members.items():
        total = combine([scene.measured[obj].mass_moments for obj in objects])
        inertial = Inertial.with_agreeing_axes(
            total.mass, total.center, total.inertia, total.principal.moments, total.principal.axes
        )
        links.append(Link(label, inertial, shapes=(Shape("mesh", file=files[label]),)))
    return Robot(name, tuple(links), tuple(joints)), [], members


def link_mesh(scene: MeasuredScene, link: Link, objects: list[Object]) -> Surface | None:
    """Return what the objects of a link show, in meters along the link's axes."""
    pieces = []
    for obj in objects:
        surface = scene.surface(obj)
        if surface is not None:
            measurement = scene.measured[obj]
            turn = link.pose.rotation.T @ measurement.rotation
            if len(objects) == 1 and np.allclose(turn, np.eye(3), 0.0, 1e-15):
                return surface
            pieces.append(surface.transform(turn, link.pose.rotation.T @ (measurement.location - link.pose.position)))
    return join_surfaces(pieces) if pieces else None


def left_out(failures: list[Finding], total: int) -> list[Finding]:
    """What a report says of objects that could not be measured."""
    if not failures:
        return []
    causes = [failure.as_record() for failure in reports.first(failures)]
    return [finding("left_out_of_robot", count=len(failures), total=total, causes=causes)]
