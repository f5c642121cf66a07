# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The grammar of .stl files in text: words with any white space between, but each name of a solid is a line.

Blender takes a fourth corner, a corner in a comment or in the name of another solid, and a wrong number, for corners
of the next triangles.
"""

from __future__ import annotations

import re
from itertools import islice

from ..verdict.finding import FileError
from .findings import STL_CUT_SHORT
from .misread import SHORT, SHORT_OR_NAN, Data, Fault, find_number_fault, refuse_line, shorten

BY_COUNT, BY_WORD = "where its number of triangles does", "with “endsolid”"  # words for the end of a file
SOLID = re.compile(rb"(?<!\S)(?:end)?solid\b(?:(?!\s(?:vertex|facet)\s)[^\n])*+", re.IGNORECASE)
_FIRST_LINE = re.compile(rb"(?:\xef\xbb\xbf)?[ \t]*solid[^\n]*", re.IGNORECASE)
_FACET_NORMAL, _CORNER = ((rb"(?:\s++" + number + rb"){3}") for number in (SHORT_OR_NAN, SHORT))
_FACETS = re.compile(
    rb"(?:\s*+(?:%b(?!\S)|facet\s++normal%b\s++outer\s++loop(?:\s++vertex%b){3}\s++endloop\s++endfacet(?!\S)))*+\s*+"
    % (SOLID.pattern, _FACET_NORMAL, _CORNER),
    re.IGNORECASE,
)
_WORD = re.compile(rb"\S+")
_CORNER_WORDS = ["vertex", True, True, True]  # True for a number that places a point
_FACET_WORDS = ["facet", "normal", *3 * [False], "outer", "loop", *3 * _CORNER_WORDS, "endloop", "endfacet"]


def check_stl_text(data: Data) -> None:
    """Raise FileError if an importer would misread a word."""
    first = _FIRST_LINE.match(data)
    at = first.end() if first else 0
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
    if isinstance(expected, bool):
        return find_number_fault(word, expected)
    return None if word.lower() == expected.encode() else (shorten(word), "“{}”".format(expected))
