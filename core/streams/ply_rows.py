# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of a .ply file's elements, in blocks: text, or binary of either byte order."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import BinaryIO, NamedTuple

import numpy as np

from ..numerics import Array, Index, NDArray

BYTES_PER_BLOCK = 1 << 22  # A text is read by a quarter of this: its numbers take more as float64.
FEW_ROWS = 64  # If so many rows have lists of equal lengths, a longer run of such rows is likely.
WINDOW = 1 << 14  # bytes or numbers among which the lengths of lists are looked for at a time
SINGLE_ROWS = 1 << 14  # rows with lists of unequal lengths that are grouped by these
MAX_LIST = 1 << 26  # numbers of a face: a larger count is damage, and would be read into memory
NUMBERS = np.dtype(np.float64)  # type of the numbers of a text
# C's forms, unknown to numpy
_NOT_A_NUMBER = re.compile(rb"(?<!\S)[+-]?(?:nan\(\w*\)|1\.#\w+)", re.IGNORECASE)

# The indices of rows, and their columns: (n,) numbers or (n, k) lists.
Block = tuple[Index, list[NDArray]]
MAX_HEADER = 1 << 20  # bytes
INDICES = "vertex_indices", "vertex_index"  # names of the list of vertices of a face
END = re.compile(rb"^end_header[ \t]*\r?\n", re.MULTILINE)
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}


class RowsError(Exception):
    """The error of a file that ends before its rows do, or has a wrong number."""


