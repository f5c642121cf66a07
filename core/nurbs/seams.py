# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of patches: the sides that coincide, and the angles of creases along them and along knots
within a patch.

Sides coincide if they agree parameter by parameter, or else point by point; a side along several
other ones is cut where these end. A sheet with real thickness (`patch_moments.sheet_moments`)
overlaps itself on one side of a crease and gapes on the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..mesh import overlapping_box_pairs
from ..numerics import Array, Index, Mask, NDArray, connected_components, cross, following_pairs
from .blender_knots import bezier_curves
from .flat_face import FlatFace, split_faces
from .splines import SIDES, Curve, Face, Patch
from .trimmed_face import TrimmedFace

if TYPE_CHECKING:
    from .patch_topology import PatchTopology

SAMPLES_PER_SIDE = 33  # Least number of points at which sides are compared.
PAIRS_PER_BLOCK = 4096  # pairs of sides compared at a time
PAIRS_PER_BATCH = 1 << 20  # Candidate pairs of sides at a time.
FOLDED_ANGLE = 1e-3  # radians: patches that lie on each other
MAX_CUT_SIDES = 10_000  # Limit of open sides that are compared with each other's ends.
MAX_END_PAIRS = 1 << 22  # Limit of open sides and ends next to them.
MAX_SIDE_PAIRS = 100_000  # Limit of closed sides compared point by point.
CREASE_SAMPLES = 17  # samples of a side for its creases
POLE_RTOL = 1e-9  # Relative to the largest normal: normals at a pole are shorter.


@dataclass(frozen=True, eq=False)
class Sides:
    """Sides and how they meet.

    points: (n, m, 3) samples at equal steps. left, right: (k,) joined sides; same: (k,) whether
    their curves run the same way. turned: (patches,) mask of patches to turn, so that joined ones
    face alike if they can. free: (n,) mask of the open sides, of `open_length` in all. gap,
    non_manifold: as in PatchTopology.
    """

    points: Array
    left: Index
    right: Index
    same: Mask
    turned: Mask
    free: Mask
    open_length: float
    gap: float
    non_manifold: int


def join_sides(
    curves: Sequence[Curve], owner: Index, forward: Mask, patches: int, tolerance: float
) -> Sides:
    """Find the sides that coincide. owner: (n,) patch of each side; forward: (n,) whether the patch
    is on its left. patches: their number; a closed surface has no side.
    """
    count = max([SAMPLES_PER_SIDE] + [2 * len(curve.space.spans) + 1 for curve in curves])
    points = np.array([curve.uniform(count) for curve in curves]).reshape(-1, count, 3)
    length = np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
    free = np.linalg.norm(points - points[:, :1], axis=2).max(axis=1) > tolerance
    coincident = _coincident_sides(curves, points, np.flatnonzero(free), tolerance)
    times = np.bincount(np.array([side for _, i, j, _ in coincident for side in (i, j)], np.intp))
    pairs, turned = _pair_sides(coincident, times, points, owner, forward, patches)
    gap, left, right, same = np.array(pairs, np.float64).reshape(-1, 4).T
    left = left.astype(np.intp)
    right = right.astype(np.intp)
    free[left] = free[right] = False
    open_length = float(length[free].sum())
    sum_of_gaps = float((gap * length[left]).sum())
    non_manifold = int((times > 1).sum())
    return Sides(
        points, left, right, same > 0.0, turned, free, open_length, sum_of_gaps, non_manifold
    )


