# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cut and fill: the volumes between an open surface and a plane, or another surface.

Against a plane the volumes are those of the prisms between the triangles and the plane, signed by
the side to which the triangles face: exact for height fields, and under an overhang the volume
that the surface encloses.

Two surfaces are compared where both are, each of one height there. The triangles of one, seen from
above, are cut by those of the other, and by the line at which their heights are equal; the bodies
between the pieces add up. Their upright sides have no part in the moments (`part_below`), so that
each piece is a body by itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..inertia import frame_about
from ..mesh import (
    Surface,
    consistent_orientation,
    find_edges,
    first_at_equal_position,
    normals,
    uncancelled_sides,
)
from ..moments import Moments, sum_moments
from ..numerics import (
    Array,
    ArrayLike,
    Integers,
    Mask,
    NDArray,
    connected_components,
    float_array,
    index_array,
    rectangle_pairs,
    sums_by_index,
    unit_vector,
)
from ..verdict import MAX_COORDINATE, MeasureError
from .findings import (
    APART,
    CLOSED_SURFACE,
    CUT_FILL_UNAVAILABLE,
    NO_FACES_TO_CUT,
    NO_RIM,
    OVERHANGS,
    PLANE_FAR,
    RIM_UPRIGHT,
)
from .part_below import measure_below

MIN_RIM_SPREAD = 1e-6  # least width of a rim by its length
UPRIGHT = 1e-9  # share of an area that counts as none if seen from above


@dataclass(frozen=True, eq=False)
class CutFill:
    """The volumes of a surface above and below a plane or another surface.

    Attributes
    ----------
    cut, fill : Moments
        Volumes to order 2: of the surface above, to be taken away, and below, to be filled.
    cut_area, fill_area : float
        Their areas, seen along the normal.
    normal : (3,) array
        The direction that counts as up.
    offset : float or None
        Of the plane, normal · x = offset.
    compared : float
        Share of the surface's area, seen along the normal, that was compared.
    """

    cut: Moments
    fill: Moments
    cut_area: float
    fill_area: float
    normal: Array
    offset: float | None = None
    compared: float = 1.0

    @property
    def net(self) -> float:
        """The volume of the cut, less that of the fill."""
        return self.cut.total - self.fill.total


def cut_fill(
    points: ArrayLike,
    triangles: ArrayLike,
    normal: ArrayLike = (0.0, 0.0, 1.0),
    offset: float = 0.0,
    displacement: ArrayLike = (0.0, 0.0, 0.0),
) -> CutFill:
    """Measure the volumes between an open surface and a plane.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
        Faces that run against the rest of their part are turned, and each part up.
    normal : (3,) array_like
    offset : float
        The plane is normal · x = offset.
    displacement : (3,) array_like
        As of `measure_below`.

    Returns
    -------
    CutFill

    Raises
    ------
    MeasureError
        If the surface is closed or has no faces, or the plane is too far away.

    Examples
    --------
    >>> from body_moments.core.cuts import cut_fill
    >>> slope = [[0, 0, -1], [1, 0, 2], [1, 1, 2], [0, 1, -1]]
    >>> found = cut_fill(slope, [[0, 1, 2], [0, 2, 3]])
    >>> round(found.cut.total * 3, 9), round(found.fill.total * 6, 9), round(found.net, 9)
    (2.0, 1.0, 0.5)
    """
    points, triangles, up = _open_surface(points, triangles, normal)
    offset = offset / float(np.linalg.norm(np.asarray(normal, np.float64)))
    if not abs(offset) < MAX_COORDINATE:
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=PLANE_FAR)
    both = measure_below(
        points, triangles, [-up, up], [-offset, offset], displacement, is_open=True
    )
    # Along -up, the part above the plane counts as below, and its triangles face down: a positive
    # volume. Along up, the triangles face up: a negative one.
    cut, fill = both.part.at(0), both.part.at(1) * -1.0
    areas = np.abs(both.face_area)
    return CutFill(cut, fill, float(areas[0]), float(areas[1]), up, offset)


