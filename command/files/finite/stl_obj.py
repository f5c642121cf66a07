# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates in .stl and .obj files."""

from __future__ import annotations

import struct

import numpy as np

from ....core.cad.obj_text import check_obj_text
from ....core.streams.findings import AT_ROW
from ....core.streams.misread import Data
from ....core.streams.stl_text import check_stl_text
from ....core.verdict.finding import finding
from .numbers import bad_in_table, refuse


def check_stl(data: Data, _path: str) -> None:
    if len(data) < 84 or len(data) != 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        check_stl_text(data)
        return
    facet = np.dtype({"names": ["at"], "formats": ["9<f4"], "offsets": [12], "itemsize": 50})
    count, first = bad_in_table(np.frombuffer(data, facet, -1, 84)["at"])
    refuse(count, finding(AT_ROW, element="triangle", row=first))


def check_obj(data: Data, _path: str) -> None:
    check_obj_text(data)
