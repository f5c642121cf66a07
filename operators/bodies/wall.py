# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells of real thickness: the material between a surface and its offset, of any thickness at once.

Thickness is a length in the world. Under a similarity an offset stays one, so that a surface and its instances share
their polynomials; for other maps the surface is mapped to the world first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import floor, inf, isfinite, log10

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.boxes import boxes_meet
from ...core.mesh.surface import Surface
from ...core.moments.moments import Moments, map_sum, sum_moments
from ...core.offset.walls import Sweep, share, sweep
from ...core.polyhedron import polyhedron_moments
from ...core.solid.measure_solid import SolidMeasure
from ..read import Reading
from .body import Body
from .instances import even_surfaces

WORTH_TELLING = 0.01  # of the thickness
WORDS = {
    "inward": "inward from the faces",
    "outward": "outward from the faces",
    "centered": "half inward and half outward from the faces",
}
SAME_AREA = 1e-9
SAME_SCALE = 1e-6  # what float32 matrices leave of one scale


@dataclass(frozen=True)
class Piece:
    """One surface. sweep: its polynomials. scale: m for each of its units. matrices: (k, 4, 4) to where it stands."""

    sweep: Sweep
    scale: float
    matrices: NDArray[np.float64]

    def largest(self, side: str) -> float:
        """The thickness in m from which the wall folds over."""
        return self.sweep.largest(side) * self.scale

    def moments(self, side: str, thickness: float) -> Moments:
        """Of the wall, in SI units."""
        return map_sum(self.sweep.moments(*share(side, thickness / self.scale)), self.matrices)

    def meets_itself(self, side: str, thickness: float) -> bool:
        """Whether the wall runs into itself."""
        return self.sweep.meets_itself(*share(side, thickness / self.scale))

    def boxes(self, side: str, thickness: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(k, 3) the middles and (k, 3) half the sides of boxes around the wall where it stands, in m."""
        low, high = self.sweep.box(*share(side, thickness / self.scale))
        linear = self.matrices[:, :3, :3]
        return linear @ ((low + high) / 2.0) + self.matrices[:, :3, 3], np.abs(linear) @ ((high - low) / 2.0)


@dataclass(frozen=True)
class Walls:
    """The walls of one object, SI units, world axes.

    thin: the body as a thin shell. side: "inward", "outward" or "centered". notes: what was decided about the sides.
    """

    thin: Body
    side: str
    pieces: tuple[Piece, ...]
    notes: tuple[str, ...]

    @property
    def largest(self) -> float:
        """The thickness in m from which a wall folds over."""
        return min(piece.largest(self.side) for piece in self.pieces)

    def body(self, thickness: float, looked: bool = True) -> Body:
        """The body with walls that thick, m. looked: whether walls that meet are looked for, which takes time.
        ValueError, with the largest thickness that works, where a wall folds over."""
        if not thickness > 0.0:
            raise ValueError("It has no thickness; set one.")
        if not thickness < self.largest:
            raise ValueError(self._folded(thickness))
        wall = sum_moments([piece.moments(self.side, thickness) for piece in self.pieces])
        return replace(
            self.thin, wall=wall, to_order=None, warnings=(*self.thin.warnings, *self._told(thickness, looked))
        )

    def without_surfaces(self) -> Walls:
        """The same without the arrays that are as large as the mesh."""
        return replace(
            self,
            thin=replace(self.thin, solids=(), refined=None),
            pieces=tuple(replace(piece, sweep=piece.sweep.without_surface()) for piece in self.pieces),
        )

    def _folded(self, thickness: float) -> str:
        piece = min(self.pieces, key=lambda piece: piece.largest(self.side))
        near = ""
        if len(piece.sweep.points):
            place = piece.matrices[0, :3, :3] @ piece.sweep.fold(self.side) + piece.matrices[0, :3, 3]
            near = " near ({:.6g}, {:.6g}, {:.6g}) m".format(*place)
        if not self.largest > 0.0:
            return (
                "Faces fold back on their neighbours{:s}, so that a wall has no place there. Merge or mend them, "
                "choose another side, or set Wall to Thin.".format(near)
            )
        return (
            "A wall of {:.6g} m, {:s}, folds over on itself{:s}; the largest that works is {:.4g} m. Choose a "
            "thinner one, another side, or set Wall to Thin.".format(thickness, self.side, near, _below(self.largest))
        )

    def _told(self, thickness: float, looked: bool) -> list[str]:
        notes = [
            "Its wall was measured as real material, {:.6g} m {:s}, with mitred corners.".format(
                thickness, WORDS[self.side]
            )
        ]
        notes.extend(self.notes)
        least = min(piece.sweep.least for piece in self.pieces)
        most = max(piece.sweep.most for piece in self.pieces)
        if least < 1.0 - WORTH_TELLING or most > 1.0 + WORTH_TELLING:
            notes.append(
                "Where more than three planes meet, or two in a blade, no corner keeps all of them at the "
                "thickness: the wall is {:.3g} to {:.3g} times as thick there.".format(least, most)
            )
        ignored = sum(piece.sweep.ignored for piece in self.pieces)
        if ignored:
            notes.append(
                "{:d} of its faces have too little area to face anywhere, and moved along with their "
                "neighbours.".format(ignored)
            )
        if not looked:
            notes.append("Whether walls run into each other at this thickness was not looked for; Measure does.")
        elif any(piece.meets_itself(self.side, thickness) for piece in self.pieces):
            notes.append(
                "Its walls run into each other, and what they share counts twice. Choose a thinner one, or "
                "another side."
            )
        elif self._places_meet(thickness):
            notes.append(
                "The walls of its instances may run into each other, and what they share counts twice: that "
                "was not looked for between instances. Make them real and join them to know."
            )
        return notes

    def _places_meet(self, thickness: float) -> bool:
        centers, extents = zip(*(piece.boxes(self.side, thickness) for piece in self.pieces))
        return boxes_meet(np.concatenate(centers), np.concatenate(extents))


def find_walls(reading: Reading, body: Body, side: str) -> Walls:
    """The walls of an object that was measured as a thin shell. ValueError, with what to do, where a surface has no
    sides."""
    if body.mass is not None:
        raise ValueError("Walls of real thickness have one density; set Wall to Thin, or give it one density.")
    pieces, notes = [], []
    for part, (solid, matrices) in zip(reading.parts, body.solids):
        surface = _oriented(part.surface, solid, notes)
        for image, places, _ in even_surfaces(surface, matrices):
            swept = sweep(image)
            scale = np.cbrt(np.abs(np.linalg.det(places[:, :3, :3])))
            _, which = np.unique(np.round(np.log(scale) / SAME_SCALE), return_inverse=True)
            for i in range(int(which.max()) + 1):
                own = which.ravel() == i
                pieces.append(Piece(swept, float(scale[own].mean()), places[own]))
    return Walls(body, side, tuple(pieces), tuple(dict.fromkeys(notes)))


def _oriented(surface: Surface, solid: SolidMeasure, notes: list[str]) -> Surface:
    """The surface with its faces outward where it is closed, else as it is."""
    if solid.method in {"exact", "reoriented"}:
        area = polyhedron_moments(solid.mended, area_order=0)[1].total
        if abs(area - solid.area.total) <= SAME_AREA * solid.area.total:  # else mending has left something out
            if solid.method == "reoriented":
                notes.append("Its faces were turned outward before.")
            return solid.mended
    notes.append("It is not closed, so that inward is what lies behind its faces as they are turned now.")
    return surface


def _below(length: float) -> float:
    """The length rounded down to four digits, so that the length that is named works."""
    if not isfinite(length):
        return inf
    unit = 10.0 ** (floor(log10(length)) - 3)
    down = float("{:.4g}".format(floor(length / unit) * unit))
    return down if down < length else float("{:.4g}".format(down - unit))
