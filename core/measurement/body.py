# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The moments of a measured body of any kind, and their method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from ..inertia.principal_frames import OwnMoments
from ..mesh.surface import Surface
from ..moments.moments import Moments
from ..verdict.finding import Finding, ReadError
from ..verdict.health import MeshHealth
from ..verdict.method import Method
from .findings import WALL_UNSUPPORTED


@dataclass(frozen=True, eq=False)
class Body:
    """The moments of a whole object, in SI units and world axes; the base class knows them to third order only.

    `volume`: known to third order at least. `length`: of a wire. `wall`: the material of a shell of real thickness.
    `mass`: moments in kg of a body of varying density; `higher_mass`: the same to the requested order, above third.
    `density_from`: source of a varying density, with a code ``density_from_…``.
    `density_key`: settings that decide a varying density, for the fingerprint; `materials`: full names of those read.
    `estimated`: true if the error bounds are estimates.
    `display_volume`: volume of the display mesh, m³, for a body that is measured without it.
    `face_count`: number of measured triangles and quads.
    """

    any_order: ClassVar[bool] = False  # true if `moments` gives any order
    has_surface: ClassVar[bool] = False  # true if `surfaces` yields any

    volume: Moments
    area: Moments
    health: MeshHealth
    method: Method
    findings: tuple[Finding, ...]
    mass: Moments | None = None
    higher_mass: Moments | None = None
    density_from: Finding | None = None
    density_key: str = ""
    materials: tuple[str, ...] = ()
    wall: Moments | None = None
    length: Moments | None = None
    estimated: bool = False
    display_volume: float | None = None
    face_count: int = 0

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume, and of the area if wanted, to an order; ReadError if they are unknown."""
        raise ReadError(WALL_UNSUPPORTED, quantity="A moment above third order or of the area")

    def third_order(self) -> Moments:
        """Return the moments of a solid or a wire that its principal frame is computed from, with exact third order."""
        return self.volume

    def moments_for_axes(self, order: int, area: bool) -> Moments | OwnMoments:
        """Return the moments that fix the axes, in own coordinates if of one surface under a similarity."""
        volume, areas = self.moments(order, area)
        return volume if areas is None else areas

    def surfaces(self, sheets: bool) -> Iterator[Surface]:
        """Yield the surfaces of the solid, or the unchanged sheets, in world coordinates as float64."""
        return iter(())
