# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of .ply files in text: each row is one line with just the fields of the header.

Blender reads a missing or wrong number as 0, and leaves out faces with a wrong index.
"""

from __future__ import annotations

import re

import numpy as np

from .misread import (
    BLOCK,
    SHORT,
    SHORT_OR_NAN,
    SHORT_WHOLE,
    VERTEX,
    Data,
    Fault,
    count_fault,
    find_number_fault,
    find_whole_fault,
    refuse_line,
    shorten,
)
from .ply_rows import INDICES, Element, Header, Property

LENGTHS = range(9)  # lists that are checked together; rows with longer ones are checked word by word
FEW_ROWS, MANY_PROPERTIES = 16, 100  # For fewer rows or more properties an expression does not pay.
_BLANK = rb"[ \t]*+"
_REST = re.compile(rb"[^\s\0\x1a]")


def check_ply_text(data: Data, header: Header) -> None:
    """Raise FileError if an importer would misread a row."""
    vertex_count = next((element.rows for element in header.elements if element.name == "vertex"), 0)
    at = header.start
    for element in header.elements:
        if element.properties:
            end = _find_end(data, at, element.rows)
            _Rows(data, element, vertex_count).check(at, end)
            at = end
    rest = _REST.search(data, at)
    if rest is not None:
        refuse_line(data, rest.start(), count_fault(_line(data, rest.start(), len(data)).split()))


class _Rows:
    def __init__(self, data: Data, element: Element, vertex_count: int) -> None:
        self._data, self._properties, self._vertex_count = data, element.properties, vertex_count
        self._is_face, self._places = element.name == "face", element.name == "vertex"
        is_worth = element.rows > FEW_ROWS and len(element.properties) < MANY_PROPERTIES
        row = _pattern_of(element) if is_worth else rb"(?!)"
        self._pattern = re.compile(rb"(?:%b%b[ \t\r]*+(?:\n|\Z))*+" % (_BLANK, row))
        only_lists = all(_is_whole(one) for one in element.properties)
        self._type = np.dtype(np.int64 if only_lists else np.float64)

    def check(self, start: int, end: int) -> None:
        while start < end:
            stop = self._end_of_pattern(start, end)
            if self._is_face:
                self._check_indices(start, stop)
            if stop < end:
                stop += len(self._check_row(stop, end))
            start = stop

    def _end_of_pattern(self, start: int, end: int) -> int:
        matched = self._pattern.match(self._data, start, end)
        return matched.end() if matched else start

    def _check_indices(self, start: int, end: int) -> None:
        """Check the faces of a block row by row only if one of its numbers, of any meaning, can be no index."""
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
        left = iter(words)
        for one in self._properties:
            count = 1
            if one.counter:
                word = next(left, b"")
                fault = find_whole_fault(word) if word else None
                if fault is not None:
                    return fault
                count = int(word or b"-1")
            fields = [word for _, word in zip(range(count), left)]
            if not 0 <= count == len(fields):
                return count_fault(words)
            faults = [self._find_field_fault(one, word) for word in fields]
            if any(faults):
                return next(filter(None, faults))
        return count_fault(words) if next(left, None) is not None else None

    def _find_field_fault(self, one: Property, word: bytes) -> Fault | None:
        if not _is_whole(one):
            return find_number_fault(word, self._places and one.name in ("x", "y", "z"))
        fault = find_whole_fault(word)
        is_index = self._is_face and one.name in INDICES
        if fault is None and is_index and not 0 <= int(word) < self._vertex_count:
            return shorten(word), VERTEX
        return fault


def _is_whole(one: Property) -> bool:
    """Return whether importers read a property as a list of whole numbers; they read single values as numbers."""
    return bool(one.counter) and (one.type[0] in "iu" or one.name in INDICES)


def _pattern_of(element: Element) -> bytes:
    fields = []
    for one in element.properties:
        number = SHORT if element.name == "vertex" and one.name in ("x", "y", "z") else SHORT_OR_NAN
        if one.counter:
            item = SHORT_WHOLE if _is_whole(one) else number
            number = b"(?:%b)" % b"|".join(rb"%d(?:[ \t]++%b){%d}+" % (n, item, n) for n in LENGTHS)
        fields.append(number)
    return rb"[ \t]++".join(fields)


def _line(data: Data, start: int, end: int) -> bytes:
    return data[start : data.find(b"\n", start, end) + 1 or end]


def _find_end(data: Data, start: int, rows: int) -> int:
    """Return the offset behind the next `rows` lines, or the end of the file."""
    while rows and start < len(data):
        block = np.frombuffer(data[start : start + BLOCK], np.uint8)
        ends = np.flatnonzero(block == ord("\n"))
        if len(ends) >= rows:
            return start + int(ends[rows - 1]) + 1
        rows -= len(ends)
        start += len(block)
    return start
