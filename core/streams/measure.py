# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The moments of a mesh that is read in blocks, and whether it closes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh.boundary import BoundarySum
from ..mesh.surface import Surface
from ..moments.moments import Moments
from ..polyhedron.integration import polyhedron_moments
from ..polyhedron.third_order import box_center
from ..verdict.finding import FileError
from .findings import FILE_WITHOUT_OBJECTS
from .mesh_file import MeshFile

MAX_REACH_RATIO = 2.0  # reach of a body relative to its first faces, at most


@dataclass(frozen=True, eq=False)
class StreamIntegrals:
    """Integrals of a mesh that was read in blocks, as its faces are, about the center of the bounding box.

    closed: True if every edge is used as often one way as the other, by their hashes (`BoundarySum`); the volume of an
    open mesh depends on the center. face_count: triangles and quads that were measured.
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

    Its moments are about the center of the bounding box: of all vertices of a .ply; of another file, of a thousand
    faces all over it, if the mesh does not reach much farther. Then it is read twice. FileError if the file is damaged,
    or coordinates are not finite. progress: called with the count of faces read since the last time.
    """
    for find_box in (mesh.sampled_box, mesh.box):
        stream = _Stream(mesh, *find_box(), progress)
        try:
            volume, area = polyhedron_moments(
                stream.pieces(),
                order,
                area_order=area_order,
                about=stream.center,
                reach=stream.reach,
                allow_open=True,
                threads=threads,
            )
        except _FarPiece:
            continue
        if not stream.face_count:
            raise FileError(FILE_WITHOUT_OBJECTS, content="faces")
        return StreamIntegrals(volume, area, stream.boundary.is_zero, stream.face_count)
    raise AssertionError("piece outside its box")


class _FarPiece(Exception):
    """A piece is much farther from the center than was thought."""


class _Stream:
    """The faces of a file on their way to the integral. progress: called with the faces of each piece."""

    def __init__(self, mesh: MeshFile, low: NDArray, high: NDArray, progress: Callable[[int], None] | None) -> None:
        large = max(np.abs(low).max(), np.abs(high).max()) > np.finfo(np.float32).max
        self.center = box_center(low, high, np.dtype(np.float64 if large else np.float32))
        self.reach = float(np.maximum(high - self.center, self.center - low).max())
        self.boundary, self.face_count = BoundarySum(), 0
        self._mesh, self._progress = mesh, progress

    def pieces(self) -> Iterator[Surface]:
        """Yield the pieces."""
        for piece in self._mesh.pieces():
            faces = len(piece.triangles) + len(piece.quads)
            if self._progress is not None:
                self._progress(faces)
            low, high = piece.box
            reach = np.maximum(high - self.center, self.center - low).max()
            if not reach <= MAX_REACH_RATIO * self.reach:  # nor where it is NaN: the box of all refuses that
                raise _FarPiece
            self.boundary.add(piece.points.reshape(-1, 3, 3) if self._mesh.is_loose else piece)
            self.face_count += faces
            yield piece
