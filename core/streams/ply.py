# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces in .ply files, in blocks, the table of vertices in memory; checks of text: each row is one
line of fields.

Blender reads a missing or wrong number as 0, and leaves out faces with a wrong index.
"""

import re
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

import numpy as np

from ..files import (
    BLOCK,
    DAMAGE_INCOMPLETE,
    FILE_UNRECOGNIZED,
    FILE_WITHOUT_OBJECTS,
    SHORT,
    SHORT_OR_NAN,
    SHORT_WHOLE,
    VERTEX,
    Data,
    Fault,
    count_fault,
    damaged,
    find_number_fault,
    find_whole_fault,
    map_file,
    refuse_line,
    shorten,
)
from ..mesh import Surface
from ..numerics import Index, NDArray
from ..verdict import FileError
from .file_mesh import (
    Box,
    FileMesh,
    Polygons,
    box_of_blocks,
    name_of_file,
    polygon_surface,
    strip_triangles,
)
from .ply_rows import (
    INDICES,
    MAX_HEADER,
    Element,
    Header,
    Property,
    RowReader,
    RowsError,
    parse_header,
)

# A block of faces takes all vertices between its first and its last one, unless they are more than
# this times its corners; then it copies those that it uses.
MAX_SPREAD = 4
# Lists of these lengths are checked by an expression; rows with longer ones, word by word.
LENGTHS = range(9)
# For fewer rows or more properties an expression does not pay.
FEW_ROWS = 16
MANY_PROPERTIES = 100
_BLANK = rb"[ \t]*+"
_REST = re.compile(rb"[^\s\0\x1a]")  # Zeros and Ctrl+Z are padding.


class PlyFile:
    """The faces of a .ply file. is_loose: False, as faces share points."""

    is_loose = False

    def __init__(self, path: Path) -> None:
        self._path = path
        with open(path, "rb") as file:
            start = file.read(MAX_HEADER)
        try:
            self._header = header = parse_header(start)
            for element in header.elements:
                # Lists may be empty, so that their counters are all that a row needs: in a text
                # one digit for each number, and a space before the next.
                kinds = [field.counter or field.type for field in element.properties]
                row_size = 2 * len(kinds) - 1
                if header.order:
                    row_size = sum(int(kind[1:]) for kind in kinds)
                if element.rows * row_size > path.stat().st_size:
                    raise self._incomplete(element)
            (self._vertices, *_) = (
                element for element in header.elements if element.name == "vertex"
            )
            if not {"x", "y", "z"} <= self._vertices.names:
                self._faces  # noqa: B018 - refused for its missing faces, if it has none
            self._axes = [self._vertices.index(axis) for axis in "xyz"]
        except (ValueError, KeyError, IndexError) as error:
            raise FileError(FILE_UNRECOGNIZED, format="PLY") from error
        if not header.order:
            check_ply_text(map_file(path), header)

    def _incomplete(self, element: Element) -> FileError:
        """Return the refusal of an element that has fewer rows than the header promises."""
        reason = "{}, {} rows".format(element.name, element.rows)
        return damaged(self._path, DAMAGE_INCOMPLETE, kind="table of numbers", error=reason)

    @property
    def face_count(self) -> int:
        """The number of faces that the header promises."""
        return self._faces[0].rows

    @cached_property
    def _faces(self) -> tuple[Element, int]:
        """The element of faces, and the index of the property that lists their vertices.

        Raises FileError.
        """
        for element in self._header.elements:
            if element.name == "face" and element.list_of_indices is not None:
                return element, element.list_of_indices
        raise FileError(FILE_WITHOUT_OBJECTS, content="faces")

    @cached_property
    def _points(self) -> NDArray[np.floating]:
        """The (n, 3) points of all vertices, finite or not."""
        points = self._empty_points()
        for _, rows, columns in self._blocks(self._vertices):
            self._fill_points(points, rows, columns)
        return points

    def box(self) -> Box:
        """Return the least and the largest coordinates. FileError if some are not finite."""
        return box_of_blocks([self._points], "vertex")

    sampled_box = box

    def pieces(self) -> Iterator[Surface]:
        """Yield surfaces of the faces: triangles, quads, and the triangles of larger polygons. Each
        has only the vertices in the range of its faces, or copies of those that they use.
        """
        faces, list_index = self._faces
        for _, _, columns in self._blocks(faces):
            if columns[list_index].shape[1] < 3:
                continue
            corners, first, stop = self._corners(columns[list_index])
            if stop - first <= MAX_SPREAD * corners.size:
                yield polygon_surface(self._points[first:stop], corners - first)
            else:
                points = self._points[corners.ravel()]
                yield polygon_surface(points, np.arange(corners.size).reshape(corners.shape))

    def mesh(self) -> FileMesh:
        """Read faces, strips of triangles, edges, and numbers of the vertices, finite or not.

        Raises FileError.
        """
        points = self._empty_points()
        numbers = {field.name for field in self._vertices.properties if not field.counter}
        values = {name: np.empty(len(points), np.float32) for name in numbers - {"x", "y", "z"}}
        faces = Polygons()
        edges: list[NDArray[np.integer]] = [np.zeros((0, 2), np.int64)]
        for element, rows, columns in self._blocks():
            if element is self._vertices:
                self._fill_points(points, rows, columns)
                with np.errstate(over="ignore", invalid="ignore"):
                    for name, of_vertices in values.items():
                        of_vertices[rows] = columns[element.index(name)]
            elif element.list_of_indices is not None:
                corners = columns[element.list_of_indices]
                if element.name == "tristrips":
                    for strip in corners:
                        faces.add(self._corners(strip_triangles(strip))[0])
                elif corners.shape[1] >= 3:
                    faces.add(self._corners(corners)[0], rows)
            elif element.name == "edge" and {"vertex1", "vertex2"} <= element.names:
                ends = [columns[element.index(name)] for name in ("vertex1", "vertex2")]
                edges.append(self._corners(np.stack(ends, axis=1))[0])
        return FileMesh(
            name_of_file(self._path), points, *faces.join(), np.concatenate(edges), values
        )

    def _corners(self, numbers: NDArray) -> tuple[NDArray[np.integer], int, int]:
        """Return vertex indices as integers, their least, and their largest plus one: 0 and 1 if
        there are none.

        FileError if one is no whole number, or beyond the vertices.
        """
        with np.errstate(invalid="ignore"):  # The cast warns of NaN, which a text may have.
            corners = np.ascontiguousarray(
                numbers, np.int32 if numbers.dtype == np.int32 else np.int64
            )
        if not corners.size:
            return corners, 0, 1
        first = int(corners.min())
        stop = int(corners.max()) + 1
        is_whole = numbers.dtype.kind != "f" or np.array_equal(corners, numbers)
        if not (is_whole and 0 <= first < stop <= self._vertices.rows):
            reason = "a vertex beyond {}".format(self._vertices.rows)
            raise damaged(self._path, DAMAGE_INCOMPLETE, kind="mesh", error=reason)
        return corners, first, stop

    def _empty_points(self) -> NDArray[np.floating]:
        """Return (n, 3) points to be filled: float32 if the file has them as such, else float64."""
        types = {self._vertices.properties[axis].type for axis in self._axes}
        return np.empty((self._vertices.rows, 3), np.float32 if types == {"f4"} else np.float64)

    def _fill_points(
        self, points: NDArray[np.floating], rows: Index, columns: list[NDArray]
    ) -> None:
        """Set points of these rows. Numbers beyond the range become infinite, and are refused
        later.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            for axis, column in enumerate(self._axes):
                points[rows, axis] = columns[column]

    def _blocks(
        self, wanted: Element | None = None
    ) -> Iterator[tuple[Element, Index, list[NDArray]]]:
        """Yield element, indices of rows, and columns of the blocks of one element, or of all."""
        with open(self._path, "rb") as file:
            file.seek(self._header.start)
            reader = RowReader(file, self._header.order)
            for element in self._header.elements:
                try:
                    for rows, columns in reader.read_rows(element):
                        if wanted in (None, element):
                            yield element, rows, columns
                except RowsError as error:
                    raise self._incomplete(element) from error
                if element is wanted:
                    return


