# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Division of a body into nearly convex pieces, by planes that reduce the volume of the pieces'
hulls most.

Each step divides the piece whose best plane gains most. Candidates for planes contain a concave
edge, or divide the piece evenly; all of them are compared at once on a coarse copy of the piece.
More pieces than wanted are made; those whose common hull costs least are merged afterwards.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..mesh import (
    ConvexHull,
    Surface,
    convex_hull,
    hull_volumes,
    triangle_areas,
    triangle_distances,
)
from ..numerics import (
    Array,
    Index,
    Mask,
    NDArray,
    connected_components,
    run_starts,
    spread_directions,
)
from ..verdict import MeasureError
from .plane_cuts import ON_PLANE_RTOL, Piece, connected_parts, cut, piece_from_surface

HULL_RTOL = 1e-6  # tolerance of the resulting hulls
SEARCH_RTOL = 1e-4  # tolerance of hulls that are only compared
COARSE_POINTS = 96  # points of the copy that planes are compared on
MAX_PLANES = 24  # through concave edges
# directions that choose planes, and planes that are compared exactly
DIRECTIONS = 120
LIKELY_PLANES = 6
LIKELY_CUTS = 2  # cuts through the middle whose halves are cut again, with exact hulls
SAMPLES_PER_BLOCK = 32  # after the first 4, which most often decide
# Moves of the best plane, relative to the size: it is moved if that reduces the hulls more.
SHIFTS = np.array([-0.06, -0.03, -0.015, 0.015, 0.03, 0.06])
SHARES = np.array([1, 2, 3]) / 4.0  # shares of the extent, where planes divide a piece evenly
SAME_AXIS = 1.0 - 1e-9  # cosine: nearer axes are one
LEAST_GAIN = 1e-3  # relative to the body's volume: a smaller reduction is none
LEAST_EXCESS = 0.01  # Excess of the hull over the volume from which a piece is worth two cuts.
HOPE = 0.02  # Relative to the excess: the assumed gain of a cut that gains nothing yet.
MERGE_CORNERS = 96  # corners of hulls that are compared before they are merged
SPARE = 2  # pieces made for each wanted piece, before they are merged


def cut_into_pieces(
    surface: Surface, outward: float, pieces: int, corners: int
) -> Generator[float, None, list[ConvexHull]]:
    """Divide a closed body into convex hulls, in steps that yield the completed share.

    surface: closed and outward. outward: m; a piece is not divided if its hull is nowhere seen
    farther from it. pieces: at most so many. corners: of each hull, at most.
    """
    body = [*connected_parts(piece_from_surface(surface))]
    volume = sum(piece.volume() for piece in body)
    open_pieces = [(piece, *_best_plane(piece, outward, volume)) for piece in body]
    done: list[Piece] = []
    while open_pieces and len(done) + len(open_pieces) < SPARE * pieces:
        best = max(range(len(open_pieces)), key=lambda i: open_pieces[i][1])
        piece, gain, plane = open_pieces.pop(best)
        parts = [*cut(piece, plane)] if gain > LEAST_GAIN * volume else []
        if len(parts) < 2:
            done.append(piece)
            continue
        open_pieces += [(part, *_best_plane(part, outward, volume)) for part in parts]
        yield 0.9 * (len(done) + len(open_pieces)) / (SPARE * pieces)
    groups = _merge(
        [piece.points for piece in (*done, *(piece for piece, *_ in open_pieces))], pieces, volume
    )
    yield 0.95
    return [_solid_hull(points, HULL_RTOL, corners) for points in groups]


def _solid_hull(points: NDArray, tolerance: float, corners: int) -> ConvexHull:
    """Return the hull of points; one that the tolerance makes flat, such as a long rod's, without.

    tolerance, corners: as for `convex_hull`.
    """
    try:
        hull = convex_hull(points, tolerance, corners)
    except MeasureError:
        return convex_hull(points, max_corners=corners)
    return convex_hull(points, max_corners=corners) if hull.is_flat else hull


