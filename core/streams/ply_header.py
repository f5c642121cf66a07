# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The header of a .ply file: its elements, and the properties of each."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

MAX_HEADER = 1 << 20  # bytes
INDICES = "vertex_indices", "vertex_index"  # names of the list of vertices of a face
END = re.compile(rb"^end_header[ \t]*\r?\n", re.MULTILINE)
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}


class Property(NamedTuple):
    """A number of a row, or a list of numbers. type: numpy's name. counter: type of a list's length, else empty."""

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
        """The index of the property that lists the vertices of a face or strip, or None if there is none."""
        names = [one.name if one.counter else "" for one in self.properties]
        return next((names.index(name) for name in INDICES if name in names), None)

    def index(self, name: str) -> int:
        """Return the index of a property. Raises ValueError."""
        return [one.name for one in self.properties].index(name)


@dataclass(frozen=True)
class Header:
    """The header of a file. order: "" for text, else "<" or ">". start: offset of the first element."""

    order: str
    elements: tuple[Element, ...]
    start: int


def parse_header(data: bytes) -> Header:
    """Return the header at the start of a file. ValueError, KeyError or IndexError if there is none."""
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
    return Header(order, tuple(Element(name, rows, tuple(kinds)) for name, rows, kinds in elements), end.end())
