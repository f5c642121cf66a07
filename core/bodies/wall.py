# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells of real thickness: the material between a surface and its offset, of any thickness at
once.

Thickness is a length in the world. A similarity maps an offset surface to an offset surface, so
that a surface and its similar instances share one polynomial; for any other map the surface is
mapped to the world first.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import floor, inf, isfinite, log10
from typing import ClassVar

import numpy as np

from .. import cuts, mesh, polyhedron
from ..measurement import WALL_UNSUPPORTED, ZERO_QUANTITY, Body
from ..moments import (
    KNOWN_ORDER,
    Measure,
    Moments,
    monomials,
    placed_boxes,
    sum_moments,
    sum_of_images,
)
from ..numerics import Array
from ..solid import (
    COMPONENTS_OVERLAP,
    INVERTED_COMPONENTS,
    OVERLAP_OF_INSTANCES,
    UNCHECKED,
    SolidIntegrals,
)
from ..verdict import (
    FLIPPED_FACES,
    NEGLIGIBLE,
    Finding,
    MeasureError,
    Procedure,
    ReadError,
    finding,
    unique,
)
from ..wall import WALL_MEASURED, OffsetSolid, offset_solid, split_thickness, wall_moments
from . import instances, mesh_body
from .findings import (
    WALL_FACES_WITHOUT_AREA,
    WALL_FOLDS,
    WALL_THICKNESS_VARIES,
    WALL_UNORIENTED,
    WALLS_OVERLAP,
)
from .reading import Reading

OPENED = Procedure.OPEN, Procedure.CAPPED, Procedure.SHELL
REPORTED = 0.01  # relative to the thickness: smaller unevenness is not reported
SAME_AREA_RTOL = 1e-9
SAME_SCALE_RTOL = 1e-6  # equal scales in float32 matrices differ by up to this share


@dataclass(frozen=True)
class WallPiece:
    """The offset polynomials of a surface, its scale in m per unit of the surface, and (k, 4, 4)
    maps to its places.
    """

    offset: OffsetSolid
    scale: float
    matrices: Array

    def max_thickness(self, side: str) -> float:
        """Return the thickness in m from which the wall folds over."""
        return self.offset.max_thickness(side) * self.scale

    def folds(self, side: str, thickness: float) -> bool:
        """Return whether the wall folds over, with the same rounding of the thickness as in
        `moments`.
        """
        return not thickness / self.scale < self.offset.max_thickness(side)

    def moments(self, side: str, thickness: float, order: int = KNOWN_ORDER) -> Moments:
        """Return the moments of the wall, in SI units."""
        reach = split_thickness(side, thickness / self.scale)
        if order <= KNOWN_ORDER:
            wall = self.offset.moments(*reach)
        else:
            wall = wall_moments(self.offset, *reach, order)
        return sum_of_images(wall, self.matrices)

    def surfaces(self, side: str, thickness: float) -> Iterator[mesh.Surface]:
        """Yield the closed surfaces of the wall in its places, in m."""
        wall = self.offset.surface(*split_thickness(side, thickness / self.scale))
        return (wall.transform(matrix[:3, :3], matrix[:3, 3]) for matrix in self.matrices)

    def per_thickness(self) -> Moments:
        """Return the wall's moments per thickness, in the limit of zero thickness."""
        # The first coefficient of the polynomials is the wall's derivative by the thickness.
        first = Moments(self.offset.coefficients[:, 0], self.offset.about, Measure.VOLUME)
        return sum_of_images(first, self.matrices) * (1.0 / self.scale)

    def self_intersects(self, side: str, thickness: float) -> bool:
        """Return whether the wall intersects itself."""
        return self.offset.self_intersects(*split_thickness(side, thickness / self.scale))

    def boxes(self, side: str, thickness: float) -> tuple[Array, Array]:
        """Return (k, 3) middles and (k, 3) half sides of boxes around the wall in its places,
        in m.
        """
        return placed_boxes(
            self.offset.box(*split_thickness(side, thickness / self.scale)), self.matrices
        )