def _best_plane(piece: Piece, outward: float, volume: float) -> tuple[float, Array]:
    """Return the largest reduction of hulls by a plane, on a coarse copy of the piece, and the (4,)
    plane; 0 if no cut is needed.

    outward: as for `cut_into_pieces`. volume: of the whole body. No single plane reduces the hulls
    of a ring or a cup: then planes through the middle are followed by another one.
    """
    excess = float(_volumes([piece.points])[0]) - piece.volume()
    coarse = _coarse(piece)
    # No cut gains more than the excess.
    if excess <= LEAST_GAIN * volume or outward > 0.0 and _is_near_hull(coarse, outward):
        return 0.0, np.zeros(4)
    gain, best = _best_of(coarse, piece)
    if gain > LEAST_GAIN * volume or excess < LEAST_EXCESS * piece.volume():
        return gain, best
    middle_planes = _even_planes(coarse.points, np.array([0.5]))
    halves = [[*cut(coarse, plane)] for plane in middle_planes]
    rough = [
        sum(_gains(part, _planes(part), _rough_volumes).max() for part in parts) for parts in halves
    ]
    likely = np.argsort(rough, kind="stable")[-LIKELY_CUTS:]
    gains = [sum(gain for gain, _ in (_best_of(part, part) for part in halves[i])) for i in likely]
    # The hulls of a spiral's halves overlap: no cut gains until it is cut often. Then most pieces
    # are merged again.
    return max(*gains, HOPE * excess), middle_planes[likely[int(np.argmax(gains))]]


def _planes(piece: Piece) -> Array:
    """Return the (k, 4) candidates for a cut."""
    size = float(np.ptp(piece.points, axis=0).max())
    return np.concatenate([_concave_planes(piece, size), _even_planes(piece.points, SHARES)])


def _best_of(coarse: Piece, piece: Piece) -> tuple[float, Array]:
    """Return the largest reduction of the hulls of a coarse piece by one plane, and the (4,) plane.

    The candidates are those of the piece itself; if it is the coarse one, the best is not refined.
    """
    planes = _planes(piece)
    planes = planes[
        np.argsort(-_gains(coarse, planes, _rough_volumes), kind="stable")[:LIKELY_PLANES]
    ]
    gains = _gains(coarse, planes)
    best = planes[gains.argmax()]
    if coarse is piece:
        return float(gains.max()), best
    size = float(np.ptp(piece.points, axis=0).max())
    near = np.concatenate([best[None], best + size * SHIFTS[:, None] * (0.0, 0.0, 0.0, 1.0)])
    gains = _gains(coarse, near)
    return float(gains.max()), near[gains.argmax()]


def _is_near_hull(piece: Piece, limit: float) -> bool:
    """Return whether samples of the hull's surface, the middles of its faces and of one edge each,
    are all within a limit of the piece; the largest faces first.
    """
    hull = _solid_hull(piece.points, SEARCH_RTOL, 64)
    largest = np.argsort(-triangle_areas(hull.points, hull.triangles), kind="stable")
    corners = hull.points[hull.triangles[largest]]
    fans = piece.points[np.stack([piece.first()[piece.face], piece.start, piece.end], axis=1)]
    samples = np.stack(
        [corners.mean(axis=1), (corners[:, 0] + corners[:, 1]) / 2.0], axis=1
    ).reshape(-1, 3)
    blocks = np.array_split(samples, np.arange(4, len(samples), SAMPLES_PER_BLOCK))
    return all(distances_from_triangles(block, fans).max() <= limit for block in blocks)


def distances_from_triangles(points: Array, corners: Array) -> Array:
    """Return the (n,) distances of points from the nearest of some (m, 3, 3) triangles."""
    pairs = points.repeat(len(corners), axis=0), np.tile(corners, (len(points), 1, 1))
    return triangle_distances(*pairs).reshape(-1, len(corners)).min(axis=1)


