# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of one measurement: all values that influence its results, besides the geometry.

A fingerprint is a text that stands for all inputs of stored numbers: geometry, transform and
settings.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

from ..numerics import shortest_decimal

VERSION = "v1"


@dataclass(frozen=True, kw_only=True)
class RequestedResults:
    """Results that a measurement has on request.

    order: of the moments; None for the order that mass properties need. surface: area moments, too.
    compare: bodies that need no display mesh are compared with it.
    """

    order: int | None = None
    surface: bool = False
    compare: bool = True
    threads: int = 1


@dataclass(frozen=True)
class Settings(RequestedResults):
    """Settings of one object's measurement, in SI units; at most one of density and mass is given.

    kind: "solid", "shell" or "wire". density: kg/m³, of a wire kg/m; mass: kg. thickness: of a
    shell, m. overlap: "signed" or "union". wall: of a shell, "thin", "inward", "outward" or
    "centered". unit: meters per Blender unit. varying: text of the settings that decide a varying
    density or a given center or inertia.
    """

    kind: str = "solid"
    density: float | None = None
    mass: float | None = None
    thickness: float = 0.0
    overlap: str = "signed"
    wall: str = "thin"
    unit: float = 1.0
    varying: str = ""

    @property
    def digest(self) -> str:
        """Digest of the settings behind stored results, without those that have no effect on this
        kind of body.
        """
        is_shell = self.kind == "shell"
        density = None if self.varying else self.density
        # Blender's properties hold values with the shortest decimals.
        density, mass = [
            None if value is None else shortest_decimal(value) for value in (density, self.mass)
        ]
        used = [
            self.kind.upper(),
            density,
            mass,
            float("{:.6g}".format(self.thickness)) if is_shell else None,
            self.overlap.upper() if self.kind == "solid" else None,
            round(self.unit, 12),
            *([self.varying] if self.varying else []),
            *([self.wall.upper()] if is_shell and self.wall != "thin" else []),
        ]
        return digest(repr(used).encode())


def fingerprint(geometry: bytes, matrix: str, settings: str) -> str:
    """Return the text stored as `body_fingerprint`: version, then the three digests."""
    return ":".join([VERSION, digest(geometry), matrix, settings])


def digest(data: bytes) -> str:
    """Return a digest of the data as 12 hexadecimal digits."""
    return hashlib.blake2s(data, digest_size=6).hexdigest()
