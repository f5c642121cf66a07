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
from typing import TYPE_CHECKING, NamedTuple

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
    coinciding_sides = [side for pair in coincident for side in (pair.first, pair.second)]
    times = np.bincount(np.array(coinciding_sides, np.intp))
    pairs, turned = _pair_sides(coincident, times, points, owner, forward, patches)
    left, right = np.array([(pair.first, pair.second) for pair in pairs], np.intp).reshape(-1, 2).T
    gap = np.array([pair.distance for pair in pairs], np.float64)
    free[left] = free[right] = False
    return Sides(
        points=points,
        left=left,
        right=right,
        same=np.array([pair.same for pair in pairs], bool),
        turned=turned,
        free=free,
        open_length=float(length[free].sum()),
        gap=float((gap * length[left]).sum()),
        non_manifold=int((times > 1).sum()),
    )


def cut_open_sides(curves: Sequence[Curve], sides: Sides, tolerance: float) -> list[list[Curve]]:
    """Return the pieces of each side, open ones cut where other open ones end; none if there is
    nothing to cut.
    """
    open_sides = np.flatnonzero(sides.free)
    if not 3 <= len(open_sides) <= MAX_CUT_SIDES:
        return []
    pieces = [[curve] for curve in curves]
    is_cut = False
    for k, ends in _ends_near_sides(sides.points[open_sides], tolerance):
        side = int(open_sides[k])
        cuts = _cut_parameters(curves[side], sides.points[side], ends, tolerance)
        if len(cuts) > 2:
            is_cut = True
            pieces[side] = [
                piece
                for part in zip(cuts[:-1], cuts[1:])
                for piece in bezier_curves(curves[side], part)
            ]
    return pieces if is_cut else []


def _ends_near_sides(samples: NDArray, tolerance: float) -> Iterator[tuple[int, Array]]:
    """Yield the index of each side in whose box ends of other sides are, and these ends (e, 3).

    samples: (n, m, 3) of all sides.
    """
    count = len(samples)
    ends = samples[:, [0, -1]].reshape(-1, 3)
    steps = _sample_steps(samples)[:, None]
    low, high = samples.min(axis=1) - steps, samples.max(axis=1) + steps
    pairs = overlapping_box_pairs(
        np.concatenate([low, ends]), np.concatenate([high, ends]), -tolerance, MAX_END_PAIRS
    )[:2]
    # The boxes of sides come first: a pair of a side and an end has one number below the count.
    side, end = np.sort(pairs, axis=0) - [[0], [count]]
    is_side_with_end = (side < count) & (end >= 0)
    side, end = side[is_side_with_end], end[is_side_with_end]
    own_ends = samples[side][:, [0, -1]]
    is_other = np.linalg.norm(ends[end, None] - own_ends, axis=2).min(axis=1) > 2.0 * tolerance
    side, end = side[is_other], end[is_other]
    order = np.argsort(side, kind="stable")
    crossed_sides, starts = np.unique(side[order], return_index=True)
    yield from zip(crossed_sides.tolist(), np.split(ends[end[order]], starts[1:]))


def _cut_parameters(curve: Curve, samples: NDArray, ends: NDArray, tolerance: float) -> list[float]:
    """Return the parameters of a side's curve where ends (e, 3) of other sides lie on it, from the
    begin of its domain to its end.

    samples: (m, 3) of the curve at equal steps.
    """
    # Whole circles are most often cut at their knots.
    knots = curve.space.intervals[1:, 0]
    is_near = np.linalg.norm(ends[:, None] - curve.evaluate(knots), axis=2) <= tolerance
    parameters = knots[is_near.any(axis=0)]
    rest = ends[~is_near.any(axis=1)]
    apart = np.linalg.norm(rest[:, None] - samples, axis=2).min(axis=1)
    rest = rest[apart <= _sample_steps(samples) + tolerance]
    if len(rest):
        nearest = nearest_parameters(curve, samples, rest, tolerance)
        miss = np.linalg.norm(rest - curve.evaluate(nearest), axis=1)
        parameters = np.unique(np.concatenate([parameters, nearest[miss <= tolerance]]))
    low, high = curve.space.domain
    # The first parameter is no begin of the side: its own ends are left out (`_ends_near_sides`).
    cuts = [low]
    for parameter in parameters.tolist():
        length = np.linalg.norm(np.diff(curve.evaluate([cuts[-1], parameter]), axis=0))
        if length > 2.0 * tolerance or len(cuts) == 1:
            cuts.append(parameter)
    return [*cuts, high]


