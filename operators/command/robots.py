# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--format urdf, sdf, mjcf and usd: the records of a file as links, and their text as a part of its document.

The process that measures makes the text, for that needs numpy; the one that gathers documents only passes it on.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from typing import Any

import bpy

from ...core.measurement import Measurement
from ...core.mesh.surface import Surface
from ...core.numerics.float32 import shortest_decimal
from ...core.robots.model import Robot
from ...core.verdict.finding import Finding, finding
from ..read.links import link_surface, object_entry
from ..write.documents import ROBOT_FORMATS
from ..write.messages import sentence
from ..write.robots.formats import robot_text
from ..write.robots.from_records import robot_of_document
from ..write.robots.stl import write_meshes
from ..write.terminal import tell


def complete(
    document: dict[str, Any],
    measured: Sequence[tuple[str, bpy.types.Object | None, Measurement]],
    options: Namespace,
) -> dict[str, Any]:
    """Return a document with its records as links and the entry `robot`, where such a format is asked for; what the
    format cannot say goes to the standard error."""
    if options.format not in ROBOT_FORMATS:
        return document
    labels = {obj: label for label, obj, _ in measured if obj is not None}
    links = {label: object_entry(obj, one, labels) for label, obj, one in measured if obj is not None}
    for entry in document["objects"]:
        if entry["name"] in links:
            entry["link"] = links[entry["name"]]
    robot, findings = robot_of_document(document)
    text, findings = robot_text(robot, options.format, findings, inertial_only=options.inertial_only)
    if options.meshes:
        findings.append(_write_meshes(robot, measured, options))
    for one in findings:
        tell(sentence(one))
    return {**document, "robot": text}


def _write_meshes(
    robot: Robot, measured: Sequence[tuple[str, bpy.types.Object | None, Measurement]], options: Namespace
) -> Finding:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    unit = options.unit_scale or shortest_decimal(depsgraph.scene.unit_settings.scale_length)
    sources = {label: obj for label, obj, _ in measured if obj is not None}

    def surface(name: str) -> Surface | None:
        return link_surface([sources[name]], depsgraph, robot.link(name).pose, unit)

    try:
        return write_meshes(robot, surface, options.output.parent)
    except OSError as error:
        return finding("robot_meshes_not_written", error=error.strerror or str(error))
