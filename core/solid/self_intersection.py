# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Self-intersection of closed surfaces, and the volume that it counts twice or as negative.

If all cones of a surface from some point have the same sign, and their sum surrounds that point
once, it is the radial image of a sphere, and cannot meet itself; for a convex body the center of
mass is such a point. For most bodies, sums over faces show this on the way. The others need a pass
over the faces, which ends early if a face looks away.

Other surfaces are sampled along lines. Each place on a line must be in a closed part once or not at
all, if the part faces outward. The total length of violations, times the lines' distances, is the
volume that counts wrongly. Every region as wide as these distances is found. The number of lines
follows from the number of faces, so that the search costs little.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh import (
    FACES_PER_BLOCK,
    HALVES,
    Crossings,
    LineGrids,
    Surface,
    find_crossings,
    line_counts,
    turned_quads,
)
from ..moments import SECOND_MOMENT_INDEX
from ..numerics import Array, cross, dot, sums_by_index
from ..verdict import Intersection
from .closedness import CheckedSurface, GivenIntegrals, same_sign
from .orientation import OrientedSolid

MAX_UNSURE_LINES = (
    0.05  # Share of lines: if more enter and leave unequally often, the rest says nothing.
)
FACES_LOOKED_AT_FIRST = 1024


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


def find_self_intersection(
    checked: CheckedSurface, given: GivenIntegrals, oriented: OrientedSolid
) -> SelfIntersection:
    """Search the surface of a solid for self-intersections.

    All three arguments are of the same surface.
    """
    mesh = oriented.mesh
    surface = oriented.surface
    volume = oriented.volume
    if not oriented.is_solid or mesh.open.any():
        return SelfIntersection(Intersection.NOT_CHECKED)
    component = None
    if mesh.number > 1:
        parts = oriented.closed_parts()
        used = np.zeros(len(parts.points), bool)
        used[parts.triangles.ravel()] = True
        surface = Surface(parts.points[used], (np.cumsum(used) - 1)[parts.triangles])
        component = parts.part
    else:
        center = volume.about + volume.raw[1:4] / volume.total
        as_given = oriented.is_proven and given.all_cones_agree
        if (as_given and surrounds_once(surface, volume.about, checked.size)) or (
            all_cones_agree(surface, center) and surrounds_once(surface, center, checked.size)
        ):
            return SelfIntersection(Intersection.EXCLUDED)
    low, high = surface.box
    grids = LineGrids.over_boxes(
        low[None], high[None], line_counts(np.array([surface.triangle_count]))
    )
    excess = measure_excess(
        find_crossings(surface, grids), grids, np.array([checked.tolerance]), component
    )
    if excess.unsure[0] > MAX_UNSURE_LINES:
        return SelfIntersection(Intersection.NOT_CHECKED)
    if not excess.volume[0] > 0.0:
        return SelfIntersection(Intersection.NOT_FOUND)
    spread = float(volume.about_center().raw[SECOND_MOMENT_INDEX.diagonal()].sum())
    effect = max(float(excess.volume[0]) / volume.total, float(excess.second_moment[0]) / spread)
    return SelfIntersection(Intersection.FOUND, float(excess.volume[0]), effect)


def all_cones_agree(surface: Surface, center: Array) -> bool:
    """Return whether no two faces have opposite sides toward a point.

    The surface may go around it several times.
    """
    total = signed = 0.0
    for corners in _corner_blocks(surface):
        a, b, c = (corner - center[:, None] for corner in corners)
        cones = dot(a, cross(b, c))
        total = total + float(np.abs(cones).sum())
        signed = signed + float(cones.sum())
        if not same_sign(total, signed):
            return False
    return True


def _corner_blocks(surface: Surface) -> Iterator[list[Array]]:
    """Yield the corners of blocks of triangles, three (3, k) arrays; the first blocks of each kind
    are short.
    """
    for faces in (surface.quads, surface.triangles):
        starts = [0, *range(FACES_LOOKED_AT_FIRST, len(faces), FACES_PER_BLOCK), len(faces)]
        for start, stop in zip(starts[:-1], starts[1:]):
            block = faces[start:stop]
            if faces is surface.quads:
                block = turned_quads(surface.points, block)[:, HALVES].reshape(-1, 3)
            if len(block):
                yield [surface.points[block[:, k]].T.astype(np.float64) for k in range(3)]


def surrounds_once(surface: Surface, point: Array, size: float) -> bool:
    """Return whether a closed surface goes around a point once, one way or the other."""
    found = find_crossings(surface, LineGrids.through_points(point[None], np.array([size])))
    return abs(int(found.sign[found.along > 0.0].sum())) == 1


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
    part: NDArray[np.integer] | None = None,
) -> Excess:
    """Measure along lines the volume that a closed part counts more than once, or as negative."""
    bodies = len(grids.cell)
    if not len(crossings.row):
        return Excess(np.zeros(bodies), np.zeros(bodies), np.ones(bodies))
    of_part = crossings.body if part is None else part[crossings.triangle].astype(np.intp)
    line = crossings.row * grids.columns + crossings.column
    group = line * (int(of_part.max()) + 1) + of_part  # a part is of one body
    order = np.lexsort((crossings.along, group))
    group = group[order]
    of_part = of_part[order]
    body = crossings.body[order]
    begins = np.flatnonzero(np.concatenate([[True], group[1:] != group[:-1]]))
    last = np.concatenate([begins[1:], [len(group)]]) - 1
    which = np.repeat(np.arange(len(begins)), last + 1 - begins)
    depth = np.cumsum(crossings.sign[order])
    depth -= (depth[begins] - crossings.sign[order][begins])[which]
    complete = depth[last] == 0
    lines = np.bincount(body[begins], minlength=bodies)
    unsure = np.where(
        lines > 0,
        np.bincount(body[begins], ~complete, minlength=bodies) / np.maximum(lines, 1),
        1.0,
    )

    is_inner = complete[which]
    is_inner[last] = False
    inner = np.flatnonzero(is_inner)
    along = crossings.along[order]
    body = body[inner]
    depth = depth[inner]
    length = along[inner + 1] - along[inner]
    outward = np.sign(sums_by_index(of_part[inner], depth * length, int(of_part.max()) + 1))
    depth = depth * outward[of_part[inner]]
    times = np.maximum(depth - 1.0, 0.0) + np.maximum(-depth, 0.0)
    wrong = np.flatnonzero((times > 0.0) & (length > tolerance[body]))
    inner, body = inner[wrong], body[wrong]
    volume = (
        times[wrong]
        * length[wrong]
        * (np.multiply.reduce(grids.cell, axis=1) * crossings.rows_apart)[body]
    )
    middle = along[inner] + length[wrong] / 2.0
    distance = grids.squared_distances(
        body, crossings.row[order][inner], crossings.column[order][inner], middle
    )
    return Excess(
        sums_by_index(body, volume, bodies), sums_by_index(body, volume * distance, bodies), unsure
    )