def cut_open_sides(curves: Sequence[Curve], sides: Sides, tolerance: float) -> list[list[Curve]]:
    """Return the pieces of each side, open ones cut where other open ones end; none if there is
    nothing to cut.
    """
    open_sides = np.flatnonzero(sides.free)
    if not 3 <= len(open_sides) <= MAX_CUT_SIDES:
        return []
    samples = sides.points[open_sides]
    ends = samples[:, [0, -1]].reshape(-1, 3)
    steps = np.linalg.norm(np.diff(samples, axis=1), axis=2).max(axis=1)
    low, high = samples.min(axis=1) - steps[:, None], samples.max(axis=1) + steps[:, None]
    pairs = overlapping_box_pairs(
        np.concatenate([low, ends]), np.concatenate([high, ends]), -tolerance, MAX_END_PAIRS
    )[:2]
    side, end = np.sort(pairs, axis=0) - [[0], [len(samples)]]
    mixed = (side < len(samples)) & (end >= 0)
    side, end = side[mixed], end[mixed]
    own_ends = np.linalg.norm(ends[end, None] - samples[side][:, [0, -1]], axis=2).min(axis=1)
    side, end = side[own_ends > 2.0 * tolerance], end[own_ends > 2.0 * tolerance]
    order = np.argsort(side, kind="stable")
    crossed, starts = np.unique(side[order], return_index=True)
    pieces = [[curve] for curve in curves]
    is_cut = False
    for which, group in zip(crossed.tolist(), np.split(ends[end[order]], starts[1:])):
        k = int(open_sides[which])
        curve = curves[k]
        # Whole circles are most often cut at their knots.
        t = curve.space.intervals[1:, 0]
        gaps = np.linalg.norm(group[:, None] - curve.evaluate(t), axis=2)
        at_knot = gaps.min(axis=1, initial=np.inf) <= tolerance
        t = t[(gaps <= tolerance).any(axis=0)]
        near = group[~at_knot]
        apart = np.linalg.norm(near[:, None] - samples[which], axis=2).min(axis=1)
        near = near[apart <= steps[which] + tolerance]
        if len(near):
            found = nearest_parameters(curve, samples[which], near, tolerance)
            miss = np.linalg.norm(near - curve.evaluate(found), axis=1)
            t = np.unique(np.concatenate([t, found[miss <= tolerance]]))
        if not len(t):
            continue
        marks = [curve.space.domain[0]]
        for at in t.tolist():
            if (
                np.linalg.norm(np.diff(curve.evaluate([marks[-1], at]), axis=0)) > 2.0 * tolerance
                or len(marks) == 1
            ):
                marks.append(at)
        marks.append(curve.space.domain[1])
        pieces[k] = [
            piece for part in zip(marks[:-1], marks[1:]) for piece in bezier_curves(curve, part)
        ]
        is_cut = True
    return pieces if is_cut else []


def _coincident_sides(
    curves: Sequence[Curve], points: NDArray, wide: Index, tolerance: float
) -> list[tuple[float, int, int, bool]]:
    """Return pairs of coinciding sides, nearest first: distance, two indices, whether their curves
    run the same way.
    """
    middle = points.shape[1] // 2
    side_points = points[wide]
    first = side_points[:, 0]
    last = side_points[:, -1]
    left, right = close_pairs(
        np.concatenate([first + last, 2.0 * side_points[:, middle]], axis=1), 2.0 * tolerance
    )
    coincident = list(_distance_between(points, wide[left], wide[right], tolerance))
    loose = np.ones(len(points), bool)
    loose[[side for _, i, j, _ in coincident for side in (i, j)]] = False
    # Equal curves with other parameters: between the same ends, or without ends.
    ring = np.linalg.norm(last - first, axis=1) <= 2.0 * tolerance
    arcs = np.flatnonzero(loose[wide] & ~ring)
    rings = np.flatnonzero(loose[wide] & ring)
    ends = close_pairs(
        np.concatenate([first + last, np.abs(first - last)], axis=1)[arcs], 2.0 * tolerance
    )
    boxes = overlapping_box_pairs(
        side_points[rings].min(axis=1), side_points[rings].max(axis=1), -tolerance, MAX_SIDE_PAIRS
    )[:2]
    candidates = np.concatenate(
        [arcs[np.stack(ends)], np.sort(rings[np.stack(boxes)], axis=0)], axis=1
    )
    for i, j in wide[candidates.T].tolist():
        coincident += _overlapping_sides(curves, points, i, j, tolerance)
    return sorted(coincident)


