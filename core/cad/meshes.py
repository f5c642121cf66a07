# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of the meshes of a file, chosen by its suffix, with the names and places that Blender's importers give."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..scans.findings import FILE_MISSING, FILE_NOT_REGULAR, FILE_TYPE
from ..streams.boxes import box_of_blocks
from ..streams.file_mesh import FileMesh
from ..streams.mesh_file import KINDS
from ..verdict.finding import FileError
from .obj import UPRIGHT
from .obj_mesh import read_obj_meshes

SUFFIXES = (*KINDS, ".obj")


def read_meshes(path: str | Path) -> tuple[list[FileMesh], NDArray[np.float64]]:
    """Return the meshes of an .stl, .ply or .obj file, in its unit, and (4, 4) the map to z up.

    Of the formats, only .obj can hold several meshes, and has y up. Raise FileError or OSError.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise FileError(FILE_TYPE, suffixes=" ".join(SUFFIXES))
    if not path.is_file():
        raise FileError(FILE_NOT_REGULAR if path.exists() else FILE_MISSING)
    if suffix == ".obj":
        meshes, upright = read_obj_meshes(path), UPRIGHT
    else:
        meshes, upright = [KINDS[suffix](path).mesh()], np.eye(4)
    for mesh in meshes:
        box_of_blocks([mesh.points], "vertex")
    return meshes, upright