class RowReader:
    """A reader of one element after another. order: "" for text, "<" or ">" for binary."""

    def __init__(self, file: BinaryIO, order: str) -> None:
        self._file = file
        self._order = order
        self._buffer: NDArray = np.zeros(0)  # the next bytes of a binary file, or numbers of a text
        self._cut_word = b""  # the beginning of a number at the end of a block of text

    def read_rows(self, element: Element) -> Iterator[Block]:
        """Yield the next element in blocks of rows with lists of the same lengths.

        All blocks have to be taken.
        """
        done = 0
        properties = element.properties
        while done < element.rows and properties:
            rows_left = element.rows - done
            # A few rows show whether a long run with equal lists is likely.
            starts, lengths = self._scan(properties, min(rows_left, FEW_ROWS))
            if (lengths == lengths[0]).all():
                table = self._equal_rows(properties, lengths[0], rows_left)
                count = len(table)
                yield (
                    np.arange(done, done + count),
                    [table[name] for name in _names(properties)],
                )
                end = table.nbytes // self._buffer.itemsize
            else:
                starts, lengths = self._scan(properties, min(rows_left, SINGLE_ROWS))
                count = len(lengths)
                end = starts[-1]
                yield from self._group_rows(properties, starts, lengths, done)
            self._buffer = self._buffer[end:]
            done += count

    def _equal_rows(
        self, properties: Sequence[Property], lengths: Index, rows_left: int
    ) -> NDArray[np.void]:
        """Return a table of the next rows, up to the first whose lists have other lengths, and to
        about BYTES_PER_BLOCK.
        """
        row = self._row_type(properties, lengths)
        unit = self._buffer.itemsize
        self._read_ahead(min(rows_left * row.itemsize, BYTES_PER_BLOCK) // unit)
        count = min(rows_left, len(self._buffer) * unit // row.itemsize)
        table = np.frombuffer(self._buffer, row, count)
        is_equal = np.ones(count, bool)
        for number, length in enumerate(lengths):
            is_equal &= table["n{}".format(number)] == length
        return table if is_equal.all() else table[: int(np.argmin(is_equal))]

    def _scan(self, properties: Sequence[Property], rows: int) -> tuple[Index, Index]:
        """Return (n + 1,) offsets of the next rows in the buffer, and the (n, lists) lengths of
        their lists.

        rows: the largest n. Offsets are in items of the buffer.
        """
        # For each list: the size of the numbers between it and the list before, the type and the
        # size of its counter, and the size of an item. In the end, `gap` is the size of the
        # numbers behind the last list.
        gap = 0
        lists = []
        for field in properties:
            if field.counter:
                counter_size = self._size(field.counter)
                lists.append((gap, field.counter, counter_size, self._size(field.type)))
            gap = 0 if field.counter else gap + self._size(field.type)
        starts: list[int] = [0]
        lengths: list[int] = []
        window = WINDOW
        while len(starts) <= rows and starts[-1] <= BYTES_PER_BLOCK:
            base = starts[-1]
            known_rows = len(starts) - 1
            self._read_ahead(base + window)
            # A row begins where the one before ends, so that this is a loop over rows. It is fast
            # with plain lists of all numbers that may be counters.
            plan = [
                (skip, self._numbers_at(kind, base, window), counter_size, item_size)
                for skip, kind, counter_size, item_size in lists
            ]
            with suppress(IndexError):  # The row goes on behind the window.
                while len(starts) <= rows:
                    at = starts[-1] - base
                    for skip, counts, counter_size, item_size in plan:
                        at += skip
                        lengths.append(counts[at])
                        at += counter_size + item_size * lengths[-1]
                    starts.append(base + at + gap)
            del lengths[len(lists) * (len(starts) - 1) :]  # lengths of a row that is cut
            new_lengths = lengths[len(lists) * known_rows :]
            if new_lengths and not 0 <= min(new_lengths) <= max(new_lengths) <= MAX_LIST:
                raise RowsError
            if len(starts) - 1 == known_rows:  # The row is longer than the window, or cut short.
                if base + window > len(self._buffer):
                    raise RowsError
                window *= 4
        self._read_ahead(starts[-1])
        if len(self._buffer) < starts[-1]:
            raise RowsError
        return np.array(starts), np.array(lengths, np.intp).reshape(len(starts) - 1, len(lists))

    def _numbers_at(self, kind: str, start: int, count: int) -> list[int]:
        """Return the whole numbers of a type at up to `count` offsets of the buffer, one at each
        offset, so that they overlap.
        """
        offsets = max(len(self._buffer) + 1 - self._size(kind), 0)
        view = np.ndarray(offsets, self._type(kind), self._buffer, strides=self._buffer.strides)
        with np.errstate(invalid="ignore"):  # The cast warns of NaN, which a text may have.
            return view[start : start + count].astype(np.int64).tolist()

    def _group_rows(
        self, properties: Sequence[Property], starts: NDArray, lengths: NDArray, first: int
    ) -> Iterator[Block]:
        """Yield the scanned rows in blocks with lists of equal lengths.

        starts, lengths: of these rows, as `_scan` returns them. first: index of the first row.
        """
        order = np.lexsort(lengths.T)
        changes = np.flatnonzero((lengths[order[1:]] != lengths[order[:-1]]).any(axis=1)) + 1
        for rows in np.split(order, changes):
            row = self._row_type(properties, lengths[rows[0]])
            size = row.itemsize // self._buffer.itemsize
            if len(rows) > 1:
                parts = self._buffer[starts[rows][:, None] + np.arange(size)]
            else:  # One row may be as large as the file, and its indices take eight times that.
                parts = self._buffer[starts[rows[0]] :][:size]
            table = np.frombuffer(parts.tobytes(), row)
            yield first + rows, [table[name] for name in _names(properties)]

    def _row_type(self, properties: Sequence[Property], lengths: Index) -> np.dtype:
        """Return the type of a row with lists of these lengths: its columns (`_names`), and the
        counters of its lists, n0, n1, ….
        """
        columns: list[tuple] = []
        numbered_lengths = iter(enumerate(lengths))
        for name, field in zip(_names(properties), properties):
            if field.counter:
                number, length = next(numbered_lengths)
                columns.append(("n{}".format(number), self._type(field.counter)))
                columns.append((name, self._type(field.type), (length,)))
            else:
                columns.append((name, self._type(field.type)))
        return np.dtype(columns)

    def _size(self, kind: str) -> int:
        """Return the size of a number in items of the buffer: bytes of a binary file, numbers of a
        text.
        """
        return int(kind[1:]) if self._order else 1

    def _type(self, kind: str) -> np.dtype:
        """Return the type of a number in the buffer: of a text, all are float64."""
        return np.dtype(self._order + kind) if self._order else NUMBERS

    def _read_ahead(self, count: int) -> None:
        """Fill the buffer to `count` bytes or numbers, or with the rest of the file."""
        while len(self._buffer) < count:
            if self._order:
                more = np.frombuffer(self._file.read(BYTES_PER_BLOCK), np.uint8)
            else:
                more = self._numbers()
            if not len(more):
                return
            self._buffer = np.concatenate([self._buffer, more]) if len(self._buffer) else more

    def _numbers(self) -> Array:
        """Return the next (n,) numbers of a text, n = 0 at its end. Raises RowsError.

        A word that a block of the file cuts is kept for the next call.
        """
        while True:
            chunk = self._file.read(BYTES_PER_BLOCK // 4)
            text = self._cut_word + chunk
            self._cut_word = b""
            if chunk:
                end = max(text.rfind(space) for space in (b" ", b"\n", b"\t", b"\r")) + 1
                self._cut_word = text[end:]
                text = text[:end]
            if text.strip():
                break
            if not chunk:
                return np.zeros(0)
        if b"(" in text or b"#" in text:
            text = _NOT_A_NUMBER.sub(b"nan", text)
        try:
            return np.array(text.split(), NUMBERS)
        except ValueError as error:
            raise RowsError from error


def _names(properties: Sequence[Property]) -> list[str]:
    """Return the names of the columns in the type of a row: properties may share a name."""
    return ["p{}".format(number) for number in range(len(properties))]


class Property(NamedTuple):
    """A number of a row, or a list of numbers. type: numpy's name. counter: type of a list's
    length, else empty.
    """

    name: str
    type: str
    counter: str = ""


@dataclass(frozen=True)
class Element:
    """A table: its name, the number of its rows, and the properties of each row."""

    name: str
    rows: int
    properties: tuple[Property, ...]

    @property
    def list_of_indices(self) -> int | None:
        """The index of the property that lists the vertices of a face or strip, or None if there is
        none.
        """
        names = [field.name if field.counter else "" for field in self.properties]
        return next((names.index(name) for name in INDICES if name in names), None)

    @property
    def names(self) -> set[str]:
        """The names of the properties."""
        return {field.name for field in self.properties}

    def index(self, name: str) -> int:
        """Return the index of a property. Raises ValueError."""
        return [field.name for field in self.properties].index(name)


@dataclass(frozen=True)
class Header:
    """The header of a file. order: "" for text, else "<" or ">". start: offset of the first
    element.
    """

    order: str
    elements: tuple[Element, ...]
    start: int


def parse_header(data: bytes) -> Header:
    """Return the header at the start of a file.

    ValueError, KeyError or IndexError if there is none.
    """
    end = END.search(data)
    if end is None or not data.startswith(b"ply"):
        raise ValueError("no header")
    order = ""
    elements: list[tuple[str, int, list[Property]]] = []
    for line in data[: end.start()].decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            order = ORDERS[words[1]]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][2].append(Property(words[4], TYPES[words[3]], TYPES[words[2]]))
        elif words[:1] == ["property"]:
            elements[-1][2].append(Property(words[2], TYPES[words[1]]))
    if any(rows < 0 for _, rows, _ in elements):
        raise ValueError("negative number of rows")
    return Header(
        order, tuple(Element(name, rows, tuple(kinds)) for name, rows, kinds in elements), end.end()
    )
