# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces: surfaces with the curves that bound them.

A boundary that follows that of the surface trims nothing. A plane is a flat face, whatever bounds
it. Any other surface is cut along its boundary (`regions`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..numerics import Array, Mask, NDArray, clamped_space, cross, dot
from ..nurbs import (
    Curve,
    Face,
    FlatFace,
    Patch,
    Quadric,
    SplineChart,
    chords_cross,
    nearest_parameters,
    patches_size,
    reverse_curves,
    self_intersects,
    vector_area,
)
from ..verdict import WELDING_RTOL, MeasureError
from .findings import SURFACE_TRIMMED
from .iges_sweeps import spanned_quadric
from .regions import MISS_RTOL, curved_region
from .surfaces import SurfaceRefusedError

FLAT_RTOL = 1e-8  # Relative to the size: a surface that is farther from a plane is curved.
END_TOLERANCE = (
    1e-5  # A curve that ends so near to the end of a side, as a share of it, ends there.
)
SEAM_SAMPLES = 8  # points on a span of a seam
CROSSING_SAMPLES = 7, 17  # on a span: ends of shorter chords may lie too near to a crossing
LIFTED_ORDER = 10  # of curves through points of a surface
LIFTED_RTOL = 1e-12  # relative to the size of a piece, which is halved until it is so near
LIFTED_DEPTH = 8
SAMPLES = 33  # points at which a curve is compared with the sides of a surface
_UNIT = (0.0, 1.0), (0.0, 1.0)
TRIM_RTOL = 1e-7  # float32 rounding: distance of the curve from the sides, relative to the domain


@dataclass(frozen=True, eq=False)
class Boundary:
    """A closed boundary of a face: its curves in space, and in the surface's parameters; None if
    they are unknown.
    """

    curves: list[Curve] | None
    parameters: list[Curve] | None = None
    prefers_parameters: bool = False


def within(
    surface: Patch | Quadric,
    boundaries: Sequence[Boundary],
    *,
    rounding: float = 0.0,
    beyond: NDArray | None = None,
) -> list[Face]:
    """Return the faces of a surface within boundaries, facing as the surface does;
    SurfaceRefusedError if they bound none.

    rounding: largest effect of the file's decimals on a point. beyond: (n, 3) points that no face
    reaches; None if boundaries run with the face on their left, seen from the side of the surface's
    normal.
    """
    loops = [one.curves or _lifted(surface, one.parameters or ()) for one in boundaries]
    if not all(loops):
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    in_space = [Boundary(loop) for loop in loops]
    if isinstance(surface, Quadric):
        try:
            patch = spanned_quadric(surface, [curve for loop in loops for curve in loop])
        except ValueError:
            patch = None
        if patch is not None and (not loops or _follow_sides(patch, _UNIT, in_space, surface)):
            return [patch]
        face = curved_region(surface, loops, rounding, beyond)
        return [face if face.loops else spanned_quadric(surface, [])]
    if _is_flat(surface, FLAT_RTOL * patches_size([surface]) + 4.0 * rounding):
        return [flat_region(loops, vector_area([surface]))]
    if _follow_sides(surface, _UNIT, in_space):
        return [surface]
    chart = SplineChart(surface)
    if chart.periods[1] and not chart.periods[0]:
        # Strips end at the sides of the direction that does not close.
        turned = SplineChart(surface.reverse_orientation())
        loops = [reverse_curves(loop) for loop in loops]
        return [curved_region(turned, loops, rounding, beyond).reverse_orientation()]
    face = curved_region(chart, loops, rounding, beyond)
    return [face if face.loops else surface]


def _lifted(surface: Patch | Quadric, parameters: Sequence[Curve]) -> list[Curve]:
    """Return curves in space through the points of a surface at curves of its parameters."""
    chart = surface if isinstance(surface, Quadric) else SplineChart(surface)
    nodes = (1.0 - np.cos(np.pi * np.arange(LIFTED_ORDER) / (LIFTED_ORDER - 1.0))) / 2.0
    space = clamped_space(LIFTED_ORDER)
    between = (nodes[1:] + nodes[:-1]) / 2.0
    tables = space.collocation_matrix(nodes), space.collocation_matrix(between)
    found = []
    if isinstance(chart, SplineChart) and parameters:
        ends = np.array([space.domain for space in chart.patch.spaces])
        places = np.concatenate([curve.samples(SAMPLES)[:, :2] for curve in parameters])
        beyond = np.maximum(ends[:, 0] - places, places - ends[:, 1]).max(axis=0)
        if (beyond > TRIM_RTOL * np.ptp(ends, axis=1))[np.equal(chart.periods, 0.0)].any():
            raise SurfaceRefusedError(SURFACE_TRIMMED)
    for curve in parameters:
        work = [(low, high, 0) for low, high in curve.space.intervals[::-1].tolist()]
        while work:
            low, high, depth = work.pop()
            truth, check = (
                chart.evaluate(*curve.evaluate(low + (high - low) * at).T[:2])[0].T
                for at in (nodes, between)
            )
            points = np.asarray(np.linalg.solve(tables[0], truth), np.float64)
            miss = np.abs(tables[1] @ points - check).max()
            if miss <= LIFTED_RTOL * np.ptp(truth, axis=0).max() or depth == LIFTED_DEPTH:
                found.append(Curve(space, points))
            else:
                middle = (low + high) / 2.0
                work += [(middle, high, depth + 1), (low, middle, depth + 1)]
    return found


def trimmed_faces(
    surface: Patch,
    domain: tuple[tuple[float, float], tuple[float, float]],
    patches: Sequence[Patch],
    boundaries: Sequence[Boundary],
    has_outer: bool,
    rounding: float = 0.0,
    quadric: Quadric | None = None,
    lifts: bool = True,
) -> list[Face]:
    """Return the faces of a surface within boundaries.

    domain: the used part of the surface. patches: that part, in one piece unless the surface may be
    torn. has_outer: False if the outer boundary is that of the surface. rounding: largest effect of
    the file's decimals on a point. quadric: the whole surface, if it is one. lifts: whether
    parameters of curved surfaces are those of `surface`.
    """
    if not boundaries:
        return [*patches]
    if len(patches) == 1:
        (patch,) = patches
        if has_outer and _follow_sides(patch, domain, boundaries, quadric):
            return [patch]
        tolerance = FLAT_RTOL * patches_size([surface]) + 4.0 * rounding
        around = [curve if ahead else curve.reverse() for curve, ahead in patch.sides]
        around = [curve for curve in around if np.ptp(curve.points, axis=0).any()]
        outer = [] if has_outer else [Boundary(around)]
        if _is_flat(patch, tolerance):
            return [_flat_face(surface, domain, [*outer, *boundaries], tolerance)]
        if not (lifts or all(one.curves for one in boundaries)):
            raise SurfaceRefusedError(SURFACE_TRIMMED)
        lifted = [
            replace(one, curves=one.curves or _lifted(surface, one.parameters or ()))
            for one in boundaries
        ]
        # A face that goes beyond a seam of its surface has this seam among its boundaries.
        seams = np.concatenate([curve.samples(SEAM_SAMPLES) for curve in around])
        faces = within(quadric or patch, [*outer, *lifted], rounding=rounding, beyond=seams)
        is_turned = quadric is not None and faces_away(quadric, patch)
        return [face.reverse_orientation() for face in faces] if is_turned else faces
    raise SurfaceRefusedError(SURFACE_TRIMMED)


def faces_away(quadric: Quadric, patch: Patch) -> bool:
    """Return whether a patch of a quadric faces inward."""
    middle = np.array([[np.mean(space.domain)] for space in patch.spaces])
    place, along, across = SplineChart(patch).evaluate(*middle)
    _, own_along, own_across = quadric.evaluate(*quadric.project(place.T).T)
    return float(dot(cross(along, across), cross(own_along, own_across))[0]) < 0.0


def flat_region(loops: Sequence[list[Curve]], normal: NDArray) -> FlatFace:
    """Return the region of a plane within loops that run with it on their left, seen from the side
    of `normal`; MeasureError if they bound none.

    Such loops may touch, but not cross, and leave the plane by a thousandth of their size.
    """
    try:
        return FlatFace.within(loops, normal)
    except MeasureError:
        face = FlatFace(tuple(map(tuple, loops)), normal / np.linalg.norm(normal))
        if not _is_sound(face):
            raise
        return face


def _is_sound(face: FlatFace) -> bool:
    """Return whether the loops of a flat face run around it, near its plane, and do not cross."""
    tolerance = MISS_RTOL * float(np.ptp(face.points, axis=0).max())
    off_plane = np.abs((face.points - face.center) @ face.normal).max()
    if off_plane > tolerance or not face.area_moments(0, face.center).total > 0.0:
        return False
    for each in CROSSING_SAMPLES:
        outlines = face.outlines(each)
        if any(self_intersects(outline, tolerance) for outline in outlines):
            return False
        if chords_cross(outlines, tolerance, touch=False):
            return False
    return True


def first_region(
    choices: Sequence[Sequence[list[Curve] | None]], normal: NDArray, rounding: float = 0.0
) -> FlatFace:
    """Return the first of several choices of loops that bound a region.

    rounding: largest effect of the file's decimals on a point. SurfaceRefusedError if none does.
    """
    for loops in choices:
        known = [loop for loop in loops if loop]
        if known and len(known) == len(loops):
            try:
                return FlatFace.within(known, normal, rounding)
            except MeasureError:
                continue
    raise SurfaceRefusedError(SURFACE_TRIMMED)


def _is_flat(patch: Patch, tolerance: float) -> bool:
    points = patch.points.reshape(-1, 3) - patch.points[0, 0]
    normal = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)[2][2]
    return bool(np.ptp(points @ normal) <= tolerance)


