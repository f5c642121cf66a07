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
from typing import NamedTuple, TypeAlias

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
BESIDE = 1e-5  # Relative to a period: a spot so near to a seam is in the region too.
MIN_STEP = 1e-12  # relative to the coordinates' range: a gap of a track that needs no line
Chart: TypeAlias = Quadric | SplineChart


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
    chart: Chart,
    loops: Sequence[Sequence[Curve]],
    rounding: float,
    beyond: NDArray | None,
) -> TrimmedFace | Patch:
    """Return the region of a surface within loops, the patch itself if they follow its boundary;
    SurfaceRefusedError if they bound none.

    beyond: (n, 3) points outside of the region; None if loops run with the region on their left.
    """
    curves = [curve for loop in loops for curve in loop]
    controls = np.concatenate([np.zeros((0, 3)), *(curve.points for curve in curves)])
    size = float(np.linalg.norm(np.ptp(controls, axis=0))) if curves else 0.0
    near = SEAM_RTOL * size + 4.0 * rounding
    curves = [curve for curve in curves if np.ptp(curve.points, axis=0).max() > near]
    piece_counts = np.cumsum([len(curve.space.spans) for curve in curves])
    pieces = np.split(sample_pieces(curves), piece_counts[:-1]) if curves else []
    samples = [piece.reshape(-1, 3) for piece in pieces]
    boundary, seams = _without_seams(samples, near)
    if not (boundary or chart.is_closed):
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    chains = _chains(samples, boundary, MISS_RTOL * size + 4.0 * rounding)
    if isinstance(chart, Quadric) and chart.is_closed and not chart.radius:
        chart = _away_from_poles(chart, samples, boundary)
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
    no_points = np.zeros((0, 3))
    # The middles of seams, which are in the region.
    seam_points = np.concatenate(
        [no_points, *(samples[k][len(samples[k]) // 2][None] for k in seams)]
    )
    if beyond is not None:  # Points near the loops tell nothing about their sides.
        around = np.concatenate([no_points, *(samples[k] for k in boundary)])
        apart = np.linalg.norm(beyond[:, None] - around, axis=2).min(axis=1, initial=np.inf)
        beyond = beyond[apart > CLEAR_RTOL * size]
    if chart.is_closed:
        region = _closed_surface_region(chart, tracks, axis, seam_points, beyond)
    else:
        region = _open_surface_region(chart, tracks, axis, size)
    if isinstance(chart, SplineChart) and _follow_sides(chart, region.tracks, rounding):
        return chart.patch
    track_lines = [track.lines for track in region.tracks]
    face = TrimmedFace(
        chart,
        tuple(track.curves for track in region.tracks),
        # First an array of no pieces, for a face without loops.
        np.concatenate([sample_pieces([])[..., :2], *(track.pieces for track in region.tracks)]),
        np.concatenate([np.zeros((0, 2, 2)), *track_lines, *region.whole_surface]),
        axis,
        region.base,
        deviation,
    )
    # A seam in other pieces each way is no pair of curves: along it, loops bound a face of no area.
    is_unsure = chart.is_closed and tracks and beyond is None and not len(seam_points)
    thin = SEAM_RTOL * size * face.perimeter
    if is_unsure and face.area_moments(0, controls[0]).total <= thin:
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    return face


def _follow_sides(chart: SplineChart, tracks: Sequence[Track], rounding: float) -> bool:
    """Return whether loops run along the boundary of a patch."""
    if not tracks:
        return True
    places = np.concatenate([track.pieces.reshape(-1, 2) for track in tracks])
    ends = np.array([space.domain for space in chart.patch.spaces])
    # (n, 2, 2) relative distances from the begin and the end of both parameters
    away = np.abs(places[:, :, None] - ends) / np.ptp(ends, axis=1)[:, None]
    away[:, np.array(chart.periods) > 0.0] = np.inf
    axis, end = np.divmod(away.reshape(-1, 4).argmin(axis=1), 2)
    on_side = places.copy()
    np.put_along_axis(on_side, axis[:, None], ends[axis, end][:, None], axis=1)
    apart = np.subtract(*(chart.evaluate(*at.T)[0] for at in (places, on_side)))
    tolerance = WELDING_RTOL * patches_size([chart.patch]) + 4.0 * rounding
    return bool(np.linalg.norm(apart, axis=0).max() <= tolerance)


def _without_seams(samples: Sequence[NDArray], near: float) -> tuple[list[int], list[int]]:
    """Return the indices of curves that no other curve runs backward, and of one of each pair of
    others, by (m, 3) samples of each curve.
    """
    ends = np.array([points[[0, -1]] for points in samples]).reshape(-1, 2, 3)
    # Equal for a curve and its reverse.
    keys = np.concatenate([ends.sum(axis=1), np.abs(ends[:, 0] - ends[:, 1])], axis=1)
    single = dict.fromkeys(range(len(samples)))
    seams = []
    for k, j in sorted(zip(*map(np.ndarray.tolist, close_pairs(keys, 2.0 * near)))):
        is_possible = k in single and j in single and len(samples[k]) == len(samples[j])
        if is_possible and np.abs(samples[j] - samples[k][::-1]).max() <= near:
            del single[k], single[j]
            seams.append(k)
    return list(single), seams


def _chains(samples: Sequence[NDArray], boundary: Sequence[int], near: float) -> list[list[int]]:
    """Return closed loops of curves, each of which begins where the one before ends.

    boundary: the indices of the curves in `samples` that are used.
    """
    ends = np.array([samples[k][[0, -1]] for k in boundary]).reshape(-1, 2, 3)
    is_left = np.ones(len(boundary), bool)
    chains = []
    while is_left.any():
        chain = [int(is_left.argmax())]
        # The first curve is left until the chain returns to it. An edge may be shorter than the
        # tolerance, so the nearest begin is taken.
        while is_left[chain[0]]:
            gaps = np.linalg.norm(ends[:, 0] - ends[chain[-1], 1], axis=1)
            gaps = np.where(is_left, gaps, np.inf)
            chain.append(int(gaps.argmin()))
            if gaps[chain[-1]] > near:
                raise refuse("a loop that does not close")
            is_left[chain[-1]] = False
        chains.append([boundary[k] for k in chain[:-1]])
    return chains


def _away_from_poles(
    sphere: Quadric, samples: Sequence[NDArray], boundary: Sequence[int]
) -> Quadric:
    """Return a sphere with its axis so that no curve runs near a pole."""
    if not boundary:
        return sphere
    points = np.concatenate([samples[k] for k in boundary])
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
    chart: Chart, curves: Sequence[Curve], points: NDArray, size: float
) -> tuple[Track, float]:
    """Return a loop in coordinates, by (c, m, 3) samples of its pieces, and its largest distance
    from the surface.
    """
    flat = points.reshape(-1, 3)
    projected = chart.project(flat)
    place, along, _ = chart.evaluate(*projected.T)
    distance = float(np.linalg.norm(place.T - flat, axis=1).max())
    coordinates = projected.reshape(*points.shape[:2], 2)
    at_pole = (np.linalg.norm(along, axis=0) <= POLE_RTOL * size).reshape(coordinates.shape[:2])
    periods = np.array(chart.periods)
    for piece, is_pole in zip(coordinates, at_pole):
        # A pole has any angle: go on as beside it.
        for end, beside, farther in ((0, 1, 2), (-1, -2, -3)):
            if is_pole[end]:
                step = _shortest(piece[beside] - piece[farther], periods)
                piece[end, 0] = piece[beside, 0] + step[0]
    wrapped = coordinates.reshape(-1, 2)
    steps = _shortest(np.diff(wrapped, axis=0), periods)
    runs = wrapped[0] + np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    pieces = runs.reshape(coordinates.shape)
    closing = _shortest(runs[0] - runs[-1], periods)
    turns = np.round((runs[-1] + closing - runs[0]) / np.where(periods > 0.0, periods, 1.0))
    begins = np.concatenate([pieces[1:, 0], [runs[-1] + closing]])
    lines = np.stack([pieces[:, -1], begins], axis=1)
    is_gap = np.abs(np.diff(lines, axis=1)[:, 0]) > MIN_STEP * np.ptp(runs, axis=0).max()
    return Track(tuple(curves), pieces, lines[is_gap.any(axis=1)], turns), distance


def _shortest(steps: NDArray, periods: NDArray) -> Array:
    """Return (..., 2) steps of coordinates without whole periods."""
    return steps - periods * np.round(steps / np.where(periods > 0.0, periods, 1.0))


class _Region(NamedTuple):
    """Loops with the region on their left. base: the line where strips begin. whole_surface: a
    (1, 2, 2) line, from which strips cover the whole surface, if the loops only bound the rest.
    """

    tracks: list[Track]
    base: float
    whole_surface: list[Array]


def _open_surface_region(chart: Chart, tracks: list[Track], axis: int, size: float) -> _Region:
    """Return the region within loops on a surface with a boundary."""
    # Loops in pairs bound a band, whatever their directions; a single one goes round an apex.
    winds = int(sum(abs(track.turns[1 - axis]) for track in tracks)) % 2
    least = min(float(track.pieces[..., axis].min()) for track in tracks)
    base = _apex(chart, axis, size) if winds else least
    areas = [_signed_area(track, axis, base) for track in tracks]
    outer = int(np.argmax(np.abs(areas)))
    oriented = [
        track if (area > 0.0) == (k == outer) else track.reverse()
        for k, (track, area) in enumerate(zip(tracks, areas))
    ]
    return _Region(oriented, base, [])


def _closed_surface_region(
    chart: Chart, tracks: list[Track], axis: int, seam_points: NDArray, beyond: NDArray | None
) -> _Region:
    """Return the region within loops on a surface without a boundary: on the side where points of a
    seam are, else where points beyond are not, else on the left of the loops.
    """
    base, top = chart.limits
    if chart.periods[axis]:
        base = min((float(track.pieces[..., axis].min()) for track in tracks), default=base)
        top = base + chart.periods[axis]
    # Loops of a negative area bound all the rest.
    bounds_rest = sum(_signed_area(track, axis, base) for track in tracks) < 0.0 or not tracks
    if tracks:
        steps = np.concatenate([track.steps for track in tracks])
        has_seam = len(seam_points) > 0
        spots = seam_points[:1] if has_seam or beyond is None else beyond
        coordinates = chart.project(spots) if len(spots) else ()
        are_inside = {
            _covers(chart, steps, spot, axis, base) + bounds_rest > 0 for spot in coordinates
        }
        if len(are_inside) > 1 or not are_inside and beyond is not None:
            raise SurfaceRefusedError(SURFACE_TRIMMED)
        # Seams should be inside and points beyond outside, else the loops are reversed.
        if are_inside == {not has_seam}:
            tracks = [track.reverse() for track in tracks]
            bounds_rest = not bounds_rest
    if not bounds_rest:
        return _Region(tracks, base, [])
    other = 1 - axis
    start = min((float(track.pieces[..., other].min()) for track in tracks), default=0.0)
    line = np.full((1, 2, 2), top)
    line[0, :, other] = start, start + chart.periods[other]
    return _Region(tracks, base, [line[:, ::-1] if axis else line])


def _signed_area(track: Track, axis: int, base: float) -> float:
    """Return the area in coordinates between a base line and a loop, positive if the loop has the
    region on its left.
    """
    begin, end = np.moveaxis(track.steps, 1, 0)
    heights = (begin + end)[:, axis] / 2.0 - base
    return (-1.0 if axis else 1.0) * float((heights * (end - begin)[:, 1 - axis]).sum())


def _apex(chart: Chart, axis: int, size: float) -> float:
    """Return the end of the second coordinate that is a point; SurfaceRefusedError if none is, or
    if strips run along the first coordinate (axis 0).
    """
    for end in chart.limits if axis else ():
        if np.isfinite(end):
            place = chart.evaluate(chart.periods[0] * np.linspace(0.0, 1.0, 5), np.full(5, end))[0]
            if np.ptp(place, axis=1).max() <= SEAM_RTOL * size:
                return end
    raise SurfaceRefusedError(SURFACE_TRIMMED)


def _covers(chart: Chart, steps: NDArray, spot: NDArray, axis: int, base: float) -> int:
    """Return how often strips from the base line to (n, 2, 2) steps cover a spot (2,)."""
    other = 1 - axis
    period = chart.periods[other]
    # A seam often ends where a loop begins: its own coordinate is that of a sample.
    spot = spot + BESIDE * period
    begin_turns, end_turns = (
        np.floor((places[:, other] - spot[other]) / period) for places in np.moveaxis(steps, 1, 0)
    )
    heights = steps[:, :, axis].mean(axis=1)
    if chart.periods[axis]:
        turns = np.floor((heights - spot[axis]) / chart.periods[axis])
        above = turns - np.floor((base - spot[axis]) / chart.periods[axis])
    else:
        above = heights > spot[axis]
    return int(round(float(((end_turns - begin_turns) * above).sum()))) * (-1 if axis else 1)
