# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of robots by name, and the way from records to their text."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from types import ModuleType
from typing import Any

from ....core.robots.model import Robot
from ....core.verdict.finding import Finding
from ..messages import sentence
from ..terminal import tell
from . import mjcf, sdf, urdf, usd
from .from_records import robot_of_documents

WRITERS: dict[str, ModuleType] = {"urdf": urdf, "sdf": sdf, "mjcf": mjcf, "usd": usd}
SUFFIXES = {"urdf": ".urdf", "sdf": ".sdf", "mjcf": ".xml", "usd": ".usda"}


def robot_text(
    robot: Robot, format_name: str, findings: Iterable[Finding] = (), *, inertial_only: bool = False
) -> tuple[str, list[Finding]]:
    """Return a robot in one of the formats, and what is to be said about it, which stands in the text as well.

    findings: about the robot, whatever the format. inertial_only: without geometry and joints.
    """
    writer = WRITERS[format_name]
    findings = [*findings, *writer.check(robot)]
    return writer.write(robot, list(map(sentence, findings)), inertial_only=inertial_only), findings


def _from_documents(format_name: str, documents: Iterable[dict[str, Any]], inertial_only: bool = False) -> str:
    """The text of the first document; what it cannot say goes to the standard error."""
    robot, found = robot_of_documents(documents)
    text, findings = robot_text(robot, format_name, found, inertial_only=inertial_only)
    for finding in findings:
        tell(sentence(finding))
    return text


FROM_DOCUMENTS: dict[str, Callable[..., str]] = {name: partial(_from_documents, name) for name in WRITERS}
