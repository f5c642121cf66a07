# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles in .stl files, in blocks: binary or text, as float32, as Blender takes them.

A file is binary if its size is exactly that of its number of triangles, else text.
"""

import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..files import (
    MARK,
    SHORT,
    SHORT_OR_NAN,
    Data,
    Fault,
    find_number_fault,
    map_file,
    parse_decimals,
    refuse_line,
    shorten,
)
from ..mesh import Surface
from ..verdict import FileError
from .file_mesh import (
    Box,
    FileMesh,
    box_of_blocks,
    merge_equal,
    name_of_file,
    without_repeats,
)
from .findings import STL_CUT_SHORT

# Bytes before the triangles, and bytes of each triangle.
HEAD = 84
RECORD = 50
CORNERS = np.dtype({"names": ["at"], "formats": ["(3,3)<f4"], "offsets": [12], "itemsize": RECORD})
TRIANGLES_PER_BLOCK = 1 << 17
SAMPLES = 1000  # triangles that show where the body is
TEXT_PER_BLOCK = 1 << 20  # bytes
TEXT_PER_TRIANGLE = 250  # bytes, about: the face count of a text is an estimate
FACET_END = b"endfacet"
_NORMAL = re.compile(rb"normal[^v]*?out")
# words for the end of a file
BY_COUNT = "where its number of triangles does"
BY_WORD = "with “endsolid”"
SOLID = re.compile(rb"(?<!\S)(?:end)?solid\b(?>(?:(?!\s(?:vertex|facet)\s)[^\n])*)", re.IGNORECASE)
_FIRST_LINE = re.compile(rb"(?:\xef\xbb\xbf)?[ \t]*solid[^\n]*", re.IGNORECASE)
_FACET_NORMAL, _CORNER = ((rb"(?:\s++" + number + rb"){3}") for number in (SHORT_OR_NAN, SHORT))
_FACETS = re.compile(
    rb"(?>(?:\s*+(?:%b(?!\S)|facet\s++normal%b\s++outer\s++loop"
    rb"(?:\s++vertex%b){3}\s++endloop\s++endfacet(?!\S)))*)\s*+"
    % (SOLID.pattern, _FACET_NORMAL, _CORNER),
    re.IGNORECASE,
)
_WORD = re.compile(rb"\S+")
_CORNER_WORDS = ["vertex", True, True, True]  # True for a number that places a point
_FACET_WORDS = [
    "facet",
    "normal",
    *3 * [False],
    "outer",
    "loop",
    *3 * _CORNER_WORDS,
    "endloop",
    "endfacet",
]


class StlFile:
    """The triangles of an .stl file.

    face_count: their number, estimated for a text. is_loose: True, as triangles share no points.
    """

    is_loose = True

    def __init__(self, path: Path) -> None:
        self._path = path
        with open(path, "rb") as file:
            head = file.read(HEAD)
        size = path.stat().st_size
        count = int.from_bytes(head[80:84], "little")
        self._binary = len(head) == HEAD and size == HEAD + RECORD * count
        if not self._binary and not head.removeprefix(MARK).lstrip().lower().startswith(b"solid"):
            raise FileError(STL_CUT_SHORT, end=BY_COUNT)
        self._is_checked = False
        self.face_count = count if self._binary else size // TEXT_PER_TRIANGLE

    def sampled_box(self) -> Box:
        """Return the box of a sample of the triangles (of a text, the first ones), of all if a
        sample is not finite.
        """
        if self._binary:
            records = np.frombuffer(map_file(self._path), CORNERS, self.face_count, HEAD)
            blocks = [records["at"][:: max(1, self.face_count // SAMPLES)].astype(np.float32)]
        else:
            with open(self._path, "rb") as file:
                blocks = list(islice(self._text_corners(file), 1))
        if all(np.isfinite(block).all() for block in blocks):
            return box_of_blocks(blocks, "triangle")
        return self.box()

    def box(self) -> Box:
        """Return the least and the largest coordinates. Raises FileError if some are not finite."""
        return box_of_blocks(
            (piece.points.reshape(-1, 3, 3) for piece in self.pieces()), "triangle"
        )

    def pieces(self) -> Iterator[Surface]:
        """Yield surfaces of the triangles, with three points for each."""
        triangles = np.arange(3 * TRIANGLES_PER_BLOCK, dtype=np.int32).reshape(-1, 3)
        with open(self._path, "rb") as file:
            for corners in _binary_corners(file) if self._binary else self._text_corners(file):
                yield Surface(corners.reshape(-1, 3), triangles[: len(corners)])

    def mesh(self) -> FileMesh:
        """Read all triangles, and merge equal points. FileError if a number is not finite."""
        points = np.concatenate(
            [np.zeros((0, 3), np.float32), *(piece.points for piece in self.pieces())]
        )
        box_of_blocks([points.reshape(-1, 3, 3)], "triangle")
        points, corners = merge_equal(points)
        corners, sides = without_repeats(corners, np.full(len(corners) // 3, 3))
        return FileMesh(name_of_file(self._path), points, corners, sides)

    def _text_corners(self, file: BinaryIO) -> Iterator[NDArray[np.float32]]:
        """Yield (n, 3, 3) corners of a text, which is read in blocks that end anywhere."""
        waiting = b""  # text behind the last whole facet
        file.readline()  # the first solid's name, of any words
        while chunk := file.read(TEXT_PER_BLOCK):
            waiting += chunk.lower()
            end = waiting.rfind(FACET_END) + len(FACET_END) if FACET_END in waiting else 0
            corners = self._parse(waiting[:end])
            waiting = waiting[end:]
            for start in range(0, len(corners), TRIANGLES_PER_BLOCK):
                yield corners[start : start + TRIANGLES_PER_BLOCK]
        if SOLID.sub(b"", waiting).strip():
            check_stl_text(map_file(self._path))
        if b"endsolid" not in waiting:
            raise FileError(STL_CUT_SHORT, end=BY_WORD)

    def _parse(self, text: bytes) -> NDArray[np.float32]:
        """Return the (n, 3, 3) corners of whole facets in lower case.

        FileError if a word is wrong: at the first facets that the expression does not match, the
        whole file is checked word by word, once.
        """
        is_plain = _FACETS.match(text).end() == len(text)  # type: ignore[union-attr]
        if not is_plain and not self._is_checked:
            check_stl_text(map_file(self._path))
            self._is_checked = True
        if b"solid" in text:
            text = SOLID.sub(b"", text)
        # Normals may be no numbers, and are left out below.
        text = _NORMAL.sub(b"normal 0 0 0 out", text)
        try:
            numbers, _ = parse_decimals(text)
            normals_and_corners = numbers.reshape(-1, 4, 3)
        except ValueError as error:
            raise FileError(STL_CUT_SHORT, end=BY_WORD) from error
        return normals_and_corners[:, 1:].astype(np.float32)


def _binary_corners(file: BinaryIO) -> Iterator[NDArray[np.float32]]:
    file.seek(HEAD)
    while len(records := np.fromfile(file, CORNERS, TRIANGLES_PER_BLOCK)):
        yield records["at"].astype(np.float32, order="C")


def check_stl_text(data: Data) -> None:
    """Raise FileError if an importer would misread a word."""
    first_line = _FIRST_LINE.match(data)
    at = first_line.end() if first_line else 0
    # The expression passes over all facets without a fault. The words of the next one are compared
    # one by one; if they are right after all, the search goes on behind them.
    while (at := _FACETS.match(data, at).end()) < len(data):  # type: ignore[union-attr]
        words = list(islice(_WORD.finditer(data, at), len(_FACET_WORDS)))
        is_cut = len(words) < len(_FACET_WORDS)
        for word, expected in zip(words[:-1] if is_cut else words, _FACET_WORDS):
            fault = _find_fault(word[0], expected)
            if fault is not None:
                refuse_line(data, word.start(), fault)
        if is_cut:
            raise FileError(STL_CUT_SHORT, end=BY_WORD)
        at = words[-1].end()


def _find_fault(word: bytes, expected: str | bool) -> Fault | None:
    """Return the fault of a word, or None. expected: an item of _FACET_WORDS."""
    if isinstance(expected, bool):
        return find_number_fault(word, expected)
    return None if word.lower() == expected.encode() else (shorten(word), "“{}”".format(expected))
