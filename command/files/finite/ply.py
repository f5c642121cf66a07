# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates in .ply files."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np

from ....core.streams.findings import AT_ROW
from ....core.streams.misread import Data
from ....core.streams.ply_header import MAX_HEADER, Header, Property, parse_header
from ....core.streams.ply_text import check_ply_text
from ....core.verdict.finding import finding
from .numbers import MALFORMED, bad_in_table, refuse


def check_ply(data: Data, _path: str) -> None:
    count, first, header = 0, 0, None
    with suppress(*MALFORMED):
        header = parse_header(data[:MAX_HEADER])
        count, first = _check_binary_ply(data, header) if header.order else (0, 0)
    refuse(count, finding(AT_ROW, element="vertex", row=first))
    if header is not None and not header.order:
        check_ply_text(data, header)


def _check_binary_ply(data: Data, header: Header) -> tuple[int, int]:
    start = header.start
    for element in header.elements:
        if any(one.counter for one in element.properties):
            ragged = _ragged_rows(data, start, element.rows, element.properties, header.order)
            if element.name == "vertex":
                return bad_in_table(np.array([[row[axis] for axis in "xyz"] for row, _ in ragged]))
            start = max((end for _, end in ragged), default=start)
            continue
        row = np.dtype([(one.name, header.order + one.type) for one in element.properties])
        if element.name == "vertex":
            if not element.properties:
                raise ValueError("vertices without coordinates")
            rows = min(element.rows, (len(data) - start) // row.itemsize)
            table = np.frombuffer(data, row, rows, start)
            found = [bad_in_table(table[axis][:, None]) for axis in "xyz"]
            return sum(count for count, _ in found), min((first for count, first in found if count), default=0)
        start += element.rows * row.itemsize
    return 0, 0


def _ragged_rows(
    data: Data, start: int, rows: int, properties: Sequence[Property], order: str
) -> Iterator[tuple[dict, int]]:
    """Yield the numbers of rows that hold lists, and the end of each row. The lists themselves are skipped."""
    kinds = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
    columns = [
        (one.name, struct.Struct(order + kinds[one.counter or one.type]), int(one.type[1]) if one.counter else 0)
        for one in properties
    ]
    for _ in range(rows):
        row = {}
        for name, column, size in columns:
            (row[name],) = column.unpack_from(data, start)
            start += column.size + (size * row[name] if size else 0)
        yield row, start
