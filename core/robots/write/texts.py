# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot as the text of a format, with the findings about it."""

from collections.abc import Callable, Iterable
from pathlib import Path

from ...mesh import Surface
from ...verdict import Finding, finding, sentence
from ..findings import INERTIA_TOO_SMALL, JOINTS_ALL_FIXED
from ..formats import FORMATS
from ..model import Robot
from .shapes import with_meshes
from .stl import write_meshes


def with_geometry(
    robot: Robot,
    format_name: str,
    surface_of: Callable[[str], Surface | None],
    output: Path,
    read: Path | None = None,
    force: bool = False,
    mesh_format: str = "stl",
) -> tuple[Robot, list[Finding]]:
    """Return a robot with meshes, written to files unless the format embeds them, and a finding
    about bare links. surface_of: as of `with_meshes`. The others: as of `write_meshes`.
    """
    robot, findings = with_meshes(robot, surface_of)
    return robot if FORMATS[format_name].holds_meshes else write_meshes(
        robot, output, read, force, mesh_format
    ), findings


def robot_text(
    robot: Robot, format_name: str, findings: Iterable[Finding] = (), *, inertial_only: bool = False
) -> tuple[str, list[Finding]]:
    """Return a robot in a format, with all findings as remarks, and these findings. inertial_only:
    only inertials.
    """
    findings = [*findings, *check(robot, format_name, inertial_only=inertial_only)]
    writer = FORMATS[format_name].writer_module
    return writer.write(robot, list(map(sentence, findings)), inertial_only=inertial_only), findings


def check(robot: Robot, format_name: str, *, inertial_only: bool = False) -> list[Finding]:
    """Return findings about a robot in a format."""
    findings = FORMATS[format_name].writer_module.check(robot)
    if inertial_only:
        return [found for found in findings if found.code == INERTIA_TOO_SMALL]
    is_stiff = robot.joints and not any(joint.free for joint in robot.joints)
    return [*([finding(JOINTS_ALL_FIXED)] if is_stiff else []), *findings]
