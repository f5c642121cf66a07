# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of robots by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from types import ModuleType

from ...mesh.surface import Surface
from ...verdict.finding import Finding
from ...verdict.sentences import sentence
from ..findings import MJCF_INERTIA_TOO_SMALL, USD_INERTIA_TOO_SMALL
from ..model import Robot
from . import gltf_robot, mjcf, sdf, urdf, usd
from .shapes import with_meshes
from .stl import write_meshes

WRITERS: dict[str, ModuleType] = {"urdf": urdf, "sdf": sdf, "mjcf": mjcf, "usd": usd, "gltf": gltf_robot}
OF_INERTIALS = {MJCF_INERTIA_TOO_SMALL, USD_INERTIA_TOO_SMALL}  # all else is said of geometry and joints
EMBEDDING = ("usd", "gltf")  # These formats hold meshes themselves; the others name files of them.


def with_geometry(
    robot: Robot,
    format_name: str,
    surface_of: Callable[[str], Surface | None],
    output: Path,
    read: Path | None = None,
    force: bool = False,
) -> tuple[Robot, list[Finding]]:
    """Return a robot with its meshes, as files if the format names such, and a finding about links without any.

    surface_of: as of `with_meshes`. output, read, force: as of `write_meshes`. Raises OSError.
    """
    robot, findings = with_meshes(robot, surface_of)
    return robot if format_name in EMBEDDING else write_meshes(robot, output, read, force), findings


def robot_text(
    robot: Robot,
    format_name: str,
    findings: Iterable[Finding] = (),
    *,
    inertial_only: bool = False,
) -> tuple[str, list[Finding]]:
    """Return a robot in one of the formats, and findings about it, which stand in the text as well.

    findings: about the robot, whatever the format. inertial_only: without geometry and joints.
    """
    writer = WRITERS[format_name]
    said = [one for one in writer.check(robot) if one.code in OF_INERTIALS or not inertial_only]
    findings = [*findings, *said]
    text = writer.write(robot, list(map(sentence, findings)), inertial_only=inertial_only)
    return text, findings
