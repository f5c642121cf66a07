# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of records about parts of bodies, and cut and fill. SI units, world frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mesh import Surface
from ..moments import Moments
from ..verdict import Finding, MeasureError, finding
from .findings import COMPARED_IN_PART, LEVEL_UNAVAILABLE, PLANE_MISSES
from .hollow import find_hollow
from .open_surfaces import CutFill
from .part_below import measure_below

MAX_LEFT_OUT = 1e-9  # share of the area
TABLE_ROWS = 33
UP = (0.0, 0.0, 1.0)


def below_record(surface: Surface, level: float) -> dict[str, Any]:
    """Return the entry `below` of a closed surface; MeasureError if the plane misses it."""
    low, high = surface.box
    if not low[2] < level < high[2]:
        raise MeasureError(LEVEL_UNAVAILABLE, fault=PLANE_MISSES)
    triangles = surface.all_triangles()[0]
    below = measure_below(surface.points, triangles, [UP], [level], surface.coordinate_error)
    part, face = below.part.at(0), below.face.at(0)
    return {
        "level": level,
        **_moments("volume", part),
        "face": _moments("area", face),
        "error_bound": {
            "volume": part.rounding_error[0],
            "face": face.rounding_error[0],
            "input": {"volume": part.input_error[0], "face": face.input_error[0]},
        },
    }


def contents_record(surface: Surface, level: float) -> dict[str, Any] | None:
    """Return the entry `contents`: the liquid in a vessel up to a level; None if it has no hollow
    there.
    """
    try:
        hollow = find_hollow(surface.points, surface.all_triangles()[0])
        liquid = hollow.contents(level)
    except MeasureError:
        return None
    free = hollow.free_surface(liquid, level)
    levels = np.linspace(hollow.bottom, hollow.spill, TABLE_ROWS)
    return {
        **_moments("volume", liquid.part.at(0)),
        "surface": None if free is None else _moments("area", free),
        "bottom": hollow.bottom,
        "spill": hollow.spill,
        "capacity": hollow.capacity,
        "table": {"levels": levels, "volumes": hollow.below(levels).volume},
    }


def _moments(name: str, moments: Moments) -> dict[str, Any]:
    """Return the entries of a total, named, its center and its second moments about that."""
    central = moments.about_center()
    return {
        name: moments.total,
        "center": central.about,
        "second_moments": central.second(),
    }


def partly_compared(volumes: CutFill) -> tuple[Finding, ...]:
    """Return a finding if a part of the surface has no counterpart."""
    if volumes.compared > 1.0 - MAX_LEFT_OUT:
        return ()
    return (finding(COMPARED_IN_PART, share=volumes.compared),)


def cut_fill_record(volumes: CutFill, against: str) -> dict[str, Any]:
    """Return the entry `cut_fill`. against: the height, `rim`, or the other object's name."""
    sides = {
        name: {
            "volume": part.total,
            "area": area,
            "center": part.center if part.total > 0.0 else None,
        }
        for name, part, area in (
            ("cut", volumes.cut, volumes.cut_area),
            ("fill", volumes.fill, volumes.fill_area),
        )
    }
    rounding = float(volumes.cut.rounding_error[0] + volumes.fill.rounding_error[0])
    moved = float(volumes.cut.input_error[0] + volumes.fill.input_error[0])
    plane = None
    if volumes.offset is not None:
        plane = {"normal": volumes.normal, "offset": volumes.offset}
    return {
        "against": against,
        "plane": plane,
        **sides,
        "net": volumes.net,
        "compared": volumes.compared,
        "error_bound": {"net": rounding, "input": {"net": moved}},
    }