def _flat_face(
    surface: Patch,
    domain: tuple[tuple[float, float], tuple[float, float]],
    boundaries: Sequence[Boundary],
    tolerance: float,
) -> FlatFace:
    """Return the region of a flat surface within boundaries; SurfaceRefusedError if they do not
    bound one.
    """
    s, t = (np.linspace(*ends, 7) for ends in domain)
    grid = surface.evaluate_grid(s, t)
    steps = [
        (grid[-1, 0] - grid[0, 0]) / (s[-1] - s[0]),
        (grid[0, -1] - grid[0, 0]) / (t[-1] - t[0]),
    ]
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1] = steps
    matrix[:3, 3] = grid[0, 0] - steps[0] * s[0] - steps[1] * t[0]
    even = grid[0, 0] + (s - s[0])[:, None, None] * steps[0] + (t - t[0])[:, None] * steps[1]
    is_even = np.abs(grid - even).max() <= tolerance

    def placed(boundary: Boundary) -> list[Curve] | None:
        if boundary.parameters is None or not is_even:
            return None
        return [curve.transform(matrix) for curve in boundary.parameters]

    in_space = [boundary.curves or placed(boundary) for boundary in boundaries]
    by_parameters = [placed(boundary) or boundary.curves for boundary in boundaries]
    choices = [in_space, by_parameters][
        :: -1 if any(one.prefers_parameters for one in boundaries) else 1
    ]
    return first_region(choices, vector_area([surface]), tolerance / 4.0)


