# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What reading and measuring any kind of object comes to: its moments, and how they came about.

Each kind has a file that makes one: `mesh_body` for whatever Blender shows as polygons.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from numpy.typing import NDArray

from ..core.moments import Moments
from ..core.solid import Health, SolidMeasure


@dataclass(frozen=True)
class Body:
    """All parts of an object together, in SI units and world axes.

    volume, area: their moments, the volume's to order 3 at least. mass: of a body whose density is not one number, its
    moments in kg; else None.
    method, warnings: as in `Measurement`.
    refined: gives what the principal frame is made from, with exact third order, where its bounds leave it undecided.
    length: of a wire, its moments; else None.
    sheet: of a shell with real thickness, its volume's moments; else None, and the area times the thickness counts.
    display_volume: of a body that is measured without its display mesh, what that would have given, m³; else None.
    solids: the surfaces that were measured, and the (k, 4, 4) maps to where each stands.
    """

    volume: Moments
    area: Moments
    health: Health
    method: str
    warnings: tuple[str, ...]
    mass: Moments | None = None
    refined: Callable[[], Moments] | None = None
    length: Moments | None = None
    sheet: Moments | None = None
    display_volume: float | None = None
    solids: tuple[tuple[SolidMeasure, NDArray], ...] = ()
