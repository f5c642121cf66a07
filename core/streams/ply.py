# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces in .ply files, in blocks; the table of vertices is in memory."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface
from ..scans.findings import FILE_UNRECOGNIZED
from ..scans.scan import damaged
from ..verdict.finding import FileError
from .boxes import Box, box_of_blocks
from .file_mesh import FileMesh, Polygons, name_of_file, polygon_surface, strip_triangles
from .findings import DAMAGE_INDEX, DAMAGE_PLY_ROWS, FILE_WITHOUT_OBJECTS
from .misread import map_file
from .ply_rows import MAX_HEADER, Element, RowReader, RowsError, parse_header
from .ply_text_check import check_ply_text

MAX_SPREAD = 4  # Up to so many vertices per corner between a block's first and last, they are not copied.


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
            (self._vertices, *_) = (element for element in header.elements if element.name == "vertex")
            if not {"x", "y", "z"} <= {one.name for one in self._vertices.properties}:
                self._faces  # noqa: B018 - refused for its missing faces, if it has none
            self._axes = [self._vertices.index(axis) for axis in "xyz"]
        except (ValueError, KeyError, IndexError) as error:
            raise FileError(FILE_UNRECOGNIZED, format="PLY") from error
        if not header.order:
            check_ply_text(map_file(path), header)

    @property
    def face_count(self) -> int:
        """The number of faces that the header promises."""
        return self._faces[0].rows

    @cached_property
    def _faces(self) -> tuple[Element, int]:
        """The element of faces, and the index of the property that lists their vertices. Raises FileError."""
        for element in self._header.elements:
            if element.name == "face" and element.list_of_indices is not None:
                return element, element.list_of_indices
        raise FileError(FILE_WITHOUT_OBJECTS, content="faces")

    @cached_property
    def _points(self) -> NDArray[np.floating]:
        points = self._empty_points()
        for _, rows, columns in self._blocks(self._vertices):
            self._fill_points(points, rows, columns)
        return points

    def box(self) -> Box:
        """Return the least and the largest coordinates. FileError if some are not finite."""
        return box_of_blocks([self._points], "vertex")

    sampled_box = box

    def pieces(self) -> Iterator[Surface]:
        """Yield surfaces of the faces: triangles, quads, and those of larger polygons."""
        faces, column = self._faces
        for _, _, columns in self._blocks(faces):
            if columns[column].shape[1] >= 3:
                yield self._piece(*self._corners(columns[column], len(self._points)))

    def mesh(self) -> FileMesh:
        """Read faces, strips of triangles, edges, and numbers of the vertices, finite or not. Raises FileError."""
        points = self._empty_points()
        names = {one.name for one in self._vertices.properties if not one.counter} - {"x", "y", "z"}
        values = {name: np.empty(len(points), np.float32) for name in names}
        faces = Polygons()
        edges: list[NDArray[np.integer]] = [np.zeros((0, 2), np.int64)]
        for element, rows, columns in self._blocks():
            if element is self._vertices:
                self._fill_points(points, rows, columns)
                with np.errstate(over="ignore", invalid="ignore"):
                    for name in names:
                        values[name][rows] = columns[element.index(name)]
            elif element.list_of_indices is not None:
                corners = columns[element.list_of_indices]
                if element.name == "tristrips":
                    for strip in corners:
                        faces.add(self._corners(strip_triangles(strip), self._vertices.rows)[0])
                elif corners.shape[1] >= 3:
                    faces.add(self._corners(corners, self._vertices.rows)[0], rows)
            elif element.name == "edge" and {"vertex1", "vertex2"} <= {one.name for one in element.properties}:
                ends = np.stack([columns[element.index(name)] for name in ("vertex1", "vertex2")], axis=1)
                edges.append(self._corners(ends, self._vertices.rows)[0])
        return FileMesh(name_of_file(self._path), points, *faces.join(), np.concatenate(edges), values)

    def _corners(self, corners: NDArray, count: int) -> tuple[NDArray[np.integer], int, int]:
        """Return vertex indices as integers, their least, and their largest plus one. FileError if one is wrong."""
        given = corners
        with np.errstate(invalid="ignore"):  # a text may have NaN
            corners = np.ascontiguousarray(corners, np.int32 if corners.dtype == np.int32 else np.int64)
        first, last = (int(corners.min()), int(corners.max()) + 1) if corners.size else (0, 1)
        whole = given.dtype.kind != "f" or np.array_equal(corners, given)
        if corners.size and not (whole and 0 <= first < last <= count):
            raise damaged(self._path, DAMAGE_INDEX, vertices=count)
        return corners, first, last

    def _piece(self, corners: NDArray[np.integer], first: int, last: int) -> Surface:
        if last - first <= MAX_SPREAD * corners.size:
            return polygon_surface(self._points[first:last], corners - first)
        return polygon_surface(self._points[corners.ravel()], np.arange(corners.size).reshape(corners.shape))

    def _empty_points(self) -> NDArray[np.floating]:
        """Return (n, 3) points to be filled: float32 if the file has them as such or as text, else float64."""
        is_exact = self._header.order and {self._vertices.properties[axis].type for axis in self._axes} != {"f4"}
        return np.empty((self._vertices.rows, 3), np.float64 if is_exact else np.float32)

    def _fill_points(self, points: NDArray[np.floating], rows: NDArray[np.intp], columns: list[NDArray]) -> None:
        with np.errstate(over="ignore", invalid="ignore"):  # Such points become infinite, and are refused.
            for axis, column in enumerate(self._axes):
                points[rows, axis] = columns[column]

    def _blocks(self, wanted: Element | None = None) -> Iterator[tuple[Element, NDArray[np.intp], list[NDArray]]]:
        """Yield element, numbers of rows, and columns of the blocks of one element, or of all."""
        with open(self._path, "rb") as file:
            file.seek(self._header.start)
            reader = RowReader(file, self._header.order)
            for element in self._header.elements:
                try:
                    for rows, columns in reader.read_rows(element):
                        if wanted in (None, element):
                            yield element, rows, columns
                except RowsError as error:
                    raise damaged(self._path, DAMAGE_PLY_ROWS, name=element.name, count=element.rows) from error
                if element is wanted:
                    return


def _least_bytes(element: Element, order: str) -> int:
    """Return the least number of bytes of a row in a file."""
    kinds = [one.counter or one.type for one in element.properties]
    return sum(int(kind[1:]) for kind in kinds) if order else 2 * len(kinds) - 1
