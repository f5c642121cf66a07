# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces: regions of curved surfaces within closed loops of curves, which lie on them within a small
distance. Their moments are integrals over strips (`strips`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, NDArray, SplineSpace, cross
from ..verdict import WELDING_RTOL
from .bezier import ROUNDING, VOLUME_RTOL
from .patch_moments import AREA_RTOL, area_slope, area_terms, flux_terms, sheet_terms
from .quadric import Quadric
from .spline_chart import SplineChart
from .splines import Curve, control_length
from .strips import StripIntegrator, Terms
from .tiles import region_tiles

MIN_TOLERANCE = 1e-13  # tolerance of strips, relative to their size
BLUR_SHARE = 0.1  # Share of the uncertainty by edges beside the surface: more cuts tell no more.
ROUNDED_ORDERS = 16  # orders of the bases of a typical surface, for the rounding of its points


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
        # The true edge may be beside the loops by the deviation, all along.
        error += self.deviation * self.perimeter * self._reach(about) ** degree
        return Moments(raw, about, Measure.AREA, error)

    def slab_moments(self, heights: NDArray, steps: NDArray, order: int, about: NDArray) -> Moments:
        """Return the volume moments of a sheet on the region, from its sections at heights (n,)
        above it. steps: (n,) weights of the sections, lengths.
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
        """A bound of the volume that the edges' distance from the surface leaves uncertain, per
        unit of length of an edge.

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
        """Return (n, 4, 2) coordinates of the corners of `quads`, and the corners."""
        tiles = region_tiles(self.chart, self.tracks, self.lines, self.axis, self.base, each)
        # As coordinates, tiles run counter-clockwise if strips run along the second one, else
        # clockwise; on a face they run counter-clockwise, seen from its side.
        if (self.facing < 0.0) == (self.axis == 1):
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
        """Return (K,) integrals of `terms` over the region, about a point (3,), and their error.

        degree: (K,) powers of a length in the integrals. most, has_gap: as for `StripIntegrator`.
        """
        unit = self._reach(about) ** degree
        blurred = BLUR_SHARE * self._blur / max(self._size**2, 1e-300)
        tolerance = max(tolerance, MIN_TOLERANCE, blurred)
        values, truncation, size = self._integrator.integrate(
            terms, unit, about, tolerance, most, has_gap
        )
        return values, (truncation + ROUNDING * U * size * (ROUNDED_ORDERS + degree)) * unit

    @cached_property
    def _integrator(self) -> StripIntegrator:
        return StripIntegrator(
            self.chart, self.curves, self.tracks, self.lines, self.axis, self.base
        )

    @cached_property
    def _box(self) -> tuple[Array, Array]:
        """Least and largest coordinates of the region."""
        corners = np.concatenate([self.tracks.reshape(-1, 2), self.lines.reshape(-1, 2)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        if len(self.lines):
            low[self.axis] = min(low[self.axis], self.base)
            high[self.axis] = max(high[self.axis], self.base)
        return low, high
