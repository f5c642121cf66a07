# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces: regions of curved surfaces within closed loops of curves, which lie on them within a small
distance.

Green's theorem in the surface's coordinates, with an antiderivative along one of them:

    ∬ f du dv = - ∮ (∫ f(u, v') dv' from a base line to v) du.

The inner integral runs over the strip between the base line and a piece of a loop, so that the face
is a signed sum of such strips, cut at the knots of surface and curve. A point of a loop has the
coordinates of the nearest point of the surface, in closed form on quadrics. The gap between the
curve and the surface is filled by lines across it: faces that share a curve close exactly, and what
is missing to the true edge is of second order in the gap.

Strips are integrated by two Gauss rules, and cut in four until these agree; the sum of their
differences is the stated truncation, which is that of the coarser rule.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from typing import TypeAlias, cast

import numpy as np

from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, Index, NDArray, SplineSpace, cross, gauss_legendre
from ..verdict import WELDING_RTOL
from .bezier import ROUNDING, VOLUME_RTOL
from .patch_moments import AREA_RTOL, area_slope, area_terms, flux_terms, sheet_terms
from .quadric import Quadric
from .spline_chart import SplineChart, follow
from .splines import Curve, control_length, homogeneous

SAMPLES = 17  # of a Bézier piece of a loop
# Gauss points along a loop and across its strips, of two rules that are compared
ALONG = 12, 18
ACROSS = 12, 18
ACROSS_LINES = 6, 6  # across cylinders and cones, where integrands are polynomials of low degree
ACROSS_GAP = 4
POINTS_PER_BLOCK = 16384
MAX_DEPTH = 10  # Limit of successive cuts of a strip.
MIN_TOLERANCE = 1e-13  # of strips, relative to their size
BLUR_SHARE = 0.1  # of the uncertainty by edges beside the surface: more cuts would tell no more
ROUNDED_ORDERS = 16  # orders of the bases of a typical surface, for the rounding of its points
# Factor on the difference of two rules that do not agree yet when a strip is not cut any more.
UNCONVERGED_FACTOR = 8.0
SAME_HEIGHT = 1e-9  # relative to all heights: samples that share a row of tiles
FLAT_STEP = 1e-12  # a change of a coordinate, relative to its range, that bounds nothing
# Returns (K + 1, ...) integrands and sizes at points with derivatives, each (3, ...).
Terms = Callable[[list[NDArray]], NDArray]
# Segment, lower and upper end, and the shares of the way between where a strip begins and ends.
Strips: TypeAlias = tuple[Index, Array, Array, Array, Array]


@dataclass(frozen=True, eq=False)
class TrimmedFace:
    """A region of a curved surface.

    loops: closed boundaries, each of curves end to end, with the region on their left, seen from
    the side of the surface's normal. tracks: (pieces, SAMPLES, 2) coordinates along the Bézier
    pieces of all curves. lines: (n, 2, 2) lines between coordinates, which close the tracks at
    poles, and with the base line bound the whole surface if the region is all but its loops. axis:
    the coordinate along which strips run from `base`. deviation: largest distance of the loops from
    the surface. facing: 1, or -1 for a face on the other side of the surface.
    """

    chart: Quadric | SplineChart
    loops: tuple[tuple[Curve, ...], ...]
    tracks: Array
    lines: Array
    axis: int
    base: float
    deviation: float
    facing: float = 1.0

    @cached_property
    def curves(self) -> tuple[Curve, ...]:
        """All boundary curves."""
        return tuple(curve for loop in self.loops for curve in loop)

    @property
    def sides(self) -> tuple[tuple[Curve, bool], ...]:
        """The boundary curves, each with True if the face is on its left."""
        return tuple((curve, self.facing > 0.0) for curve in self.curves)

    @property
    def spaces(self) -> tuple[SplineSpace, ...]:
        """Function spaces of the boundary curves."""
        return tuple(curve.space for curve in self.curves)

    @cached_property
    def points(self) -> Array:
        """(n, 1, 3) control points of the boundary, and points of the surface between them."""
        low, high = self._box
        u, v = (np.linspace(*ends, 9) for ends in zip(low, high))
        grid = self.chart.evaluate(*np.meshgrid(u, v))[0].reshape(3, -1).T
        return np.concatenate([*(curve.points for curve in self.curves), grid])[:, None]

    @cached_property
    def perimeter(self) -> float:
        """An upper bound of the length of the boundary."""
        return control_length(self.curves)

    def reverse_orientation(self) -> TrimmedFace:
        """Return the same region facing the other way."""
        return replace(self, facing=-self.facing)

    def transform(self, matrix: NDArray) -> TrimmedFace:
        """Return the face's image under an affine map (4, 4)."""
        matrix = np.asarray(matrix, np.float64)
        loops = tuple(tuple(curve.transform(matrix) for curve in loop) for loop in self.loops)
        deviation = self.deviation * float(np.linalg.norm(matrix[:3, :3], 2))
        return replace(self, chart=self.chart.transform(matrix), loops=loops, deviation=deviation)

    def volume_moments(self, order: int, about: NDArray) -> Moments:
        """Return the moments of the cone from a point (3,) to the region: the region's share in a
        body's moments.
        """
        degree = monomials(order).sum(axis=1)
        flux = partial(flux_terms, order=order)
        raw, error = self._integrate(flux, degree + 1.0, about, VOLUME_RTOL, has_gap=True)
        return Moments(
            self.facing * raw / (degree + 3.0), about, Measure.VOLUME, error / (degree + 3.0)
        )

    def area_moments(self, order: int, about: NDArray) -> Moments:
        """Return the moments of the region's area about a point (3,)."""
        degree = monomials(order).sum(axis=1).astype(np.float64)
        raw, error = self._integrate(partial(area_terms, order=order), degree, about, AREA_RTOL)
        error += self.deviation * self.perimeter * self._reach(about) ** degree
        return Moments(raw, about, Measure.AREA, error)

    def slab_moments(self, heights: NDArray, steps: NDArray, order: int, about: NDArray) -> Moments:
        """Return the volume moments of a sheet on the region, from its sections at heights (n,)
        with weights (n,).
        """
        degree = monomials(order).sum(axis=1).astype(np.float64)
        sheet = partial(sheet_terms, heights=self.facing * heights, steps=steps, order=order)
        raw, error = self._integrate(sheet, degree, about, AREA_RTOL, most=2)
        return Moments(raw, about, Measure.VOLUME, error)

    @property
    def uneven(self) -> float:
        """A bound of the volume that the edges' distance from the surface leaves uncertain."""
        skin = 0.0
        if not self._is_near:  # The whole surface may be off by the distance of its edges.
            skin = self.area_moments(0, self.points[0, 0]).total + self.deviation * self.slope
        return max(self._blur * self.perimeter, self.deviation * skin)

    @cached_property
    def _blur(self) -> float:
        """The same per unit of length of an edge.

        Surfaces meet beside edges near them, at most at the root of distance times size if they
        touch there. Of edges farther off, either the edges or the surfaces may be right.
        """
        lever = np.sqrt(self.deviation * self._size) if self._is_near else self._size / 2.0
        return self.deviation * float(lever)

    @property
    def _is_near(self) -> bool:
        """Whether the edges lie on the surface within the tolerance of welding."""
        return self.deviation <= WELDING_RTOL * self._size

    @property
    def _size(self) -> float:
        return float(np.linalg.norm(np.ptp(self.points, axis=(0, 1))))

    @property
    def slope(self) -> float:
        """An estimate of the largest change of the area per unit of displacement."""
        if isinstance(self.chart, SplineChart):
            return self.perimeter + area_slope([self.chart.patch])
        # The integral of the mean curvature of a sphere is 4π times its radius.
        return self.perimeter + 4.0 * np.pi * self._size

    def quads(self, each: int) -> Array:
        """Return (n, 4, 3) corners of quadrilaterals that fill the region, with about `each` steps
        to a span or a quarter of a turn.
        """
        return self._tiles(each)[1]

    def sagitta(self, each: int) -> float:
        """Return the largest distance of the middles of the quadrilaterals from the surface."""
        tiles, corners = self._tiles(each)
        middle = self.chart.evaluate(*tiles.mean(axis=1).T)[0].T
        return float(np.linalg.norm(corners.mean(axis=1) - middle, axis=1).max(initial=0.0))

    def normals(self, number: int, each: int) -> Array:
        """Return (m, 3) unit normals at the samples of a side's curve."""
        place = self.chart.project(self.curves[number].samples(each))
        _, along, across = self.chart.evaluate(*place.T)
        normal = self.facing * np.stack(cross(along, across), axis=1)
        return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)

    def _tiles(self, each: int) -> tuple[Array, Array]:
        """Return (n, 4, 2) coordinates of the corners of `quads`, and the corners.

        Rows along the direction of strips are cut at the samples of the loops; between two of these
        the region is where strips of odd sum lie.
        """
        axis, other = self.axis, 1 - self.axis
        stride = max(1, (SAMPLES - 1) // each)
        tracks = self.tracks[:, ::stride]
        steps = np.concatenate(
            [np.stack([tracks[:, :-1], tracks[:, 1:]], axis=2).reshape(-1, 2, 2), self.lines]
        )
        widths = self.chart.step(each)
        heights = [*np.unique(steps[..., axis]).tolist(), self.base]
        grain = SAME_HEIGHT * max(max(heights) - min(heights), 1e-300)
        heights = np.unique(np.round(np.array(heights) / grain))
        (begin, end) = np.moveaxis(steps, 1, 0)
        ends = np.round(np.stack([begin[:, axis], end[:, axis]]) / grain)
        cuts = [
            np.linspace(a, b, 1 + max(1, int(np.ceil((b - a) * grain / widths[axis] - 1e-9))))[:-1]
            for a, b in zip(heights[:-1], heights[1:])
        ]
        heights = np.concatenate([*cuts, heights[-1:]])
        bottom, top = heights[:-1], heights[1:]
        low, high = ends.min(axis=0), ends.max(axis=0)
        row, edge = np.nonzero((low <= bottom[:, None]) & (high >= top[:, None]) & (low < high))
        slope = (end - begin)[edge, other] / (ends[1] - ends[0])[edge]
        x = begin[edge, other] + (np.stack([bottom[row], top[row]]) - ends[0, edge]) * slope
        period = self.chart.periods[other]
        if period:
            x -= period * np.floor(x.mean(axis=0) / period)
        enters = (ends[1] > ends[0])[edge] == (axis == 0)
        order = np.lexsort((x.sum(axis=0), row))
        first = order[np.unique(row[order], return_index=True)[1]] if len(order) else order
        x[:, first[~enters[first]]] += period
        order = np.lexsort((x.sum(axis=0), row))
        pairs = np.flatnonzero(enters[order][:-1] & ~enters[order][1:] & (np.diff(row[order]) == 0))
        left, right = x[:, order[pairs]], x[:, order[pairs + 1]]
        rows = row[order[pairs]]
        # Rows that no loop enters are all in the region, or none of them.
        empty = np.setdiff1d(np.arange(len(bottom)), row)
        level = ends.mean(axis=0)
        base = self.base / grain
        beyond = np.where(
            bottom[empty, None] >= base - 0.5,
            level > bottom[empty, None],
            level < top[empty, None],
        )
        turns = (beyond * (end - begin)[:, other]).sum(axis=1) / (period or 1.0)
        full = empty[np.round(np.abs(turns)) % 2 == 1] if period else empty[:0]
        rows = np.concatenate([rows, full])
        left = np.concatenate([left, np.zeros((2, len(full)))], axis=1)
        right = np.concatenate([right, np.full((2, len(full)), period)], axis=1)
        parts = np.maximum(np.ceil((right - left).max(axis=0) / widths[other]), 1).astype(np.intp)
        tile = np.repeat(np.arange(len(rows)), parts)
        index = np.arange(len(tile)) - np.repeat(np.cumsum(parts) - parts, parts)
        corners = []
        for end_of_row, step in ((0, 0), (0, 1), (1, 1), (1, 0)):
            share = (index + step) / parts[tile]
            across = left[end_of_row, tile] * (1.0 - share) + right[end_of_row, tile] * share
            height = (bottom, top)[end_of_row][rows[tile]] * grain
            corners.append(np.stack([across, height] if axis else [height, across], axis=-1))
        tiles = np.stack(corners, axis=1)
        if (self.facing < 0.0) == (axis == 1):
            tiles = tiles[:, ::-1]
        return tiles, np.moveaxis(self.chart.evaluate(*np.moveaxis(tiles, -1, 0))[0], 0, -1)

    def _reach(self, about: NDArray) -> float:
        return float(np.sqrt(((self.points - about) ** 2).sum(axis=-1).max()))

    def _integrate(
        self,
        terms: Terms,
        degree: NDArray,
        about: NDArray,
        tolerance: float,
        most: int = 1,
        has_gap: bool = False,
    ) -> tuple[Array, Array]:
        """Return (K,) integrals over the region, about a point (3,), and their error."""
        unit = self._reach(about) ** degree
        values, estimate, size = self._integrals(terms, unit, about, tolerance, most, has_gap)
        return values, (estimate + ROUNDING * U * size * (ROUNDED_ORDERS + degree)) * unit

    def _integrals(
        self,
        terms: Terms,
        unit: NDArray,
        about: NDArray,
        tolerance: float,
        most: int,
        has_gap: bool,
    ) -> tuple[Array, float, float]:
        """Return (K,) integrals over the region, the truncation divided by `unit`, and the size of
        all strips.

        terms: integrands of derivatives up to `most`, about a point (3,). unit: (K,) factors from
        sizes to bounds of integrals. has_gap: count the gaps between loops and surface.
        """
        k = len(unit)
        most_unit = np.maximum(unit, 1e-300)[:, None]
        blurred = BLUR_SHARE * self._blur / max(self._size**2, 1e-300)
        tolerance = max(tolerance, MIN_TOLERANCE, blurred)
        index, ends, strips = self._strips
        values, estimate, size = np.zeros(k), 0.0, 0.0
        if has_gap and len(self.tracks):
            values, lost, size = self._gap_integrals(terms, about)
            estimate = float((np.abs(lost) / most_unit[:, 0]).max())
        mean = 0.0
        for depth in range(MAX_DEPTH + 1):
            if not len(strips[0]):
                break
            samples = self._samples(index, ends) if depth else self._first_samples
            coarse, fine = self._strip_integrals(samples, ends, strips, terms, about, most)
            mean = mean or float(fine[k].mean())
            differ = (np.abs(fine[:k] - coarse[:k]) / most_unit).max(axis=0)
            good = differ <= tolerance * np.maximum(fine[k], mean)
            done = good if depth < MAX_DEPTH else np.ones_like(good)
            values = values + fine[:k, done].sum(axis=1)
            estimate += float(np.where(good, differ, UNCONVERGED_FACTOR * differ)[done].sum())
            size += float(fine[k, done].sum())
            index, ends, strips = _cut(
                index, ends, cast("Strips", tuple(row[~done] for row in strips))
            )
        return values * (-1.0 if self.axis else 1.0), estimate, size

    def _gap_integrals(self, terms: Terms, about: NDArray) -> tuple[Array, Array, float]:
        """Return integrals over the gaps between loops and surface, to be counted as strips are,
        their truncation and size.
        """
        index, ends, _ = self._strips
        is_curve = index < len(self.tracks)
        ends = ends[is_curve]
        across, across_weights = gauss_legendre(ACROSS_GAP)
        found = []
        for points, samples in zip(ALONG, self._first_samples):
            weights = gauss_legendre(points)[1]
            place, slope, curve, velocity = (row[:, is_curve] for row in samples)
            surface, *slopes = self.chart.evaluate(*place)
            move = slopes[0] * slope[0] + slopes[1] * slope[1]
            arm = (curve - surface)[..., None]
            spot = surface[..., None] + across * arm
            spot -= about[:, None, None, None]
            along = move[..., None] + across * (velocity - move)[..., None]
            weight = (ends[:, 1:] - ends[:, :1])[..., None] * weights[:, None] * across_weights
            block = terms([spot, np.broadcast_to(arm, along.shape), along])
            found.append((block * weight).sum(axis=(1, 2, 3)))
        sign = -1.0 if self.axis else 1.0
        return sign * found[1][:-1], found[1][:-1] - found[0][:-1], float(found[1][-1])

    def _strip_integrals(
        self,
        samples: Sequence[Sequence[Array]],
        ends: NDArray,
        strips: Strips,
        terms: Terms,
        about: NDArray,
        most: int,
    ) -> tuple[Array, Array]:
        """Return (K + 1, n) integrals over strips by the coarse and by the fine rule, from the
        `_samples` of their segments.
        """
        is_line = isinstance(self.chart, Quadric) and not self.chart.minor and self.axis == 1
        found = []
        rules = zip(samples, ALONG, ACROSS_LINES if is_line else ACROSS)
        for (place, slope, *_), along, across in rules:
            weights = gauss_legendre(along)[1]
            inner, inner_weights = gauss_legendre(across)
            top = place[self.axis]
            rate = slope[1 - self.axis] * (ends[:, 1:] - ends[:, :1]) * weights
            blocks = []
            step = max(1, POINTS_PER_BLOCK // (along * across))
            for start in range(0, len(strips[0]), step):
                part, low, high, first, last = (row[start : start + step] for row in strips)
                high = np.where(np.isnan(high)[:, None], top[part], high[:, None])
                width = high - low[:, None]
                share = first[:, None] + (last - first)[:, None] * inner
                swept = low[:, None, None] + width[:, :, None] * share[:, None]
                other = place[1 - self.axis][part][:, :, None]
                where = (other, swept) if self.axis else (swept, other)
                derivatives = self.chart.evaluate(*where, most)
                derivatives[0] -= about[:, None, None, None]
                element = (rate[part] * width * (last - first)[:, None])[..., None] * inner_weights
                block = terms(derivatives)
                sums = np.einsum("knij,nij->kn", block[:-1], element)
                size = (block[-1] * np.abs(element)).sum(axis=(1, 2))
                blocks.append(np.concatenate([sums, size[None]]))
            found.append(np.concatenate(blocks, axis=1))
        return found[0], found[1]

    @cached_property
    def _first_samples(self) -> list[list[Array]]:
        """The samples of all segments that are not cut yet."""
        return self._samples(*self._strips[:2])

    def _samples(self, index: Index, ends: NDArray) -> list[list[Array]]:
        """Return for each rule `_coordinates` at its points of segments."""
        return [
            self._coordinates(index, ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * nodes)
            for nodes, _ in map(gauss_legendre, ALONG)
        ]

    @cached_property
    def _strips(self) -> tuple[Index, Array, Strips]:
        """Segments of curves and lines, and the strips from the base line to them.

        (s,) piece, (s, 2) ends on it; and for each strip its segment, lower end, upper end (NaN: at
        the curve), and the shares of the way between them where it begins and ends.
        """
        count = len(self.tracks) + len(self.lines)
        pieces: list[list[float]] = [[0.0, 1.0] for _ in range(count)]
        steps = np.linspace(0.0, 1.0, SAMPLES)
        tracks = np.concatenate(
            [self.tracks, self.lines[:, :1] + np.diff(self.lines, axis=1) * steps[:, None]]
        )
        for axis in (0, 1):
            row = tracks[..., axis]
            knots = self.chart.knots(axis, float(row.min()), float(row.max()))
            above = row[..., None] > knots
            piece, sample, knot = np.nonzero(above[:, 1:] != above[:, :-1])
            low, high = steps[sample], steps[sample + 1]
            begins_above = above[piece, sample, knot]
            at = (low + high) / 2.0
            for _ in range(40):  # Newton's steps, kept within the interval
                place, slope, *_ = self._coordinates(piece, at[:, None])
                rest = place[axis, :, 0] - knots[knot]
                before = (rest > 0.0) == begins_above
                low, high = np.where(before, at, low), np.where(before, high, at)
                rate = slope[axis, :, 0]
                onward = at - rest / np.where(rate == 0.0, 1.0, rate)
                inside = (onward > low) & (onward < high) & (rate != 0.0)
                moved = np.where(inside, onward, (low + high) / 2.0)
                step = np.abs(moved - at).max(initial=0.0)
                at = moved
                if step <= 1e-15:
                    break
            for k, cut in zip(piece.tolist(), at.tolist()):
                pieces[k].append(cut)
        index = np.repeat(np.arange(count), [len(set(cuts)) - 1 for cuts in pieces])
        ends = np.array(
            [pair for cuts in map(sorted, map(set, pieces)) for pair in zip(cuts[:-1], cuts[1:])]
        )
        middle = self._coordinates(index, ends.mean(axis=1)[:, None])[0][self.axis, :, 0]
        ranges = np.ptp(tracks[..., 1 - self.axis], axis=1)
        keep = ranges > FLAT_STEP * max(float(np.ptp(tracks[..., 1 - self.axis])), 1e-300)
        low, high = min(self.base, float(middle.min())), max(self.base, float(middle.max()))
        marks = self.chart.knots(self.axis, low, high)
        strips: list[tuple] = []
        for segment, top in enumerate(middle.tolist()):
            if not keep[index[segment]]:
                continue
            between = marks[(marks > min(self.base, top)) & (marks < max(self.base, top))]
            stops = [self.base, *(between if top > self.base else between[::-1]).tolist(), np.nan]
            strips += [(segment, a, b, 0.0, 1.0) for a, b in zip(stops[:-1], stops[1:])]
        segment, *rows = np.array(strips, np.float64).reshape(-1, 5).T
        return index, ends, cast("Strips", (segment.astype(np.intp), *rows))

    def _coordinates(self, index: Index, at: NDArray) -> list[Array]:
        """Return (2, n, m) coordinates and their slopes on pieces (n,), at (n, m) parameters from 0
        to 1, and (3, n, m) points and velocities, zero on lines.
        """
        count = len(self.tracks)
        found = [np.zeros((size, *at.shape)) for size in (2, 2, 3, 3)]
        on_line = index >= count
        if on_line.any():
            begin, end = np.moveaxis(self.lines[index[on_line] - count], 1, 0)[..., None]
            found[0][:, on_line] = np.moveaxis(begin + (end - begin) * at[on_line, None], 1, 0)
            found[1][:, on_line] = np.moveaxis(end - begin, 1, 0)
        if not on_line.all():
            part, steps = index[~on_line], at[~on_line]
            scaled = steps * (SAMPLES - 1)
            left = np.clip(scaled.astype(np.intp), 0, SAMPLES - 2)
            share = (scaled - left)[..., None]
            track = self.tracks[part[:, None], left] * (1.0 - share)
            track += self.tracks[part[:, None], left + 1] * share
            nets, origin = self._nets
            on_curve = evaluate_nets(nets[part], steps, origin)
            points, velocity = (row.reshape(3, -1).T for row in on_curve)
            place = self.chart.project(points, track.reshape(-1, 2))
            slope = follow(self.chart, points, velocity, place)
            for row, values in zip(found, (place.T, slope.T, *on_curve)):
                row[:, ~on_line] = values.reshape(-1, *steps.shape)
        return found

    @cached_property
    def _nets(self) -> tuple[Array, Array]:
        return bezier_nets(self.curves)

    @cached_property
    def _box(self) -> tuple[Array, Array]:
        """Least and largest coordinates of the region."""
        corners = np.concatenate([self.tracks.reshape(-1, 2), self.lines.reshape(-1, 2)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        if len(self.lines):
            low[self.axis] = min(low[self.axis], self.base)
            high[self.axis] = max(high[self.axis], self.base)
        return low, high


def bezier_nets(curves: Sequence[Curve]) -> tuple[Array, Array]:
    """Return (c, order, 4) homogeneous control points of the Bézier pieces of curves, raised to one
    order, about an origin (3,), and that.
    """
    origin = curves[0].points[0] if curves else np.zeros(3)
    order = max((curve.space.order for curve in curves), default=2)
    nets = [np.zeros((0, order, 4))]
    for curve in curves:
        weights = np.ones(len(curve.points)) if curve.weights is None else curve.weights
        net = homogeneous(curve.points - origin, weights)[curve.space.active_controls]
        nets.append(_raised_extraction(curve.space, order) @ net)
    return np.concatenate(nets), origin


@lru_cache(maxsize=64)
def _raised_extraction(space: SplineSpace, order: int) -> Array:
    """Return (s, order, k) weights of the acting control points in Bézier points of an order;
    cached: do not modify.
    """
    table = space.bezier_extraction
    for degree in range(space.order, order):
        share = (np.arange(degree + 1) / degree)[:, None]
        first, last = (np.pad(table, ((0, 0), ends, (0, 0))) for ends in ((1, 0), (0, 1)))
        table = share * first + (1.0 - share) * last
    return table


def sample_pieces(curves: Sequence[Curve]) -> Array:
    """Return (c, SAMPLES, 3) points of the Bézier pieces of curves."""
    nets, origin = bezier_nets(curves)
    at = np.broadcast_to(np.linspace(0.0, 1.0, SAMPLES), (len(nets), SAMPLES))
    return np.moveaxis(evaluate_nets(nets, at, origin)[0], 0, -1)


def evaluate_nets(nets: NDArray, at: NDArray, origin: NDArray) -> tuple[Array, Array]:
    """Return (3, n, m) points and velocities of Bézier curves (n, order, 4), at (n, m) parameters
    from 0 to 1.
    """
    degree = nets.shape[1] - 1
    powers = np.arange(degree)
    choose = np.array([math.comb(degree - 1, k) for k in range(degree)], np.float64)
    t, rest = at[..., None], 1.0 - at[..., None]
    lower = choose * t**powers * rest ** powers[::-1]
    begin, end = lower @ nets[:, :-1], lower @ nets[:, 1:]
    values = np.moveaxis(rest * begin + t * end, -1, 0)
    slopes = degree * np.moveaxis(end - begin, -1, 0)
    place = values[:3] / values[3]
    velocity = (slopes[:3] - place * slopes[3]) / values[3]
    return place + origin[:, None, None], velocity


def _cut(index: Index, ends: NDArray, strips: Strips) -> tuple[Index, Array, Strips]:
    """Return strips cut in four, with the halves of their segments."""
    used, part = np.unique(strips[0], return_inverse=True)
    middle = ends[used].mean(axis=1)
    halves = np.concatenate(
        [np.stack([ends[used, 0], middle], axis=1), np.stack([middle, ends[used, 1]], axis=1)]
    )
    _, low, high, first, last = strips
    between = (first + last) / 2.0
    quarters = [
        (part + half * len(used), low, high, begin, end)
        for half in (0, 1)
        for begin, end in ((first, between), (between, last))
    ]
    return (
        np.tile(index[used], 2),
        halves,
        cast("Strips", tuple(np.concatenate(row) for row in zip(*quarters))),
    )