def _sample_steps(samples: NDArray) -> Array:
    """Return the (...,) largest distances of neighboring samples (..., m, 3)."""
    return np.linalg.norm(np.diff(samples, axis=-2), axis=-1).max(axis=-1)


class _Pair(NamedTuple):
    """Two sides that coincide: their largest distance, their indices, and whether their curves run
    the same way.
    """

    distance: float
    first: int
    second: int
    same: bool


def _coincident_sides(
    curves: Sequence[Curve], points: NDArray, wide: Index, tolerance: float
) -> list[_Pair]:
    """Return the pairs of coinciding sides, nearest first. wide: the indices of the sides that are
    no points.
    """
    middle = points.shape[1] // 2
    side_points = points[wide]
    begin, end = side_points[:, 0], side_points[:, -1]
    # These keys are equal for a side and its reverse.
    left, right = close_pairs(
        np.concatenate([begin + end, 2.0 * side_points[:, middle]], axis=1), 2.0 * tolerance
    )
    coincident = list(_pairs_by_parameter(points, wide[left], wide[right], tolerance))
    is_loose = np.ones(len(points), bool)
    is_loose[[side for pair in coincident for side in (pair.first, pair.second)]] = False
    # Equal curves with other parameters: between the same ends, or without ends.
    is_ring = np.linalg.norm(end - begin, axis=1) <= 2.0 * tolerance
    arcs = np.flatnonzero(is_loose[wide] & ~is_ring)
    rings = np.flatnonzero(is_loose[wide] & is_ring)
    arc_keys = np.concatenate([begin + end, np.abs(begin - end)], axis=1)[arcs]
    arc_pairs = np.stack(close_pairs(arc_keys, 2.0 * tolerance))
    ring_points = side_points[rings]
    ring_pairs = overlapping_box_pairs(
        ring_points.min(axis=1), ring_points.max(axis=1), -tolerance, MAX_SIDE_PAIRS
    )[:2]
    candidates = np.concatenate([arcs[arc_pairs], np.sort(rings[np.stack(ring_pairs)], axis=0)], 1)
    for first, second in wide[candidates.T].tolist():
        coincident += _pairs_by_points(curves, points, first, second, tolerance)
    return sorted(coincident)


class _Merging:
    """Patches that joined sides merge to groups, and which of them must turn.

    owner: (n,) patch of each side. forward: (n,) whether the patch is on its left.
    """

    def __init__(self, owner: Index, forward: Mask, patch_count: int) -> None:
        self._owner = owner
        self._forward = forward
        # A union-find forest: the parent of each patch, whether it is turned against the parent,
        # and the size of its group if it is a root.
        self._parent = list(range(patch_count))
        self._is_odd = [False] * patch_count
        self._size = [1] * patch_count
        self.is_joined = np.zeros(len(owner), bool)  # (n,) sides
        self.pairs: list[_Pair] = []

    def root(self, patch: int) -> tuple[int, bool]:
        """Return the root of a patch's group, and whether the patch is turned against the root."""
        is_turned = False
        while self._parent[patch] != patch:
            is_turned ^= self._is_odd[patch]
            patch = self._parent[patch]
        return patch, is_turned

    def needs_turn(self, pair: _Pair) -> bool:
        """Return whether one of the two patches must be turned, as both are given."""
        return bool(pair.same == (self._forward[pair.first] == self._forward[pair.second]))

    def rank(self, pair: _Pair) -> int:
        """Return the rank of a pair: 0 within a group; 1 joins a single patch, 2 other groups,
        without turning; 3 joins with turning; 4 contradicts its group.
        """
        first, is_first_turned = self.root(int(self._owner[pair.first]))
        second, is_second_turned = self.root(int(self._owner[pair.second]))
        needs_turn = self.needs_turn(pair)
        if first == second:
            return 0 if needs_turn == is_first_turned ^ is_second_turned else 4
        if needs_turn:
            return 3
        return 1 if (self._size[first] == 1) != (self._size[second] == 1) else 2

    def join(self, pair: _Pair) -> None:
        """Join two sides, and merge the groups of their patches, the smaller into the larger."""
        first, is_first_turned = self.root(int(self._owner[pair.first]))
        second, is_second_turned = self.root(int(self._owner[pair.second]))
        if first != second:
            if self._size[first] < self._size[second]:
                first, second = second, first
            self._parent[second] = first
            self._is_odd[second] = self.needs_turn(pair) ^ is_first_turned ^ is_second_turned
            self._size[first] += self._size[second]
        self.is_joined[[pair.first, pair.second]] = True
        self.pairs.append(pair)


