# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of robots by name."""

from __future__ import annotations

from collections.abc import Iterable
from types import ModuleType

from ....core.robots.model import Robot
from ....core.verdict.finding import Finding
from ..messages import sentence
from . import mjcf, sdf, urdf, usd

WRITERS: dict[str, ModuleType] = {"urdf": urdf, "sdf": sdf, "mjcf": mjcf, "usd": usd}


def robot_text(
    robot: Robot, format_name: str, findings: Iterable[Finding] = (), *, inertial_only: bool = False
) -> tuple[str, list[Finding]]:
    """Return a robot in one of the formats, and what is to be said about it, which stands in the text as well.

    findings: about the robot, whatever the format. inertial_only: without geometry and joints.
    """
    writer = WRITERS[format_name]
    findings = [*findings, *writer.check(robot)]
    return writer.write(robot, list(map(sentence, findings)), inertial_only=inertial_only), findings