def fit_rim(
    points: ArrayLike, triangles: ArrayLike, up: ArrayLike = (0.0, 0.0, 1.0)
) -> tuple[Array, float]:
    """Fit a plane to the rim of an open surface: by least squares along its longest open edge.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
    up : (3,) array_like
        The side to which the normal points.

    Returns
    -------
    normal : (3,) array
    offset : float

    Raises
    ------
    MeasureError
        If there is no rim, or it is too narrow for a plane.

    Examples
    --------
    >>> from body_moments.core.cuts import fit_rim
    >>> pit = [[0, 0, 3], [1, 0, 3], [1, 1, 3], [0, 1, 3], [0.5, 0.5, 1]]
    >>> normal, offset = fit_rim(pit, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    >>> normal.round(9).tolist(), round(offset, 9)
    ([0.0, 0.0, 1.0], 3.0)
    """
    points = float_array("points", points, "n", 3, finite=True)
    triangles = index_array("triangles", triangles, "m", 3, count=len(points))
    up = unit_vector("up", up)
    triangles = first_at_equal_position(points)[triangles]
    _, start, stop = uncancelled_sides(triangles, np.zeros(len(triangles), np.intp))
    if not len(start):
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=NO_RIM)
    loop, _ = connected_components(len(points), start, stop)
    length = np.linalg.norm(points[stop] - points[start], axis=1)
    kept = loop[start] == np.argmax(sums_by_index(loop[start], length))
    ends = np.stack([points[start[kept]], points[stop[kept]]])
    weight = length[kept] / length[kept].sum()
    center = weight @ ends.mean(axis=0)
    ends = ends - center
    # 6 ∫ x x' over the sides: Σ weight (a a' + b b' + (a + b)(a + b)') with their ends a and b.
    total = ends.sum(axis=0)
    spread = np.einsum("s,si,sj->ij", weight, total, total) + np.einsum(
        "s,esi,esj->ij", weight, ends, ends
    )
    width, axes = np.linalg.eigh(spread)
    normal = axes[:, 0] * (1.0 if axes[:, 0] @ up >= 0.0 else -1.0)
    if width[1] <= MIN_RIM_SPREAD**2 * width[2] or abs(normal @ up) < MIN_RIM_SPREAD:
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=RIM_UPRIGHT)
    return normal, float(normal @ center)


def surface_cut_fill(surface: Surface, height: float | None) -> CutFill:
    """Measure the volumes between an open surface and a height, or with None the plane through its
    rim. Raises MeasureError.
    """
    points, triangles = surface.points, surface.all_triangles()[0]
    up, offset = fit_rim(points, triangles) if height is None else ((0.0, 0.0, 1.0), height)
    return cut_fill(points, triangles, up, offset, surface.coordinate_error)


def cut_fill_between(
    points: ArrayLike,
    triangles: ArrayLike,
    other_points: ArrayLike,
    other_triangles: ArrayLike,
    up: ArrayLike = (0.0, 0.0, 1.0),
) -> CutFill:
    """Measure the volumes between two open surfaces that have one height at each place.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
    other_points : (k, 3) array_like
    other_triangles : (l, 3) array_like of int
        The other surface, above which the first is cut, and below which it is filled.
    up : (3,) array_like

    Returns
    -------
    CutFill

    Raises
    ------
    MeasureError
        If a surface has overhangs, or they have no area in common.

    Examples
    --------
    >>> from body_moments.core.cuts import cut_fill_between
    >>> square = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]
    >>> roof = [[1, 1, 1], [3, 1, -1], [3, 3, -1], [1, 3, 1]]
    >>> halves = [[0, 1, 2], [0, 2, 3]]
    >>> found = cut_fill_between(roof, halves, square, halves)
    >>> round(found.cut.total, 9), round(found.fill.total, 9), found.cut.center.round(6).tolist()
    (1.0, 1.0, [1.333333, 2.0, 0.333333])
    """
    points, triangles, up = _open_surface(points, triangles, up)
    other_points, other_triangles, _ = _open_surface(other_points, other_triangles, up)
    frame = np.array(frame_about(up.tolist()))
    center = (points.min(axis=0) + points.max(axis=0)) / 2.0
    # The corners of both surfaces, (t, 3, 3), with z up, without upright triangles.
    surfaces = []
    for vertices, faces in ((points, triangles), (other_points, other_triangles)):
        corners = ((vertices - center) @ frame.T)[faces]
        area = _doubled_area(corners)
        size = np.linalg.norm(normals(vertices, faces), axis=1)
        is_upright = area <= UPRIGHT * size
        if (area < -UPRIGHT * size).any():
            raise MeasureError(CUT_FILL_UNAVAILABLE, fault=OVERHANGS)
        if is_upright.all():
            raise MeasureError(CUT_FILL_UNAVAILABLE, fault=APART)
        surfaces.append(corners[~is_upright])
    sums: list[list[Moments]] = [[], []]
    areas = np.zeros(2)
    boxes = [(corners[..., :2].min(axis=1), corners[..., :2].max(axis=1)) for corners in surfaces]
    for i, j, _ in rectangle_pairs(*boxes):
        pieces = _cut_pairs(surfaces[0][i], surfaces[1][j])
        above = pieces[..., 2] - pieces[..., 3]
        for side, sign in enumerate((1.0, -1.0)):
            part = _clip(pieces, sign * above)
            fan = np.stack(
                [np.broadcast_to(part[:, :1], part[:, 1:-1].shape), part[:, 1:-1], part[:, 2:]],
                axis=2,
            ).reshape(-1, 3, 4)
            fan = fan[_doubled_area(fan) > 0.0]
            if not len(fan):
                continue
            # The first surface's triangles, and the other's, which face down: outward for a cut.
            upper, lower = fan[:, :, [0, 1, 2]], fan[:, ::-1, [0, 1, 3]]
            soup = np.concatenate([upper, lower] if side == 0 else [upper[:, ::-1], lower[:, ::-1]])
            level = float(soup[..., 2].max())
            # A plane above all leaves the bodies whole.
            body = measure_below(
                soup.reshape(-1, 3), np.arange(3 * len(soup)).reshape(-1, 3), [[0, 0, 1]], [level]
            )
            sums[side].append(body.part.at(0))
            areas[side] += _doubled_area(fan).sum() / 2.0
    if not areas.any():
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=APART)
    place = np.eye(4)
    place[:3, :3] = frame.T
    place[:3, 3] = center
    nothing = Moments(np.zeros(10), np.zeros(3))
    cut, fill = (sum_moments(parts or [nothing]).transform(place) for parts in sums)
    whole = float(_doubled_area(surfaces[0]).sum()) / 2.0
    shared = float(areas.sum()) / whole
    return CutFill(cut, fill, float(areas[0]), float(areas[1]), up, None, min(shared, 1.0))