def _pair_sides(
    coincident: Sequence[_Pair],
    times: Index,
    points: NDArray,
    owner: Index,
    forward: Mask,
    patch_count: int,
) -> tuple[list[_Pair], Mask]:
    """Return the joined pairs, and a (patches,) mask of the ones to turn. times: number of pairs
    with each side.

    If more than two sides meet, as for touching bodies, pairs of patches already joined by other
    sides come first, then single patches that fit without turning, then other patches that fit: so
    no patch is turned needlessly. Among equal pairs the sharpest angle comes first; patches that
    lie on each other come last.
    """
    merging = _Merging(owner, forward, patch_count)
    crowded = []
    for pair in coincident:
        if times[pair.first] == times[pair.second] == 1:
            merging.join(pair)
        else:
            crowded.append(pair)
    arms = _arms(points, owner, patch_count)
    angles = {pair: float(np.linalg.norm(arms[pair.first] - arms[pair.second])) for pair in crowded}
    crowded_sides = np.array([(pair.first, pair.second) for pair in crowded], np.intp)
    meeting_of_side, _ = connected_components(len(owner), *crowded_sides.reshape(-1, 2).T)
    meetings: dict[int, list[_Pair]] = {}
    for pair in crowded:
        meetings.setdefault(int(meeting_of_side[pair.first]), []).append(pair)
    for meeting in meetings.values():
        meeting.sort(key=lambda pair: (round(angles[pair], 3), pair))
        for priority in range(5):
            for pair in meeting:
                # Folded patches may only be joined with the last two ranks.
                least = 3 if angles[pair] < FOLDED_ANGLE else 0
                is_free = not (merging.is_joined[pair.first] or merging.is_joined[pair.second])
                if is_free and max(merging.rank(pair), least) <= priority:
                    merging.join(pair)
    is_turned = [merging.root(patch)[1] for patch in range(patch_count)]
    return merging.pairs, np.array(is_turned, bool)


def _arms(points: NDArray, owner: Index, patch_count: int) -> Array:
    """Return (n, 3) directions from the middles of sides to those of their patches."""
    middles = points.mean(axis=1)
    sums = np.zeros((patch_count, 3))
    np.add.at(sums, owner, middles)
    arms = (sums[owner] / np.bincount(owner)[owner, None]) - middles
    return arms / np.maximum(np.linalg.norm(arms, axis=1), 1e-300)[:, None]


def close_pairs(keys: NDArray, limit: float) -> tuple[Index, Index]:
    """Return pairs i < j of rows of (n, d) keys with no coordinate that differs by more than a
    limit.
    """
    keys = keys - keys[:1]
    # Along a skew line, close rows are close too, and few others: only neighbors are compared. No
    # ratio of two slopes is simple, so that rows of a grid seldom share a place on the line.
    slope = 1.0 / np.sqrt(np.arange(2.0, 2.0 + keys.shape[1]))
    line = (keys * slope).sum(axis=1)
    order = np.argsort(line, kind="stable")
    line = line[order]
    reach = limit * slope.sum() + 1e-12 * np.abs(line).max(initial=0.0)
    count = np.searchsorted(line, line + reach, side="right")
    count -= np.arange(1, len(line) + 1)
    pairs = []
    for i, j in following_pairs(order, count, PAIRS_PER_BATCH):
        near = (np.abs(keys[i] - keys[j]) <= limit).all(axis=1)
        pairs.append(np.sort([i[near], j[near]], axis=0))
    return tuple(np.concatenate([np.empty((2, 0), np.intp), *pairs], axis=1))


