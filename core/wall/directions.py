# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Offset directions: the movement of a surface's vertices if its faces move along their normals.

Every vertex moves along a direction d that moves the planes of its faces by one: n·d = 1 for each
normal n around it (Blender's Solidify calls that even thickness; on a cube it is the mitre). If at
most three planes meet, the shortest such d is exact; planes within about one degree count as one,
because d would have to run far along their crease. If more planes meet, there may be no such d. It
is then the least-squares solution, with each face weighted by its angle at the vertex, so that the
cutting of flat faces does not matter. Planes within about 15 degrees count as the round surface
that they stand for, and the vertex goes along their mean normal. If this d would run behind one of
the faces, d is the direction most in front of all of them (by multiplicative weights, Arora, Hazan
and Kale, Theory of Computing 8, 2012).

Inside a flat side and along a straight edge a vertex may slide without moving the planes. There d
is as even as it can be, Σ cot |d_i - d_j|² least (Pinkall and Polthier, Experiment. Math. 2, 1993),
so that the finely cut sides of a thick-walled box shrink as a whole, and do not fold over if its
edges move inward.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..mesh import Surface, find_edges, first_at_equal_position
from ..moments import U
from ..numerics import Array, Integers, Mask, NDArray
from ..solid import vertex_pairs
from ..verdict import MeasureError
from .findings import NO_FACE_AREA, WALL_WITHOUT_SIDES

TRIANGLES_PER_BLOCK = 4096  # triangles at a time
# Relative to the largest eigenvalue of Σ θ n n'; φ²/4 for planes φ apart. Less is one plane.
SAME_PLANE_RTOL = 1e-4
LEAST_SQUARES_RTOL = 2e-2  # The same if not all planes can be met.
SLIVER_RTOL = 1e-9  # Relative to the longest side: lower triangles have no reliable normal.
NOISY_HEIGHT_FACTOR = (
    1e3  # times the points' shift by storing: lower triangles' normals are known to 1e-3 only
)
UNEVEN_RTOL = 1e-6  # smaller relative deviations from the thickness do not count
MIN_ADVANCE = (
    0.1  # Share of the thickness: if a face would get less, its vertices need a better direction.
)
MAXIMIN_STEPS = 400  # Steps of the search for a better direction.
RANK_RTOL = (
    1e-12  # Relative to the largest eigenvalue: planes that span less are equal to rounding.
)
# limit of steps, and the share of the unevenness at which to stop
SMOOTHING_STEPS = 400
SMOOTHING_RTOL = 1e-12


@dataclass(frozen=True, eq=False)
class OffsetDirections:
    """Offset directions, (n, 3) `vectors`: the displacement of each vertex per unit of thickness.

    tangential_error, normal_error: (2, n) first-order bounds of the vectors' changes, of their
    whole length and of their part along the normals; row 0 by rounding, row 1 by storing the points
    as float32. Directions by multiplicative weights have no such bound. has_normal: (m,) False for
    triangles without a known normal, which were ignored.
    """

    vectors: Array
    tangential_error: Array
    normal_error: Array
    has_normal: Mask


def blocks(triangles: NDArray) -> Iterator[NDArray]:
    """Yield blocks of triangles, small enough that their scratch arrays stay in the cache."""
    return (
        triangles[start : start + TRIANGLES_PER_BLOCK]
        for start in range(0, len(triangles), TRIANGLES_PER_BLOCK)
    )


def weld_equal(surface: Surface) -> tuple[Array, Integers]:
    """Return points and triangles with one vertex for each place, and refuse edges that a wall
    cannot have.
    """
    triangles, _ = surface.all_triangles()
    first = first_at_equal_position(surface.points)
    triangles = first[triangles.astype(np.intp)]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    if not len(triangles):
        raise MeasureError(NO_FACE_AREA)
    used, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    edges = find_edges(triangles)
    misoriented = (edges.count == 2) & (
        edges.signed_use_count(np.zeros(len(triangles), bool)) != 0.0
    )
    for fault, is_wrong in (
        ("more than two faces meet there. Separate the parts", edges.count > 2),
        ("the normals there are opposite. Use Mesh > Normals > Recalculate Outside", misoriented),
    ):
        if is_wrong.any():
            pairs = used[vertex_pairs(triangles, edges.first[is_wrong])]
            raise MeasureError(WALL_WITHOUT_SIDES, elements=pairs, count=len(pairs), fault=fault)
    return surface.points[used].astype(np.float64), triangles


def offset_directions(points: Array, triangles: Integers, stored: float = 0.0) -> OffsetDirections:
    """Return the direction of every vertex of (n, 3) float64 points, which storing has moved by at
    most `stored`, a length.
    """
    count = len(points)
    normals, angles, noise, solid = (
        np.concatenate(column)
        for column in zip(*(corner_geometry(points[part], stored) for part in blocks(triangles)))
    )
    corner = triangles[solid].ravel()
    weight = angles[solid].ravel()
    normals = np.repeat(normals[solid], 3, axis=0)
    # The angle around each vertex; a vertex without a known normal has no corner.
    total = np.maximum(np.bincount(corner, weight, count), np.finfo(float).tiny)

    def mean(values: NDArray) -> Array:
        """Return the (n,) means over the corners at each vertex, weighted by their angles."""
        return np.bincount(corner, weight * values, count) / total

    middle = np.stack([mean(column) for column in normals.T], axis=1)
    length = np.linalg.norm(middle, axis=1)
    middle /= np.where(length > 0.0, length, 1.0)[:, None]
    # With d = m + c, m the mean normal: Σ θ n n'·c = Σ θ n (1 - n·m), and 1 - n·m = |n - m|² / 2
    # does not cancel. `solved` takes away the part of m along a crease of planes that count as one.
    short = ((normals - middle[corner]) ** 2).sum(axis=1) / 2.0
    system = np.empty((count, 3, 3))
    for i in range(3):
        for j in range(i, 3):
            system[:, i, j] = system[:, j, i] = mean(normals[:, i] * normals[:, j])
    right = np.stack([mean(short * column) for column in normals.T], axis=1)
    values, axes = np.linalg.eigh(system)
    # The (2, n) largest errors of the normals around a vertex, by rounding and by storing.
    tilt = np.stack([_group_maximum(row.repeat(3), corner, count) for row in noise[solid].T])
    noisy = tilt.sum(axis=0)
    least_share = -_group_maximum(-weight / total[corner], corner, count)
    # A mean square over the corners bounds the square at each of them by this factor squared.
    thinnest = 1.0 / np.sqrt(np.maximum(least_share, np.finfo(float).tiny))

    def solved(least: float) -> tuple[NDArray, NDArray, NDArray]:
        """Return (n, 3) directions in the axes with eigenvalues above `least`, relative to the
        largest; (n,) root mean squares of n·d - 1; and (n,) bounds of the change of d for each
        radian by which the normals turn.
        """
        independent = values > least * values[:, 2:]
        inverse = np.where(independent, 1.0 / np.where(independent, values, 1.0), 0.0)
        vectors = np.einsum("nij,nj,nkj,nk->ni", axes, inverse, axes, right) + np.einsum(
            "nij,nj,nkj,nk->ni", axes, independent, axes, middle
        )
        off = np.sqrt(mean((np.einsum("ij,ij->i", normals, vectors[corner]) - 1.0) ** 2))
        # Wedin's bound for least squares of least norm, with `gain` the norm of the inverse:
        # 2 gain |d|, half of it because the free axes turn, and gain² off by the residual.
        gain = np.sqrt(inverse.max(axis=1))
        return vectors, off, 2.0 * gain * np.linalg.norm(vectors, axis=1) + gain**2 * off

    vectors, off, gain = solved(SAME_PLANE_RTOL)
    # Normals that are off by `noisy` change n·d by at most noisy |d|; 4 is a margin.
    rough = off > UNEVEN_RTOL + 4.0 * noisy * np.linalg.norm(vectors, axis=1)
    if rough.any():
        for values_by_vertex, smooth in zip((vectors, off, gain), solved(LEAST_SQUARES_RTOL)):
            values_by_vertex[rough] = smooth[rough]
        low = -_group_maximum(-np.einsum("ij,ij->i", normals, vectors[corner]), corner, count)
        behind = np.flatnonzero(rough & (low < MIN_ADVANCE))
        if len(behind):
            _maximin_direction(vectors, behind, low, corner, weight, normals)
    # The axes along which a vertex may slide without moving the planes around it. Normals that are
    # off by `noisy` give an eigenvalue of at most its square; 8 is a margin.
    is_free = values <= np.maximum(RANK_RTOL, (8.0 * noisy) ** 2)[:, None] * values[:, 2:]
    is_free &= (total > np.finfo(float).tiny)[:, None] & ~rough[:, None]
    if is_free.any():
        free = np.einsum("nij,nj,nkj->nik", axes, is_free, axes)
        vectors = _smooth_in_plane(points, triangles[solid], vectors, free)
    far = np.linalg.norm(vectors, axis=1)
    # The change of n·d for each radian: the normal's own turn, and that of the solution.
    lift = thinnest * (far + gain * off)
    # Of both rows, only rounding has its own errors of the solution, some 8 roundings.
    return OffsetDirections(
        vectors,
        gain * tilt + 8.0 * U * gain * [[1.0], [0.0]],
        lift * tilt + 8.0 * U * lift * [[1.0], [0.0]],
        solid,
    )


def _smooth_in_plane(points: NDArray, triangles: NDArray, vectors: NDArray, free: NDArray) -> Array:
    """Return vectors made even by conjugate gradients along projections `free`, (n, 3, 3), which
    become zero at the boundaries, so that these stay.
    """
    edges = find_edges(triangles)
    # Boundaries are closed loops, so that each end of a side is the start of one.
    free[triangles.ravel()[edges.boundary_sides()]] = 0.0
    can_move = np.einsum("nii->n", free) > 0.5
    triangles = triangles[can_move[triangles].any(axis=1)]
    if not len(triangles):
        return vectors
    used, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    free = free[used]
    count = len(used)
    corners = points[used][triangles]
    # from corner k to k + 1, across from corner k + 2
    sides = corners - np.roll(corners, -1, axis=1)
    double = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    dots = np.einsum("mki,mki->mk", np.roll(sides, -1, axis=1), np.roll(sides, -2, axis=1))
    weight = (-dots / double[:, None]).ravel()  # the cotangent of the angle across from a side
    start = triangles.ravel()
    stop = np.roll(triangles, -1, axis=1).ravel()

    def gradient(steps: NDArray) -> Array:
        """Return half the gradient of Σ cot |d_i - d_j|², in the free directions."""
        force = weight[:, None] * (steps[start] - steps[stop])
        total = np.stack(
            [
                np.bincount(start, column, count) - np.bincount(stop, column, count)
                for column in force.T
            ],
            axis=1,
        )
        return np.einsum("nij,nj->ni", free, total)

    size = np.bincount(start, np.abs(weight), count) + np.bincount(stop, np.abs(weight), count)
    size = np.maximum(size, np.finfo(float).tiny)[:, None]  # the preconditioner's diagonal
    directions = vectors[used]
    residual = -gradient(directions)
    step = residual / size
    unevenness = first = np.vdot(residual, step)
    for _ in range(SMOOTHING_STEPS):
        if not unevenness > SMOOTHING_RTOL**2 * first:
            break
        image = gradient(step)
        curvature = np.vdot(step, image)
        if not curvature > 0.0:  # cotangents of wide angles are negative
            break
        directions = directions + unevenness / curvature * step
        residual = residual - unevenness / curvature * image
        before = unevenness
        unevenness = np.vdot(residual, residual / size)
        step = residual / size + unevenness / before * step
    vectors = vectors.copy()
    vectors[used] = directions
    return vectors


def _group_maximum(values: NDArray, group: NDArray, count: int) -> Array:
    """Return the (count,) largest of the (k,) values in each (k,) group, zero for empty groups."""
    order = np.argsort(values)
    maximum = np.zeros(count)
    maximum[group[order]] = values[order]  # The last of equal indices wins.
    return maximum


def _maximin_direction(
    vectors: NDArray,
    behind: NDArray,
    low: NDArray,
    corner: NDArray,
    weight: NDArray,
    normals: NDArray,
) -> None:
    """Replace the (n, 3) vectors of vertices `behind` in place if other ones are farther in front
    of all their faces.

    low: (n,) least n·d. corner, weight, normals: the vertex, angle and normal of each corner.
    """
    count = len(behind)
    number = np.full(len(vectors), -1)
    number[behind] = np.arange(count)
    corner_rows = np.flatnonzero(number[corner] >= 0)
    vertex = number[corner[corner_rows]]
    normals = normals[corner_rows]
    angle = weight[corner_rows]
    share = angle / np.bincount(vertex, angle, count)[vertex]
    best = np.full(count, -np.inf)
    best_direction = np.zeros((count, 3))
    for k in range(MAXIMIN_STEPS):
        trial = np.stack(
            [np.bincount(vertex, share * column, count) for column in normals.T], axis=1
        )
        length = np.linalg.norm(trial, axis=1)
        trial /= np.where(length > 0.0, length, 1.0)[:, None]
        height = np.einsum("ij,ij->i", normals, trial[vertex])
        least = -_group_maximum(-height, vertex, count)
        better = least > best
        best[better], best_direction[better] = least[better], trial[better]
        # Faces that the trial is least in front of count more in the next one.
        share = share * np.exp(-height / np.sqrt(1.0 + k))
        share /= np.bincount(vertex, share, count)[vertex]
    # The length that moves the faces by 1 in the mean, by least squares.
    height = np.einsum("ij,ij->i", normals, best_direction[vertex])
    square = np.bincount(vertex, angle * height**2, count)
    scale = np.bincount(vertex, angle * height, count) / np.where(square > 0.0, square, 1.0)
    better = (best * scale > low[behind]) & (best > 0.0)
    vectors[behind[better]] = (scale[:, None] * best_direction)[better]


def corner_geometry(
    points: NDArray, stored: float = 0.0
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return (m, 3) unit normals, (m, 3) angles, (m, 2) bounds of the normals' turns by rounding
    and by storing, rad, and a mask of known normals.

    points: (m, 3, 3) corners, each at most `stored` off.
    """
    sides = points[:, [1, 2, 0]] - points
    normal = np.cross(sides[:, 0], sides[:, 1])
    double = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    solid = double > longest * np.maximum(SLIVER_RTOL * longest, NOISY_HEIGHT_FACTOR * stored)
    double = np.where(solid, double, 1.0)
    dots = -np.einsum("mki,mki->mk", sides, sides[:, [2, 0, 1]])
    angles = np.arctan2(double[:, None], dots)
    # Corners off by ± stored along the normal N, |N| = double, change it by stored |±a ±b ±c|, with
    # sides a + b + c = 0: at most twice the longest. Its products are off by some 8 roundings.
    noise = np.stack([8.0 * U * longest**2 / double, 2.0 * stored * longest / double], axis=1)
    return normal / double[:, None], angles, noise, solid
