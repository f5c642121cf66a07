# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the numbers in .obj files: vertices and their indices, parameters of free-form curves
and surfaces.

Blender reads a missing or wrong number as 0, leaves out faces with a wrong index, and does not read
the statement after a byte order mark.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

import numpy as np

from ..files import (
    BLOCK,
    MARK,
    SHORT,
    SHORT_OR_NAN,
    SHORT_WHOLE,
    VERTEX,
    WHOLE,
    Data,
    Fault,
    count_fault,
    find_number_fault,
    find_whole_fault,
    refuse_line,
    shorten,
)
from ..numerics import Int64, Mask, NDArray

VERTICES = {b"v": 3, b"vt": 1, b"vn": 3, b"vp": 1}  # the least count of numbers
INDICES = {b"f": 3, b"l": 2, b"p": 1}  # the least count of indices
WHOLES = {b"deg": 1, b"curv2": 2}  # the least count of whole numbers
FREE_FORM = {b"surf": 4, b"curv": 2}  # the count of numbers before the indices
_KINDS = b"|".join([*VERTICES, *INDICES, *WHOLES, *FREE_FORM, b"parm"])
_MARKED = re.compile(MARK + rb"[ \t]*(?:" + _KINDS + rb")(?!\S)")
# not \n, \r
_SPACES = bytes.maketrans(bytes(range(10)) + bytes(range(11, 13)) + bytes(range(14, 32)), b" " * 30)
_NEXT = b" \v "  # joins a line and its continuation, so that lines can still be counted
_INDEX = rb"%(n)b(?>(?:/(?>(?:%(n)b)?)){0,2})"
_SHORT_INDEX, _ANY_INDEX = (_INDEX % {b"n": number} for number in (SHORT_WHOLE, rb"[+-]?[0-9]++"))
_FIELDS = {
    name: rb"(?:[ \r\v]++%b)" % field
    for name, field in ((b"n", SHORT), (b"m", SHORT_OR_NAN), (b"i", _SHORT_INDEX))
}
_LINES = re.compile(
    rb"(?>(?:(?:v(?:(?>%(n)b{3,})|t(?>%(m)b+)|n(?>%(m)b{3,}))|f(?>%(i)b{3,})|l(?>%(i)b{2,})"
    rb"|p(?>%(i)b+))[ \r\v]*+\n|[ \r\v]*+(?!(?:%(kinds)b)(?!\S))[^\n]*+\n)*)"
    % (_FIELDS | {b"kinds": _KINDS})
)


def check_obj_text(data: Data) -> None:
    """Raise FileError if an importer would misread a statement."""
    if _MARKED.match(data[:BLOCK]):
        refuse_line(data, 0, ("U+FEFF", "“v”"))
    counts = np.zeros(3, np.int64)  # counts of v, vt and vn before the block
    for start, text in blocks(data):
        lines = Lines(text, counts)
        counts = lines.after
        for at, before in _find_suspects(lines):
            fault = _find_fault(text[at : text.index(b"\n", at)], before)
            if fault is not None:
                # Find the statement's line in the file, where joined lines (\v) are apart.
                for _ in range(text.count(b"\n", 0, at) + text.count(b"\v", 0, at)):
                    start = data.find(b"\n", start) + 1
                refuse_line(data, start, fault)


def blocks(data: Data) -> Iterator[tuple[int, bytes]]:
    """Yield the offset and the text of blocks of whole statements, continued lines joined to
    one.
    """
    start = 0
    while start < len(data):
        end = (
            data.rfind(b"\n", start, start + BLOCK) + 1 or data.find(b"\n", start) + 1 or len(data)
        )
        while end < len(data) and data[max(start, end - 3) : end].endswith((b"\\\n", b"\\\r\n")):
            end = data.find(b"\n", end) + 1 or len(data)
        text = data[start:end].translate(_SPACES).replace(b"\\\r\n", _NEXT).replace(b"\\\n", _NEXT)
        yield start, text if text.endswith(b"\n") else text + b"\n"
        start = end


