# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of the surfaces and of the meshes of a file, chosen by its suffix."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..files import DEFAULT_LIMITS, FILE_TYPE, Limits, check_regular
from ..numerics import Array, ArrayLike
from ..nurbs import Face
from ..streams import KINDS, FileMesh, box_of_blocks
from ..verdict import FileError
from .iges import IgesReader
from .obj import UPRIGHT, ObjReader, read_obj_meshes
from .step import StepReader
from .surfaces import SurfaceFile

_READERS = {
    ".igs": IgesReader,
    ".iges": IgesReader,
    ".step": StepReader,
    ".stp": StepReader,
}
SUFFIXES = (*_READERS, ".obj")


def read_surfaces(
    path: str | Path, limits: Limits = DEFAULT_LIMITS, for_blender: bool = True
) -> SurfaceFile:
    """Return the bodies of a STEP, IGES or .obj file of up to `limits.text_bytes`.

    Raise FileError or OSError.

    for_blender: only those surfaces of .obj files that Blender can represent.
    """
    path, suffix = _existing_file(path, SUFFIXES)
    limits.check(path, "text_bytes", path.stat().st_size)
    if suffix == ".obj":
        return ObjReader(path, for_blender).read()
    return _READERS[suffix](path).read()


def read_source(source: bytes, matrix: ArrayLike) -> tuple[tuple[Face, ...], float]:
    """Return the faces of a body's `source` in place, and their rounding. Raise FileError."""
    data = zlib.decompressobj().decompress(source, DEFAULT_LIMITS.text_bytes)
    reader = StepReader if data.lstrip().startswith(b"ISO-10303-21") else IgesReader
    (body,) = reader(Path(), data).read().bodies
    place = np.reshape(matrix, (4, 4))
    scale = float(np.linalg.norm(place[:3, :3], 2))
    return tuple(face.transform(place) for face in body.patches), scale * body.rounding


def read_meshes(path: str | Path) -> tuple[list[FileMesh], Array]:
    """Return the meshes of an .stl, .ply or .obj file, in its unit, and (4, 4) the map to z up.

    Names and places are those of Blender's importers. Of the formats, only .obj can hold several
    meshes, and has y up. Raise FileError or OSError.
    """
    path, suffix = _existing_file(path, (*KINDS, ".obj"))
    if suffix == ".obj":
        meshes = read_obj_meshes(path)
        upright = UPRIGHT
    else:
        meshes = [KINDS[suffix](path).mesh()]
        upright = np.eye(4)
    for mesh in meshes:
        box_of_blocks([mesh.points], "vertex")
    return meshes, upright


def _existing_file(path: str | Path, suffixes: Sequence[str]) -> tuple[Path, str]:
    """Return a path and its suffix in lower case, or raise FileError if it is no file of these
    kinds.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in suffixes:
        raise FileError(FILE_TYPE, suffixes=" ".join(suffixes))
    check_regular(path)
    return path, suffix
