# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces: surfaces with the curves that bound them.

A plane is a flat face, whatever bounds it. Any other surface is cut along its boundary (`regions`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..numerics import Array, NDArray, clamped_space
from ..nurbs import (
    Curve,
    Face,
    FlatFace,
    Patch,
    Quadric,
    SplineChart,
    bezier_nets,
    chords_cross,
    evaluate_nets,
    halves,
    patches_size,
    reverse_curves,
    sample_pieces,
    self_intersects,
    vector_area,
)
from ..verdict import MeasureError
from .findings import SURFACE_TRIMMED
from .regions import MISS_RTOL, TRIM_RTOL, curved_region
from .surfaces import SurfaceRefusedError, refuse

FLAT_RTOL = 1e-8  # Relative to the size: a surface that is farther from a plane is curved.
SEAM_SAMPLES = 8  # points on a span of a seam
CROSSING_SAMPLES = 7, 17  # on a span: ends of shorter chords may lie too near to a crossing
LIFTED_ORDER = 10  # order of curves through points of a surface
LIFTED_RTOL = 1e-12  # relative to the size of a piece, which is halved until it is so near
LIFTED_DEPTH = 8
ROUNDED = 1e-15  # relative to the coordinates: pieces of no length are not halved


def face_within(
    surface: Patch | Quadric,
    loops: Sequence[Sequence[Curve]],
    rounding: float = 0.0,
    beyond: NDArray | None = None,
) -> Face:
    """Return the face of a surface within loops, facing as the surface does; MeasureError if they
    bound none.

    rounding: largest effect of the file's decimals on a point. beyond: (n, 3) points that no face
    reaches; None if loops run with the face on their left, seen from the side of the surface's
    normal.
    """
    if isinstance(surface, Quadric):
        return curved_region(surface, loops, rounding, beyond)
    if is_flat(surface, rounding):
        return flat_region(loops, vector_area([surface]))
    chart = SplineChart(surface)
    if chart.periods[1] and not chart.periods[0]:
        # Strips end at the sides of the direction that does not close.
        loops = [reverse_curves(loop) for loop in loops]
        turned = face_within(surface.reverse_orientation(), loops, rounding, beyond)
        return turned.reverse_orientation()
    return curved_region(chart, loops, rounding, beyond)


def patch_sides(patch: Patch) -> tuple[list[Curve], NDArray]:
    """Return the sides of a patch that are no points, end to end, and (n, 3) samples of them."""
    around = [curve if ahead else curve.reverse() for curve, ahead in patch.sides]
    around = [curve for curve in around if np.ptp(curve.points, axis=0).any()]
    return around, np.concatenate([curve.samples(SEAM_SAMPLES) for curve in around])


def is_flat(patch: Patch, rounding: float) -> bool:
    """Return whether the points of a patch lie in a plane. rounding: their largest error."""
    points = patch.points.reshape(-1, 3) - patch.points[0, 0]
    normal = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)[2][2]
    return bool(np.ptp(points @ normal) <= FLAT_RTOL * patches_size([patch]) + 4.0 * rounding)


def lifted(surface: Patch | Quadric, parameters: Sequence[Curve]) -> list[Curve]:
    """Return curves in space through the points of a surface at curves of its parameters;
    SurfaceRefusedError if they leave its domain.
    """
    chart = surface if isinstance(surface, Quadric) else SplineChart(surface)
    if isinstance(chart, SplineChart):
        _check_domain(chart, parameters)
    # Chebyshev's extrema, at which interpolation is almost as near as can be.
    nodes = (1.0 - np.cos(np.pi * np.arange(LIFTED_ORDER) / (LIFTED_ORDER - 1.0))) / 2.0
    between = (nodes[1:] + nodes[:-1]) / 2.0
    space = clamped_space(LIFTED_ORDER)
    nets, origin = bezier_nets(parameters)
    # Where each piece begins: the index of its Bézier piece, and the share of this before it.
    begins = np.arange(float(len(nets)))
    control_points: dict[float, Array] = {}
    for depth in range(LIFTED_DEPTH + 1):
        at_nodes, at_between = (
            np.moveaxis(chart.evaluate(*evaluate_nets(nets, at[None], origin)[0][:2])[0], 0, -1)
            for at in (nodes, between)
        )
        points = np.asarray(np.linalg.solve(space.collocation_matrix(nodes), at_nodes), np.float64)
        miss = np.abs(space.collocation_matrix(between) @ points - at_between).max(axis=(1, 2))
        extent = np.ptp(at_nodes, axis=1).max(axis=1)
        reach = np.abs(at_nodes).max(initial=0.0)
        is_near = miss <= LIFTED_RTOL * extent + ROUNDED * reach
        is_near |= depth == LIFTED_DEPTH
        control_points.update(zip(begins[is_near].tolist(), points[is_near]))
        nets = np.concatenate([half @ nets[~is_near] for half in halves(nets.shape[1])])
        begins = np.concatenate([begins[~is_near], begins[~is_near] + 0.5 ** (depth + 1)])
    return [Curve(space, control_points[begin]) for begin in sorted(control_points)]


def _check_domain(chart: SplineChart, parameters: Sequence[Curve]) -> None:
    """Raise SurfaceRefusedError if curves leave the domain of a patch where it does not close."""
    ends = np.array([space.domain for space in chart.patch.spaces])
    places = sample_pieces(parameters)[..., :2].reshape(-1, 2)
    beyond = np.maximum(ends[:, 0] - places, places - ends[:, 1]).max(axis=0)
    is_open = np.equal(chart.periods, 0.0)
    if (beyond > TRIM_RTOL * np.ptp(ends, axis=1))[is_open].any():
        raise SurfaceRefusedError(SURFACE_TRIMMED)


def flat_region(
    loops: Sequence[Sequence[Curve]], normal: NDArray, rounding: float = 0.0
) -> FlatFace:
    """Return the region of a plane within loops, facing to the side of `normal`;
    SurfaceRefusedError if they bound none.

    rounding: largest effect of the file's decimals on a point. Loops that run with the region on
    their left, seen from that side, may touch, and leave the plane by a thousandth of their size.
    """
    try:
        return FlatFace.within(loops, normal, rounding)
    except MeasureError:
        face = FlatFace(tuple(map(tuple, loops)), normal / np.linalg.norm(normal))
        if not _is_sound(face):
            raise refuse("edges that cross, leave their plane or do not close") from None
        return face


def _is_sound(face: FlatFace) -> bool:
    """Return whether the loops of a flat face are closed, run around it, near its plane, and do not
    cross.
    """
    tolerance = MISS_RTOL * float(np.ptp(face.points, axis=0).max())
    off_plane = np.abs((face.points - face.center) @ face.normal).max()
    # Of each loop, the (curves, 2, 3) begin and end of its curves.
    ends = [np.array([curve.evaluate(curve.space.domain) for curve in loop]) for loop in face.loops]
    gap = max(np.abs(loop[:, 0] - np.roll(loop[:, 1], 1, axis=0)).max() for loop in ends)
    area = face.area_moments(0, face.center).total
    if max(off_plane, gap) > tolerance or not area > 0.0:
        return False
    for each in CROSSING_SAMPLES:
        outlines = face.outlines(each)
        if any(self_intersects(outline, tolerance) for outline in outlines):
            return False
        if chords_cross(outlines, tolerance, touch=False):
            return False
    return True
