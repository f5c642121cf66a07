# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces in .ply files, in blocks; the table of vertices is in memory."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface, normals
from ..scans.findings import FILE_UNRECOGNIZED
from ..scans.scan import damaged
from ..verdict.finding import FileError
from .boxes import Box, box_of_blocks
from .findings import DAMAGE_INDEX, DAMAGE_PLY_ROWS, FILE_WITHOUT_OBJECTS, PLY_CONCAVE_POLYGONS
from .misread import map_file
from .ply_header import INDICES, MAX_HEADER, Element, Header, parse_header
from .ply_rows import RowReader, RowsError
from .ply_text import check_ply_text

MAX_SPREAD = 4  # Up to so many vertices per corner between a block's first and last, they are not copied.
CONCAVE_RTOL = 1e-6  # Relative to a polygon's normal; triangles less against it are rounding.


class PlyFile:
    """The faces of a .ply file."""

    is_loose = False

    def __init__(self, path: Path) -> None:
        self._path = path
        with open(path, "rb") as file:
            start = file.read(MAX_HEADER)
        try:
            self._header = header = parse_header(start)
            for element in header.elements:
                if element.rows * _least_bytes(element, header.order) > path.stat().st_size:
                    raise damaged(self._path, DAMAGE_PLY_ROWS, name=element.name, count=element.rows)
            self._faces, self._column = _faces_of(header)
            self.face_count = self._faces.rows
            self._points = self._read_points()
        except (ValueError, KeyError, IndexError) as error:
            raise FileError(FILE_UNRECOGNIZED, format="PLY") from error

    def box(self) -> Box:
        """Return the least and the largest coordinates. Raises FileError if some are not finite."""
        return box_of_blocks([self._points], "vertex")

    sampled_box = box

    def pieces(self) -> Iterator[Surface]:
        """Yield surfaces of the faces: triangles, quads, and polygons of more sides as fans."""
        for columns in self._blocks(self._faces):
            corners = columns[self._column]
            if corners.shape[1] < 3:
                continue
            given = corners
            with np.errstate(invalid="ignore"):  # a text may have NaN
                corners = np.ascontiguousarray(corners, np.int32 if corners.dtype == np.int32 else np.int64)
            first, last = int(corners.min()), int(corners.max()) + 1
            whole = given.dtype.kind != "f" or np.array_equal(corners, given)
            if not whole or not 0 <= first < last <= len(self._points):
                raise damaged(self._path, DAMAGE_INDEX, vertices=len(self._points))
            yield self._piece(corners, first, last)

    def _piece(self, corners: NDArray[np.integer], first: int, last: int) -> Surface:
        sides = corners.shape[1]
        if last - first <= MAX_SPREAD * corners.size:
            points, faces = self._points[first:last], corners - first
        else:
            points, faces = self._points[corners.ravel()], np.arange(corners.size).reshape(-1, sides)
        if sides == 3:
            return Surface(points, faces)
        if sides == 4:
            return Surface(points, quads=faces)
        fans = np.stack([faces[:, [0, k, k + 1]] for k in range(1, sides - 1)])
        vectors = normals(points, fans.reshape(-1, 3)).reshape(*fans.shape[:2], 3)
        whole = vectors.sum(axis=0)
        along = np.einsum("kmi,mi->km", vectors, whole)
        concave = int((along < -CONCAVE_RTOL * np.einsum("mi,mi->m", whole, whole)).any(axis=0).sum())
        if concave:
            raise FileError(PLY_CONCAVE_POLYGONS, count=concave)
        return Surface(points, fans.reshape(-1, 3))

    def _read_points(self) -> NDArray[np.floating]:
        """Read (n, 3) points: float32 if the file has them as such or as text, else float64."""
        (vertices, *_) = (element for element in self._header.elements if element.name == "vertex")
        columns = [vertices.index(axis) for axis in "xyz"]
        if not self._header.order:
            check_ply_text(map_file(self._path), self._header)
        kinds = {vertices.properties[column].type for column in columns}
        exact = self._header.order and kinds != {"f4"}
        points = np.empty((vertices.rows, 3), np.float64 if exact else np.float32)
        done = 0
        with np.errstate(over="ignore", invalid="ignore"):  # Such points become infinite, and are refused.
            for block in self._blocks(vertices):
                for axis, column in enumerate(columns):
                    points[done : done + len(block[column]), axis] = block[column]
                done += len(block[columns[0]])
        return points

    def _blocks(self, wanted: Element) -> Iterator[list[NDArray]]:
        """Yield the columns of an element, in blocks."""
        with open(self._path, "rb") as file:
            file.seek(self._header.start)
            reader = RowReader(file, self._header.order)
            for element in self._header.elements:
                try:
                    for block in reader.read_rows(element):
                        if element is wanted:
                            yield block
                except RowsError as error:
                    raise damaged(self._path, DAMAGE_PLY_ROWS, name=element.name, count=element.rows) from error
                if element is wanted:
                    return


def _faces_of(header: Header) -> tuple[Element, int]:
    """Return the element of faces, and the index of the property that lists their vertices. Raises FileError."""
    for element in header.elements:
        for number, one in enumerate(element.properties):
            if element.name == "face" and one.name in INDICES and one.counter:
                return element, number
    raise FileError(FILE_WITHOUT_OBJECTS, content="faces")


def _least_bytes(element: Element, order: str) -> int:
    """Return the least number of bytes of a row in a file."""
    kinds = [one.counter or one.type for one in element.properties]
    return sum(int(kind[1:]) for kind in kinds) if order else 2 * len(kinds) - 1