def _coarse(piece: Piece) -> Piece:
    """Return a copy of a piece with at most COARSE_POINTS points: one for each cell of a grid, the
    farthest from the middle. Edges whose ends become one are left out.
    """
    points = piece.points
    if len(points) <= COARSE_POINTS:
        return piece
    low = points.min(axis=0)
    extent = np.maximum(np.ptp(points, axis=0), np.finfo(float).tiny)
    far = np.argsort(-((points - points.mean(axis=0)) ** 2).sum(axis=1), kind="stable")
    cells = 16
    while True:  # It ends: 2 cells along each axis hold 8 points at most.
        # At least 2 cells, so that a thin body keeps both of its sides.
        number = np.maximum(np.ceil(cells * extent / extent.max()), 2.0)
        place = np.minimum((points - low) / extent * number, number - 1.0).astype(np.intp)
        cell = place @ (cells * cells, cells, 1)
        _, first, which = np.unique(cell[far], return_index=True, return_inverse=True)
        if len(first) <= COARSE_POINTS:
            break
        cells -= 1
    chosen = np.empty(len(points), np.intp)
    chosen[far] = far[first][which]
    moved = replace(piece, start=chosen[piece.start], end=chosen[piece.end])
    return moved.take(moved.start != moved.end)


def _concave_planes(piece: Piece, size: float) -> Array:
    """Return (k, 4) planes through concave edges: in either face, and halfway between; the most
    important ones.
    """
    count = len(piece.points)
    # Both uses of an edge that two faces share are neighbors in this order, the forward one first.
    key = np.minimum(piece.start, piece.end) * count + np.maximum(piece.start, piece.end)
    order = np.lexsort((piece.start > piece.end, key))
    # Pairs of neighbors with one key that are not part of a longer run: edges of just two faces.
    same = key[order][1:] == key[order][:-1]
    is_pair = same & ~np.append(False, same[:-1]) & ~np.append(same[1:], False)
    first = order[:-1][is_pair]
    second = order[1:][is_pair]
    a = piece.points[piece.start[first]]
    b = piece.points[piece.end[first]]
    first_normal = piece.normals[piece.face[first]]
    second_normal = piece.normals[piece.face[second]]
    # The edge's length times the sine of the angle between the faces, negative if it is concave.
    turn = np.einsum("ij,ij->i", np.cross(first_normal, second_normal), b - a)
    concave = turn < -1e-6 * size
    a, b, first_normal, second_normal = (
        values[concave] for values in (a, b, first_normal, second_normal)
    )
    weight = -turn[concave]
    if not len(a):
        return np.zeros((0, 4))
    between = np.cross(first_normal + second_normal, b - a)
    normal = np.concatenate([first_normal, second_normal, between])
    length = np.linalg.norm(normal, axis=1)
    has_direction = length > 1e-9 * size  # between opposite faces there is none
    normal = normal[has_direction] / length[has_direction, None]
    at = np.tile(a, (3, 1))[has_direction]
    weight = np.tile(weight, 3)[has_direction]
    largest = normal[np.arange(len(normal)), np.abs(normal).argmax(axis=1)]
    normal *= np.where(largest < 0.0, -1.0, 1.0)[:, None]
    planes = np.column_stack([normal, np.einsum("ij,ij->i", normal, at)])
    # Planes with the same normal, rounded to sixths, and the same distance from the middle, rounded
    # to 24ths of the size, count as one, as heavy as all of them.
    middle = np.append(piece.points.mean(axis=0), -1.0)
    steps = np.column_stack([np.rint(normal * 6.0), np.rint(planes @ middle / size * 24.0)])
    _, first_plane, group = np.unique(steps, axis=0, return_index=True, return_inverse=True)
    total = np.bincount(group.ravel(), weight)
    return planes[first_plane[np.argsort(-total, kind="stable")[:MAX_PLANES]]]


def _even_planes(points: Array, shares: Array) -> Array:
    """Return (k, 4) planes that divide the extents along the principal axes of the points and along
    x, y and z.
    """
    offsets = points - points.mean(axis=0)
    principal = np.linalg.eigh(offsets.T @ offsets)[1].T
    is_own = np.abs(principal).max(axis=1) < SAME_AXIS
    axes = np.concatenate([principal[is_own], np.eye(3)])
    along = points @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    levels = low[:, None] + (high - low)[:, None] * shares
    return np.column_stack([axes.repeat(len(shares), axis=0), levels.ravel()])