@dataclass(frozen=True)
class Walls:
    """The walls of one object, SI units, world axes.

    thin: the body as a thin shell. side: "inward", "outward" or "centered". findings: the decisions
    about the sides.
    """

    thin: Body
    side: str
    pieces: tuple[WallPiece, ...]
    findings: tuple[Finding, ...]

    @property
    def max_thickness(self) -> float:
        """The thickness in m from which a wall folds over."""
        return min(piece.max_thickness(self.side) for piece in self.pieces)

    def body(self, thickness: float, check_overlap: bool = True) -> WallBody:
        """Return the body with walls of a thickness, m, or raise ReadError; `check_overlap` takes
        time.
        """
        if not thickness > 0.0:
            raise ReadError(ZERO_QUANTITY, quantity="thickness")
        if any(piece.folds(self.side, thickness) for piece in self.pieces):
            raise ReadError(self._folded_reason(thickness))
        wall = sum_moments([piece.moments(self.side, thickness) for piece in self.pieces])
        thin = self.thin
        return WallBody(
            thin.volume,
            thin.area,
            thin.health,
            thin.method,
            (*thin.findings, *self._decisions(thickness, check_overlap)),
            wall=wall,
            face_count=thin.face_count,
            walls=self,
            thickness=thickness,
        )

    def drop_arrays(self) -> Walls:
        """Return a copy without the arrays that are as large as the mesh."""
        return replace(
            self,
            thin=Body(
                self.thin.volume,
                self.thin.area,
                self.thin.health,
                self.thin.method,
                self.thin.findings,
            ),
            pieces=tuple(
                replace(piece, offset=piece.offset.drop_arrays()) for piece in self.pieces
            ),
        )

    def _folded_reason(self, thickness: float) -> Finding:
        """Return the finding about the wall that folds over first, with the (3,) point in m where
        it does.
        """
        piece = min(self.pieces, key=lambda piece: piece.max_thickness(self.side))
        point = None
        if len(piece.offset.points):  # else they were dropped (`drop_arrays`)
            matrix = piece.matrices[0]
            location = piece.offset.first_fold_location(self.side)
            point = (matrix[:3, :3] @ location + matrix[:3, 3]).tolist()
        return finding(
            WALL_FOLDS,
            thickness=thickness,
            side=self.side,
            largest=_round_down(self.max_thickness),
            point=point,
        )

    def _decisions(self, thickness: float, check_overlap: bool) -> list[Finding]:
        """Return findings about the walls of a thickness, m."""
        findings = [finding(WALL_MEASURED, thickness=thickness, side=self.side), *self.findings]
        minimum = float(min(piece.offset.min_ratio for piece in self.pieces))
        maximum = float(max(piece.offset.max_ratio for piece in self.pieces))
        if minimum < 1.0 - REPORTED or maximum > 1.0 + REPORTED:
            slight = self._unevenness() < NEGLIGIBLE
            findings.append(
                finding(WALL_THICKNESS_VARIES, slight=slight, minimum=minimum, maximum=maximum)
            )
        ignored = sum(piece.offset.degenerate_triangles for piece in self.pieces)
        if ignored:
            findings.append(finding(WALL_FACES_WITHOUT_AREA, count=ignored))
        if not check_overlap:
            findings.append(
                finding(
                    UNCHECKED, subject="the overlap of the walls at this thickness. Press Measure"
                )
            )
        elif any(piece.self_intersects(self.side, thickness) for piece in self.pieces):
            findings.append(finding(WALLS_OVERLAP))
        else:
            centers, extents = zip(*(piece.boxes(self.side, thickness) for piece in self.pieces))
            if mesh.boxes_overlap(np.concatenate(centers), np.concatenate(extents)):
                findings.append(finding(UNCHECKED, subject=OVERLAP_OF_INSTANCES))
        return findings

    def _unevenness(self) -> float:
        """Return the largest relative difference of moments (order 0 to 2) between a very thin wall
        and the surface.
        """
        surface = self.thin.area
        center = surface.center
        degree = monomials(2).sum(axis=1)
        wall = (
            sum_moments([piece.per_thickness() for piece in self.pieces])
            .about_point(center)
            .truncate(2)
            .raw
        )
        sheet = surface.about_point(center).truncate(2).raw
        # The radius of gyration about the center, from the moments of x², y² and z².
        reach = np.sqrt(sheet[(degree == 2) & (monomials(2).max(axis=1) == 2)].sum() / sheet[0])
        return float((np.abs(wall - sheet) / (sheet[0] * reach**degree)).max())


