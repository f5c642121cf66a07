# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of a .ply file's elements, in blocks: text, or binary of either byte order."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from .ply_header import Element, Property

BYTES_PER_BLOCK = 1 << 22
FEW_ROWS = 64  # rows of one length: shorter runs are read one at a time
SINGLE_ROWS = 1 << 14  # rows read one at a time before the next search for equal lengths
MAX_LIST = 1 << 26  # numbers of a face: a larger count is damage, and would be read into memory
NUMBERS = np.dtype(np.float64)  # type of the numbers of a text


class RowsError(Exception):
    """The error of a file that ends before its rows do, or has a wrong number."""


class RowReader:
    """A reader of one element after another. order: "" for text, "<" or ">" for binary."""

    def __init__(self, file: BinaryIO, order: str) -> None:
        self._file, self._order = file, order
        self._buffer: NDArray = np.zeros(0)  # bytes or numbers, once there are some
        self._text = b""

    def read_rows(self, element: Element) -> Iterator[list[NDArray]]:
        """Yield the next element in blocks of columns, (n,) numbers or (n, k) lists. All blocks have to be taken."""
        left = element.rows if element.properties else 0
        while left:
            lengths = self._lengths(element.properties)
            row = self._row_type(element.properties, lengths)
            table = self._table(row, left)
            same = np.ones(len(table), bool)
            for number, length in lengths.items():
                same &= table["n{}".format(number)] == length
            count = len(table) if same.all() else int(np.argmin(same))
            if count < min(FEW_ROWS, left):
                for block in self._single_rows(element, min(left, SINGLE_ROWS)):
                    left -= len(block[0])
                    yield block
                continue
            self._buffer = self._buffer[count * row.itemsize // self._buffer.itemsize :]
            left -= count
            yield [table["p{}".format(number)][:count] for number in range(len(element.properties))]

    def _lengths(self, properties: Sequence[Property]) -> dict[int, int]:
        """Return the lengths of the lists of the next row by their property's index, and buffer the whole row."""
        at, lengths = 0, {}
        for number, one in enumerate(properties):
            if one.counter:
                lengths[number] = self._integer(at, one.counter)
                at += self._size(one.counter)
            at += self._size(one.type) * lengths.get(number, 1)
            self._fill(at)
        return lengths

    def _row_type(self, properties: Sequence[Property], lengths: dict[int, int]) -> np.dtype:
        fields: list[tuple] = []
        for number, one in enumerate(properties):
            if number in lengths:
                fields.append(("n{}".format(number), self._type(one.counter)))
                fields.append(("p{}".format(number), self._type(one.type), (lengths[number],)))
            else:
                fields.append(("p{}".format(number), self._type(one.type)))
        return np.dtype(fields)

    def _table(self, row: np.dtype, left: int) -> NDArray:
        """Read the next part of the file, and return the whole rows in the buffer, at most `left`."""
        unit = self._buffer.itemsize
        self._read_ahead(min(left * row.itemsize, BYTES_PER_BLOCK) // unit)
        count = min(left, len(self._buffer) * unit // row.itemsize)
        return np.frombuffer(self._buffer, row, count)

    def _single_rows(self, element: Element, rows: int) -> Iterator[list[NDArray]]:
        """Yield `rows` rows, read one at a time, in blocks of equally long rows."""
        by_lengths: dict[tuple[int, ...], list[bytes]] = {}
        types: dict[tuple[int, ...], np.dtype] = {}
        for _ in range(rows):
            lengths = self._lengths(element.properties)
            key = tuple(lengths.values())
            if key not in types:
                types[key] = self._row_type(element.properties, lengths)
            size = types[key].itemsize // self._buffer.itemsize
            by_lengths.setdefault(key, []).append(self._buffer[:size].tobytes())
            self._buffer = self._buffer[size:]
        for key, found in by_lengths.items():
            table = np.frombuffer(b"".join(found), types[key])
            yield [table["p{}".format(number)] for number in range(len(element.properties))]

    def _size(self, kind: str) -> int:
        """Return the size of a number in items of the buffer: bytes of a binary file, numbers of a text."""
        return int(kind[1:]) if self._order else 1

    def _type(self, kind: str) -> np.dtype:
        return np.dtype(self._order + kind) if self._order else NUMBERS

    def _integer(self, at: int, kind: str) -> int:
        """Return the length of a list, stored at an index of the buffer. Raises RowsError."""
        end = at + self._size(kind)
        self._fill(end)
        value = self._buffer[at:end].view(self._type(kind))[0]
        if not 0 <= value <= MAX_LIST or value != int(value):
            raise RowsError
        return int(value)

    def _fill(self, count: int) -> None:
        """Fill the buffer to `count` bytes or numbers. Raises RowsError if the file has fewer."""
        if len(self._buffer) < count:
            self._read_ahead(count)
            if len(self._buffer) < count:
                raise RowsError

    def _read_ahead(self, count: int) -> None:
        """Fill the buffer to `count` bytes or numbers, or with the rest of the file."""
        while len(self._buffer) < count:
            more = np.frombuffer(self._file.read(BYTES_PER_BLOCK), np.uint8) if self._order else self._numbers()
            if not len(more):
                return
            self._buffer = np.concatenate([self._buffer, more]) if len(self._buffer) else more

    def _numbers(self) -> NDArray[np.float64]:
        """Return the next (n,) numbers of a text, n = 0 at its end. Raises RowsError."""
        while True:
            chunk = self._file.read(BYTES_PER_BLOCK)
            text, self._text = self._text + chunk, b""
            if chunk:
                end = max(text.rfind(space) for space in (b" ", b"\n", b"\t", b"\r")) + 1
                text, self._text = text[:end], text[end:]
            if text.strip():
                break
            if not chunk:
                return np.zeros(0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                return np.fromstring(text.decode("ascii"), NUMBERS, sep=" ")
            except (ValueError, DeprecationWarning) as error:
                raise RowsError from error
