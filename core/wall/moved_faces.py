# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a body behind its moved faces.

The moved surface may go through itself, and turn over where the body is thin. Triangles that cross
others are divided along their planes, so that each piece has one winding number before it and one
behind it. It bounds the part if one of its sides belongs to it and the other does not. Places that
are nearer to the surface than the faces moved do not belong to it; rays show it.
"""

from __future__ import annotations

import numpy as np

from ..mesh import (
    Surface,
    faces_beside_edges,
    normals,
    overlapping_box_pairs,
    tree_of_all,
    triangle_areas,
)
from ..numerics import Array, Floats, Index, Integers, Mask, connected_components, run_starts

ROUNDING = 1e-9  # relative to the size: nearer points are on a plane
STEP = 1e-7  # relative to the size: the distance of places before and behind a piece from it
NEARER = 1e-6  # share of the depths that places may be nearer; directions are rounded to it
MAX_PAIRS = 3_000_000  # pairs of triangles whose boxes overlap
PAIRS_PER_BLOCK = 1 << 16
MAX_DIVISIONS = 3_000_000  # tests of pieces of triangles against others that cross them
RAYS = 12  # directions, and their opposites


def part_behind(
    points: Array,
    moved: Floats,
    triangles: Integers,
    depths: tuple[float, float, float],
) -> Surface | None:
    """Return the boundary of the part of a body behind its moved faces; None if too many triangles
    are near each other.

    points, moved: (n, 3) corners of the (m, 3) triangles before and after the move. depths: the
    least distances of the part from the body's surface: sideways, below its top, and above its
    bottom.
    """
    size = float(np.ptp(points, axis=0).max())
    tolerance = ROUNDING * size
    corners = moved[triangles].astype(np.float64)
    units = _unit_normals(corners, size)
    beside = faces_beside_edges(triangles, len(points))
    if beside is None:  # T-junctions: each triangle counts by itself
        beside = np.zeros((2, 0), np.int32)
    first, second, untested = overlapping_box_pairs(
        corners.min(axis=1), corners.max(axis=1), -tolerance, MAX_PAIRS
    )
    if untested:
        return None
    pairs = np.concatenate([[first, second], [second, first]], axis=1)
    blocks = np.array_split(pairs, 1 + pairs.shape[1] // PAIRS_PER_BLOCK, axis=1)
    meets, divides = np.concatenate(
        [_find_meetings(corners, units, block, tolerance) for block in blocks], axis=1
    )
    crossings = pairs[:, divides]
    is_divided = np.zeros(len(corners), bool)
    is_divided[crossings[0]] = True
    # A patch consists of neighbors that no other triangle meets. So all of its triangles bound the
    # part if its largest one does. Triangles with a common side do not count as meeting.
    shared = (triangles[pairs[0], :, None] == triangles[pairs[1], None]).sum(axis=(1, 2))
    is_apart = np.ones(len(corners), bool)
    is_apart[pairs[0, meets & (shared < 2)]] = False
    inner_edges = beside[:, is_apart[beside].all(axis=0)].astype(np.intp)
    patch, patch_count = connected_components(len(corners), *inner_edges)
    order = np.argsort(triangle_areas(moved, triangles))
    largest = np.zeros(patch_count, np.intp)
    largest[patch[order]] = order  # the last of equal indices wins
    tested = largest[~is_divided[largest]]  # a divided triangle is a patch, tested by its pieces
    pieces = _divide_along(corners, units, crossings, tolerance)
    if pieces is None:
        return None
    piece_corners, piece_owners = pieces
    cells = np.concatenate([corners[tested], piece_corners])
    owners = np.concatenate([tested, piece_owners])
    middles, steps = cells.mean(axis=1), STEP * size * units[owners]
    # Places before all cells, then places behind them.
    sides = np.concatenate([middles + steps, middles - steps])
    tree = tree_of_all(moved, triangles)
    component = np.zeros(len(sides), np.intp)
    winding = tree.winding_numbers(sides - tree.origin, component, 0.0)[0]
    inside = np.flatnonzero(winding > 0)
    belongs = np.zeros(len(sides), bool)
    across = np.tile(units[owners], (2, 1))[inside]
    belongs[inside] = _belong(points, triangles, sides[inside], across, depths)
    jump = winding[len(cells) :] - winding[: len(cells)]
    is_bound = belongs[len(cells) :] != belongs[: len(cells)]
    lying_together = np.flatnonzero(is_bound & (np.abs(jump) != 1))
    if len(lying_together):
        is_flat = np.abs(np.einsum("ei,ei->e", *units[beside])) > 1.0 - ROUNDING
        group = connected_components(len(corners), *beside[:, is_flat].astype(np.intp))[0]
        for cell in lying_together:
            is_bound[cell] = _is_counted(corners, units, group, owners[cell], middles[cell], size)
    is_bounding_patch = np.zeros(patch_count, bool)
    is_bounding_patch[patch[tested]] = is_bound[: len(tested)]
    is_kept = is_bounding_patch[patch]
    if not is_divided.any():
        return Surface(moved, triangles[is_kept])
    kept_pieces = piece_corners[is_bound[len(tested) :]]
    boundary = np.concatenate([corners[is_kept & ~is_divided], kept_pieces])
    return Surface(boundary.reshape(-1, 3), np.arange(3 * len(boundary)).reshape(-1, 3))


def _divide_along(
    corners: Array, units: Array, crossings: Index, tolerance: float
) -> tuple[Array, Index] | None:
    """Return the pieces (k, 3, 3) of triangles that planes of others divide, and the (k,) triangle
    of each; None if there are too many. crossings: (2, c) divided triangles, and the others.
    """
    pieces = [np.zeros((0, 3, 3))]
    owners = [np.zeros(0, np.intp)]
    divided, dividing = crossings[:, np.argsort(crossings[0], kind="stable")]
    starts = run_starts(divided)
    test_count = 0
    for triangle, planes in zip(divided[starts], np.split(dividing, starts[1:])):
        cells = corners[triangle][None]
        for plane in planes:
            count = len(cells)
            test_count += count
            if test_count > MAX_DIVISIONS:
                return None
            _, is_crossed = _find_meetings(
                np.concatenate([cells, corners[plane][None]]),
                units[np.repeat([triangle, plane], [count, 1])],
                np.stack([np.arange(count), np.full(count, count)]),
                tolerance,
            )
            height = (cells[is_crossed] - corners[plane, 0]) @ units[plane]
            height[np.abs(height) <= tolerance] = 0.0
            cells = np.concatenate([cells[~is_crossed], _divide(cells[is_crossed], height)])
        pieces.append(cells)
        owners.append(np.full(len(cells), triangle))
    return np.concatenate(pieces), np.concatenate(owners)


def _unit_normals(corners: Array, size: float) -> Array:
    """Return the (k, 3) unit normals of triangles (k, 3, 3), zero if they have no area."""
    across = normals(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    lengths = np.linalg.norm(across, axis=1)
    return across / np.where(lengths > (ROUNDING * size) ** 2, lengths, np.inf)[:, None]


def _find_meetings(corners: Array, units: Array, pairs: Index, tolerance: float) -> Mask:
    """Return a (2, k) mask: whether pairs of triangles in two planes meet along a segment, and
    whether also the plane of the second triangle divides the first.

    pairs: (2, k) indices of the (m, 3, 3) corners and (m, 3) units.
    """
    first, second = pairs
    along = np.cross(units[first], units[second])
    along /= np.maximum(np.linalg.norm(along, axis=1), np.finfo(float).tiny)[:, None]
    # The ends of each triangle's segment in the other one's plane, along the common line.
    low, high = np.empty((2, 2, len(first)))
    is_divided = np.empty((2, len(first)), bool)
    for k, (triangle, other) in enumerate([(first, second), (second, first)]):
        height = np.einsum("kci,ki->kc", corners[triangle] - corners[other, :1], units[other])
        height[np.abs(height) <= tolerance] = 0.0
        places = np.einsum("kci,ki->kc", corners[triangle], along)
        next_height = np.roll(height, -1, axis=1)
        crosses = height * next_height < 0.0
        share = height / np.where(crosses, height - next_height, 1.0)
        places += np.where(crosses, share * (np.roll(places, -1, axis=1) - places), 0.0)
        is_end = crosses | (height == 0.0)
        low[k] = np.where(is_end, places, np.inf).min(axis=1)
        high[k] = np.where(is_end, places, -np.inf).max(axis=1)
        is_divided[k] = crosses.any(axis=1)
    meets = high.min(axis=0) - low.max(axis=0) > tolerance
    return np.stack([meets, meets & is_divided[0]])


def _divide(cells: Array, height: Array) -> Array:
    """Return the parts of triangles, (k, 3, 3), above and below a plane between their corners.

    height: (k, 3), of the corners above the plane; at most one of a triangle is zero.
    """
    signs = np.sign(height)
    # The tip is the corner alone on its side: that below if two are above, else that above.
    lone = np.where(signs.sum(axis=1) > 0.0, -1.0, 1.0)
    order = (np.argmax(signs == lone[:, None], axis=1)[:, None] + np.arange(3)) % 3
    tip, left, right = np.take_along_axis(cells, order[..., None], 1).swapaxes(0, 1)
    top, *ends = np.take_along_axis(height, order, 1).T
    near, far = (
        tip + (top / (top - end))[:, None] * (corner - tip)
        for end, corner in zip(ends, (left, right))
    )
    parts = np.array([[tip, near, far], [near, left, right], [near, right, far]])
    has_area = np.array([top != 0.0, ends[0] != 0.0, ends[1] != 0.0])
    return parts.swapaxes(1, 2)[has_area]


def _belong(
    points: Array,
    triangles: Integers,
    places: Array,
    across: Array,
    depths: tuple[float, float, float],
) -> Mask:
    """Return an (e,) mask of places in the body that are nowhere nearer to its surface than the
    `depths` of `part_behind`, by rays.

    Rays run both ways along the (e, 3) unit vectors `across` and along the body's normals with the
    largest areas.
    """
    corners = points[triangles]
    tree = tree_of_all(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    places = places - tree.origin
    belong = tree.winding_numbers(places, np.zeros(len(places), np.intp), 0.0)[0] > 0
    units = _unit_normals(corners, float(np.ptp(points, axis=0).max()))
    ways, group = np.unique(np.rint(units / NEARER), axis=0, return_inverse=True)
    area = np.bincount(group.ravel(), triangle_areas(points, triangles))
    ways = ways[np.argsort(-area)[:RAYS]] * NEARER
    ways = ways[ways.any(axis=1)]
    wall, top, bottom = np.maximum(depths, np.finfo(float).tiny) * (1.0 - NEARER)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    for ray in [*ways, *-ways, across, -across]:
        rays = np.broadcast_to(ray, places.shape)
        height = np.where(rays[:, 2] < 0.0, bottom, top)
        # The distance between the depth sideways and that along z, by the ray's direction.
        nearest = 1.0 / (np.hypot(rays[:, 0], rays[:, 1]) / wall + np.abs(rays[:, 2]) / height)
        reach = float(nearest.max(initial=0.0))
        belong &= tree.first_hits(places, rays, reach)[0] > nearest
    return belong


def _is_counted(
    corners: Array, units: Array, group: Index, owner: int, place: Array, size: float
) -> bool:
    """Return whether the triangle `owner` bounds the part at a place where flat sheets coincide.

    Sheets, the groups of flat neighbors, are taken one after the other. A sheet counts if it
    changes the number of sheets that face as the triangle, kept between 0 and 1.
    """
    away = corners - place
    sides = np.cross(away, np.roll(away, -1, axis=1)) @ units[owner]
    covers = (np.abs(away @ units[owner]) <= ROUNDING * size).all(axis=1)
    covers &= (sides > 0.0).all(axis=1) | (sides < 0.0).all(axis=1)
    signs = np.where(covers, np.sign(units @ units[owner]), 0.0)
    running = np.clip(np.cumsum(np.bincount(group, signs)), 0.0, 1.0)
    before = running[group[owner] - 1] if group[owner] else 0.0
    return bool(running[group[owner]] != before)
