# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of a mesh in a file, in blocks."""

from __future__ import annotations

from pathlib import Path

from ..scans.findings import FILE_TYPE
from ..verdict.finding import FileError
from .ply import PlyFile
from .stl import StlFile

# A mesh whose faces can be read in blocks, any number of times.
MeshFile = PlyFile | StlFile
KINDS = {".stl": StlFile, ".ply": PlyFile}


def open_mesh_file(path: str | Path) -> MeshFile:
    """Open an .stl or .ply file, to read it in blocks, but a .ply's vertices at once. Raises FileError and OSError."""
    path = Path(path)
    kind = KINDS.get(path.suffix.lower())
    if kind is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(KINDS))
    return kind(path)