def _pair_sides(
    coincident: Sequence[tuple[float, int, int, bool]],
    times: Index,
    points: NDArray,
    owner: Index,
    forward: Mask,
    count: int,
) -> tuple[list[tuple[float, int, int, bool]], Mask]:
    """Return the joined pairs, and a (patches,) mask of the ones to turn. times: number of pairs
    with each side.

    If more than two sides meet, as for touching bodies, pairs of patches already joined by other
    sides come first, then single patches that fit without turning, then other patches that fit: so
    no patch is turned needlessly. Among equal pairs the sharpest angle comes first; patches that
    lie on each other come last.
    """
    part = list(range(count))
    odd = [False] * count
    size = [1] * count

    def root(patch: int) -> tuple[int, bool]:
        turn = False
        while part[patch] != patch:
            turn ^= odd[patch]
            patch = part[patch]
        return patch, turn

    pairs = []
    used = np.zeros(len(owner), bool)
    middles = points.mean(axis=1)
    sums = np.zeros((count, 3))
    np.add.at(sums, owner, middles)
    arms = (sums[owner] / np.bincount(owner)[owner, None]) - middles
    arms /= np.maximum(np.linalg.norm(arms, axis=1), 1e-300)[:, None]

    def angle(pair: tuple[float, int, int, bool]) -> float:
        return float(np.linalg.norm(arms[pair[1]] - arms[pair[2]]))

    def rank(pair: tuple[float, int, int, bool]) -> int:
        _, i, j, same = pair
        (a, turn) = root(int(owner[i]))
        (b, other) = root(int(owner[j]))
        flip = same == (forward[i] == forward[j])
        if a == b:
            rank_found = 0 if flip == turn ^ other else 4
        else:
            joins_single = (size[a] == 1) != (size[b] == 1)
            rank_found = 3 if flip else 2 - joins_single
        return max(rank_found, 3) if angle(pair) < FOLDED_ANGLE else rank_found

    def join(pair: tuple[float, int, int, bool]) -> None:
        _, i, j, same = pair
        (a, turn) = root(int(owner[i]))
        (b, other) = root(int(owner[j]))
        if a != b:
            a, b = (a, b) if size[a] >= size[b] else (b, a)
            part[b] = a
            odd[b] = bool(same == (forward[i] == forward[j])) ^ turn ^ other
            size[a] += size[b]
        used[[i, j]] = True
        pairs.append(pair)

    crowds = [pair for pair in coincident if max(times[pair[1]], times[pair[2]]) > 1]
    for pair in coincident:
        if times[pair[1]] == times[pair[2]] == 1:
            join(pair)
    crowd, number = connected_components(
        len(owner), *(np.array([pair[k] for pair in crowds], np.intp) for k in (1, 2))
    )
    together: dict[int, list] = {}
    for pair in crowds:
        together.setdefault(int(crowd[pair[1]]), []).append(pair)
    for meeting in together.values():
        meeting.sort(key=lambda pair: (round(angle(pair), 3), pair))
        for priority in range(5):
            for pair in meeting:
                if not (used[pair[1]] or used[pair[2]]) and rank(pair) <= priority:
                    join(pair)
    return pairs, np.array([root(patch)[1] for patch in range(count)], bool)


def close_pairs(keys: NDArray, limit: float) -> tuple[Index, Index]:
    """Return pairs i < j of rows of (n, d) keys with no coordinate that differs by more than a
    limit.
    """
    keys = keys - keys[:1]
    slope = 1.0 / np.sqrt(np.arange(2.0, 2.0 + keys.shape[1]))
    line = (keys * slope).sum(axis=1)
    order = np.argsort(line, kind="stable")
    line = line[order]
    count = np.searchsorted(
        line, line + (limit * slope.sum() + 1e-12 * np.abs(line).max(initial=0.0)), side="right"
    )
    count -= np.arange(1, len(line) + 1)
    pairs = []
    for i, j in following_pairs(order, count, PAIRS_PER_BATCH):
        near = (np.abs(keys[i] - keys[j]) <= limit).all(axis=1)
        pairs.append(np.sort([i[near], j[near]], axis=0))
    return tuple(np.concatenate([np.empty((2, 0), np.intp), *pairs], axis=1))


def _distance_between(
    points: NDArray, left: NDArray, right: NDArray, tolerance: float
) -> Iterator[tuple[float, int, int, bool]]:
    """Yield pairs of sides that coincide parameter by parameter: distance, indices, True if they
    run the same way.
    """
    for start in range(0, len(left), PAIRS_PER_BLOCK):
        i = left[start : start + PAIRS_PER_BLOCK]
        j = right[start : start + PAIRS_PER_BLOCK]
        reversed_distance, forward_distance = (
            np.linalg.norm(points[i] - other_points, axis=2).max(axis=1)
            for other_points in (points[j][:, ::-1], points[j])
        )
        for same, gap, fits in (
            (False, reversed_distance, reversed_distance <= tolerance),
            (
                True,
                forward_distance,
                (forward_distance <= tolerance) & (reversed_distance > tolerance),
            ),
        ):
            yield from zip(
                gap[fits].tolist(), i[fits].tolist(), j[fits].tolist(), [same] * int(fits.sum())
            )


def _overlapping_sides(
    curves: Sequence[Curve], points: NDArray, i: int, j: int, tolerance: float
) -> list[tuple[float, int, int, bool]]:
    """Return [(distance, i, j, True if same direction)] if all points of each curve are on the
    other curve, else [].
    """
    gaps, ways = [], []
    for curve, samples, others in (
        (curves[j], points[j], points[i]),
        (curves[i], points[i], points[j]),
    ):
        t = nearest_parameters(curve, samples, others, tolerance)
        gaps.append(float(np.linalg.norm(others - curve.evaluate(t), axis=1).max()))
        # negative if they run against it
        ways.append(float((np.diff(others, axis=0) * curve.derivatives(t[:-1])[1]).sum()))
        if gaps[-1] > tolerance:
            return []
    return [(max(gaps), i, j, ways[0] > 0.0)]


