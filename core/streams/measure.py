# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The moments of a mesh that is read in blocks, and whether it closes."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..files import FILE_TYPE, FILE_WITHOUT_OBJECTS
from ..mesh import BoundarySum, Surface
from ..moments import Moments
from ..polyhedron import box_center, polyhedron_moments
from ..verdict import FileError
from .ply import PlyFile
from .stl import StlFile

# Largest reach of a body, relative to the box of its sampled faces. Chosen: up to it, the center is
# still in or near the body, and `polyhedron_moments` needs only a rough reach.
MAX_REACH_RATIO = 2.0
# A mesh whose faces can be read in blocks, any number of times.
MeshFile = PlyFile | StlFile
KINDS = {".stl": StlFile, ".ply": PlyFile}


@dataclass(frozen=True, eq=False)
class StreamIntegrals:
    """Integrals of a mesh that was read in blocks, without repair, about the center of a bounding
    box.

    closed: True if every edge is used equally often both ways, by their hashes (`BoundarySum`); the
    volume of an open mesh depends on the center. face_count: triangles and quads that were
    measured.
    """

    volume: Moments
    area: Moments
    closed: bool
    face_count: int


def measure_stream(
    mesh: MeshFile,
    order: int = 3,
    area_order: int = 0,
    threads: int = 1,
    progress: Callable[[int], None] | None = None,
) -> StreamIntegrals:
    """Measure a mesh that is larger than memory, to orders of the volume's and the area's moments.

    The moments are about the center of the bounding box of all vertices of a .ply, or of a sample
    of the triangles of an .stl; a mesh that reaches much farther than the sample is read again with
    the box of all. FileError if the file is damaged, or not finite. progress: called with the count
    of faces read since the last time.
    """
    orders = order, area_order
    integrals = _measure_about(mesh, *mesh.sampled_box(), *orders, threads, progress)
    if integrals is None:
        integrals = _measure_about(mesh, *mesh.box(), *orders, threads, progress)
    assert integrals is not None  # No piece reaches beyond the box of all.
    return integrals


class _FarPiece(Exception):
    """The error of a piece that reaches much farther from the center than the sampled box."""


def _measure_about(
    mesh: MeshFile,
    low: NDArray,
    high: NDArray,
    order: int,
    area_order: int,
    threads: int,
    progress: Callable[[int], None] | None,
) -> StreamIntegrals | None:
    """Measure a mesh about the center of a box, (3,) `low` to (3,) `high`; None if a piece reaches
    more than MAX_REACH_RATIO times as far.
    """
    # `box_center` rounds to float32, if it can, so that subtracting the center is exact.
    is_large = max(np.abs(low).max(), np.abs(high).max()) > np.finfo(np.float32).max
    center = box_center(low, high, np.dtype(np.float64 if is_large else np.float32))
    reach = float(np.maximum(high - center, center - low).max())
    boundary = BoundarySum()
    face_counts = []

    def pieces() -> Iterator[Surface]:
        """Yield the pieces, and add up their boundary and their faces on the way."""
        for piece in mesh.pieces():
            face_counts.append(len(piece.triangles) + len(piece.quads))
            if progress is not None:
                progress(face_counts[-1])
            least, largest = piece.box
            # "Not less", so that NaN raises it too; the box of all pieces refuses NaN.
            if not np.maximum(largest - center, center - least).max() <= MAX_REACH_RATIO * reach:
                raise _FarPiece
            boundary.add(piece.points.reshape(-1, 3, 3) if mesh.is_loose else piece)
            yield piece

    try:
        volume, area = polyhedron_moments(
            pieces(),
            order,
            area_order=area_order,
            about=center,
            reach=reach,
            allow_open=True,
            threads=threads,
        )
    except _FarPiece:
        return None
    if not face_counts:
        raise FileError(FILE_WITHOUT_OBJECTS, content="faces")
    return StreamIntegrals(volume, area, boundary.is_zero, sum(face_counts))


def open_mesh_file(path: str | Path) -> MeshFile:
    """Open an .stl or .ply file, to read it in blocks, but a .ply's vertices at once.

    Raises FileError and OSError.
    """
    path = Path(path)
    kind = KINDS.get(path.suffix.lower())
    if kind is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(KINDS))
    return kind(path)