def _gains(
    piece: Piece,
    planes: Array,
    measure: Callable[..., Array] = hull_volumes,
) -> Array:
    """Return (k,) reductions: by how much each of (k, 4) planes reduces the volume of the hulls of
    connected parts, for each part it adds.

    measure: (n, 3) points, (s,) starts of sets and a tolerance to the (s,) volumes of their hulls.
    """
    points = piece.points
    edges = np.unique(np.sort(np.stack([piece.start, piece.end], axis=1), axis=1), axis=0)
    height = points @ planes[:, :3].T - planes[:, 3]  # (n, k)
    height[np.abs(height) <= ON_PLANE_RTOL * np.ptp(points, axis=0).max()] = 0.0
    a, b = height[edges[:, 0]], height[edges[:, 1]]
    edge, plane = np.nonzero(a * b < 0.0)
    share = (a[edge, plane] / (a[edge, plane] - b[edge, plane]))[:, None]
    crossings = (1.0 - share) * points[edges[edge, 0]] + share * points[edges[edge, 1]]
    outward = np.stack(
        [np.bincount(piece.start, column[piece.face], len(points)) for column in piece.normals.T],
        axis=1,
    )
    # Sets of points: the whole piece, then each connected part on each side of each plane. `places`
    # and `sets` have an entry for each point of each set; `set_planes` and `are_inward` for each
    # set: its plane, and whether it is the wall of a hole.
    places = [points]
    sets = [np.zeros(len(points), np.intp)]
    set_planes = [np.full(1, -1)]
    are_inward = [np.zeros(1, bool)]
    set_count = 1
    for sign in (1.0, -1.0):
        vertex, vertex_plane = np.nonzero(sign * height >= 0.0)
        number = np.full(height.shape, -1)  # row of each vertex on this side of each plane
        number[vertex, vertex_plane] = np.arange(len(vertex))
        ends = number[edges]  # (e, 2, k)
        # an edge in the plane joins nothing
        is_joining = (ends >= 0).all(axis=1) & ((a != 0.0) | (b != 0.0))
        joining_edge, joining_plane = np.nonzero(is_joining)
        crossing_number = len(vertex) + np.arange(len(crossings))
        inner_end = ends[edge, :, plane].max(axis=1)
        part, part_count = connected_components(
            len(vertex) + len(crossings),
            np.concatenate([ends[joining_edge, 0, joining_plane], crossing_number]),
            np.concatenate([ends[joining_edge, 1, joining_plane], inner_end]),
        )
        part_planes = np.empty(part_count, np.intp)
        part_planes[part] = np.concatenate([vertex_plane, plane])
        places += [points[vertex], crossings]
        sets.append(set_count + part)
        set_planes.append(part_planes)
        are_inward.append(
            _face_inward(points[vertex], outward[vertex], part[: len(vertex)], part_count)
        )
        set_count += part_count
    place = np.concatenate(places)
    set_of_place = np.concatenate(sets)
    plane_of_set = np.concatenate(set_planes)
    order = np.argsort(set_of_place, kind="stable")
    starts = np.searchsorted(set_of_place[order], np.arange(set_count))
    around = _boxes_around(place[order], starts, plane_of_set, np.concatenate(are_inward))
    # Walls of holes join the set around them.
    order = order[np.argsort(around[set_of_place[order]], kind="stable")]
    outer_sets, starts = np.unique(around[set_of_place[order]], return_index=True)
    volumes = measure(place[order], starts, SEARCH_RTOL)
    planes_of_parts = plane_of_set[outer_sets[1:]]
    part_counts = np.bincount(planes_of_parts, minlength=len(planes))
    reductions = volumes[0] - np.bincount(planes_of_parts, volumes[1:], len(planes))
    return reductions / np.maximum(part_counts - 1, 1)


@lru_cache(maxsize=1)
def _directions() -> ConvexHull:
    """Return the hull of directions on the unit sphere."""
    return convex_hull(spread_directions(DIRECTIONS), 1e-9)


def _rough_volumes(points: Array, starts: Index, _: float) -> Array:
    """Return estimates of the volumes of hulls of sets of points, (s,): those of polyhedra of the
    farthest points in some directions. The tolerance has no effect.
    """
    ball = _directions()
    sizes = np.diff(np.append(starts, len(points)))
    reach = points @ ball.points.T
    # The rows of the points that reach farthest of their set in a direction.
    row, direction = np.nonzero(reach >= np.maximum.reduceat(reach, starts).repeat(sizes, axis=0))
    farthest = np.empty((len(starts), len(ball.points), 3))
    farthest[np.arange(len(starts)).repeat(sizes)[row], direction] = points[row]
    farthest -= farthest[:, :1].copy()  # cones from the first point, to lose no digits far away
    a, b, c = (farthest[:, ball.triangles[:, k]] for k in range(3))
    return np.einsum("ijk,ijk->i", a, np.cross(b, c)) / 6.0


