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
from ...core.moments.moments import Moments, map_sum, monomials, sum_moments
from ...core.offset.walls import Sweep, share, sweep
from ...core.polyhedron import polyhedron_moments
from ...core.solid.measure_solid import SolidMeasure
from ...core.verdict.finding import Finding, ReadError, finding, unique
from ...core.verdict.tolerances import NEGLIGIBLE
from ..read import Reading
from .body import Body
from .instances import even_surfaces

REPORTED = 0.01  # of the thickness: less unevenness is not reported
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

    def folds(self, side: str, thickness: float) -> bool:
        """Whether the wall folds over, rounded as `moments` rounds."""
        return not thickness / self.scale < self.sweep.largest(side)

    def moments(self, side: str, thickness: float) -> Moments:
        """Of the wall, in SI units."""
        return map_sum(self.sweep.moments(*share(side, thickness / self.scale)), self.matrices)

    def per_thickness(self) -> Moments:
        """Of the wall by its thickness, where that goes to zero."""
        first = Moments(self.sweep.coefficients[:, 0], self.sweep.about, "volume")
        return map_sum(first, self.matrices) * (1.0 / self.scale)

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

    thin: the body as a thin shell. side: "inward", "outward" or "centered". findings: what was decided about the sides.
    """

    thin: Body
    side: str
    pieces: tuple[Piece, ...]
    findings: tuple[Finding, ...]

    @property
    def largest(self) -> float:
        """The thickness in m from which a wall folds over."""
        return min(piece.largest(self.side) for piece in self.pieces)

    def body(self, thickness: float, looked: bool = True) -> Body:
        """The body with walls that thick, m. looked: whether walls that meet are looked for, which takes time.
        ReadError where a wall folds over."""
        if not thickness > 0.0:
            raise ReadError("no_thickness")
        if any(piece.folds(self.side, thickness) for piece in self.pieces):
            raise ReadError(self._folded(thickness))
        wall = sum_moments([piece.moments(self.side, thickness) for piece in self.pieces])
        return replace(
            self.thin, wall=wall, to_order=None, findings=(*self.thin.findings, *self._decisions(thickness, looked))
        )

    def without_surfaces(self) -> Walls:
        """The same without the arrays that are as large as the mesh."""
        return replace(
            self,
            thin=replace(self.thin, solids=(), refined=None),
            pieces=tuple(replace(piece, sweep=piece.sweep.without_surface()) for piece in self.pieces),
        )

    def _folded(self, thickness: float) -> Finding:
        piece = min(self.pieces, key=lambda piece: piece.largest(self.side))
        largest = self.largest
        near = {}
        if len(piece.sweep.points):
            point = piece.matrices[0, :3, :3] @ piece.sweep.fold(self.side) + piece.matrices[0, :3, 3]
            near = {"point": point.tolist()}
        if not largest > 0.0:
            return finding("wall_faces_fold_back" if near else "wall_faces_fold_back_somewhere", **near)
        sizes = {"thickness": thickness, "side": self.side, "largest": _below(largest)}
        return finding("wall_folds" if near else "wall_folds_somewhere", **sizes, **near)

    def _decisions(self, thickness: float, looked: bool) -> list[Finding]:
        findings = [finding("wall_measured", thickness=thickness, side=self.side), *self.findings]
        minimum = float(min(piece.sweep.least for piece in self.pieces))
        maximum = float(max(piece.sweep.most for piece in self.pieces))
        if minimum < 1.0 - REPORTED or maximum > 1.0 + REPORTED:
            slight = self._unevenness() < NEGLIGIBLE
            code = "wall_thickness_varies_slightly" if slight else "wall_thickness_varies"
            findings.append(finding(code, minimum=minimum, maximum=maximum))
        ignored = sum(piece.sweep.ignored for piece in self.pieces)
        if ignored:
            findings.append(finding("wall_faces_without_area", count=ignored))
        if not looked:
            findings.append(finding("wall_overlap_unchecked"))
        elif any(piece.meets_itself(self.side, thickness) for piece in self.pieces):
            findings.append(finding("walls_overlap"))
        elif self._places_meet(thickness):
            findings.append(finding("instance_walls_unchecked"))
        return findings

    def _unevenness(self) -> float:
        """How far the moments to second order of a very thin wall are from those of its surface, by its size."""
        surface = self.thin.area
        center, degree = surface.center, monomials(2).sum(axis=1)
        wall = sum_moments([piece.per_thickness() for piece in self.pieces]).shifted(center).truncated(2).raw
        sheet = surface.shifted(center).truncated(2).raw
        reach = np.sqrt(sheet[(degree == 2) & (monomials(2).max(axis=1) == 2)].sum() / sheet[0])
        return float((np.abs(wall - sheet) / (sheet[0] * reach**degree)).max())

    def _places_meet(self, thickness: float) -> bool:
        centers, extents = zip(*(piece.boxes(self.side, thickness) for piece in self.pieces))
        return boxes_meet(np.concatenate(centers), np.concatenate(extents))


def find_walls(reading: Reading, body: Body, side: str) -> Walls:
    """The walls of an object that was measured as a thin shell. MeasureError where a surface has no sides."""
    if body.mass is not None:
        raise ReadError("wall_needs_one_density")
    pieces, findings = [], []
    for part, (solid, matrices) in zip(reading.parts, body.solids):
        surface = _oriented(part.surface, solid, findings)
        for image, places, _ in even_surfaces(surface, matrices):
            swept = sweep(image)
            scale = np.cbrt(np.abs(np.linalg.det(places[:, :3, :3])))
            _, which = np.unique(np.round(np.log(scale) / SAME_SCALE), return_inverse=True)
            for i in range(int(which.max()) + 1):
                own = which.ravel() == i
                pieces.append(Piece(swept, float(scale[own].mean()), places[own]))
    return Walls(body, side, tuple(pieces), unique(findings))


def _oriented(surface: Surface, solid: SolidMeasure, findings: list[Finding]) -> Surface:
    """The surface with its faces outward where it is closed, else as it is."""
    if solid.method in {"exact", "reoriented"}:
        area = polyhedron_moments(solid.mended, area_order=0)[1].total
        if abs(area - solid.area.total) <= SAME_AREA * solid.area.total:  # else the repair has left something out
            if solid.method == "reoriented":
                findings.append(finding("wall_faces_reversed"))
            return solid.mended
    findings.append(finding("wall_unoriented"))
    return surface


def _below(length: float) -> float:
    """The length rounded down to four digits, so that the length that is named works."""
    if not isfinite(length):
        return inf
    unit = 10.0 ** (floor(log10(length)) - 3)
    down = float("{:.4g}".format(floor(length / unit) * unit))
    return down if down < length else float("{:.4g}".format(down - unit))
