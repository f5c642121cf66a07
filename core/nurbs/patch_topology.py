# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Closedness and orientation of patches and flat faces, and the caps of their holes.

Every patch has four sides, curves that run round it with the patch on their left; the sides of a flat face are the
curves that bound it. A side is closed if it is a point (a
pole) or coincides with another side: of the same patch (a cyclic direction, a seam) or of another one, run the other
way. Sides coincide if they agree parameter by parameter, or else point by point; a side along several other ones is cut
where these end. A vector area of zero proves nothing:
an open cylinder's is zero too.

Open sides are joined to loops, and a loop is closed by the cone to its centroid. For a flat loop of any shape the cone
is the exact flat cap, as a signed sum. A cone over a B-spline curve is a B-spline patch with degree one in the other
direction, so that caps are patches like all others.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..mesh.boxes import overlapping_box_pairs
from ..numerics.arrays import following_pairs
from ..numerics.bspline import SplineSpace, clamped_space
from ..numerics.graph import connected_components
from ..verdict.finding import MeasureError
from .bezier_form import bezier_curves
from .curve import Curve
from .findings import DISCONTINUOUS_PATCH
from .flat_face import self_intersects
from .patch import Face, Patch
from .patch_moments import vector_area

SAMPLES_PER_SIDE = 33  # Least number of points at which sides are compared.
PAIRS_PER_BLOCK = 4096  # pairs of sides compared at a time
PAIRS_PER_BATCH = 1 << 20  # Candidate pairs of sides at a time.
FOLDED_ANGLE = 1e-3  # radians: patches that lie on each other
MAX_CHORDS = 4096  # Limit for a boundary loop that is tested for crossing itself.
MAX_CUT_SIDES = 400  # Limit of open sides that are compared with each other's ends.
MAX_SIDE_PAIRS = 100_000  # Limit of closed sides compared point by point.


@dataclass(frozen=True, eq=False)
class BoundaryLoop:
    """Open sides that run round a hole.

    caps: patches that close the hole and face as the sides' patches do. component: index of the sides' component.
    zero_area: the hole is closed already. area: of the cap, an estimate. self_intersecting: flat, and crosses itself.
    """

    caps: tuple[Patch, ...]
    component: int
    is_planar: bool
    zero_area: bool
    area: float
    self_intersecting: bool


@dataclass(frozen=True, eq=False)
class PatchTopology:
    """Components, orientations, joined sides and holes of patches.

    component: (n,) component index of each patch; number: of components. flipped: (n,) mask of patches that face
    against most of their component, or against its first if as many face each way. loops: the holes. open_sides,
    non_manifold_sides: the numbers of sides that are open, or coincide with several other sides. misoriented_sides: the
    number of joined pairs that run the same way before any patch is turned. seam_gap: the sum over joined sides of
    largest distance times length. seams: (k, 2) joined sides that were not cut, counted over all patches in turn.
    unclosable: (number,) mask of components with open sides that form no loop, or with a one-sided surface.
    """

    component: NDArray[np.intp]
    number: int
    flipped: NDArray[np.bool_]
    loops: tuple[BoundaryLoop, ...]
    open_sides: int
    non_manifold_sides: int
    misoriented_sides: int
    seam_gap: float
    seams: NDArray[np.intp]
    unclosable: NDArray[np.bool_]