def _open_surface(
    points: ArrayLike, triangles: ArrayLike, normal: ArrayLike
) -> tuple[Array, Integers, Array]:
    """Return the points, the triangles, consistent and with each part facing up, and the unit
    normal.

    MeasureError if it is closed or has no faces.
    """
    points = float_array("points", points, "n", 3, finite=True)
    triangles = index_array("triangles", triangles, "m", 3, count=len(points))
    normal = unit_vector("normal", normal)
    if not len(triangles):
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=NO_FACES_TO_CUT)
    welded = first_at_equal_position(points)[triangles]
    edges = find_edges(welded)
    if not (edges.count == 1).any():
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=CLOSED_SURFACE)
    first, second = edges.manifold_side_pairs()
    misoriented = edges.upward[first] == edges.upward[second]
    first, second = first // 3, second // 3
    vectors = normals(points, triangles)
    flipped, _ = consistent_orientation(
        len(triangles), first, second, misoriented, np.linalg.norm(vectors, axis=1)
    )
    part, _ = connected_components(len(triangles), first, second)
    facing = np.where(flipped, -1.0, 1.0) * (vectors @ normal)
    flipped ^= (sums_by_index(part, facing) < 0.0)[part]
    return points, np.where(flipped[:, None], triangles[:, ::-1], triangles), normal


def _doubled_area(corners: NDArray) -> Array:
    """Return the doubled areas of (t, 3, 2 or more) corners, seen from above."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _cut_pairs(first: Array, second: Array) -> Array:
    """Return (p, 6, 4) corners x, y and both heights of the convex pieces of (p, 3, 3) triangles
    within p others, seen from above.

    The other height is that of the plane through the second triangle, kept between its corners'.
    """
    pieces = np.concatenate([first, first[..., 2:]], axis=2)
    for k in range(3):
        start, side = second[:, k, None, :2], second[:, (k + 1) % 3, None, :2]
        way = side - start
        offset = pieces[..., :2] - start
        inside = way[..., 0] * offset[..., 1] - way[..., 1] * offset[..., 0]
        pieces = _clip(pieces, inside)
    a, b = second[:, 1:2] - second[:, :1], second[:, 2:] - second[:, :1]
    offset = pieces[..., :2] - second[:, :1, :2]
    area = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    s = (offset[..., 0] * b[..., 1] - offset[..., 1] * b[..., 0]) / area
    t = (a[..., 0] * offset[..., 1] - a[..., 1] * offset[..., 0]) / area
    height = second[:, :1, 2] + s * a[..., 2] + t * b[..., 2]
    low, high = second[..., 2].min(axis=1)[:, None], second[..., 2].max(axis=1)[:, None]
    pieces[..., 3] = np.clip(height, low, high)
    return pieces


def _clip(polygons: Array, side: Array) -> Array:
    """Cut (p, k, d) convex polygons to where a linear function, (p, k) at their corners, is not
    negative: return (p, k + 1, d) polygons, whose last corners repeat, zero if nothing is left.
    """
    following, next_side = np.roll(polygons, -1, axis=1), np.roll(side, -1, axis=1)
    keeps: Mask = side >= 0.0
    crosses = keeps != (next_side >= 0.0)
    # After each corner, the crossing of its side; of these 2 k places, first the kept ones.
    share = side / np.where(crosses, side - next_side, 1.0)
    crossing = polygons + share[..., None] * (following - polygons)
    count, k, d = polygons.shape
    corners = np.stack([polygons, crossing], axis=2).reshape(count, 2 * k, d)
    kept = np.stack([keeps, crosses], axis=2).reshape(count, 2 * k)
    order = np.argsort(~kept, axis=1, kind="stable")[:, : k + 1]
    number = kept.sum(axis=1)
    # Places in the order, the last kept one again and again.
    last = np.minimum(np.arange(k + 1), np.maximum(number - 1, 0)[:, None])
    order = np.take_along_axis(order, np.minimum(last, k), axis=1)
    clipped = np.take_along_axis(corners, order[..., None], axis=1)
    clipped[number == 0] = 0.0
    return clipped
