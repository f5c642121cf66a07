# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The method behind numbers: the kind of body that was measured, and the steps that were needed."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Procedure(StrEnum):
    """The procedure that a body needed.

    The first four are of solids, the least trustworthy first.
    """

    OPEN = "open"  # bounds no certain volume: not to be closed, flat, or mostly within itself
    CAPPED = "capped"  # closed by caps over its holes
    REORIENTED = "reoriented"  # closed after faces were flipped
    EXACT = "exact"  # closed as it is
    UNION = "union"  # overlapping components united first
    SHELL = "shell"  # a sheet or a wall
    WIRE = "wire"  # a curve
    GIVEN = "given"  # a mass that is known, without geometry
    ASSEMBLY = "assembly"  # several bodies as one

    @property
    def is_closed(self) -> bool:
        """True if the surface encloses the measured volume."""
        return self in (Procedure.CAPPED, Procedure.REORIENTED, Procedure.EXACT, Procedure.UNION)


class Source(StrEnum):
    """The source of the geometry: the word before the procedure, empty for polygons."""

    POLYGONS = ""
    NURBS = "NURBS"
    GRID = "grid"


@dataclass(frozen=True)
class Method:
    """The way a body was measured; `str` is the public contract's `method`.

    Parameters
    ----------
    procedure : Procedure
    source : Source

    Examples
    --------
    >>> from body_moments.core.verdict import Method
    >>> from body_moments.core.verdict.method import Procedure, Source
    >>> str(Method(Procedure.EXACT, Source.NURBS)), str(Method.parse("NURBS exact").source)
    ('NURBS exact', 'NURBS')
    """

    procedure: Procedure
    source: Source = Source.POLYGONS

    def __str__(self) -> str:
        return " ".join(filter(None, (self.source.value, self.procedure.value)))

    @classmethod
    def parse(cls, text: str) -> Method | None:
        """Return the method that `str` has written; None for any other text."""
        source, _, procedure = text.rpartition(" ")
        try:
            return cls(Procedure(procedure), Source(source))
        except ValueError:
            return None


def least_trusted(procedures: list[Procedure]) -> Procedure:
    """Return the least trustworthy procedure of several solids."""
    ranking = list(Procedure)
    return min(procedures, key=ranking.index, default=Procedure.OPEN)
