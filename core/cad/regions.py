# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions of curved surfaces: how closed loops of curves in space run in a surface's coordinates,
and on which side of them the region is.

A seam, which a loop runs there and back, bounds nothing and is left out. Of the loops on a surface
with a boundary the outer one is found by its area. On a sphere or torus either side of a loop is a
region: a seam tells which, else the direction of the loops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..numerics import Array, NDArray, spread_directions
from ..nurbs import (
    Curve,
    Patch,
    Quadric,
    SplineChart,
    TrimmedFace,
    close_pairs,
    patches_size,
    reverse_curves,
    sample_pieces,
)
from ..verdict import WELDING_RTOL
from .findings import SURFACE_TRIMMED
from .surfaces import SurfaceRefusedError, refuse

CLEAR_RTOL = 1e-3  # relative to the size: a point so far from loops is on one side of them
SEAM_RTOL = 1e-6  # relative to the size: curves so near run along each other
TRIM_RTOL = 1e-7  # float32 rounding: distance of parameters from the domain, relative to it
MISS_RTOL = 1e-3  # relative to the size: a curve beyond this distance is not on the surface
POLE_RTOL = 1e-9  # relative to the size: the slope by the angle at a pole
MIN_CLEARANCE = (
    1e-3  # distance of curves from the poles of a sphere, as one minus the sine of the latitude
)
AXES = 64  # directions among which a sphere's axis is chosen
BESIDE = 1e-5  # of a period: a spot so near to a seam is in the region too
MIN_STEP = 1e-12  # relative to the coordinates' range: a gap of a track that needs no line


@dataclass(frozen=True, eq=False)
class Track:
    """A closed loop in coordinates. curves: in space. pieces: (n, m, 2) samples of their Bézier
    pieces. lines: (k, 2, 2) steps between the pieces. turns: (2,) whole periods that it winds.
    """

    curves: tuple[Curve, ...]
    pieces: Array
    lines: Array
    turns: Array

    def reverse(self) -> Track:
        """Return the loop, run backward."""
        curves = tuple(reverse_curves(self.curves))
        return Track(curves, self.pieces[::-1, ::-1], self.lines[::-1, ::-1], -self.turns)

    @property
    def steps(self) -> Array:
        """(n, 2, 2) begin and end of all straight steps."""
        runs = self.pieces.reshape(-1, 2)
        steps = np.stack([runs[:-1], runs[1:]], axis=1)
        last = self.lines[-1:]
        closing = last if len(last) and (last[0, 0] == runs[-1]).all() else steps[:0]
        return np.concatenate([steps, closing])


