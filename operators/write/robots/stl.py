# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of links as binary STL, which all readers of robots know."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ....core.mesh.surface import Surface
from ....core.robots.model import Robot
from ....core.verdict.finding import Finding, finding

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def to_stl(surface: Surface) -> bytes:
    """Return a surface as binary STL, with zero normals, which readers find from the corners.

    Parameters
    ----------
    surface : Surface
        In meters, along the link's axes.

    Returns
    -------
    bytes
    """
    triangles = surface.all_triangles()[0]
    rows = np.zeros(len(triangles), _TRIANGLE)
    rows["corners"] = surface.points[triangles]
    return b"Body Moments".ljust(80, b"\0") + np.uint32(len(rows)).astype("<u4").tobytes() + rows.tobytes()


def write_meshes(robot: Robot, surface_of: Callable[[str], Surface | None], folder: Path) -> Finding:
    """Write each mesh that a robot's links name, and return what was written. Raises OSError.

    Parameters
    ----------
    robot : Robot
    surface_of : callable
        Returns a link's surface by its name, None where it has none.
    folder : Path
        Where the robot's own file is.

    Returns
    -------
    Finding
    """
    written = 0
    for link in robot.links:
        for shape in link.shapes:
            surface = surface_of(link.name) if shape.kind == "mesh" else None
            if surface is not None:
                path = folder / shape.file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(to_stl(surface))
                written += 1
    return finding("robot_meshes_written", count=written, folder=str(folder))