@dataclass(frozen=True, eq=False)
class WallBody(Body):
    """A shell of real thickness, m, with the `walls` from which it was made."""

    any_order: ClassVar[bool] = True

    walls: Walls = field(kw_only=True)
    thickness: float = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the wall, and of the surface itself."""
        walls = self.walls
        wall = sum_moments(
            [piece.moments(walls.side, self.thickness, order) for piece in walls.pieces]
        )
        return wall, walls.thin.moments(order, True)[1] if area else None

    def surfaces(self, sheets: bool) -> Iterator[mesh.Surface]:
        """Yield the closed surfaces of the walls in world coordinates; no `sheets`."""
        for piece in () if sheets else self.walls.pieces:
            yield from piece.surfaces(self.walls.side, self.thickness)


def vessel_surface(body: Body) -> mesh.Surface:
    """Return the walls of a body as a vessel, whose holes are open; MeasureError if it has none, or
    components overlap.
    """
    solids = body.solids if isinstance(body, mesh_body.MeshBody) else ()
    findings = [*body.findings, *(each for solid, _ in solids for each in solid.findings)]
    if any(each.code == COMPONENTS_OVERLAP for each in findings):
        raise MeasureError(cuts.LEVEL_UNAVAILABLE, fault=cuts.SHARED_SPACE)
    is_whole = isinstance(body, WallBody) or body.method.procedure not in OPENED
    surfaces = [*body.surfaces(not is_whole)]
    if not surfaces:
        raise MeasureError(cuts.LEVEL_UNAVAILABLE, fault=cuts.SURFACE_NEEDED)
    return mesh.join_surfaces(surfaces)


def find_walls(reading: Reading, body: mesh_body.MeshBody, side: str) -> Walls:
    """Return the walls of an object measured as a thin shell, or raise MeasureError if a surface
    has no sides.
    """
    if body.mass is not None:
        raise ReadError(WALL_UNSUPPORTED, quantity="A varying density")
    pieces = []
    findings = []
    for part, (solid, matrices) in zip(reading.parts, body.solids):
        surface, decisions = _orient_outward(part.surface, solid)
        findings += decisions
        for image, image_matrices, _ in instances.group_by_similarity(surface, matrices):
            offset = offset_solid(image)
            scales = np.cbrt(np.abs(np.linalg.det(image_matrices[:, :3, :3])))
            rounded = np.round(np.log(scales) / SAME_SCALE_RTOL)
            for scale in np.unique(rounded):
                has_scale = rounded == scale
                mean_scale = float(scales[has_scale].mean())
                pieces.append(WallPiece(offset, mean_scale, image_matrices[has_scale]))
    return Walls(body, side, tuple(pieces), unique(findings))


def _orient_outward(
    surface: mesh.Surface, solid: SolidIntegrals
) -> tuple[mesh.Surface, list[Finding]]:
    """Return the surface with faces outward if it is closed, else as it is; and findings."""
    unoriented = surface, [finding(WALL_UNORIENTED)]
    if solid.method not in (Procedure.EXACT, Procedure.REORIENTED):
        return unoriented
    repaired = solid.repaired_surface
    area = polyhedron.polyhedron_moments(repaired, area_order=0, allow_open=True)[1].total
    if abs(area - solid.area.total) > SAME_AREA_RTOL * solid.area.total:
        return unoriented  # The repair has removed faces.
    turns = FLIPPED_FACES, INVERTED_COMPONENTS
    return repaired, [result for result in solid.findings if result.code in turns]


def _round_down(length: float) -> float:
    """Return the length rounded down to four digits, so that a wall of the rounded length does not
    fold.
    """
    if not isfinite(length):
        return inf
    unit = 10.0 ** (floor(log10(length)) - 3)  # one in the fourth digit
    rounded = float("{:.4g}".format(floor(length / unit) * unit))
    return rounded if rounded < length else float("{:.4g}".format(rounded - unit))