class Lines:
    """The statements of a block of text. counts: of v, vt and vn before the block.

    starts, ends: (n,) offsets. kinds: (3, n) whether a line is v, vt or vn. before: (3, n) their
    counts before a line. after: (3,) the counts after the block.
    """

    def __init__(self, text: bytes, counts: Int64) -> None:
        self.text = text
        # so that three letters can be read from any word on
        self.letters = np.frombuffer(text + b"\n\n\n", np.uint8)
        self._is_word = self.letters > ord(" ")
        self._is_word[1:] &= self.letters[:-1] <= ord(" ")
        self.ends = np.flatnonzero(self.letters[:-3] == ord("\n"))
        self.starts = np.append(0, self.ends[:-1] + 1)
        words = np.append(np.flatnonzero(self._is_word), len(text))
        first = words[np.searchsorted(words, self.starts)]
        kind, second, third = (
            np.where(first < self.ends, self.letters[first + shift], 0) for shift in range(3)
        )
        self._kind = np.where(second <= ord(" "), kind, 0)
        is_vertex = kind == ord("v")
        of_two = [is_vertex & (second == ord(letter)) & (third <= ord(" ")) for letter in "tn"]
        self.kinds = np.array([is_vertex & (second <= ord(" ")), *of_two])
        behind = counts[:, None] + np.cumsum(self.kinds, axis=1)
        self.before = behind - self.kinds
        self.after = behind[:, -1]

    def has_kind(self, kinds: str) -> Mask:
        """Return whether the (n,) lines are statements of one of some letters."""
        return np.isin(self._kind, [ord(letter) for letter in kinds])

    def keep(self, is_kept: Mask) -> bytes:
        """Return the text with spaces in place of all but some (n,) lines."""
        inside = np.repeat(is_kept, self.ends - self.starts + 1)
        return np.where(inside, self.letters[:-3], np.uint8(ord(" "))).tobytes()

    def indices(self, is_indexed: Mask) -> tuple[NDArray, NDArray, NDArray]:
        """Return (n,) offsets of indices in lines, their kinds (0, 1, 2 for v, vt, vn), and their
        absolute values.
        """
        letters = self.letters[:-3]
        # Unsigned: letters below "0" become large.
        is_part = (letters - ord("0") < 10) | (letters == ord("-")) | (letters == ord("+"))
        is_part &= np.repeat(is_indexed, self.ends - self.starts + 1)
        at = np.flatnonzero(is_part & ~np.append(False, is_part[:-1]))
        text = np.where(is_part, letters, np.uint8(ord(" "))).tobytes()
        value = np.abs(np.fromstring(text, np.int64, sep=" "))
        # The kind is the number of slashes since the first index of a word; of two slashes without
        # an index between them, the count is 2.
        is_first = self._is_word[at]
        slashes = np.cumsum(np.where(is_first, 0, 1 + (letters[at - 2] == ord("/"))))
        return at, slashes - np.maximum.accumulate(np.where(is_first, slashes, 0)), value


def _find_suspects(lines: Lines) -> list[tuple[int, NDArray]]:
    """Return offsets of possibly wrong statements, each with the counts of v, vt and vn before
    it.
    """
    is_odd = np.zeros(len(lines.starts), bool)
    at = 0
    while (at := _LINES.match(lines.text, at).end()) < len(lines.text):  # type: ignore[union-attr]
        is_odd[np.searchsorted(lines.starts, at)] = True
        at = lines.text.index(b"\n", at) + 1
    is_indexed = lines.has_kind("flp") & ~is_odd
    if is_indexed.any():
        offsets, role, value = lines.indices(is_indexed)
        # First a quick choice, by the counts before the first such line: others are no lower.
        least = lines.before[:, np.argmax(is_indexed)]
        is_suspect = (value == 0) | (value > least[role])
        offsets, role, value = offsets[is_suspect], role[is_suspect], value[is_suspect]
        line = np.searchsorted(lines.starts, offsets, "right") - 1
        limit = lines.before[role, line]
        # Importers ignore vt and vn if there are none.
        is_odd[line[((value == 0) | (value > limit)) & ((role == 0) | (limit > 0))]] = True
    return [(int(lines.starts[line]), lines.before[:, line]) for line in np.flatnonzero(is_odd)]


def _find_fault(line: bytes, before: Sequence[int] | NDArray) -> Fault | None:
    """Return the part that an importer would misread, or None. before: counts of v, vt and vn."""
    kind = line.split(None, 1)[0]
    # Without a space before it, a comment is a part of an index; 1.#IND is a number without a
    # comment.
    words = re.split(rb"\s#" if kind in INDICES else rb"(?<!\.)#", line)[0].split()[1:]
    faults: Iterable[Fault | None]
    if kind in VERTICES:
        least = VERTICES[kind]
        faults = (
            find_number_fault(word, kind == b"v" and place < 3) for place, word in enumerate(words)
        )
    elif kind in INDICES:
        least = INDICES[kind]
        faults = (_find_index_fault(word, before) for word in words)
    elif kind in WHOLES:
        least = WHOLES[kind]
        faults = map(find_whole_fault, words)
    else:
        numbers = FREE_FORM.get(kind, len(words))
        least = numbers + 1 if kind in FREE_FORM else 2
        values = words[1:] if kind == b"parm" else words[:numbers]
        faults = chain(
            (find_number_fault(word, True) for word in values),
            (_find_index_fault(word, before) for word in words[numbers:]),
        )
    fault = next(filter(None, faults), None)
    return count_fault(line.split()) if fault is None and len(words) < least else fault


def _find_index_fault(word: bytes, before: Sequence[int] | NDArray) -> Fault | None:
    """Return the fault of a word that is no index of v, vt and vn, or None.

    Indices of absent vt or vn are ignored.
    """
    if not re.fullmatch(_ANY_INDEX, word):
        return shorten(word), WHOLE
    for role, (number, count) in enumerate(zip(word.split(b"/"), before)):
        # Longer numbers are above any count; `int` refuses those of thousands of digits.
        is_there = len(number) < 19 and 0 < abs(int(number or 0)) <= count
        if number and not is_there and (count or not role):
            return shorten(word), VERTEX
    return None