def _follow_sides(
    patch: Patch,
    domain: tuple[tuple[float, float], tuple[float, float]],
    boundaries: Sequence[Boundary],
    quadric: Quadric | None = None,
) -> bool:
    """Return whether boundaries follow a patch's boundary, in its parameters, or in space if these
    are unknown. quadric: the surface that the patch is a part of.
    """
    tolerance = WELDING_RTOL * patches_size([patch])
    sides = [[patch.side(axis, end) for end in (0, 1)] for axis in (0, 1)]
    samples = np.array([[curve.uniform(SAMPLES) for curve in row] for row in sides])
    is_pole = np.linalg.norm(samples - samples[:, :, :1], axis=3).max(axis=2) <= tolerance
    is_closed = np.abs(samples[:, 0] - samples[:, 1]).max(axis=(1, 2)) <= tolerance
    if all(boundary.parameters is not None for boundary in boundaries):
        pieces = [
            Piece(curve.points[:, :2], curve.space.order == 2)
            for boundary in boundaries
            for curve in boundary.parameters or ()
        ]
        return trims_nothing(pieces, domain, is_closed, is_pole)
    if any(boundary.curves is None for boundary in boundaries):
        return False
    left = np.array(
        [curve.uniform(SAMPLES) for boundary in boundaries for curve in boundary.curves or ()]
    )
    left = left[np.linalg.norm(left - left[:, :1], axis=2).max(axis=1) > tolerance]
    pieces = []
    places = np.zeros((4, SAMPLES, 2))
    if quadric is not None:
        points = np.concatenate([samples.reshape(4, SAMPLES, 3), left])
        places = quadric.project(points.reshape(-1, 3)).reshape(-1, SAMPLES, 2)
        for axis in np.flatnonzero(quadric.periods):
            places[..., axis] = np.unwrap(places[..., axis], period=quadric.periods[axis], axis=1)
    places, lines = places[4:], places[:4]
    for axis, end in np.argwhere(~is_pole).tolist():
        if quadric is None:
            share, is_on = _along_side(sides[axis][end], samples[axis, end], left, tolerance)
        else:
            share, is_on = _along_line(quadric, lines[2 * axis + end], places, left, tolerance)
            places = places[~is_on]
        if is_closed[1 - axis]:
            share = np.unwrap(share, axis=1, period=1.0)
        ends = np.full((len(left), 2, 2), float(end))
        ends[:, :, 1 - axis] = share[:, [0, -1]]
        whole = np.round(ends)
        ends = np.where(np.abs(ends - whole) <= END_TOLERANCE, whole, ends)
        pieces += [Piece(row, True) for row in ends[is_on]]
        left = left[~is_on]
    return not len(left) and trims_nothing(pieces, _UNIT, is_closed, is_pole)


