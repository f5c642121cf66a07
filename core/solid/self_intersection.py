# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Self-intersection of closed surfaces, and the volume that it counts twice or as negative.

If all cones of a surface from some point are positive, and a ray from that point leaves the surface
once, it is the radial image of a sphere, and cannot meet itself; for a convex body the center of
mass is such a point. The pass over the faces that shows this ends early if a face looks away.

Other surfaces are sampled along lines. Each place on a line must be in a closed part once or not at
all, if the part faces outward. The total length of violations, times the lines' distances, is the
volume that counts wrongly. Every region as wide as these distances is found. The number of lines
follows from the number of faces, so that the search costs little.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..mesh import (
    HALVES,
    LINE_SLOPES,
    Crossings,
    LineGrids,
    Surface,
    find_crossings,
    keep_used,
    line_counts,
    turned_quads,
)
from ..moments import SECOND_MOMENT_INDEX
from ..numerics import Array, Integers, Mask, NDArray, run_starts, sums_by_index
from ..verdict import Intersection
from .closedness import CheckedSurface
from .orientation import OrientedSolid

MAX_UNSURE_LINES = (
    0.05  # Share of lines: if more enter and leave unequally often, the rest says nothing.
)
FACES_PER_BLOCK = 4096
SUM_ROUNDING = 1e-13  # Relative rounding of a sum of numbers of one sign.


@dataclass(frozen=True, eq=False)
class SelfIntersection:
    """Result of the search for self-intersections.

    `volume`: estimated volume that counts twice or as negative (unit³), times the number of surplus
    counts. `effect`: the larger of its shares of the volume and of the second moment about the
    center.
    """

    state: Intersection
    volume: float = 0.0
    effect: float = 0.0


def find_self_intersection(checked: CheckedSurface, oriented: OrientedSolid) -> SelfIntersection:
    """Search the surface of a solid for self-intersections."""
    mesh = oriented.mesh
    surface = oriented.surface
    volume = oriented.volume
    if not oriented.is_solid or mesh.open.any():
        return SelfIntersection(Intersection.NOT_CHECKED)
    part = None
    if mesh.number > 1:
        parts = oriented.closed_parts()
        surface = Surface(*keep_used(parts.points, parts.triangles))
        part = parts.part
    else:
        center = volume.about + volume.raw[1:4] / volume.total
        if is_star(surface, center) or is_star(surface, volume.about):
            return SelfIntersection(Intersection.EXCLUDED)
    low, high = surface.box
    lines = line_counts(np.array([surface.triangle_count]))
    grids = LineGrids.over_boxes(low[None], high[None], lines)
    crossings = find_crossings(surface, grids)
    excess = measure_excess(crossings, grids, np.array([checked.tolerance]), part)
    if excess.unsure[0] > MAX_UNSURE_LINES:
        return SelfIntersection(Intersection.NOT_CHECKED)
    excess_volume = float(excess.volume[0])
    if not excess_volume > 0.0:
        return SelfIntersection(Intersection.NOT_FOUND)
    spread = float(volume.about_center().raw[SECOND_MOMENT_INDEX.diagonal()].sum())
    effect = max(excess_volume / volume.total, float(excess.second_moment[0]) / spread)
    return SelfIntersection(Intersection.FOUND, excess_volume, effect)


def is_star(surface: Surface, center: Array) -> bool:
    """Return whether a closed surface, facing outward, is certainly star-shaped about a point.

    The search ends early if a face looks away.
    """
    coordinates = along_ray(surface.points.T, center[:, None])
    total = signed = 0.0
    crossings = 0
    for faces in (surface.quads, surface.triangles):
        starts = [*range(0, len(faces), FACES_PER_BLOCK), len(faces)]
        for start, stop in zip(starts[:-1], starts[1:]):
            block = faces[start:stop]
            if faces is surface.quads:
                block = turned_quads(surface.points, block)[:, HALVES].reshape(-1, 3)
            cones, is_crossed = find_cones(coordinates.take(block.T, 1, mode="clip"))
            total += float(np.abs(cones).sum())
            signed += float(cones.sum())
            crossings += int(np.count_nonzero(is_crossed))
            if not total - signed <= SUM_ROUNDING * total:  # also if NaN
                return False
    return crossings == 1