def find_topology(patches: Sequence[Face], tolerance: float) -> PatchTopology:
    """Find the seams, orientation and holes of patches; MeasureError if a patch may be torn at a knot."""
    if any(space.is_discontinuous for patch in patches for space in patch.spaces):
        raise MeasureError(DISCONTINUOUS_PATCH)
    around_patches = [patch.sides for patch in patches]
    curves = [curve for around in around_patches for curve, _ in around]
    owner = np.repeat(np.arange(len(patches)), list(map(len, around_patches)))
    forward = np.array([ahead for around in around_patches for _, ahead in around])
    number_of = np.arange(len(curves))
    sides = _join_sides(curves, owner, forward, tolerance)
    pieces = _cut_sides(curves, sides, tolerance)
    if pieces:
        counts = np.array(list(map(len, pieces)))
        cut_owner, cut_forward = np.repeat(owner, counts), np.repeat(forward, counts)
        cut_curves = [curve for row in pieces for curve in row]
        cut_sides = _join_sides(cut_curves, cut_owner, cut_forward, tolerance)
        if cut_sides.open_length < sides.open_length - tolerance:
            curves, owner, forward, sides = cut_curves, cut_owner, cut_forward, cut_sides
            number_of = np.repeat(np.where(counts == 1, number_of, -1), counts)
    points, left, right, same, free = sides.points, sides.left, sides.right, sides.same, sides.free

    # Two sides fit if one runs against the other; else one of their patches must turn.
    misoriented = same == (forward[left] == forward[right])
    component, number = connected_components(len(patches), owner[left], owner[right])
    flipped, conflict = _orient_patches(len(patches), owner[left], owner[right], misoriented)
    are_most = 2 * np.bincount(component, flipped) > np.bincount(component)
    flipped ^= are_most[component]
    unclosable = np.zeros(number, bool)
    unclosable[component[conflict]] = True

    loops, forward = [], forward ^ flipped[owner]
    for loop_sides, complete in _find_loops(points, np.flatnonzero(free), forward, tolerance):
        if not complete:
            unclosable[component[owner[loop_sides]]] = True
            continue
        loop_curves, part = [curves[k] for k in loop_sides], int(component[owner[loop_sides[0]]])
        loops.append(_cap_loop(loop_curves, part, points[loop_sides], forward[loop_sides], tolerance))
    return PatchTopology(
        component,
        number,
        flipped,
        tuple(loops),
        int(free.sum()),
        sides.non_manifold,
        int(misoriented.sum()),
        sides.gap,
        np.stack([number_of[left], number_of[right]], axis=1)[(number_of[left] >= 0) & (number_of[right] >= 0)],
        unclosable,
    )


@dataclass(frozen=True, eq=False)
class _Sides:
    """Sides and how they meet.

    points: (n, m, 3) samples at equal steps. left, right: (k,) joined sides; same: (k,) whether their curves run the
    same way. free: (n,) mask of the open ones, of `open_length` in all. gap, non_manifold: as in PatchTopology.
    """

    points: NDArray[np.float64]
    left: NDArray[np.intp]
    right: NDArray[np.intp]
    same: NDArray[np.bool_]
    free: NDArray[np.bool_]
    open_length: float
    gap: float
    non_manifold: int


def _join_sides(
    curves: Sequence[Curve], owner: NDArray[np.intp], forward: NDArray[np.bool_], tolerance: float
) -> _Sides:
    """Find the sides that coincide. owner: (n,) patch of each side; forward: (n,) whether the patch is on its left."""
    count = max([SAMPLES_PER_SIDE] + [2 * len(curve.space.spans) + 1 for curve in curves])
    points = np.array([curve.apply_weights(_uniform_table(curve.space, count)) for curve in curves])
    length = np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
    free = np.linalg.norm(points - points[:, :1], axis=2).max(axis=1) > tolerance
    left, right, same, gap, non_manifold = _pair_sides(
        _coincident_sides(curves, points, np.flatnonzero(free), tolerance), points, owner, forward
    )
    free[left] = free[right] = False
    return _Sides(
        points, left, right, same, free, float(length[free].sum()), float((gap * length[left]).sum()), non_manifold
    )


def _cut_sides(curves: Sequence[Curve], sides: _Sides, tolerance: float) -> list[list[Curve]]:
    """Return the pieces of each side, open ones cut where other open ones end; none if there is nothing to cut."""
    open_sides = np.flatnonzero(sides.free)
    if not 3 <= len(open_sides) <= MAX_CUT_SIDES:
        return []
    ends = sides.points[open_sides][:, [0, -1]].reshape(-1, 3)
    pieces, is_cut = [[curve] for curve in curves], False
    for k in open_sides.tolist():
        curve, samples = curves[k], sides.points[k]
        step = np.linalg.norm(np.diff(samples, axis=0), axis=1).max()
        near = ends[np.linalg.norm(ends[:, None] - samples, axis=2).min(axis=1) <= step + tolerance]
        near = near[np.linalg.norm(near[:, None] - samples[[0, -1]], axis=2).min(axis=1) > 2.0 * tolerance]
        t = nearest_parameters(curve, samples, near, tolerance) if len(near) else np.zeros(0)
        t = np.unique(t[np.linalg.norm(near - curve.evaluate(t), axis=1) <= tolerance])
        if not len(t):
            continue
        marks = [curve.space.domain[0]]
        for at in t.tolist():
            if np.linalg.norm(np.diff(curve.evaluate([marks[-1], at]), axis=0)) > 2.0 * tolerance or len(marks) == 1:
                marks.append(at)
        marks.append(curve.space.domain[1])
        pieces[k] = [piece for part in zip(marks[:-1], marks[1:]) for piece in bezier_curves(curve, part)]
        is_cut = True
    return pieces if is_cut else []


