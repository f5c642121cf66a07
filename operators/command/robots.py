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
from ..read.links import link_entry
from ..write.documents import ROBOT_FORMATS
from ..write.messages import sentence
from ..write.robots.formats import robot_text
from ..write.robots.from_records import robot_of_document
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
    links = {label: link_entry(obj, one, labels) for label, obj, one in measured if obj is not None}
    for entry in document["objects"]:
        if entry["name"] in links:
            entry["link"] = links[entry["name"]]
    robot, found = robot_of_document(document)
    text, findings = robot_text(robot, options.format, found, inertial_only=options.inertial_only)
    for one in findings:
        tell(sentence(one))
    return {**document, "robot": text}
