# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as a robot: which objects are measured, and what of them becomes a link."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
from bpy.types import Collection, Context, Object

from ....core.measurement import Measurement
from ....core.robots.model import Robot
from ....core.verdict.finding import EditRefusedError, Finding, MeasureError, finding
from ...bodies.assembly import measure_assembly
from ...bodies.many import measured_in_turn
from ...read import measurable
from ...read.links import link_entry
from ...write import record, reports
from ...write.robots.from_records import robot_of_records
from .. import selection


@dataclass
class MeasuredScene:
    """Objects that were measured, and why others were not.

    measured: by object. failures: one for each object that could not be measured.
    """

    measured: dict[Object, Measurement] = field(default_factory=dict)
    failures: list[Finding] = field(default_factory=list)


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
    scene = MeasuredScene()

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
    context: Context, name: str, root: Collection, objects: list[Object]
) -> tuple[Robot, list[Finding], dict[str, list[Object]]]:
    """Return a robot with a link for each collection in one, or for the collection itself where there is none in it.
    They are assemblies, along the world's axes, with all that they hold.

    Parameters
    ----------
    context : Context
    name : str
    root : Collection
    objects : list of Object
        What counts of what they hold is their own decision; what their meshes show is of these.

    Returns
    -------
    Robot
    list of Finding
        Why other collections are no links.
    dict of str to list of Object
        The objects of each link.
    """
    depsgraph = context.evaluated_depsgraph_get()
    records, findings, members = [], [], {}
    for collection in list(root.children) or [root]:
        label = collection.name_full
        try:
            measurement = measure_assembly(collection, depsgraph).measurement
        except MeasureError as error:
            findings.append(reports.failure(label, error.finding))
            continue
        held = {*collection.all_objects}
        members[label] = [obj for obj in objects if obj in held]
        place = {"position": [0.0, 0.0, 0.0], "rotation": [1.0, 0.0, 0.0, 0.0], "scale": [1.0, 1.0, 1.0], "parents": []}
        records.append({**record.record(measurement, "world"), "name": label, "link": place})
    robot, left_out = robot_of_records(name, records)
    return robot, [*findings, *left_out], members


def left_out(failures: list[Finding], total: int) -> list[Finding]:
    """What a report says of objects that could not be measured."""
    if not failures:
        return []
    causes = [failure.as_record() for failure in reports.first(failures)]
    return [finding("left_out_of_robot", count=len(failures), total=total, causes=causes)]
