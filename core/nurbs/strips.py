# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Integrals over a region of a curved surface within closed loops of curves, which lie on it within
a small distance.

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

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numerics import Array, Index, Mask, NDArray, gauss_legendre
from .piece_nets import SAMPLES, bezier_nets, evaluate_nets
from .quadric import Quadric
from .spline_chart import SplineChart, follow
from .splines import Curve

# Gauss points along a loop and across its strips, of two rules that are compared
ALONG = 12, 18
ACROSS = 12, 18
ACROSS_LINES = 6, 6  # across cylinders and cones, where integrands are polynomials of low degree
ACROSS_GAP = 4
POINTS_PER_BLOCK = 16384
MAX_DEPTH = 10  # Limit of successive cuts of a strip.
# Factor on the difference of two rules that do not agree yet when a strip is not cut any more.
UNCONVERGED_FACTOR = 8.0
NEWTON_STEPS = 40
FLAT_STEP = 1e-12  # a change of a coordinate, relative to its range, that bounds nothing
# Returns (K + 1, ...) integrands and sizes at points with derivatives, each (3, ...).
Terms = Callable[[list[NDArray]], NDArray]


@dataclass(frozen=True, eq=False)
class Places:
    """Points of segments. coordinates, slopes: (2, n, m) of the nearest points of the surface, and
    their derivatives by the parameter of the piece. points, velocities: (3, n, m) of the curve;
    zero on lines.
    """

    coordinates: Array
    slopes: Array
    points: Array
    velocities: Array


@dataclass(frozen=True, eq=False)
class Strips:
    """Strips of coordinates from the base line to segments of curves and lines.

    piece: (s,) of each segment, tracks before lines. ends: (s, 2) parameters of the segment on its
    piece, from 0 to 1. segment: (n,) of each strip. low, high: (n,) heights between which the strip
    is; NaN: at the segment. first, last: (n,) shares of the way between them where it begins and
    ends.
    """

    piece: Index
    ends: Array
    segment: Index
    low: Array
    high: Array
    first: Array
    last: Array

    def __len__(self) -> int:
        return len(self.segment)

    def cut(self, selection: Mask) -> Strips:
        """Return some of the strips, each cut in four: halves of its segment by halves of its
        height.
        """
        segments, segment = np.unique(self.segment[selection], return_inverse=True)
        begin, end = self.ends[segments].T
        middle = self.ends[segments].mean(axis=1)
        halves = np.concatenate(
            [np.stack([begin, middle], axis=1), np.stack([middle, end], axis=1)]
        )
        first, last = self.first[selection], self.last[selection]
        between = (first + last) / 2.0
        # In turn: the first half of all segments with both halves of the height, then the second.
        return Strips(
            piece=np.tile(self.piece[segments], 2),
            ends=halves,
            segment=np.concatenate([np.tile(segment, 2), np.tile(segment + len(segments), 2)]),
            low=np.tile(self.low[selection], 4),
            high=np.tile(self.high[selection], 4),
            first=np.tile(np.concatenate([first, between]), 2),
            last=np.tile(np.concatenate([between, last]), 2),
        )