def nearest_parameters(curve: Curve, samples: NDArray, points: NDArray, tolerance: float) -> Array:
    """Return (n,) parameters of the curve points nearest to points; samples: (m, 3) of the curve,
    at equal steps.
    """
    low, high = curve.space.domain
    steps = low + (high - low) * np.linspace(0.0, 1.0, len(samples))
    closed = np.linalg.norm(samples[-1] - samples[0]) <= 2.0 * tolerance
    t = steps[np.argmin(((points[:, None] - samples[None]) ** 2).sum(axis=2), axis=1)]
    for _ in range(12):
        place, slope = curve.derivatives(t)
        square = (slope**2).sum(axis=1)
        step = ((points - place) * slope).sum(axis=1) / np.where(square > 0.0, square, 1.0)
        t = t + np.clip(step, steps[0] - steps[1], steps[1] - steps[0])
        t = low + (t - low) % (high - low) if closed else np.clip(t, low, high)
        if not len(t) or np.abs(step).max() <= 1e-15 * (high - low):
            break
    return t


def sharpest_crease(faces: Sequence[Face], topology: PatchTopology) -> float:
    """Return the largest angle, in radians, between the normals on both sides of a crease, 0 if
    there is none.
    """
    worst = max(map(_inner_crease_angle, split_faces(faces)[0]), default=0.0)
    sides = [
        (face, k, curve) for face, one in enumerate(faces) for k, (curve, _) in enumerate(one.sides)
    ]
    for seam in topology.seams.tolist():
        first_side, second_side = (
            _along_side(faces[face], k) * (-1.0 if topology.flipped[face] else 1.0)
            for face, k, _ in map(sides.__getitem__, seam)
        )
        points = [sides[k][2].samples(CREASE_SAMPLES) for k in seam]
        nearest = np.linalg.norm(points[0][:, None] - points[1], axis=2).argmin(axis=1)
        worst = max(worst, _largest_angle(first_side, second_side[nearest]))
    return worst


def _along_side(patch: Face, number: int) -> Array:
    """Return (m, 3) a face's unit normals along a side, at the samples of the side's curve; zero at
    poles.
    """
    if isinstance(patch, FlatFace):
        return np.tile(
            patch.normal, (len(patch.sides[number][0].space.uniform_parameters(CREASE_SAMPLES)), 1)
        )
    if isinstance(patch, TrimmedFace):
        return patch.normals(number, CREASE_SAMPLES)
    axis, end, _ = SIDES[number]
    held = patch.spaces[axis]
    run = patch.spaces[1 - axis]
    tables = [(np.array([held.domain[end]]), None), (run.uniform_parameters(CREASE_SAMPLES), None)]
    return _normals(patch, *(tables if axis == 0 else tables[::-1])).reshape(-1, 3)


def _inner_crease_angle(patch: Patch) -> float:
    """Return the largest crease angle at a patch's inner knots."""
    worst = 0.0
    for axis, space in enumerate(patch.spaces):
        inner = space.intervals[1:, 0]
        if not len(inner):
            continue
        across = patch.spaces[1 - axis].uniform_parameters(CREASE_SAMPLES), None
        before, after = ((inner, spans) for spans in (space.spans[:-1], space.spans[1:]))
        normals_before, normals_after = (
            _normals(patch, *((parameters, across) if axis == 0 else (across, parameters)))
            for parameters in (before, after)
        )
        worst = max(worst, _largest_angle(normals_before, normals_after))
    return worst


def _normals(patch: Patch, *parameters: tuple[NDArray, NDArray | None]) -> Array:
    """Return (m, n, 3) unit normals at parameters (values, spans or None) of s and of t; zero if
    undefined.
    """
    (s, by_s), (t, by_t) = (
        [space.collocation_matrix(at, k, spans) for k in (0, 1)]
        for space, (at, spans) in zip(patch.spaces, parameters)
    )
    net = np.moveaxis(patch.points - patch.points[0, 0], -1, 0)
    weights = np.ones(net.shape[1:]) if patch.weights is None else patch.weights
    net = np.concatenate([net * weights, weights[None]])
    place, along, across = (
        s_weights @ net @ t_weights.T for s_weights, t_weights in ((s, t), (by_s, t), (s, by_t))
    )
    along, across = (slope[:3] - place[:3] / place[3] * slope[3] for slope in (along, across))
    normal = np.stack(cross(along, across), axis=-1)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.where(
        length > POLE_RTOL * length.max(), normal / np.where(length > 0.0, length, 1.0), 0.0
    )


def _largest_angle(first: NDArray, second: NDArray) -> float:
    """Return the largest angle between corresponding unit vectors, ignoring pairs with a zero
    vector.
    """
    known = first.any(axis=-1) & second.any(axis=-1)
    chord = np.linalg.norm(first[known] - second[known], axis=-1).max(initial=0.0)
    return float(2.0 * np.arcsin(min(chord / 2.0, 1.0)))