def _along_side(
    side: Curve, samples: NDArray, rows: NDArray, tolerance: float
) -> tuple[Array, Mask]:
    """Return (n, m) shares of a side's parameter next to rows (n, m, 3) of points, and a mask of
    the rows on the side.
    """
    share = np.zeros(rows.shape[:2])
    step = np.linalg.norm(np.diff(samples, axis=0), axis=1).max()
    apart = np.linalg.norm(rows[:, :, None] - samples, axis=3).min(axis=2).max(axis=1)
    is_on = apart <= 2.0 * step + tolerance
    points = rows[is_on].reshape(-1, 3)
    if len(points):
        low, high = side.space.domain
        t = nearest_parameters(side, samples, points, tolerance)
        miss = np.linalg.norm(points - side.derivatives(t)[0], axis=1)
        share[is_on] = ((t - low) / (high - low)).reshape(-1, rows.shape[1])
        is_on[is_on] = miss.reshape(-1, rows.shape[1]).max(axis=1) <= tolerance
    return share, is_on


def _along_line(
    quadric: Quadric, side: NDArray, places: NDArray, rows: NDArray, tolerance: float
) -> tuple[Array, Mask]:
    """Return the same for a side (m, 2) along which one coordinate of a quadric is constant, as
    shares of the other one. places: (n, m, 2) coordinates of the rows.
    """
    middle = len(side) // 2
    still = int(np.abs(side[middle + 1] - side[middle]).argmin())
    on_side = np.where(np.arange(2) == still, side[middle], places)
    miss = np.moveaxis(quadric.evaluate(*np.moveaxis(on_side, 2, 0))[0], 0, 2) - rows
    is_on = np.linalg.norm(miss, axis=2).max(axis=1) <= tolerance
    side, run = side[:, 1 - still], places[:, :, 1 - still]
    period = quadric.periods[1 - still]
    if period:
        run = run + period * np.round((side[middle] - run[:, middle, None]) / period)
    return (run - side[0]) / (side[-1] - side[0]), is_on


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of a curve with (n, 2) control points. straight: True if they are the corners of a
    polygonal line.
    """

    points: Array
    straight: bool


def trims_nothing(
    pieces: Sequence[Piece],
    domain: tuple[tuple[float, float], tuple[float, float]],
    closed: Sequence[bool] = (False, False),
    poles: Sequence[Sequence[bool]] = ((False, False), (False, False)),
) -> bool:
    """Return whether the pieces run along the whole boundary once, always in the same sense of
    rotation.

    Sides that are one point may be left out; a seam is run once in each direction. closed: whether
    the surface closes along each direction. poles: whether its side at the least and the largest
    value of each parameter is a point.
    """
    low, high = np.array(domain).T
    if not pieces or not (high > low).all():
        return False
    runs = _runs(
        [((piece.points - low) / (high - low), piece.straight) for piece in pieces], closed
    )
    if runs is None:
        return False
    senses: set[float] = set()
    for axis in (0, 1):
        along = sorted((at, begin, end) for run, at, begin, end in runs if run == axis)
        sides_left = (
            set() if closed[1 - axis] else {end for end in (0, 1) if not poles[1 - axis][end]}
        )
        starts = [
            k for k, run in enumerate(along) if not k or run[0] - along[k - 1][0] > 2.0 * TRIM_RTOL
        ]
        for first, last in zip(starts, [*starts[1:], len(along)]):
            net, total = _traversals([run[1:] for run in along[first:last]], closed[axis])
            side = next((end for end in (0, 1) if abs(along[first][0] - end) <= TRIM_RTOL), None)
            if side is None or closed[1 - axis]:
                is_right = not net.any() and (total <= 2).all()
            elif poles[1 - axis][side]:
                is_right = bool((total <= 1).all())
            else:
                is_right = bool((total == 1).all() and (net == net[0]).all())
                senses.add(float(net[0]) * (1.0 if (axis == 0) == (side == 0) else -1.0))
                sides_left.discard(side)
            if not is_right:
                return False
        if sides_left:
            return False
    return len(senses) <= 1


def _runs(
    pieces: Sequence[tuple[NDArray, bool]], closed: Sequence[bool]
) -> list[tuple[int, float, float, float]] | None:
    """Return runs along the directions of the unit square: the changing parameter, the other one,
    begin and end.

    pieces: control points, and True if they are corners. None if a piece runs across.
    """
    runs = []
    for points, straight in pieces:
        for row in np.stack([points[:-1], points[1:]], axis=1) if straight else points[None]:
            is_still = np.ptp(row, axis=0) <= TRIM_RTOL
            if is_still.all():
                continue
            axis = int(is_still.argmin())
            at = float(row[:, 1 - axis].mean())
            ends = row[[0, -1], axis].tolist()
            is_beyond = min(ends) < -TRIM_RTOL or max(ends) > 1.0 + TRIM_RTOL
            if not is_still.any() or is_beyond and not closed[axis]:
                return None
            if closed[1 - axis]:  # A seam at the end of the domain is the one at its beginning.
                at = (at + TRIM_RTOL) % 1.0 - TRIM_RTOL
            runs.append((axis, at, *ends))
    return runs


def _traversals(runs: Sequence[tuple[float, float]], closed: bool) -> tuple[NDArray, NDArray]:
    """Return for each piece of a line the counts of runs along it: the difference of both
    directions, and the sum.
    """
    marks = [0.0, 1.0]
    changes = []
    for begin, end in runs:
        low = min(begin, end)
        high = max(begin, end)
        way = 1 if end > begin else -1
        turns = (
            range(int(np.floor(low + TRIM_RTOL)), int(np.ceil(high - TRIM_RTOL))) if closed else [0]
        )
        for turn in turns:
            ends = max(low - turn, 0.0), min(high - turn, 1.0)
            changes.append((*ends, way))
            marks += ends
    edges = np.unique(marks)
    middles = ((edges[:-1] + edges[1:]) / 2.0)[np.diff(edges) > 2.0 * TRIM_RTOL]
    passes = np.array([way * ((low < middles) & (middles < high)) for low, high, way in changes])
    return passes.sum(axis=0), np.abs(passes).sum(axis=0)