class StripIntegrator:
    """Integrals over the region of a surface between a base line, tracks of curves, and lines.

    curves: in space. tracks, lines, axis, base: as for `TrimmedFace`.
    """

    def __init__(
        self,
        chart: Quadric | SplineChart,
        curves: Sequence[Curve],
        tracks: NDArray,
        lines: NDArray,
        axis: int,
        base: float,
    ) -> None:
        self._chart = chart
        self._nets, self._origin = bezier_nets(curves)
        self._tracks = tracks
        self._lines = lines
        self._axis = axis
        self._base = base

    def integrate(
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
        divisor = np.maximum(unit, 1e-300)
        values, estimate, size = np.zeros(k), 0.0, 0.0
        if has_gap and len(self._tracks):
            values, truncation, size = self._gap_integrals(terms, about)
            estimate = float((np.abs(truncation) / divisor).max())
        strips = self._strips
        mean_size = 0.0
        for depth in range(MAX_DEPTH + 1):
            if not len(strips):
                break
            samples = self._samples(strips) if depth else self._first_samples
            coarse, fine = self._strip_integrals(samples, strips, terms, about, most)
            sizes = fine[k]
            mean_size = mean_size or float(sizes.mean())
            # The worst of all moments stands for each.
            differences = (np.abs(fine[:k] - coarse[:k]) / divisor[:, None]).max(axis=0)
            agrees = differences <= tolerance * np.maximum(sizes, mean_size)
            is_done = agrees if depth < MAX_DEPTH else np.ones_like(agrees)
            errors = np.where(agrees, differences, UNCONVERGED_FACTOR * differences)
            values = values + fine[:k, is_done].sum(axis=1)
            estimate += float(errors[is_done].sum())
            size += float(sizes[is_done].sum())
            strips = strips.cut(~is_done)
        return values * self._sign, estimate, size

    @property
    def _sign(self) -> float:
        """The sign of a strip's share in the region's integral."""
        return -1.0 if self._axis else 1.0

    def _gap_integrals(self, terms: Terms, about: NDArray) -> tuple[Array, Array, float]:
        """Return (K,) integrals over the gaps between loops and surface, to be added to those of
        strips before their sign, their truncation and size.

        A gap is a ruled surface: from the surface's nearest points, across, to the loop.
        """
        is_curve = self._strips.piece < len(self._tracks)
        widths = np.diff(self._strips.ends[is_curve], axis=1)[..., None]
        across, across_weights = gauss_legendre(ACROSS_GAP)
        sums = []
        for along, places in zip(ALONG, self._first_samples):
            weights = widths * gauss_legendre(along)[1][:, None] * across_weights
            surface, *slopes = self._chart.evaluate(*places.coordinates[:, is_curve])
            rates = places.slopes[:, is_curve]
            surface_velocity = slopes[0] * rates[0] + slopes[1] * rates[1]
            gap = (places.points[:, is_curve] - surface)[..., None]
            spots = surface[..., None] + across * gap
            spots -= about[:, None, None, None]
            change = places.velocities[:, is_curve] - surface_velocity
            velocity = surface_velocity[..., None] + across * change[..., None]
            # Points and their derivatives across the gap and along the loop.
            values = terms([spots, np.broadcast_to(gap, velocity.shape), velocity])
            sums.append((values * weights).sum(axis=(1, 2, 3)))
        coarse, fine = sums
        # `integrate` multiplies all by the sign of strips, which gaps have not.
        return self._sign * fine[:-1], fine[:-1] - coarse[:-1], float(fine[-1])

    def _strip_integrals(
        self, samples: Sequence[Places], strips: Strips, terms: Terms, about: NDArray, most: int
    ) -> tuple[Array, Array]:
        """Return (K + 1, n) integrals over strips by the coarse and by the fine rule, from the
        `_samples` of their segments; the last row: sizes.
        """
        is_line = isinstance(self._chart, Quadric) and not self._chart.minor and self._axis == 1
        sums = []
        for places, along, across in zip(samples, ALONG, ACROSS_LINES if is_line else ACROSS):
            nodes, node_weights = gauss_legendre(across)
            tops = places.coordinates[self._axis]
            others = places.coordinates[1 - self._axis]
            rates = places.slopes[1 - self._axis] * np.diff(strips.ends, axis=1)
            rates = rates * gauss_legendre(along)[1]
            blocks = []
            step = max(1, POINTS_PER_BLOCK // (along * across))
            for start in range(0, len(strips), step):
                block = slice(start, start + step)
                segment = strips.segment[block]
                low, high = strips.low[block, None], strips.high[block, None]
                first = strips.first[block, None]
                part = strips.last[block, None] - first
                width = np.where(np.isnan(high), tops[segment], high) - low
                # (strips, 1 or points along the segment, points across)
                shares = first + part * nodes
                swept = low[..., None] + width[..., None] * shares[:, None]
                other = others[segment][..., None]
                u, v = (other, swept) if self._axis else (swept, other)
                derivatives = self._chart.evaluate(u, v, most)
                derivatives[0] -= about[:, None, None, None]
                element = (rates[segment] * width * part)[..., None] * node_weights
                values = terms(derivatives)
                integrals = np.einsum("knij,nij->kn", values[:-1], element)
                sizes = (values[-1] * np.abs(element)).sum(axis=(1, 2))
                blocks.append(np.concatenate([integrals, sizes[None]]))
            sums.append(np.concatenate(blocks, axis=1))
        return sums[0], sums[1]

    @cached_property
    def _first_samples(self) -> list[Places]:
        """The samples of all segments that are not cut yet."""
        return self._samples(self._strips)

    def _samples(self, strips: Strips) -> list[Places]:
        """Return for each rule the places at its points of segments."""
        begin = strips.ends[:, :1]
        width = strips.ends[:, 1:] - begin
        return [
            self._places(strips.piece, begin + width * nodes)
            for nodes, _ in map(gauss_legendre, ALONG)
        ]

    @cached_property
    def _strips(self) -> Strips:
        """The strips before they are cut: of each segment between knots that its curve crosses, a
        strip between any two neighboring knots across.
        """
        shares = np.linspace(0.0, 1.0, SAMPLES)[:, None]
        line_tracks = self._lines[:, :1] + np.diff(self._lines, axis=1) * shares
        tracks = np.concatenate([self._tracks, line_tracks])
        cuts_of_piece: list[set[float]] = [{0.0, 1.0} for _ in tracks]
        for axis in (0, 1):
            for piece, cut in zip(*self._knot_crossings(tracks, axis)):
                cuts_of_piece[piece].add(cut)
        pieces, ends = [], []
        for piece, cuts in enumerate(map(sorted, cuts_of_piece)):
            pieces += [piece] * (len(cuts) - 1)
            ends += zip(cuts[:-1], cuts[1:])
        piece_of_segment = np.array(pieces, np.intp)
        segment_ends = np.array(ends)
        middles = segment_ends.mean(axis=1)[:, None]
        tops = self._places(piece_of_segment, middles).coordinates[self._axis, :, 0]
        across = tracks[..., 1 - self._axis]
        bounds_area = np.ptp(across, axis=1) > FLAT_STEP * max(float(np.ptp(across)), 1e-300)
        low, high = min(self._base, float(tops.min())), max(self._base, float(tops.max()))
        knots = self._chart.knots(self._axis, low, high)
        segments, lows, highs = [], [], []
        for segment in np.flatnonzero(bounds_area[piece_of_segment]).tolist():
            top = float(tops[segment])
            between = knots[(knots > min(self._base, top)) & (knots < max(self._base, top))]
            stops = (between if top > self._base else between[::-1]).tolist()
            segments += [segment] * (len(stops) + 1)
            lows += [self._base, *stops]
            highs += [*stops, np.nan]
        return Strips(
            piece=piece_of_segment,
            ends=segment_ends,
            segment=np.array(segments, np.intp),
            low=np.array(lows),
            high=np.array(highs),
            first=np.zeros(len(segments)),
            last=np.ones(len(segments)),
        )

    def _knot_crossings(self, tracks: NDArray, axis: int) -> tuple[list[int], list[float]]:
        """Return the pieces that cross a knot of a coordinate, and the parameters where they do.

        tracks: (pieces, SAMPLES, 2) coordinates of all tracks and lines.
        """
        heights = tracks[..., axis]
        knots = self._chart.knots(axis, float(heights.min()), float(heights.max()))
        is_above = heights[..., None] > knots
        piece, sample, knot = np.nonzero(is_above[:, 1:] != is_above[:, :-1])
        begins_above = is_above[piece, sample, knot]
        shares = np.linspace(0.0, 1.0, SAMPLES)
        low, high = shares[sample], shares[sample + 1]
        at = (low + high) / 2.0
        for _ in range(NEWTON_STEPS):  # Newton's steps, kept within the interval
            places = self._places(piece, at[:, None])
            excess = places.coordinates[axis, :, 0] - knots[knot]
            is_before = (excess > 0.0) == begins_above
            low, high = np.where(is_before, at, low), np.where(is_before, high, at)
            rate = places.slopes[axis, :, 0]
            onward = at - excess / np.where(rate == 0.0, 1.0, rate)
            is_inside = (onward > low) & (onward < high) & (rate != 0.0)
            moved = np.where(is_inside, onward, (low + high) / 2.0)
            step = np.abs(moved - at).max(initial=0.0)
            at = moved
            if step <= 1e-15:
                break
        return piece.tolist(), at.tolist()

    def _places(self, piece: Index, at: NDArray) -> Places:
        """Return the places on pieces (n,), at (n, m) parameters from 0 to 1."""
        places = Places(*(np.zeros((size, *at.shape)) for size in (2, 2, 3, 3)))
        is_line = piece >= len(self._tracks)
        if is_line.any():
            lines = self._lines[piece[is_line] - len(self._tracks)]
            begin, end = np.moveaxis(lines, 1, 0)[..., None]
            line_places = begin + (end - begin) * at[is_line, None]
            places.coordinates[:, is_line] = np.moveaxis(line_places, 1, 0)
            places.slopes[:, is_line] = np.moveaxis(end - begin, 1, 0)
        is_curve = ~is_line
        if is_curve.any():
            track, steps = piece[is_curve], at[is_curve]
            points, velocities = evaluate_nets(self._nets[track], steps, self._origin)
            flat_points, flat_velocities = points.reshape(3, -1).T, velocities.reshape(3, -1).T
            # The nearest point is searched from the track's value between its samples.
            scaled = steps * (SAMPLES - 1)
            left = np.clip(scaled.astype(np.intp), 0, SAMPLES - 2)
            share = (scaled - left)[..., None]
            guess = self._tracks[track[:, None], left] * (1.0 - share)
            guess += self._tracks[track[:, None], left + 1] * share
            coordinates = self._chart.project(flat_points, guess.reshape(-1, 2))
            slopes = follow(self._chart, flat_points, flat_velocities, coordinates)
            places.coordinates[:, is_curve] = coordinates.T.reshape(-1, *steps.shape)
            places.slopes[:, is_curve] = slopes.T.reshape(-1, *steps.shape)
            places.points[:, is_curve] = points
            places.velocities[:, is_curve] = velocities
        return places
