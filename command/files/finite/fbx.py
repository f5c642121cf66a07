# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates in .fbx files."""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Iterator
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from ....core.streams.findings import AT_ROW
from ....core.streams.misread import SHORT, Data, find_number_fault, refuse_line
from ....core.verdict.finding import finding
from .numbers import BLOCK, MALFORMED, bad_in_table, refuse

_FBX_MAGIC = b"Kaydara FBX Binary  \0\x1a\0"
_FBX_TYPES = {b"d": np.dtype("<f8"), b"f": np.dtype("<f4")}
# The end of a node's head: its name behind its length, and the type of its first property, an array.
_FBX_VERTICES = re.compile(rb"\x08Vertices(?=[df])")


def check_fbx(data: Data, _path: str) -> None:
    """Raise FileError if a vertex of a mesh or of its shape keys is not finite."""
    if data[:23] != _FBX_MAGIC:
        _check_ascii_fbx(data)
        return
    for vertices in _FBX_VERTICES.finditer(data):
        with suppress(*MALFORMED):
            count, first = 0, 0
            for begin, numbers in _fbx_array(data, vertices.end()):
                more, row = bad_in_table(numbers[:, None])
                first = first if count else (begin + row) // 3
                count += more
            refuse(count, finding(AT_ROW, element="vertex", row=first))


_FBX_ARRAY = re.compile(rb"Vertices(?<!\wVertices)\s*:(?:\s*\*\d+\s*\{\s*a\s*:)?")
_FBX_NUMBERS = re.compile(rb"(?:[\s,]*+%b(?=[\s,}]|\Z))*+[\s,]*+" % SHORT)
_FBX_WORD = re.compile(rb"[^\s,:{}]++(?!\s*:)")  # not the name of what follows


def _check_ascii_fbx(data: Data) -> None:
    for array in _FBX_ARRAY.finditer(data):
        is_named = data[max(0, array.start() - 100) : array.start()].rpartition(b"\n")[2].strip()
        numbers = None if is_named else _FBX_NUMBERS.match(data, array.end())
        while numbers is not None:
            word = _FBX_WORD.match(data, numbers.end())
            fault = None if word is None else find_number_fault(word[0], True)
            if fault is not None:
                refuse_line(data, numbers.end(), fault)
            numbers = None if word is None else _FBX_NUMBERS.match(data, word.end())


def _fbx_array(data: Data, at: int) -> Iterator[tuple[int, NDArray]]:
    """Yield the numbers of an array in blocks, each after the count of numbers before it."""
    kind = _FBX_TYPES[data[at : at + 1]]
    count, packed, size = struct.unpack_from("<3I", data, at + 1)
    at += 13
    if not packed:
        yield 0, np.frombuffer(data, kind, count, at)
        return
    unpacker, rest, done = zlib.decompressobj(), b"", 0
    for begin in range(at, at + size, BLOCK):
        piece = data[begin : min(begin + BLOCK, at + size)]
        while piece and done < count:
            block = rest + unpacker.decompress(piece, BLOCK)
            piece = unpacker.unconsumed_tail
            whole = len(block) // kind.itemsize
            yield done, np.frombuffer(block, kind, whole)
            rest, done = block[whole * kind.itemsize :], done + whole