@lru_cache(maxsize=64)
def _uniform_table(space: SplineSpace, count: int) -> NDArray[np.float64]:
    """Return (count, k) weights of k control points at equal steps of the domain; cached: do not modify."""
    low, high = space.domain
    return space.collocation_matrix(low + (high - low) * np.linspace(0.0, 1.0, count))


def _coincident_sides(
    curves: Sequence[Curve], points: NDArray, wide: NDArray[np.intp], tolerance: float
) -> list[tuple[float, int, int, bool]]:
    """Return pairs of coinciding sides, nearest first: distance, two indices, whether their curves run the same way."""
    middle = points.shape[1] // 2
    side_points = points[wide]
    first, last = side_points[:, 0], side_points[:, -1]
    left, right = _close_pairs(np.concatenate([first + last, 2.0 * side_points[:, middle]], axis=1), 2.0 * tolerance)
    coincident = list(_distance_between(points, wide[left], wide[right], tolerance))
    loose = np.ones(len(points), bool)
    loose[[side for _, i, j, _ in coincident for side in (i, j)]] = False
    # Equal curves with other parameters: between the same ends, or without ends.
    ring = np.linalg.norm(last - first, axis=1) <= 2.0 * tolerance
    arcs, rings = np.flatnonzero(loose[wide] & ~ring), np.flatnonzero(loose[wide] & ring)
    ends = _close_pairs(np.concatenate([first + last, np.abs(first - last)], axis=1)[arcs], 2.0 * tolerance)
    boxes = overlapping_box_pairs(
        side_points[rings].min(axis=1), side_points[rings].max(axis=1), -tolerance, MAX_SIDE_PAIRS
    )[:2]
    candidates = np.concatenate([arcs[np.stack(ends)], np.sort(rings[np.stack(boxes)], axis=0)], axis=1)
    for i, j in wide[candidates.T].tolist():
        coincident += _overlapping_sides(curves[i], curves[j], points[i], points[j], i, j, tolerance)
    return sorted(coincident)


def _pair_sides(
    coincident: Sequence[tuple[float, int, int, bool]],
    points: NDArray,
    owner: NDArray[np.intp],
    forward: NDArray[np.bool_],
) -> tuple[NDArray, NDArray, NDArray, NDArray, int]:
    """Return joined sides (k,) and (k,), whether their curves run the same way, distances; and the non-manifold count.

    If more than two sides meet, as for touching bodies, pairs of patches already joined by other sides come first, then
    single patches that fit without turning, then other patches that fit: so no patch is turned needlessly. Among equal
    pairs the sharpest angle comes first; patches that lie on each other come last.
    """
    times = np.bincount(np.array([side for _, i, j, _ in coincident for side in (i, j)], np.intp))
    part, odd, size = list(range(len(owner))), [False] * len(owner), [1] * len(owner)

    def root(patch: int) -> tuple[int, bool]:
        turn = False
        while part[patch] != patch:
            turn ^= odd[patch]
            patch = part[patch]
        return patch, turn

    pairs, used = [], np.zeros(len(owner), bool)
    middles = points.mean(axis=1)
    sums = np.add.reduceat(middles, np.flatnonzero(np.diff(owner, prepend=-1)), axis=0)
    arms = (sums / np.bincount(owner)[:, None])[owner] - middles
    arms /= np.maximum(np.linalg.norm(arms, axis=1), 1e-300)[:, None]

    def angle(pair: tuple[float, int, int, bool]) -> float:
        return float(np.linalg.norm(arms[pair[1]] - arms[pair[2]]))

    def rank(pair: tuple[float, int, int, bool]) -> int:
        _, i, j, same = pair
        (a, turn), (b, other) = root(int(owner[i])), root(int(owner[j]))
        flip = same == (forward[i] == forward[j])
        if a == b:
            rank_found = 0 if flip == turn ^ other else 4
        else:
            rank_found = 3 if flip else 1 if (size[a] == 1) != (size[b] == 1) else 2
        return max(rank_found, 3) if angle(pair) < FOLDED_ANGLE else rank_found

    def join(pair: tuple[float, int, int, bool]) -> None:
        _, i, j, same = pair
        (a, turn), (b, other) = root(int(owner[i])), root(int(owner[j]))
        if a != b:
            a, b = (a, b) if size[a] >= size[b] else (b, a)
            part[b], odd[b] = a, bool(same == (forward[i] == forward[j])) ^ turn ^ other
            size[a] += size[b]
        used[[i, j]] = True
        pairs.append(pair)

    crowds = [pair for pair in coincident if max(times[pair[1]], times[pair[2]]) > 1]
    for pair in coincident:
        if times[pair[1]] == times[pair[2]] == 1:
            join(pair)
    crowd, number = connected_components(len(owner), *(np.array([pair[k] for pair in crowds], np.intp) for k in (1, 2)))
    together: dict[int, list] = {}
    for pair in crowds:
        together.setdefault(int(crowd[pair[1]]), []).append(pair)
    for meeting in together.values():
        meeting.sort(key=lambda pair: (round(angle(pair), 3), pair))
        for priority in range(5):
            for pair in meeting:
                if not (used[pair[1]] or used[pair[2]]) and rank(pair) <= priority:
                    join(pair)
    left, right, same, gap = (
        (np.array(column) for column in zip(*((i, j, same, gap) for gap, i, j, same in pairs)))
        if pairs
        else np.zeros((4, 0))
    )
    return left.astype(np.intp), right.astype(np.intp), same.astype(bool), gap, int((times > 1).sum())


