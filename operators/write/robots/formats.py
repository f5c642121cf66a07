# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The formats of robots by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import ModuleType

from ....core.mesh.surface import Surface
from ....core.robots.model import Robot
from ....core.verdict.finding import Finding
from ..messages import sentence
from . import gltf_robot, mjcf, sdf, urdf, usd

WRITERS: dict[str, ModuleType] = {"urdf": urdf, "sdf": sdf, "mjcf": mjcf, "usd": usd, "gltf": gltf_robot}
OF_INERTIALS = {"mjcf_inertia_too_small", "usd_inertia_too_small"}  # all else is said of geometry and joints
EMBEDDING = ("usd", "gltf")  # what holds meshes itself; the others name files of them


def robot_text(
    robot: Robot,
    format_name: str,
    findings: Iterable[Finding] = (),
    *,
    inertial_only: bool = False,
    surface_of: Callable[[str], Surface | None] | None = None,
) -> tuple[str, list[Finding]]:
    """Return a robot in one of the formats, and what is to be said about it, which stands in the text as well.

    findings: about the robot, whatever the format. inertial_only: without geometry and joints. surface_of: a link's
    surface by its name, for formats that hold meshes themselves; without it they have none.
    """
    writer = WRITERS[format_name]
    said = [one for one in writer.check(robot) if one.code in OF_INERTIALS or not inertial_only]
    findings = [*findings, *said]
    options = {"surface_of": surface_of} if format_name in EMBEDDING else {}
    text = writer.write(robot, list(map(sentence, findings)), inertial_only=inertial_only, **options)
    return text, findings
