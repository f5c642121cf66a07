# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--format urdf, sdf, mjcf, usd and gltf: the measured objects of a file as a robot, whose text its
document holds.

The process that measures makes the text, because that needs numpy; the process that gathers
documents only copies it.
"""

from argparse import Namespace
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import bpy

from ...blender.session.robots import (
    SceneLinks,
    bone_links,
    collection_links,
    jointed_robot,
    object_candidate,
)
from ...blender.settings.options import MeasureOptions
from ...blender.write.findings import FILE_NOT_WRITTEN
from ...core.measurement import Measurement, print_message
from ...core.robots import (
    FORMATS,
    Robot,
    merge_fixed,
    robot_name,
    robot_text,
    with_geometry,
    with_primitives,
    without_collision,
)
from ...core.verdict import MeasureError, Severity, finding, sentence, severity, system_reason
from ..files.output import is_stream
from .entries import failure

MeasuredObject = tuple[str, bpy.types.Object | None, Measurement]


def complete(
    document: dict[str, Any],
    measured: Sequence[MeasuredObject],
    options: Namespace,
    measure_options: MeasureOptions,
    *,
    is_opened: bool,
) -> dict[str, Any]:
    """Return a document with the text of its links as `robot`, without it if there is no link, or
    unchanged if no format of robots is requested.

    Writes the meshes, and prints the format's findings. measure_options: the options of the
    measurements. is_opened: whether the file is the open scene, with its collections and bones.
    """
    if options.format not in FORMATS:
        return document
    if options.links == "object" or not is_opened:
        scene_links = _by_object(document, measured, measure_options)
    else:
        scene_links = _of_scene(document, measured, options.links, measure_options)
    scene_links = (
        replace(scene_links, robot=scene_links.robot.with_fixed_roots())
        if options.fixed_base
        else scene_links
    )
    robot = with_primitives(scene_links.robot, "none")
    geometry_findings = []
    failed = []
    if not (options.no_meshes or options.inertial_only or is_stream(options.output)):
        surface_of = partial(scene_links.surface, bpy.context)
        source = Path(document["file"]) if document["file"] else None
        try:
            robot_with_colliders = (
                without_collision(scene_links.robot)
                if options.collision == "none"
                else scene_links.with_colliders().robot
            )
            robot, geometry_findings = with_geometry(
                robot_with_colliders,
                options.format,
                surface_of,
                options.output,
                source,
                options.force,
                options.mesh_format,
            )
        except OSError as error:
            failed = [
                finding(
                    FILE_NOT_WRITTEN, file=error.filename or "meshes", error=system_reason(error)
                )
            ]
    robot = merge_fixed(robot) if options.merge_fixed else robot
    text, findings = robot_text(
        robot,
        options.format,
        [*scene_links.findings, *geometry_findings],
        inertial_only=options.inertial_only,
    )
    findings += failed
    for problem in findings:
        print_message(sentence(problem))
    refused = [
        failure(None, problem) for problem in findings if severity(problem) == Severity.ERROR
    ]
    written = {"robot": text} if robot.links else {}
    return document | written | {"errors": [*document["errors"], *refused]}


def _by_object(
    document: dict[str, Any], measured: Sequence[MeasuredObject], measure_options: MeasureOptions
) -> SceneLinks:
    """Return the measured objects as links."""
    labels = {obj: label for label, obj, _ in measured if obj is not None}
    candidates = [
        object_candidate(label, obj, measurement, labels) for label, obj, measurement in measured
    ]
    candidates.sort(key=lambda candidate: candidate.name)
    unit = measure_options.meters_per_unit(bpy.context.scene)
    robot, findings = jointed_robot(
        bpy.context, robot_name(document["file"]), candidates, labels, unit
    )
    return SceneLinks(robot, findings, unit, {label: [obj] for obj, label in labels.items()})


def _of_scene(
    document: dict[str, Any],
    measured: Sequence[MeasuredObject],
    links: str,
    measure_options: MeasureOptions,
) -> SceneLinks:
    """Return the scene's collections or bones as links; if they are refused, no links and the
    finding.
    """
    name = robot_name(document["file"])
    context = bpy.context
    link_options = replace(measure_options, order=None)
    try:
        if links == "bone":
            objects = [obj for obj in context.view_layer.objects if not obj.hide_render]
            return bone_links(context, name, objects, link_options)
        objects = [obj for _, obj, _ in measured if obj is not None]
        return collection_links(context, name, context.scene.collection, objects, link_options)
    except MeasureError as error:
        return SceneLinks(
            Robot(name, ()), [error.finding], measure_options.meters_per_unit(context.scene)
        )