def check_ply_text(data: Data, header: Header) -> None:
    """Raise FileError if an importer would misread a row of a text, or anything follows its rows.

    Each row is one line, so that an element ends with the line of its last row.
    """
    vertex_count = next(
        (element.rows for element in header.elements if element.name == "vertex"), 0
    )
    at = header.start
    for element in header.elements:
        if element.properties:
            end = _find_end(data, at, element.rows)
            _RowCheck(data, element, vertex_count).check(at, end)
            at = end
    rest = _REST.search(data, at)
    if rest is not None:
        refuse_line(data, rest.start(), count_fault(_line(data, rest.start(), len(data)).split()))


class _RowCheck:
    """The check of the rows of an element: many at a time by an expression, the others word by
    word.
    """

    def __init__(self, data: Data, element: Element, vertex_count: int) -> None:
        self._data = data
        self._properties = element.properties
        self._vertex_count = vertex_count
        self._is_face = element.name == "face"
        self._is_vertex = element.name == "vertex"
        uses_expression = element.rows > FEW_ROWS and len(element.properties) < MANY_PROPERTIES
        row = _pattern_of(element) if uses_expression else rb"(?!)"  # This never matches.
        self._pattern = re.compile(rb"(?>(?:%b%b[ \t\r]*+(?:\n|\Z))*)" % (_BLANK, row))
        has_only_wholes = all(map(_is_whole, element.properties))
        self._type = np.dtype(np.int64 if has_only_wholes else np.float64)

    def check(self, start: int, end: int) -> None:
        """Raise FileError if a row from byte `start` to byte `end` has a fault.

        The expression passes over the rows that it matches; the next row is checked word by word.
        """
        while start < end:
            match = self._pattern.match(self._data, start, end)
            stop = match.end() if match else start
            if self._is_face:
                self._check_indices(start, stop)
            if stop < end:
                stop += len(self._check_row(stop, end))
            start = stop

    def _check_indices(self, start: int, end: int) -> None:
        """Raise FileError if a face from byte `start` to byte `end` has a wrong index.

        Most blocks pass at once: if each of their numbers, counters and others too, could be an
        index, so could each index. Only other blocks are checked row by row.
        """
        while start < end:
            stop = self._data.find(b"\n", min(start + BLOCK, end - 1), end) + 1 or end
            values = np.fromstring(self._data[start:stop], self._type, sep=" ")
            if values.size and not (values.min() >= 0 and values.max() < self._vertex_count):
                while start < stop:
                    start += len(self._check_row(start, stop))
            start = stop

    def _check_row(self, start: int, end: int) -> bytes:
        """Return the row at `start` if all its words are right, else raise FileError."""
        line = _line(self._data, start, end)
        fault = self._find_fault(line.split())
        if fault is not None:
            refuse_line(self._data, start, fault)
        return line

    def _find_fault(self, words: list[bytes]) -> Fault | None:
        """Return the first fault of the words of a row, or None."""
        start = 0  # the first word of the next property
        for field in self._properties:
            count = 1
            if field.counter:
                if start == len(words):
                    return count_fault(words)
                fault = find_whole_fault(words[start])
                if fault is not None:
                    return fault
                count = int(words[start])
                start += 1
            if not 0 <= count <= len(words) - start:
                return count_fault(words)
            for word in words[start : start + count]:
                fault = self._find_field_fault(field, word)
                if fault is not None:
                    return fault
            start += count
        return count_fault(words) if start < len(words) else None

    def _find_field_fault(self, field: Property, word: bytes) -> Fault | None:
        """Return the fault of a number, or of an item of a list, or None."""
        if not _is_whole(field):
            return find_number_fault(word, self._is_vertex and field.name in ("x", "y", "z"))
        fault = find_whole_fault(word)
        is_index = self._is_face and field.name in INDICES
        if fault is None and is_index and not 0 <= int(word) < self._vertex_count:
            return shorten(word), VERTEX
        return fault