def along_ray(points: NDArray, origin: NDArray) -> Array:
    """Return coordinates of (3, n) points from an origin, sheared so that a ray is the z axis."""
    rows = np.subtract(points, origin, dtype=np.float64, order="C")
    for row, slope in zip(rows, LINE_SLOPES):
        row -= slope * rows[2]
    return rows


def find_cones(corners: NDArray) -> tuple[Array, Mask]:
    """Return (t,) signed cones, times 6, from the origin over triangles, (3, 3, t) coordinates of
    corners; and the triangles that the z axis may cross upward, if all cones are positive.
    """
    x, y, z = corners
    # Of each side, opposite to corner i, the doubled area of its triangle with the ray.
    first, second, third = [x[i - 2] * y[i - 1] - y[i - 2] * x[i - 1] for i in range(3)]
    # A side that the ray meets counts for both of its triangles: no surface that goes around the
    # origin twice seems to be crossed once.
    is_crossed = np.minimum(np.minimum(first, second), third) >= 0.0
    return z[0] * first + z[1] * second + z[2] * third, is_crossed


@dataclass(frozen=True, eq=False)
class Excess:
    """Miscounted volumes of b bodies, (b,): regions that count more than once or as negative, times
    the surplus.

    `second_moment`: of these regions, about the center of the body's box. `unsure`: share of the
    crossed lines that do not enter as often as they leave; 1 if no line is crossed.
    """

    volume: Array
    second_moment: Array
    unsure: Array


def measure_excess(
    crossings: Crossings,
    grids: LineGrids,
    tolerance: Array,
    part: Integers | None = None,
) -> Excess:
    """Measure along lines the volume that a closed part counts more than once, or as negative.

    tolerance: (b,) lengths along a line that count as none. part: (t,) the closed part of each
    triangle, of one body only; by default a part is a body.
    """
    bodies = len(grids.cell)
    if not len(crossings.row):
        return Excess(np.zeros(bodies), np.zeros(bodies), np.ones(bodies))
    part_of_crossing = crossings.body if part is None else part[crossings.triangle].astype(np.intp)
    parts = int(part_of_crossing.max()) + 1
    line = crossings.row * grids.columns + crossings.column
    chord = line * parts + part_of_crossing  # the number of a line and a part that it crosses
    order = np.lexsort((crossings.along, chord))
    body = crossings.body[order]
    sign = crossings.sign[order]
    along = crossings.along[order]
    # The first and the last crossing of each chord, and the chord of each crossing, from 0 on.
    first = run_starts(chord[order])
    last = np.append(first[1:], len(chord)) - 1
    chord = np.repeat(np.arange(len(first)), last + 1 - first)
    # How often the part counts the piece of the line after each crossing.
    depth = np.cumsum(sign)
    depth -= (depth[first] - sign[first])[chord]
    is_complete = depth[last] == 0
    chords = np.bincount(body[first], minlength=bodies)
    incomplete = np.bincount(body[first], ~is_complete, minlength=bodies)
    unsure = np.where(chords > 0, incomplete / np.maximum(chords, 1), 1.0)

    has_piece = is_complete[chord]
    has_piece[last] = False
    piece = np.flatnonzero(has_piece)  # by the crossing that it begins at
    length = along[piece + 1] - along[piece]
    depth = depth[piece]
    part_of_piece = part_of_crossing[order][piece]
    # A part that faces inward counts its pieces as negative.
    outward = np.sign(sums_by_index(part_of_piece, depth * length, parts))
    depth = depth * outward[part_of_piece]
    surplus = np.maximum(depth - 1.0, 0.0) + np.maximum(-depth, 0.0)
    wrong = np.flatnonzero((surplus > 0.0) & (length > tolerance[body[piece]]))
    piece, length, surplus = piece[wrong], length[wrong], surplus[wrong]
    body = body[piece]
    area_per_line = np.multiply.reduce(grids.cell, axis=1) * crossings.rows_apart
    volume = surplus * length * area_per_line[body]
    middle = along[piece] + length / 2.0
    distance = grids.squared_distances(
        body, crossings.row[order][piece], crossings.column[order][piece], middle
    )
    return Excess(
        sums_by_index(body, volume, bodies), sums_by_index(body, volume * distance, bodies), unsure
    )
