# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface that keeps a liquid out of measured bodies.

It is their outer side: cavities, and bodies inside of others, displace nothing more. Holes and
hollows that are open upward keep the liquid out as long as their rims are above the waterline.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..bodies import MeshBody
from ..cuts import Hollow, find_hollow
from ..measurement import Body
from ..mesh import (
    Bvh,
    first_at_equal_position,
    intersecting_pairs,
    sort_components,
    uncancelled_sides,
)
from ..numerics import Array, Index, Integers, Mask, first_occurrence
from ..solid import (
    COMPONENTS_OVERLAP,
    SELF_INTERSECTING,
    ComponentRelations,
    SolidIntegrals,
    classify_pairs,
    measure_solid,
)
from ..verdict import MeasureError, Procedure, welding_tolerance
from .findings import FLOAT_UNAVAILABLE, FLOODED_OUTSIDE, NO_BODY, OPEN_HULL, SHARED_SPACE

NOT_UNITED = {COMPONENTS_OVERLAP, SELF_INTERSECTING}

LEAST_HOLLOW = 1e-6  # relative to the volume: smaller hollows count as wet
MAX_HOLLOWS = 8


@dataclass(frozen=True, eq=False)
class Hull:
    """A closed surface, (n, 3) points and (m, 3) triangles, the (k, 3) points of its rims, the
    (m,) part of each triangle, and the (3,) largest shift of the points by storing.
    """

    points: Array
    triangles: Integers
    openings: Array
    part: Index
    displacement: Array


def outer_surface(body: Body) -> Iterator[tuple[SolidIntegrals, Array]]:
    """Yield the closed solids that a body displaces, and the (k, 4, 4) maps to their places, m."""
    if isinstance(body, MeshBody):
        yield from body.solids
    else:
        for surface in body.surfaces(False):
            yield measure_solid(surface), np.eye(4)[None]


def find_hull(bodies: Iterable[Body]) -> Hull:
    """Return the outer side of bodies with their holes closed, or raise MeasureError."""
    points, triangles, caps, part, rims = [], [], [], [], []
    start = number = 0  # counts of points and of parts before this solid
    displacement = np.zeros(3)
    for body in bodies:
        for solid, matrices in outer_surface(body):
            if solid.method is Procedure.OPEN:
                raise MeasureError(FLOAT_UNAVAILABLE, fault=OPEN_HULL)
            if any(found.code in NOT_UNITED for found in solid.findings):
                raise MeasureError(FLOAT_UNAVAILABLE, fault=SHARED_SPACE)
            closed = solid.parts()
            mesh = solid.oriented.mesh
            rim = mesh.points[np.unique(mesh.capped_edges)].astype(np.float64)
            for matrix in matrices:
                linear = matrix[:3, :3].T
                # A mirror image has its corners in the opposite order.
                step = 1 if np.linalg.det(linear) > 0.0 else -1
                points.append(closed.points.astype(np.float64) @ linear + matrix[:3, 3])
                triangles.append(closed.triangles[:, ::step] + start)
                caps.append(closed.face < 0)
                part.append(closed.part + number)
                rims.append(rim @ linear + matrix[:3, 3])
                displacement = np.maximum(
                    displacement, solid.given_surface.coordinate_error @ np.abs(linear)
                )
                start += len(closed.points)
                number += closed.number
    if not points:
        raise MeasureError(FLOAT_UNAVAILABLE, fault=NO_BODY)
    joined = np.concatenate(points)
    faces = np.concatenate(triangles)
    owner = np.concatenate(part)
    kept = _outer_parts(joined, faces, owner, np.concatenate(caps), number)
    is_kept = kept[owner]
    return Hull(joined, faces[is_kept], np.concatenate(rims), owner[is_kept], displacement)


def _outer_parts(
    points: Array, triangles: Integers, part: Index, is_cap: Mask, number: int
) -> Mask:
    """Return a (number,) mask of the parts that no other one contains; MeasureError if parts
    overlap.

    part, is_cap: (m,) of the triangles: their part, and whether they close a hole.
    """
    is_solid, relations, tolerance = _relate(points, triangles, part, number)
    kept = is_solid.copy()
    kept[relations.contained_in[:, 0]] = False
    if len(relations.intersecting):
        # Of parts that go through each other, one may be in the other's opening and meet only its
        # cap, as a mast or a crew in an open hull. Such a part displaces nothing more.
        skins = sort_components(points, triangles[~is_cap], part[~is_cap], number)
        tree = Bvh(points, skins, kept)
        small, large = relations.intersecting.T
        pierced, unfinished = intersecting_pairs(tree, small, large, tolerance)
        if (pierced | unfinished).any():
            raise MeasureError(FLOAT_UNAVAILABLE, fault=SHARED_SPACE)
        has_cap = np.zeros(number, bool)
        has_cap[part[is_cap]] = True
        kept[np.where(has_cap[small] & ~has_cap[large], large, small)] = False
    return kept