def _close_pairs(keys: NDArray, limit: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return pairs i < j of rows of (n, d) keys with no coordinate that differs by more than a limit."""
    keys = keys - keys[:1]
    slope = 1.0 / np.sqrt(np.arange(2.0, 2.0 + keys.shape[1]))
    line = (keys * slope).sum(axis=1)
    order = np.argsort(line, kind="stable")
    line = line[order]
    count = np.searchsorted(line, line + (limit * slope.sum() + 1e-12 * np.abs(line).max(initial=0.0)), side="right")
    count -= np.arange(1, len(line) + 1)
    pairs = []
    for i, j in following_pairs(order, count, PAIRS_PER_BATCH):
        near = (np.abs(keys[i] - keys[j]) <= limit).all(axis=1)
        pairs.append(np.sort([i[near], j[near]], axis=0))
    return tuple(np.concatenate([np.empty((2, 0), np.intp), *pairs], axis=1))


def _distance_between(
    points: NDArray, left: NDArray, right: NDArray, tolerance: float
) -> Iterator[tuple[float, int, int, bool]]:
    """Yield pairs of sides that coincide parameter by parameter: distance, indices, True if they run the same way."""
    for start in range(0, len(left), PAIRS_PER_BLOCK):
        i, j = left[start : start + PAIRS_PER_BLOCK], right[start : start + PAIRS_PER_BLOCK]
        reversed_distance, forward_distance = (
            np.linalg.norm(points[i] - other_points, axis=2).max(axis=1)
            for other_points in (points[j][:, ::-1], points[j])
        )
        for same, gap, fits in (
            (False, reversed_distance, reversed_distance <= tolerance),
            (True, forward_distance, (forward_distance <= tolerance) & (reversed_distance > tolerance)),
        ):
            yield from zip(gap[fits].tolist(), i[fits].tolist(), j[fits].tolist(), [same] * int(fits.sum()))


def _overlapping_sides(
    first: Curve, second: Curve, first_points: NDArray, second_points: NDArray, i: int, j: int, tolerance: float
) -> list[tuple[float, int, int, bool]]:
    """Return [(distance, i, j, True if same direction)] if all points of each curve are on the other curve, else []."""
    gaps, ways = [], []
    for curve, samples, points in ((second, second_points, first_points), (first, first_points, second_points)):
        t = nearest_parameters(curve, samples, points, tolerance)
        gaps.append(float(np.linalg.norm(points - curve.evaluate(t), axis=1).max()))
        ways.append(float((np.diff(points, axis=0) * curve.velocity(t[:-1])).sum()))  # negative if they run against it
        if gaps[-1] > tolerance:
            return []
    return [(max(gaps), int(i), int(j), bool(ways[0] > 0.0))]


def nearest_parameters(curve: Curve, samples: NDArray, points: NDArray, tolerance: float) -> NDArray[np.float64]:
    """Return (n,) parameters of the curve points nearest to points; samples: (m, 3) of the curve, at equal steps."""
    low, high = curve.space.domain
    steps = low + (high - low) * np.linspace(0.0, 1.0, len(samples))
    closed = np.linalg.norm(samples[-1] - samples[0]) <= 2.0 * tolerance
    t = steps[np.argmin(((points[:, None] - samples[None]) ** 2).sum(axis=2), axis=1)]
    for _ in range(12):
        slope = curve.velocity(t)
        square = (slope**2).sum(axis=1)
        step = ((points - curve.evaluate(t)) * slope).sum(axis=1) / np.where(square > 0.0, square, 1.0)
        t = t + np.clip(step, steps[0] - steps[1], steps[1] - steps[0])
        t = low + (t - low) % (high - low) if closed else np.clip(t, low, high)
    return t


def _orient_patches(
    count: int, left: NDArray, right: NDArray, misoriented: NDArray
) -> tuple[NDArray[np.bool_], NDArray[np.intp]]:
    """Return a mask of patches to turn, to face as the first of their component, and indices of patches in conflict."""
    neighbors: list[list[tuple[int, bool]]] = [[] for _ in range(count)]
    for i, j, flip in zip(left.tolist(), right.tolist(), misoriented.tolist()):
        neighbors[i].append((j, flip))
        neighbors[j].append((i, flip))
    flipped, visited, conflict = np.zeros(count, bool), np.zeros(count, bool), []
    for first in range(count):
        pending, visited[first] = [first], True
        while pending:
            i = pending.pop()
            for j, flip in neighbors[i]:
                if not visited[j]:
                    flipped[j], visited[j] = flipped[i] ^ flip, True
                    pending.append(j)
                elif flipped[j] != flipped[i] ^ flip:
                    conflict.append(i)
    return flipped, np.array(conflict, np.intp)


def _find_loops(
    points: NDArray, free: NDArray[np.intp], forward: NDArray[np.bool_], tolerance: float
) -> list[tuple[list[int], bool]]:
    """Join open sides to chains; return the side indices of each chain, and True if it is closed."""
    ahead = forward[free]
    begin, end = (points[free, np.where(ahead, source, target)] for source, target in ((0, -1), (-1, 0)))
    limit = 2.0 * tolerance
    i, j = _close_pairs(np.concatenate([begin, end]), limit)
    count = len(free)
    i, j = np.concatenate([i, j]), np.concatenate([j, i])  # both ways
    meet = (i >= count) & (j < count)
    i, j = i[meet] - count, j[meet]
    close = np.linalg.norm(end[i] - begin[j], axis=1) <= limit
    onward: list[list[int]] = [[] for _ in range(count)]
    for source, target in sorted(zip(i[close].tolist(), j[close].tolist())):
        onward[source].append(target)
    loops, used = [], np.zeros(count, bool)
    for first in range(count):
        path = [] if used[first] else [first]
        while path:
            used[path[-1]] = True
            after = [k for k in onward[path[-1]] if not used[k]]
            if first in onward[path[-1]] or not after:
                loops.append((free[path].tolist(), first in onward[path[-1]]))
                break
            path.append(after[0])
    return loops


def _cap_loop(
    curves: Sequence[Curve], component: int, points: NDArray, forward: NDArray[np.bool_], tolerance: float
) -> BoundaryLoop:
    """Close a loop by the cone to its centroid, and return the loop with its caps."""
    run = np.concatenate([row if ahead else row[::-1] for row, ahead in zip(points, forward)])
    steps = np.diff(np.concatenate([run, run[:1]]), axis=0)
    weigh = np.linalg.norm(steps, axis=1)
    center = ((run + steps / 2.0) * weigh[:, None]).sum(axis=0) / weigh.sum()
    arms = run - center
    _, _, axes = np.linalg.svd(arms, full_matrices=False)
    width = np.linalg.norm(np.cross(arms, steps), axis=1).sum() / 2.0
    caps = []
    for curve, ahead in zip(curves, forward):
        ends = (np.broadcast_to(center, curve.points.shape), curve.points)[:: 1 if ahead else -1]
        weights = None if curve.weights is None else np.stack([curve.weights] * 2, axis=1)
        caps.append(Patch((curve.space, clamped_space(2)), np.stack(ends, axis=1), weights))
    flat = bool(np.abs(arms @ axes[2]).max() <= tolerance)
    # A path there and back has no net area; for a loop in space only its cone's area shows that.
    area = float(np.linalg.norm(vector_area(caps))) if flat else width
    slim = bool(area <= tolerance * weigh.sum())
    crossing = flat and not slim and len(arms) <= MAX_CHORDS and self_intersects(arms @ axes[:2].T, tolerance)
    return BoundaryLoop(tuple(caps), component, flat, slim, area, crossing)