def curved_region(
    chart: Quadric | SplineChart,
    loops: Sequence[Sequence[Curve]],
    rounding: float,
    beyond: NDArray | None,
) -> TrimmedFace | Patch:
    """Return the region of a surface within loops, the patch itself if they follow its boundary;
    SurfaceRefusedError if they bound none.

    beyond: (n, 3) points outside of the region; None if loops run with the region on their left.
    """
    curves = [curve for loop in loops for curve in loop]
    box = np.concatenate([np.zeros((0, 3)), *(curve.points for curve in curves)])
    size = float(np.linalg.norm(np.ptp(box, axis=0))) if curves else 0.0
    near = SEAM_RTOL * size + 4.0 * rounding
    curves = [one for one in curves if np.ptp(one.points, axis=0).max() > near]
    counts = np.cumsum([len(curve.space.spans) for curve in curves])
    pieces = np.split(sample_pieces(curves), counts[:-1]) if curves else []
    samples = [row.reshape(-1, 3) for row in pieces]
    kept, seams = _without_seams(samples, near)
    if not (kept or chart.is_closed):
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    chains = _chains(samples, kept, MISS_RTOL * size + 4.0 * rounding)
    if isinstance(chart, Quadric) and chart.is_closed and not chart.radius:
        chart = _away_from_poles(chart, samples, kept)
    tracks = []
    deviation = 0.0
    for chain in chains:
        track, distance = _track(
            chart, [curves[k] for k in chain], np.concatenate([pieces[k] for k in chain]), size
        )
        tracks.append(track)
        deviation = max(deviation, distance)
    if deviation > MISS_RTOL * size + 10.0 * rounding:
        raise refuse("an edge that misses its surface")
    turns = np.array([track.turns for track in tracks]).reshape(-1, 2)
    if turns.any(axis=0).all():
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    axis = 0 if turns[:, 1].any() else 1
    witness = np.concatenate([samples[k][len(samples[k]) // 2][None] for k in seams] or [box[:0]])
    if beyond is not None:
        around = np.concatenate([samples[k] for k in kept] or [box[:0]])
        apart = np.linalg.norm(beyond[:, None] - around, axis=2).min(axis=1, initial=np.inf)
        beyond = beyond[apart > CLEAR_RTOL * size]
    tracks, base, whole = _oriented(chart, tracks, axis, witness, beyond, size)
    if isinstance(chart, SplineChart) and _follow_sides(chart, tracks, rounding):
        return chart.patch
    lines = np.concatenate([np.zeros((0, 2, 2)), *(track.lines for track in tracks), *whole])
    face = TrimmedFace(
        chart,
        tuple(track.curves for track in tracks),
        np.concatenate([sample_pieces([])[..., :2], *(track.pieces for track in tracks)]),
        lines,
        axis,
        base,
        deviation,
    )
    # A seam that is in other pieces each way shows no side of it.
    is_unsure = chart.is_closed and tracks and beyond is None and not len(witness)
    thin = SEAM_RTOL * size * face.perimeter
    if is_unsure and face.area_moments(0, box[0]).total <= thin:
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    return face


def _follow_sides(chart: SplineChart, tracks: Sequence[Track], rounding: float) -> bool:
    """Return whether loops run along the boundary of a patch."""
    if not tracks:
        return True
    places = np.concatenate([track.pieces.reshape(-1, 2) for track in tracks])
    ends = np.array([space.domain for space in chart.patch.spaces])
    away = np.abs(places[:, :, None] - ends) / np.ptp(ends, axis=1)[:, None]
    away[:, np.array(chart.periods) > 0.0] = np.inf
    axis, end = np.divmod(away.reshape(-1, 4).argmin(axis=1), 2)
    on_side = places.copy()
    np.put_along_axis(on_side, axis[:, None], ends[axis, end][:, None], axis=1)
    apart = np.subtract(*(chart.evaluate(*row.T)[0] for row in (places, on_side)))
    tolerance = WELDING_RTOL * patches_size([chart.patch]) + 4.0 * rounding
    return bool(np.linalg.norm(apart, axis=0).max() <= tolerance)


def _without_seams(samples: Sequence[NDArray], near: float) -> tuple[list[int], list[int]]:
    """Return the indices of curves that no other curve runs backward, and of one of each pair of
    others.
    """
    ends = np.array([row[[0, -1]] for row in samples]).reshape(-1, 2, 3)
    keys = np.concatenate([ends.sum(axis=1), np.abs(ends[:, 0] - ends[:, 1])], axis=1)
    kept = dict.fromkeys(range(len(samples)))
    seams = []
    for k, j in sorted(zip(*map(np.ndarray.tolist, close_pairs(keys, 2.0 * near)))):
        is_open = k in kept and j in kept and len(samples[k]) == len(samples[j])
        if is_open and np.abs(samples[j] - samples[k][::-1]).max() <= near:
            del kept[k], kept[j]
            seams.append(k)
    return list(kept), seams


def _chains(samples: Sequence[NDArray], kept: Sequence[int], near: float) -> list[list[int]]:
    """Return closed loops of curves, each of which begins where the one before ends."""
    begins, ends = np.array([samples[k][[0, -1]] for k in kept]).reshape(-1, 2, 3).swapaxes(0, 1)
    left = np.ones(len(kept), bool)
    chains = []
    while left.any():
        chain = [int(left.argmax())]
        # An edge may be shorter than the tolerance.
        while left[chain[0]]:
            gaps = np.where(left, np.linalg.norm(begins - ends[chain[-1]], axis=1), np.inf)
            chain.append(int(gaps.argmin()))
            if gaps[chain[-1]] > near:
                raise refuse("a loop that does not close")
            left[chain[-1]] = False
        chains.append([kept[k] for k in chain[:-1]])
    return chains


def _away_from_poles(sphere: Quadric, samples: Sequence[NDArray], kept: Sequence[int]) -> Quadric:
    """Return a sphere with its axis so that no curve runs near a pole."""
    if not kept:
        return sphere
    points = np.concatenate([samples[k] for k in kept])
    arms = np.linalg.solve(sphere.frame[:3, :3], (points - sphere.frame[:3, 3]).T) / sphere.minor
    axes = np.concatenate([[[0.0, 0.0, 1.0]], spread_directions(AXES)])
    clearance = 1.0 - np.abs(axes @ arms).max(axis=1)
    best = axes[0 if clearance[0] > MIN_CLEARANCE else int(clearance.argmax())]
    side = np.cross(best, np.eye(3)[np.abs(best).argmin()])
    side /= np.linalg.norm(side)
    turn = np.eye(4)
    turn[:3, :3] = np.stack([side, np.cross(best, side), best], axis=1)
    return replace(sphere, frame=sphere.frame @ turn)


def _track(
    chart: Quadric | SplineChart, curves: Sequence[Curve], points: NDArray, size: float
) -> tuple[Track, float]:
    """Return a loop in coordinates, by (c, m, 3) samples of its pieces, and its largest distance
    from the surface.
    """
    flat = points.reshape(-1, 3)
    found = chart.project(flat)
    place, along, _ = chart.evaluate(*found.T)
    distance = float(np.linalg.norm(place.T - flat, axis=1).max())
    found = found.reshape(*points.shape[:2], 2)
    pole = (np.linalg.norm(along, axis=0) <= POLE_RTOL * size).reshape(found.shape[:2])
    periods = np.array(chart.periods)

    def wrapped(steps: NDArray) -> NDArray:
        return steps - periods * np.round(steps / np.where(periods > 0.0, periods, 1.0))

    for row, is_pole in zip(found, pole):  # A pole has any angle: go on as beside it.
        for end, one, two in ((0, 1, 2), (-1, -2, -3)):
            if is_pole[end]:
                row[end, 0] = row[one, 0] + wrapped(row[one] - row[two])[0]
    runs = found.reshape(-1, 2)
    runs = runs[0] + np.concatenate(
        [np.zeros((1, 2)), np.cumsum(wrapped(np.diff(runs, axis=0)), axis=0)]
    )
    pieces = runs.reshape(found.shape)
    closing = wrapped(runs[0] - runs[-1])
    turns = np.round((runs[-1] + closing - runs[0]) / np.where(periods > 0.0, periods, 1.0))
    begins = np.concatenate([pieces[1:, 0], [runs[-1] + closing]])
    lines = np.stack([pieces[:, -1], begins], axis=1)
    span = np.ptp(runs, axis=0)
    lines = lines[(np.abs(np.diff(lines, axis=1)[:, 0]) > MIN_STEP * span.max()).any(axis=1)]
    return Track(tuple(curves), pieces, lines, turns), distance


def _oriented(
    chart: Quadric | SplineChart,
    tracks: Sequence[Track],
    axis: int,
    witness: NDArray,
    beyond: NDArray | None,
    size: float,
) -> tuple[list[Track], float, list[Array]]:
    """Return loops with the region on their left, the base line of the strips, and the line that
    adds the whole surface if it is needed.
    """
    low, high = chart.limits if axis else (-np.inf, np.inf)
    along = [track.pieces[..., axis] for track in tracks]
    least = min((float(row.min()) for row in along), default=low if np.isfinite(low) else 0.0)
    # Loops in pairs bound a band, whatever their directions; a single one goes round an apex.
    winds = int(sum(abs(track.turns[1 - axis]) for track in tracks)) % 2
    base = least
    if not chart.is_closed and winds:
        base = _apex(chart, low, high, size)
    elif chart.is_closed and not chart.periods[axis]:
        base = low
    sign = -1.0 if axis else 1.0

    def area(track: Track) -> float:
        begin, end = np.moveaxis(track.steps, 1, 0)
        heights = (begin + end)[:, axis] / 2.0 - base
        return sign * float((heights * (end - begin)[:, 1 - axis]).sum())

    areas = [area(track) for track in tracks]
    if not chart.is_closed:
        outer = int(np.argmax(np.abs(areas)))
        tracks = [
            track if (value > 0.0) == (k == outer) else track.reverse()
            for k, (track, value) in enumerate(zip(tracks, areas))
        ]
        return tracks, base, []
    top = base + chart.periods[axis] if chart.periods[axis] else high
    start = min((float(track.pieces[..., 1 - axis].min()) for track in tracks), default=0.0)
    ends = np.zeros((1, 2, 2))
    ends[:, :, axis] = top
    ends[0, :, 1 - axis] = start, start + chart.periods[1 - axis]
    if axis:
        ends = ends[:, ::-1]
    total = sum(areas)
    # Reversed loops bound all the rest.
    is_whole = total < 0.0 or not tracks
    if tracks:
        steps = np.concatenate([track.steps for track in tracks])
        known = witness[:1] if len(witness) or beyond is None else beyond
        spots = chart.project(known) if len(known) else ()
        held = {_covers(chart, steps, spot, axis, base) + is_whole > 0 for spot in spots}
        if len(held) > 1 or not held and beyond is not None:
            raise SurfaceRefusedError(SURFACE_TRIMMED)
        if held == {not len(witness)}:
            tracks = [track.reverse() for track in tracks]
            is_whole = not is_whole
    return list(tracks), base, [ends] if is_whole else []


def _apex(chart: Quadric | SplineChart, low: float, high: float, size: float) -> float:
    """Return the end of the second coordinate that is a point; SurfaceRefusedError if none is."""
    for end in (low, high):
        if np.isfinite(end):
            place = chart.evaluate(chart.periods[0] * np.linspace(0.0, 1.0, 5), np.full(5, end))[0]
            if np.ptp(place, axis=1).max() <= SEAM_RTOL * size:
                return end
    raise SurfaceRefusedError(SURFACE_TRIMMED)


def _covers(
    chart: Quadric | SplineChart, steps: NDArray, spot: NDArray, axis: int, base: float
) -> int:
    """Return how often strips from the base line to (n, 2, 2) steps cover a spot (2,)."""
    period = chart.periods[1 - axis]
    # A seam often ends where a loop begins: its own coordinate is that of a sample.
    spot = spot + BESIDE * period
    begin, end = (
        np.floor((row[:, 1 - axis] - spot[1 - axis]) / period) for row in np.moveaxis(steps, 1, 0)
    )
    heights = steps[:, :, axis].mean(axis=1)
    if chart.periods[axis]:
        turns = np.floor((heights - spot[axis]) / chart.periods[axis])
        above = turns - np.floor((base - spot[axis]) / chart.periods[axis])
    else:
        above = heights > spot[axis]
    return int(round(float(((end - begin) * above).sum()))) * (-1 if axis else 1)