def _relate(
    points: Array, triangles: Integers, part: Index, number: int
) -> tuple[Mask, ComponentRelations, float]:
    """Return a (number,) mask of the parts with a volume, how these lie to each other, and the
    tolerance.
    """
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    step = float(np.spacing(np.float32(np.abs(points).max())))
    tolerance = welding_tolerance(size, step)
    parts = sort_components(points, triangles, part, number)
    is_solid = parts.volume > 0.0
    return is_solid, classify_pairs(points, parts, is_solid, tolerance), tolerance


def are_inside(hull: Hull, spaces: Sequence[Hull], tanks: Sequence[Hull]) -> Mask:
    """Return a mask of the flooded spaces that lie in a hull; MeasureError if one reaches through
    its surface, or overlaps another one or a tank.
    """
    every = [hull, *spaces, *tanks]
    points = np.concatenate([each.points for each in every])
    corners = np.cumsum([0, *[len(each.points) for each in every]])
    first_parts = np.cumsum([0, *[int(each.part.max()) + 1 for each in every]])
    triangles = np.concatenate([each.triangles + first for each, first in zip(every, corners)])
    part = np.concatenate([each.part + first for each, first in zip(every, first_parts)])
    is_solid, relations, _ = _relate(points, triangles, part, int(first_parts[-1]))
    # The index in `every` of each part: 0 for the hull, then the spaces, then the tanks.
    owner = np.repeat(np.arange(len(every)), np.diff(first_parts))
    is_flooded = (owner > 0) & (owner <= len(spaces))
    inner, outer = relations.contained_in.T
    in_hull = owner[outer] == 0
    is_shared = (is_flooded[inner] | is_flooded[outer]) & ~in_hull
    if is_flooded[relations.intersecting].any() or is_shared.any():
        raise MeasureError(FLOAT_UNAVAILABLE, fault=FLOODED_OUTSIDE)
    is_outside = is_flooded & is_solid
    is_outside[inner[in_hull]] = False
    return np.bincount(owner, is_outside, len(every))[1 : len(spaces) + 1] == 0


def fill_hollows(hull: Hull, up: Array) -> Hull:
    """Return the hull with the hollows that are open upward filled up to lids on their rims."""
    points, triangles, openings, part = hull.points, hull.triangles, hull.openings, hull.part
    for _ in range(MAX_HOLLOWS):
        try:
            hollow = find_hollow(points, triangles, up)
        except MeasureError:
            break
        volume = float(
            sort_components(points, triangles, np.zeros(len(triangles), int), 1).volume[0]
        )
        if hollow.capacity <= LEAST_HOLLOW * volume:
            break
        _, start, stop = uncancelled_sides(
            hollow.triangles, np.zeros(len(hollow.triangles), np.intp)
        )
        # The lid is a fan from the rim, turned round, to its middle: the point after the hollow's.
        rim = hollow.points[start]
        count = len(hollow.points)
        lid = np.stack([stop, start, np.full(len(start), count)], axis=1)
        added = np.concatenate([hollow.triangles, lid]) + len(points)
        # The filling becomes a part, in contact with the parts whose walls it has. Other parts that
        # are in the filled hollow displace nothing more.
        is_wall = np.isin(part, part[_same_triangles(points, triangles, hollow)])
        points = np.concatenate([points, hollow.points, rim.mean(axis=0)[None]])
        number = int(part.max()) + 1
        if not is_wall.all():
            kept = _outer_parts(
                points,
                np.concatenate([triangles[~is_wall], added]),
                np.concatenate([part[~is_wall], np.full(len(added), number)]),
                # a mask of the lid, the last of the triangles
                np.arange(-np.count_nonzero(~is_wall), len(added)) >= len(hollow.triangles),
                number + 1,
            )
            if not kept[number]:
                raise MeasureError(FLOAT_UNAVAILABLE, fault=SHARED_SPACE)
            is_kept = is_wall | kept[part]
            triangles, part = triangles[is_kept], part[is_kept]
        triangles = np.concatenate([triangles, added])
        part = np.concatenate([part, np.full(len(added), number)])
        openings = np.concatenate([openings, rim])
    if triangles is hull.triangles:
        return hull
    return Hull(points, triangles, openings, part, hull.displacement)


def _same_triangles(points: Array, triangles: Integers, hollow: Hollow) -> Mask:
    """Return an (m,) mask of the triangles at the places of a hollow's walls, which face either
    way.
    """
    place = first_at_equal_position(np.concatenate([hollow.points, points]))
    every = np.concatenate([hollow.triangles, triangles + len(hollow.points)])
    first = first_occurrence(*np.sort(place[every], axis=1).T)
    count = len(hollow.triangles)
    return first[count:] < count
