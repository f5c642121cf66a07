# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells of real thickness: the material between a surface and its offset, of any thickness at once.

Thickness is a length in the world, so every surface is mapped there first: instances that differ only by where they
stand share their polynomials, others have their own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import floor, inf, isfinite, log10

import numpy as np
from numpy.typing import NDArray

from ..core.moments import Moments, map_sum, sum_moments
from ..core.offset import Sweep, share, sweep
from ..core.polyhedron import solid_and_area
from ..core.solid import SolidMeasure
from ..core.surface import Surface
from .body import Body
from .read import Reading

WORTH_TELLING = 0.01  # of the thickness
WORDS = {"inward": "inward from the faces", "outward": "outward from the faces",
         "centered": "half inward and half outward from the faces"}
SAME_AREA = 1e-9


@dataclass(frozen=True)
class Walls:
    """The walls of one object, SI units, world axes.

    thin: the body as a thin shell. side: "inward", "outward" or "centered". pieces: the polynomials of each surface,
    and the (k, 3) places where it stands. turned: whether faces had to be turned outward.
    """

    thin: Body
    side: str
    pieces: tuple[tuple[Sweep, NDArray], ...]
    turned: bool

    @property
    def largest(self) -> float:
        """The thickness in m from which a wall folds over."""
        return min(piece.largest(self.side) for piece, _ in self.pieces)

    def body(self, thickness: float, looked: bool = True) -> Body:
        """The body with walls that thick, m. looked: whether walls that meet are looked for, which takes its time.
        ValueError, with the largest thickness that works, where a wall folds over."""
        if not thickness > 0.0:
            raise ValueError("It has no thickness; set one.")
        if not thickness < self.largest:
            raise ValueError(self._folded(thickness))
        inside, outside = share(self.side, thickness)
        moments = []
        for piece, places in self.pieces:
            matrices = np.tile(np.eye(4), (len(places), 1, 1))
            matrices[:, :3, 3] = places
            moments.append(map_sum(piece.moments(inside, outside), matrices))
        wall = sum_moments(moments)
        return replace(self.thin, wall=wall, warnings=(*self.thin.warnings, *self._told(thickness, looked)))

    def moments(self, thickness: float) -> Moments:
        """The volume moments of the material alone."""
        return self.body(thickness, looked=False).wall

    def without_surfaces(self) -> Walls:
        """The same without what is as large as the mesh."""
        return replace(self, thin=replace(self.thin, solids=(), refined=None),
                       pieces=tuple((piece.without_surface(), places) for piece, places in self.pieces))

    def _folded(self, thickness: float) -> str:
        piece, places = min(self.pieces, key=lambda pair: pair[0].largest(self.side))
        near = ""
        if len(piece.points):
            near = " near ({:.6g}, {:.6g}, {:.6g}) m".format(*(piece.fold(self.side) + places[0]))
        if not self.largest > 0.0:
            return ("Faces fold back on their neighbours{:s}, so that a wall has no place there. Merge or mend them, "
                    "choose another side, or set Wall to Thin.".format(near))
        return ("A wall of {:.6g} m, {:s}, folds over on itself{:s}; the largest that works is {:.4g} m. Choose a "
                "thinner one, another side, or set Wall to Thin.".format(
                    thickness, self.side, near, _below(self.largest)))

    def _told(self, thickness: float, looked: bool) -> list[str]:
        notes = ["Its wall was measured as real material, {:.6g} m {:s}, with mitred corners.".format(
            thickness, WORDS[self.side])]
        if self.turned:
            notes.append("Its faces were turned outward before.")
        least, most = (pick(getattr(piece, name) for piece, _ in self.pieces)
                       for pick, name in ((min, "least"), (max, "most")))
        if least < 1.0 - WORTH_TELLING or most > 1.0 + WORTH_TELLING:
            notes.append("Where more than three planes meet, no corner keeps all of them at the thickness: the wall is "
                         "{:.3g} to {:.3g} times as thick there.".format(least, most))
        ignored = sum(piece.ignored for piece, _ in self.pieces)
        if ignored:
            notes.append("{:d} of its faces have no area, and moved along with their neighbours.".format(ignored))
        if not looked:
            notes.append("Whether walls run into each other at this thickness was not looked for; Measure does.")
        elif any(piece.meets_itself(*share(self.side, thickness)) for piece, _ in self.pieces):
            notes.append("Its walls run into each other, and what they share counts twice. Choose a thinner one, or "
                         "another side.")
        return notes


def find_walls(reading: Reading, body: Body, side: str) -> Walls:
    """The walls of an object that was measured as a thin shell. ValueError, with what to do, where a surface has no
    sides."""
    if body.mass is not None:
        raise ValueError("Walls of real thickness have one density; set Wall to Thin, or give it one density.")
    pieces, turned = [], False
    for part, (solid, matrices) in zip(reading.parts, body.solids):
        surface, mended = _oriented(part.surface, solid)
        turned |= mended and solid.method == "reoriented"
        linear, which = np.unique(matrices[:, :3, :3].reshape(-1, 9), axis=0, return_inverse=True)
        for i, row in enumerate(linear):
            pieces.append((sweep(surface.mapped(row.reshape(3, 3))), matrices[which.ravel() == i, :3, 3]))
    return Walls(body, side, tuple(pieces), turned)


def _oriented(surface: Surface, solid: SolidMeasure) -> tuple[Surface, bool]:
    """The surface with its faces outward where it is closed, else as it is; and whether it is the mended one."""
    if solid.method not in {"exact", "reoriented"}:
        return surface, False
    area = solid_and_area(solid.mended)[1].total
    if abs(area - solid.area.total) > SAME_AREA * solid.area.total:  # mending has left something out
        return surface, False
    return solid.mended, True


def _below(length: float) -> float:
    """The length rounded down to four digits, so that what is told works."""
    if not isfinite(length):
        return inf
    unit = 10.0 ** (floor(log10(length)) - 3)
    down = float("{:.4g}".format(floor(length / unit) * unit))
    return down if down < length else float("{:.4g}".format(down - unit))
