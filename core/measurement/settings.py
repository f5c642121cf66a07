# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of one measurement: all values that influence its results, besides the geometry.

A fingerprint is a text that stands for all inputs of stored numbers: geometry, transform and
settings.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from .. import numerics, verdict
from ..wall import PRINT_UNFIT

VERSION = "v1"


class Pocket(NamedTuple):
    """A ball in a print that is filled with ballast: its center in the object's coordinates, in
    Blender units; radius, m; density, kg/m³.
    """

    center: tuple[float, ...]
    radius: float
    density: float


class PrintSettings(NamedTuple):
    """How a body is printed: counts of walls and of top and bottom layers, with the width of a wall
    and the height of a layer in m; infill in percent of the core; price of a spool of filament and
    its weight in kg, 0 without a price; a pocket of ballast.
    """

    walls: int = 2
    line_width: float = 0.00042
    top: int = 4
    bottom: int = 4
    layer_height: float = 0.0002
    infill: float = 15.0
    price: float = 0.0
    spool: float = 1.0
    pocket: Pocket | None = None

    @property
    def wall(self) -> float:
        """Width of all walls, m."""
        return self.walls * self.line_width

    def check(self) -> None:
        """Raise ReadError if nothing can be printed with these settings."""
        if not 0.0 <= self.infill <= 100.0:
            raise verdict.ReadError(PRINT_UNFIT, fault="its infill is not from 0 to 100 %")
        is_counted = min(self.walls, self.top, self.bottom) >= 0
        if not (is_counted and min(self.line_width, self.layer_height, self.spool) > 0.0):
            raise verdict.ReadError(
                PRINT_UNFIT, fault="a count, width, height or weight is not positive"
            )

    def record(self) -> dict[str, Any]:
        """Return the entry `print` of a record, without the price of the spool and the pocket."""
        values = self._asdict()
        del values["price"], values["spool"], values["pocket"]
        return values


@dataclass(frozen=True)
class Settings:
    """Settings of one object's measurement, in SI units; at most one of density and mass is given.

    kind: "solid", "shell", "printed" or "wire". density: kg/m³, of a wire kg/m; mass: kg.
    thickness: of a shell, m. overlap: "signed" or "union". wall: of a shell, "thin", "inward",
    "outward" or "centered". unit: meters per Blender unit. varying: text of the settings that
    decide a varying density or a given center or inertia. printed: of a print.
    order: of the requested moments; None for the order that mass properties need. surface: area
    moments, too. compare: bodies that need no display mesh are compared with it.
    """

    kind: str = "solid"
    density: float | None = None
    mass: float | None = None
    thickness: float = 0.0
    overlap: str = "signed"
    wall: str = "thin"
    unit: float = 1.0
    varying: str = ""
    printed: PrintSettings = PrintSettings()
    order: int | None = None
    surface: bool = False
    compare: bool = True
    threads: int = 1

    @cached_property
    def digest(self) -> str:
        """Digest of the settings behind stored results, without those that have no effect on this
        kind of body.
        """
        is_shell = self.kind == "shell"
        density = None if self.varying else self.density
        # Blender's properties hold values with the shortest decimals.
        density, mass = [
            None if value is None else numerics.shortest_decimal(value)
            for value in (density, self.mass)
        ]
        printed = list(self.printed[:-1])
        if (pocket := self.printed.pocket) is not None:
            printed += [*pocket.center, pocket.radius, pocket.density]
        used = [
            self.kind.upper(),
            density,
            mass,
            float("{:.6g}".format(self.thickness)) if is_shell else None,
            self.overlap.upper() if self.kind in ("solid", "printed") else None,
            round(self.unit, 12),
            *([self.varying] if self.varying else []),
            *([self.wall.upper()] if is_shell and self.wall != "thin" else []),
            *(map("{:.6g}".format, printed) if self.kind == "printed" else []),
        ]
        return digest(repr(used).encode())


def fingerprint(geometry: bytes, matrix: str, settings: str) -> str:
    """Return the text stored as `body_fingerprint`: version, then the three digests."""
    return ":".join([VERSION, digest(geometry), matrix, settings])


def digest(data: bytes) -> str:
    """Return a digest of the data as 12 hexadecimal digits."""
    return hashlib.blake2s(data, digest_size=6).hexdigest()
