# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates in .stl and .obj files."""

from __future__ import annotations

import re
import struct

import numpy as np

from ....core.verdict.finding import finding
from .numbers import Data, bad_in_table, bad_in_text, count_matches, refuse


def check_stl(data: Data, _path: str) -> None:
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        facets = np.frombuffer(
            data, np.dtype({"names": ["at"], "formats": ["9<f4"], "offsets": [12], "itemsize": 50}), -1, 84
        )
        count, first = bad_in_table(facets["at"])
        refuse(count, finding("at_triangle", triangle=first))
        return
    vertices = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
    count, first = bad_in_text(data, lambda line, _: (word for words in vertices.findall(line) for word in words))
    if first is not None:
        before = count_matches(data, vertices, first)
        refuse(count, finding("at_triangle", triangle=before // 3))


def check_obj(data: Data, _path: str) -> None:
    def coordinates(line: bytes, _begin: int) -> list[bytes]:
        words = line.split()
        return words[1:4] if words[:1] == [b"v"] else []

    count, first = bad_in_text(data, coordinates)
    if first is not None:
        before = count_matches(data, re.compile(rb"^[ \t]*v[ \t]", re.MULTILINE), first)
        refuse(count, finding("at_vertex", vertex=before))
