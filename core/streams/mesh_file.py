# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of a mesh in a file, in blocks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface
from ..scans.findings import FILE_TYPE
from ..verdict.finding import FileError
from .ply import PlyFile
from .stl import StlFile

KINDS = {".stl": StlFile, ".ply": PlyFile}


@runtime_checkable
class MeshFile(Protocol):
    """A mesh that is read in blocks, as often as it is asked for.

    `face_count`: the number of faces that the file promises; for a text an estimate.
    `is_loose`: True if no two faces share a point: triangle i has the points 3i to 3i + 2.
    """

    face_count: int
    is_loose: bool

    def sampled_box(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return a box of some of the faces."""
        ...

    def box(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the least and the largest coordinates. Raises FileError if some are not finite."""
        ...

    def pieces(self) -> Iterator[Surface]:
        """Yield the faces."""
        ...


def open_mesh_file(path: str | Path) -> MeshFile:
    """Open an .stl or .ply file, text or binary, to be read in blocks.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    MeshFile
        An .stl is read block by block whenever its faces are asked for. Of a .ply the table of vertices is in memory.

    Raises
    ------
    FileError
        If the file is damaged, cut short, or of another kind.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> import struct, tempfile
    >>> from pathlib import Path
    >>> from body_moments.core.streams import open_mesh_file
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "one.stl"
    ...     head, facet = struct.pack("<80xI", 1), struct.pack("<12f2x", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0)
    ...     _ = path.write_bytes(head + facet)
    ...     mesh = open_mesh_file(path)
    ...     mesh.face_count, mesh.box()[1].tolist()
    (1, [1.0, 1.0, 0.0])
    """
    path = Path(path)
    kind = KINDS.get(path.suffix.lower())
    if kind is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(KINDS))
    return kind(path)
