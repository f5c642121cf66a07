# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bodies in a mesh file, read as a whole and without any object: with the coordinates that Blender would store."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..measurement.settings import Settings
from ..streams.boxes import box_of_blocks
from ..streams.file_mesh import FileMesh
from ..verdict.finding import ReadError
from .findings import NO_GEOMETRY
from .mesh_body import MeshBody
from .polygons import sum_of_instances
from .reading import Part, Reading
from .wall import WallBody, find_walls


def read_mesh(mesh: FileMesh, upright: NDArray[np.float64]) -> Reading:
    """Return the reading of a file's mesh in a place, (4, 4): a rotation.

    FileError if a coordinate is too large, ReadError if there are no faces.
    """
    if not len(mesh.sides):
        raise ReadError(NO_GEOMETRY)
    with np.errstate(over="ignore"):
        points = mesh.points.astype(np.float32)
    box_of_blocks([points], "vertex")
    part = Part(replace(mesh, points=points).surface(), upright[None])
    return Reading(mesh.name, "MESH", upright, upright[:3, :3], np.zeros(3), [part])


def body_of_mesh(reading: Reading, settings: Settings) -> MeshBody | WallBody:
    """Return the solid or sheet that the faces bound, with walls as set, or raise MeasureError."""
    is_shell = settings.kind == "shell"
    body = sum_of_instances(reading, settings.unit, is_shell, settings.threads)
    if is_shell and settings.wall != "thin":
        return find_walls(reading, body, settings.wall).body(settings.thickness)
    return body