def _is_whole(field: Property) -> bool:
    """Return whether importers read a property as whole numbers: only a list is; single values, of
    whole types too, are read as decimal numbers.
    """
    return bool(field.counter) and (field.type[0] in "iu" or field.name in INDICES)


def _pattern_of(element: Element) -> bytes:
    """Return an expression for a row without a fault, but for the values of indices."""
    patterns = []
    for field in element.properties:
        is_coordinate = element.name == "vertex" and field.name in ("x", "y", "z")
        pattern = SHORT if is_coordinate else SHORT_OR_NAN
        if field.counter:
            item = SHORT_WHOLE if _is_whole(field) else pattern
            pattern = b"(?:%b)" % b"|".join(
                rb"%d(?>(?:[ \t]++%b){%d})" % (n, item, n) for n in LENGTHS
            )
        patterns.append(pattern)
    return rb"[ \t]++".join(patterns)


def _line(data: Data, start: int, end: int) -> bytes:
    """Return the line that begins at `start`, with its end."""
    return data[start : data.find(b"\n", start, end) + 1 or end]


def _find_end(data: Data, start: int, rows: int) -> int:
    """Return the offset behind the `rows` lines from `start` on, or the end of the file."""
    while rows and start < len(data):
        block = np.frombuffer(data[start : start + BLOCK], np.uint8)
        ends = np.flatnonzero(block == ord("\n"))
        if len(ends) >= rows:
            return start + int(ends[rows - 1]) + 1
        rows -= len(ends)
        start += len(block)
    return start