def _pairs_by_parameter(
    points: NDArray, left: NDArray, right: NDArray, tolerance: float
) -> Iterator[_Pair]:
    """Yield those pairs of sides that coincide parameter by parameter; (k,) indices of sides."""
    for start in range(0, len(left), PAIRS_PER_BLOCK):
        i = left[start : start + PAIRS_PER_BLOCK]
        j = right[start : start + PAIRS_PER_BLOCK]
        against = np.linalg.norm(points[i] - points[j][:, ::-1], axis=2).max(axis=1)
        along = np.linalg.norm(points[i] - points[j], axis=2).max(axis=1)
        is_against = against <= tolerance
        is_along = (along <= tolerance) & ~is_against
        for distance, fits, same in ((against, is_against, False), (along, is_along, True)):
            for row in zip(distance[fits].tolist(), i[fits].tolist(), j[fits].tolist()):
                yield _Pair(*row, same)


def _pairs_by_points(
    curves: Sequence[Curve], points: NDArray, i: int, j: int, tolerance: float
) -> list[_Pair]:
    """Return the pair of two sides if all points of each curve are on the other curve, else an
    empty list.
    """
    gaps, ways = [], []
    for curve, samples, others in (
        (curves[j], points[j], points[i]),
        (curves[i], points[i], points[j]),
    ):
        nearest = nearest_parameters(curve, samples, others, tolerance)
        gaps.append(float(np.linalg.norm(others - curve.evaluate(nearest), axis=1).max()))
        # The sum of steps along tangents is negative if the curves run against each other.
        tangents = curve.derivatives(nearest[:-1])[1]
        ways.append(float((np.diff(others, axis=0) * tangents).sum()))
        if gaps[-1] > tolerance:
            return []
    return [_Pair(max(gaps), i, j, ways[0] > 0.0)]


def nearest_parameters(curve: Curve, samples: NDArray, points: NDArray, tolerance: float) -> Array:
    """Return (n,) parameters of the curve points nearest to points; samples: (m, 3) of the curve,
    at equal steps.
    """
    low, high = curve.space.domain
    steps = low + (high - low) * np.linspace(0.0, 1.0, len(samples))
    closed = np.linalg.norm(samples[-1] - samples[0]) <= 2.0 * tolerance
    t = steps[np.argmin(((points[:, None] - samples[None]) ** 2).sum(axis=2), axis=1)]
    # Gauss-Newton steps, none longer than the distance of samples; 12 are enough from so near.
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
    # Of each side: the index of its face, its number among the sides of this, and its curve.
    sides = [
        (index, number, curve)
        for index, face in enumerate(faces)
        for number, (curve, _) in enumerate(face.sides)
    ]
    for seam in topology.seams.tolist():
        normals, points = [], []
        for side in seam:
            index, number, curve = sides[side]
            turn = -1.0 if topology.flipped[index] else 1.0
            normals.append(turn * _along_side(faces[index], number))
            points.append(curve.samples(CREASE_SAMPLES))
        nearest = np.linalg.norm(points[0][:, None] - points[1], axis=2).argmin(axis=1)
        worst = max(worst, _largest_angle(normals[0], normals[1][nearest]))
    return worst


def _along_side(patch: Face, number: int) -> Array:
    """Return the (m, 3) unit normals of a face at the samples of a side's curve; zero at poles."""
    if isinstance(patch, FlatFace):
        parameters = patch.curves[number].space.uniform_parameters(CREASE_SAMPLES)
        return np.tile(patch.normal, (len(parameters), 1))
    if isinstance(patch, TrimmedFace):
        return patch.normals(number, CREASE_SAMPLES)
    axis, end, _ = SIDES[number]
    at_end = np.array([patch.spaces[axis].domain[end]]), None
    along = patch.spaces[1 - axis].uniform_parameters(CREASE_SAMPLES), None
    return _normals(patch, *((at_end, along) if axis == 0 else (along, at_end))).reshape(-1, 3)


def _inner_crease_angle(patch: Patch) -> float:
    """Return the largest crease angle at a patch's inner knots."""
    worst = 0.0
    for axis, space in enumerate(patch.spaces):
        inner = space.intervals[1:, 0]
        if not len(inner):
            continue
        across = patch.spaces[1 - axis].uniform_parameters(CREASE_SAMPLES), None
        # At a knot, the span before it and the one after it have each a normal.
        before, after = (
            _normals(patch, *((knots, across) if axis == 0 else (across, knots)))
            for knots in ((inner, space.spans[:-1]), (inner, space.spans[1:]))
        )
        worst = max(worst, _largest_angle(before, after))
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