def _face_inward(points: NDArray, out: NDArray, label: Index, parts: int) -> Mask:
    """Return a (parts,) mask of the parts whose faces look at their middle: walls of holes.

    points: (n, 3). out: (n, 3) sums of the normals of the faces around each. label: (n,) parts.
    """
    count = np.maximum(np.bincount(label, minlength=parts), 1)
    # Σ (point - middle) · normal
    flux = np.bincount(label, np.einsum("ij,ij->i", points, out), parts)
    for place, normal in zip(points.T, out.T):
        flux -= np.bincount(label, place, parts) * np.bincount(label, normal, parts) / count
    return flux < 0.0


def _boxes_around(points: NDArray, starts: Index, plane: Index, inward: Mask) -> Index:
    """Return an index for each set of points: of a hole's walls, the largest set of the same plane
    with a box around theirs; else its own.

    points: (n, 3), set after set. starts, plane, inward: (s,) for the sets.
    """
    low = np.minimum.reduceat(points, starts)
    high = np.maximum.reduceat(points, starts)
    size = (high - low).sum(axis=1)
    around = np.arange(len(starts))
    order = np.argsort(plane, kind="stable")
    for group in np.split(order, run_starts(plane[order])[1:]):
        if inward[group].any():
            inside = (low[group] <= low[group, None]).all(axis=2) & (
                high[group] >= high[group, None]
            ).all(axis=2)
            largest = np.where(inside, size[group], -1.0).argmax(axis=1)
            around[group] = np.where(
                inward[group] & (size[group][largest] > size[group]), group[largest], group
            )
    return around


def _merge(sets: list[Array], most: int, volume: float) -> list[Array]:
    """Merge sets of points, each time the pair whose common hull adds least, until at most so many
    are left.

    Pairs whose common hull adds less than LEAST_GAIN of the body's volume are merged also below
    that number. The hulls that are compared have few corners.
    """
    hulls = [_solid_hull(points, SEARCH_RTOL, MERGE_CORNERS).points for points in sets]
    volumes = _volumes(hulls)
    cost = np.full((len(sets), len(sets)), np.inf)
    rows, columns = np.triu_indices(len(sets), 1)
    cost[rows, columns] = _volumes(
        [np.concatenate([hulls[i], hulls[j]]) for i, j in zip(rows, columns)]
    )
    cost[rows, columns] -= volumes[rows] + volumes[columns]
    while len(sets) > 1:
        i, j = (int(place) for place in np.unravel_index(cost.argmin(), cost.shape))
        if len(sets) <= most and cost[i, j] > LEAST_GAIN * volume:
            break
        keep = [k for k in range(len(sets)) if k not in (i, j)]
        merged = _solid_hull(
            np.concatenate([hulls[i], hulls[j]]), SEARCH_RTOL, MERGE_CORNERS
        ).points
        sets = [*(sets[k] for k in keep), np.concatenate([sets[i], sets[j]])]
        cost = cost[np.ix_(keep, keep)]
        hulls = [hulls[k] for k in keep]
        *common, volume_of_merged = _volumes(
            [*(np.concatenate([points, merged]) for points in hulls), merged]
        )
        column = np.array(common) - volumes[keep] - volume_of_merged
        volumes = np.append(volumes[keep], volume_of_merged)
        hulls = [*hulls, merged]
        cost = np.pad(cost, ((0, 1), (0, 1)), constant_values=np.inf)
        cost[:-1, -1] = column
    return sets


def _volumes(sets: Sequence[Array]) -> Array:
    """Return the (s,) volumes of the hulls of sets of points."""
    if not sets:
        return np.zeros(0)
    starts = np.cumsum([0, *(len(points) for points in sets[:-1])])
    volumes = hull_volumes(np.concatenate(sets), starts, SEARCH_RTOL)
    # The tolerance may make a thin hull flat.
    return volumes if volumes.all() else hull_volumes(np.concatenate(sets), starts, 1e-8)
