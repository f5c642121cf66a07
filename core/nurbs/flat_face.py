# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat faces of a body: regions of a plane, bounded by closed loops of B-spline curves, with holes.

Their moments follow from their boundary (`curve_moments.plane_moments`), however the plane may be
parametrized.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..flat import orient_loops
from ..mesh import overlapping_box_pairs
from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, ArrayLike, NDArray, SplineSpace
from ..verdict import WELDING_RTOL, MeasureError
from .curve_moments import curves_center, plane_moments
from .findings import CURVES_BOUND_NOTHING
from .splines import Curve, Face, Patch, control_length, reverse_curves

if TYPE_CHECKING:
    from .trimmed_face import TrimmedFace

SAME_HEIGHT_RTOL = (
    1e-9  # Relative to the extent: corners whose heights differ by less share a row of trapezoids.
)
PAIRS_PER_BLOCK = 1 << 22  # rows and edges compared at a time
# Primes: a crossing at a simple fraction of a curve is no corner of its chords.
SAMPLES_PER_SPAN = 17  # for the first comparison
FINER_SAMPLES = 67, 257  # used if the chords of fewer samples cross
MAX_CHORDS = 8192  # Limit with finer samples.


@dataclass(frozen=True, eq=False)
class FlatFace:
    """A region of a plane.

    loops: closed boundaries, each of curves end to end, with the region on their left, seen from
    the side of `normal`, a (3,) unit vector.
    """

    loops: tuple[tuple[Curve, ...], ...]
    normal: Array

    @classmethod
    def within(
        cls, loops: Sequence[Sequence[Curve]], toward: ArrayLike, stored: float = 0.0
    ) -> FlatFace:
        """Return the region between loops of any direction, its normal towards `toward`, or raise
        MeasureError. stored: as for `planar_region`.
        """
        oriented, normal = planar_loops(loops, stored)
        face = cls(tuple(map(tuple, oriented)), normal)
        return face.reverse_orientation() if float(normal @ np.asarray(toward)) < 0.0 else face

    @property
    def curves(self) -> tuple[Curve, ...]:
        """All boundary curves."""
        return tuple(curve for loop in self.loops for curve in loop)

    @property
    def sides(self) -> tuple[tuple[Curve, bool], ...]:
        """The boundary curves, and True for each, because the face is on its left."""
        return tuple((curve, True) for curve in self.curves)

    @property
    def spaces(self) -> tuple[SplineSpace, ...]:
        """Function spaces of the boundary curves."""
        return tuple(curve.space for curve in self.curves)

    @property
    def points(self) -> Array:
        """(n, 1, 3) control points of the boundary."""
        return np.concatenate([curve.points for curve in self.curves])[:, None]

    @cached_property
    def center(self) -> Array:
        """(3,) the mean control point, which is in the plane."""
        return self.points.mean(axis=(0, 1))

    @cached_property
    def _moments(self) -> Moments:
        """Area moments of third order about the center."""
        return plane_moments(self.curves, self.normal, 3, self.center)

    @property
    def uneven(self) -> float:
        """A bound of the volume between the plane and control points beside it, by rounding."""
        deviation = float(np.abs((self.points - self.center) @ self.normal).max())
        return deviation * self.area_moments(0, self.center).total

    @property
    def slope(self) -> float:
        """An upper bound of the change of the area per unit of displacement: the boundary's
        length.
        """
        return control_length(self.curves)

    def reverse_orientation(self) -> FlatFace:
        """Return the same region facing the other way."""
        loops = tuple(tuple(reverse_curves(loop)) for loop in self.loops)
        return FlatFace(loops, -self.normal)

    def transform(self, matrix: ArrayLike) -> FlatFace:
        """Return the face's image under an affine map (4, 4)."""
        matrix = np.asarray(matrix, np.float64)
        normal = np.cross(*(matrix[:3, :3] @ self._frame).T)
        loops = tuple(tuple(curve.transform(matrix) for curve in loop) for loop in self.loops)
        return FlatFace(loops, normal / np.linalg.norm(normal))

    def area_moments(self, order: int, about: NDArray) -> Moments:
        """Return the moments of the region's area about any point (3,)."""
        if order > self._moments.order:
            return plane_moments(self.curves, self.normal, order, self.center).about_point(about)
        return self._moments.truncate(order).about_point(about)

    def volume_moments(self, order: int, about: NDArray) -> Moments:
        """Return the moments of the cone from a point (3,) to the region: the region's share in a
        body's moments.
        """
        area = self.area_moments(order, about)
        degree = monomials(order).sum(axis=1)
        height = float((self.center - about) @ self.normal)
        reach = float(np.sqrt(((self.points - about) ** 2).sum(axis=-1).max()))
        # 16: chosen, a margin over the few roundings of a height.
        error = abs(height) * area.rounding_error + 16.0 * U * area.total * reach ** (degree + 1.0)
        return Moments(
            height * area.raw / (degree + 3.0), about, Measure.VOLUME, error / (degree + 3.0)
        )

    def slab_moments(self, heights: NDArray, steps: NDArray, order: int, about: NDArray) -> Moments:
        """Return the volume moments of a slab on the region, from its sections at heights (n,) with
        weights (n,).
        """
        # A section at a height is the region, about a point that is as much lower.
        sections = [self.area_moments(order, about - height * self.normal) for height in heights]
        raw = sum(step * section.raw for step, section in zip(steps, sections))
        error = sum(step * section.rounding_error for step, section in zip(steps, sections))
        return Moments(np.asarray(raw), about, Measure.VOLUME, np.asarray(error))

    def outlines(self, each: int) -> list[Array]:
        """Return the loops as polygons (n, 2) along the plane, through `each` samples per span."""
        outlines = _sampled_loops(self.loops, each)
        flat = (np.concatenate(outlines) - self.center) @ self._frame
        return np.split(flat, np.cumsum([len(outline) for outline in outlines])[:-1])

    def quads(self, each: int) -> Array:
        """Return (n, 4, 3) corners of trapezoids that fill the polygon through `each` samples per
        span.
        """
        outlines = self.outlines(each)
        begin = np.concatenate(outlines)
        # In whole grains, heights that differ by rounding are equal.
        grain = SAME_HEIGHT_RTOL * float(np.ptp(begin, axis=0).max())
        begin[:, 1] = np.round(begin[:, 1] / grain) * grain
        starts = np.cumsum([len(outline) for outline in outlines])[:-1]
        end = np.concatenate([np.roll(part, -1, axis=0) for part in np.split(begin, starts)])
        heights = np.unique(begin[:, 1])
        low = np.minimum(begin[:, 1], end[:, 1])
        high = np.maximum(begin[:, 1], end[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (end[:, 0] - begin[:, 0]) / (end[:, 1] - begin[:, 1])
        blocks: list[Array] = []
        step = max(1, PAIRS_PER_BLOCK // len(low))
        for start in range(0, len(heights) - 1, step):
            top = heights[start + 1 : start + 1 + step]
            bottom = heights[start : start + len(top)]
            row, edge = np.nonzero((low <= bottom[:, None]) & (high >= top[:, None]))
            x = begin[edge, 0] + (np.stack([bottom[row], top[row]]) - begin[edge, 1]) * slope[edge]
            order = np.lexsort((x.sum(axis=0), row))
            x_bottom, x_top = x[:, order]
            y_bottom, y_top = bottom[row[order]], top[row[order]]
            # From the left, edges of a row enter and leave the region in turn.
            left = slice(0, None, 2)
            right = slice(1, None, 2)
            corners = [
                (x_bottom[left], y_bottom[left]),
                (x_bottom[right], y_bottom[right]),
                (x_top[right], y_top[right]),
                (x_top[left], y_top[left]),
            ]
            blocks.append(np.moveaxis(np.array(corners, np.float64), 2, 0))
        return np.concatenate(blocks) @ self._frame.T + self.center

    @cached_property
    def _frame(self) -> Array:
        """(3, 2) two unit vectors along the plane; the normal is their cross product."""
        along = np.cross(self.normal, np.eye(3)[np.argmin(np.abs(self.normal))])
        along /= np.linalg.norm(along)
        return np.array([along, np.cross(self.normal, along)], np.float64).T


def split_faces(faces: Sequence[Face]) -> tuple[list[Patch], list[FlatFace | TrimmedFace]]:
    """Return the patches, and the faces within loops of curves."""
    patches = [face for face in faces if isinstance(face, Patch)]
    return patches, [face for face in faces if not isinstance(face, Patch)]


def planar_region(curves: Sequence[Curve], stored: float = 0.0) -> tuple[list[Curve], Array]:
    """Return the curves oriented around a plane region, outer ones counter-clockwise, holes
    clockwise, and its normal.

    A curve inside an odd number of others is a hole, as in Blender. The first nonzero component of
    the unit normal (3,) in the order z, y, x is positive. stored: largest displacement of the
    points by storing them. MeasureError if the curves are not closed, too small, not in one plane,
    or cross.
    """
    loops, normal = planar_loops([[curve] for curve in curves], stored)
    return [curve for (curve,) in loops], normal


def planar_loops(
    loops: Sequence[Sequence[Curve]], stored: float = 0.0
) -> tuple[list[list[Curve]], Array]:
    """Return loops of curves end to end, oriented as by `planar_region`, and the normal of their
    plane.
    """
    curves = [curve for loop in loops for curve in loop]
    center = curves_center(curves)
    size = max(float(np.abs(curve.points - center).max()) for curve in curves)
    # 4: chosen, as the errors of several points act together.
    tolerance = 4.0 * (WELDING_RTOL * size + stored + 2.0**-52 * float(np.abs(center).max()))
    if not all(_is_closed(loop, tolerance) for loop in loops):
        raise MeasureError(
            CURVES_BOUND_NOTHING,
            fault="A curve is open and bounds no region. Close it with Toggle Cyclic",
        )
    points = np.concatenate([curve.points for curve in curves]) - center
    points -= points.mean(axis=0)  # The middle of a box need not be in the plane.
    # Three zero rows, so that there are three axes for fewer points too.
    _, _, axes = np.linalg.svd(np.concatenate([points, np.zeros((3, 3))]), full_matrices=False)
    if np.abs(points @ axes[2]).max() > tolerance:
        raise MeasureError(
            CURVES_BOUND_NOTHING,
            fault="The curves are not in one plane and bound no flat region. Flatten them",
        )
    normal = axes[2]
    # Of a unit vector one component is at least 0.57; those below 1e-6 may be rounding.
    leading = next(axis for axis in (2, 1, 0) if abs(normal[axis]) > 1e-6)
    normal = normal * np.sign(normal[leading])
    frame = np.stack([axes[0], np.cross(normal, axes[0])], axis=1)
    polygons = _separate_polygons(loops, center, frame, tolerance)
    starts = np.cumsum([0, *map(len, polygons)])
    edges = orient_loops(np.concatenate(polygons), np.split(np.arange(starts[-1]), starts[1:-1]))
    # The first edge of a loop that keeps its direction runs to the next corner.
    is_ahead = edges[starts[:-1], 0] < edges[starts[:-1], 1]
    oriented = [
        list(loop) if ahead else reverse_curves(loop) for loop, ahead in zip(loops, is_ahead)
    ]
    return oriented, normal


def _is_closed(loop: Sequence[Curve], tolerance: float) -> bool:
    """Return whether curves without jumps end where the next ones begin."""
    if any(curve.space.is_discontinuous for curve in loop):
        return False
    ends = np.array([curve.evaluate(curve.space.domain) for curve in loop])
    gaps = np.linalg.norm(ends[:, 1] - np.roll(ends[:, 0], -1, axis=0), axis=1)
    return bool(gaps.max() <= tolerance)


def _sampled_loops(loops: Sequence[Sequence[Curve]], each: int) -> list[Array]:
    """Return the (n, 3) samples of loops, `each` per span."""
    return [np.concatenate([curve.samples(each)[:-1] for curve in loop]) for loop in loops]


def _separate_polygons(
    loops: Sequence[Sequence[Curve]], center: NDArray, frame: NDArray, tolerance: float
) -> list[NDArray]:
    """Return loops as polygons (n, 2) that do not cross, through as few samples as show this.

    frame: (3, 2) vectors along the plane. MeasureError if loops are too small or cross.
    """
    spans = sum(len(curve.space.spans) for loop in loops for curve in loop)
    finer = [each for each in FINER_SAMPLES if spans * each <= MAX_CHORDS]
    for each in (SAMPLES_PER_SPAN, *finer):
        polygons = [
            _without_repeats((points - center) @ frame, tolerance)
            for points in _sampled_loops(loops, each)
        ]
        if min(map(len, polygons)) < 3:
            raise MeasureError(
                CURVES_BOUND_NOTHING,
                fault=(
                    "A curve is smaller than the rounding of its coordinates. Delete it, "
                    "move it nearer to the origin"
                ),
            )
        if not chords_cross(polygons, tolerance):
            return polygons
    raise MeasureError(
        CURVES_BOUND_NOTHING,
        fault="The curves cross or touch, so the region is ambiguous. Separate them",
    )


def self_intersects(loop: NDArray, tolerance: float) -> bool:
    """Return whether a polygon (n, 2) crosses itself, along an edge or at a corner; touching does
    not count.
    """
    # Where a loop crosses itself at a corner, no edges cross, but two corners coincide; there the
    # polygon through the middles of its edges crosses itself along edges.
    loop = _without_repeats(loop, tolerance)
    return chords_cross([loop], tolerance, touch=False) or (
        chords_cross([loop], tolerance)
        and chords_cross([(loop + np.roll(loop, 1, axis=0)) / 2.0], tolerance, touch=False)
    )


def _without_repeats(loop: NDArray, tolerance: float) -> Array:
    """Return a polygon without repeated points."""
    return loop[np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > tolerance]


def chords_cross(loops: Sequence[NDArray], tolerance: float, touch: bool = True) -> bool:
    """Return whether edges of polygons (n, 2) cross by more than a tolerance, also at a corner of
    one of them, or, if `touch`, corners coincide.
    """
    begin = np.concatenate(loops)
    end, after = (np.concatenate([np.roll(loop, -k, axis=0) for loop in loops]) for k in (1, 2))
    low, high = (
        np.pad(corner, ((0, 0), (0, 1)))
        for corner in (np.minimum(begin, end), np.maximum(begin, end))
    )
    i, j, _ = overlapping_box_pairs(low, high, -2.0 * tolerance, len(begin) ** 2)
    if touch and (np.abs(begin[i] - begin[j]).max(axis=1) <= tolerance).any():
        return True
    # Each pair in both orders: the line of an edge, and the corners of the other one.
    edge, other = np.concatenate([i, j]), np.concatenate([j, i])
    run = end[edge] - begin[edge]
    length = np.linalg.norm(run, axis=1)
    arms = np.array([corners[other] - begin[edge] for corners in (begin, end, after)])
    sides = run[:, 0] * arms[..., 1] - run[:, 1] * arms[..., 0]
    is_far = np.abs(sides) > tolerance * length
    is_left = sides > 0.0
    is_cut = is_far[0] & is_far[1] & (is_left[0] != is_left[1])
    # The other edge ends on the edge, and the one after it goes on beyond.
    along = (arms[1] * run).sum(axis=1)
    is_inside = (along > tolerance * length) & (along < (length - tolerance) * length)
    is_passed = is_inside & is_far[0] & ~is_far[1] & is_far[2] & (is_left[0] != is_left[2])
    return bool((is_cut[: len(i)] & is_cut[len(i) :]).any() or is_passed.any())
