# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates in .ply files."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from ....core.verdict.finding import finding
from .numbers import MALFORMED, Data, bad_in_table, bad_in_text, count_bytes, refuse

_PLY_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_MAX_PLY_HEADER = 1 << 20


def check_ply(data: Data, _path: str) -> None:
    # Properties of an element: (name, type), or (name, type of the count, type) of a list.
    elements: list[tuple[str, int, list[tuple[str, ...]]]] = []
    order = ""
    header = re.search(rb"^end_header[ \t]*\r?\n", data[:_MAX_PLY_HEADER], re.MULTILINE)
    if header is None:
        return
    with suppress(*MALFORMED):
        for line in data[: header.start()].decode("latin-1").splitlines():
            words = line.split()
            if words[:1] == ["format"]:
                order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
            elif words[:1] == ["element"]:
                elements.append((words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                elements[-1][2].append((words[4], _PLY_TYPES[words[2]], _PLY_TYPES[words[3]]))
            elif words[:1] == ["property"]:
                elements[-1][2].append((words[2], _PLY_TYPES[words[1]]))
        check = _check_binary_ply if order else _check_ascii_ply
        count, first = check(data, header.end(), elements, order)
        refuse(count, finding("at_vertex", vertex=first))


def _check_ascii_ply(data: Data, start: int, elements: list, _order: str) -> tuple[int, int]:
    names = [name for name, _, _ in elements]
    if "vertex" not in names:
        return 0, 0
    number = names.index("vertex")
    _, rows, properties = elements[number]
    line_before = sum(rows for _, rows, _ in elements[:number])
    columns = [[one[0] for one in properties].index(axis) for axis in "xyz"]
    here, line_number = start, 0

    def coordinates(line: bytes, begin: int) -> list[bytes]:
        nonlocal here, line_number
        line_number += count_bytes(data, b"\n", here, begin)
        here = begin
        words = line.split() if 0 <= line_number - line_before < rows else []
        return [words[column] for column in columns if column < len(words)]

    count, first = bad_in_text(data, coordinates, start)
    return count, 0 if first is None else count_bytes(data, b"\n", start, first) - line_before


def _check_binary_ply(data: Data, start: int, elements: list, order: str) -> tuple[int, int]:
    for name, rows, properties in elements:
        if any(len(one) == 3 for one in properties):
            ragged = _ragged_rows(data, start, rows, properties, order)
            if name == "vertex":
                return bad_in_table(np.array([[row[axis] for axis in "xyz"] for row, _ in ragged]))
            start = max((end for _, end in ragged), default=start)
            continue
        row = np.dtype([(one[0], order + one[1]) for one in properties])
        if name == "vertex":
            if not properties:
                raise ValueError("vertices without coordinates")
            rows = min(rows, (len(data) - start) // row.itemsize)
            table = np.frombuffer(data, row, rows, start)
            found = [bad_in_table(table[axis][:, None]) for axis in "xyz"]
            return sum(count for count, _ in found), min((first for count, first in found if count), default=0)
        start += rows * row.itemsize
    return 0, 0


def _ragged_rows(data: Data, start: int, rows: int, properties: list, order: str) -> Iterator[tuple[dict, int]]:
    """The numbers of rows that hold lists, and where each ends. Lists themselves are passed over."""
    kinds = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
    columns = [(one[0], struct.Struct(order + kinds[one[1]]), int(one[-1][1]) if one[2:] else 0) for one in properties]
    for _ in range(rows):
        row = {}
        for name, column, size in columns:
            (row[name],) = column.unpack_from(data, start)
            start += column.size + (size * row[name] if size else 0)
        yield row, start
