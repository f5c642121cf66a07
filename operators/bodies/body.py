# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What reading and measuring any kind of object comes to: its moments, and how they came about.

Each kind has a file that makes one: `mesh_body` for whatever Blender shows as polygons.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from numpy.typing import NDArray

from ...core.mesh.surface import Surface
from ...core.moments.moments import Moments
from ...core.solid.measure_solid import SolidIntegrals
from ...core.verdict.finding import Finding
from ...core.verdict.health import MeshReport


@dataclass(frozen=True)
class MeasuredBody:
    """All parts of an object together, in SI units and world axes.

    volume, area: their moments, the volume's to order 3 at least. mass: of a body whose density is not one number, its
    moments in kg; else None.
    wall: of a shell of real thickness, the volume moments of its material; None of a thin one.
    method, findings: as in `Measurement`.
    third_order: gives what the principal frame is made from, with exact third order, where its bounds leave it
    undecided.
    length: of a wire, its moments; else None.
    estimated: whether the bounds of its errors are estimates.
    display_volume: of a body that is measured without its display mesh, what that would have given, m³; else None.
    moments: gives the volume's and the area's moments to a higher order: (order, area wanted), and None for an area
        that is not; itself None where only moments to order 3 are known.
    solids: the surfaces that were measured, and the (k, 4, 4) maps to where each stands.
    surfaces: gives the surfaces where they stand, in float64: around what is solid, or the sheets as they are (sheets
        wanted).
    face_count: how many triangles and quads were measured.
    """

    volume: Moments
    area: Moments
    health: MeshReport
    method: str
    findings: tuple[Finding, ...]
    mass: Moments | None = None
    wall: Moments | None = None
    third_order: Callable[[], Moments] | None = None
    length: Moments | None = None
    estimated: bool = False
    display_volume: float | None = None
    moments: Callable[[int, bool], tuple[Moments, Moments | None]] | None = None
    solids: tuple[tuple[SolidIntegrals, NDArray], ...] = ()
    surfaces: Callable[[bool], Iterator[Surface]] | None = None
    face_count: int = 0
