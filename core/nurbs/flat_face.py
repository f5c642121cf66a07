# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat faces of a body: regions of a plane, bounded by closed loops of B-spline curves, with holes.

Their moments follow from their boundary (`curve_moments.plane_moments`), however the plane may be parametrized.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..moments.moments import Measure, Moments, U, monomials
from ..numerics.bspline import SplineSpace
from .curve import Curve
from .curve_moments import plane_moments
from .patch import Face, Patch
from .planar_regions import planar_loops

SAME_HEIGHT_RTOL = 1e-9  # Relative to the extent: corners whose heights differ by less share a row of trapezoids.
PAIRS_PER_BLOCK = 1 << 22  # rows and edges compared at a time


@dataclass(frozen=True, eq=False)
class FlatFace:
    """A region of a plane.

    loops: closed boundaries, each of curves end to end, with the region on their left. normal: (3,) the unit vector
    that sees them so.
    """

    loops: tuple[tuple[Curve, ...], ...]
    normal: NDArray[np.float64]

    @classmethod
    def within(cls, loops: Sequence[Sequence[Curve]], toward: ArrayLike) -> FlatFace:
        """Return the region between loops of any direction, its normal towards `toward`, or raise MeasureError."""
        oriented, normal = planar_loops(loops)
        face = cls(tuple(map(tuple, oriented)), normal)
        return face.reverse_orientation() if float(normal @ np.asarray(toward)) < 0.0 else face

    @property
    def curves(self) -> tuple[Curve, ...]:
        """All boundary curves."""
        return tuple(curve for loop in self.loops for curve in loop)

    @property
    def sides(self) -> tuple[tuple[Curve, bool], ...]:
        """The boundary curves, and True for each, as the face is on its left."""
        return tuple((curve, True) for curve in self.curves)

    @property
    def spaces(self) -> tuple[SplineSpace, ...]:
        """Function spaces of the boundary curves."""
        return tuple(curve.space for curve in self.curves)

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 1, 3) control points of the boundary."""
        return np.concatenate([curve.points for curve in self.curves])[:, None]

    @cached_property
    def center(self) -> NDArray[np.float64]:
        """(3,) the mean control point, which is in the plane."""
        return self.points.mean(axis=(0, 1))

    @property
    def deviation(self) -> float:
        """The largest distance of a control point from the plane, by rounding."""
        return float(np.abs((self.points - self.center) @ self.normal).max())

    @property
    def perimeter(self) -> float:
        """An upper bound of the length of the boundary."""
        return sum(float(np.linalg.norm(np.diff(curve.points, axis=0), axis=1).sum()) for curve in self.curves)

    def reverse_orientation(self) -> FlatFace:
        """Return the same region facing the other way."""
        loops = tuple(tuple(curve.reverse() for curve in reversed(loop)) for loop in self.loops)
        return FlatFace(loops, -self.normal)

    def transform(self, matrix: ArrayLike) -> FlatFace:
        """Return its image under an affine map (4, 4)."""
        matrix = np.asarray(matrix, np.float64)
        normal = np.cross(*(matrix[:3, :3] @ self._frame).T)
        loops = tuple(tuple(curve.transform(matrix) for curve in loop) for loop in self.loops)
        return FlatFace(loops, normal / np.linalg.norm(normal))

    def area_moments(self, order: int, about: NDArray) -> Moments:
        """Return the moments of the region's area about any point (3,)."""
        return plane_moments(self.curves, self.normal, order, self.center).about_point(about)

    def volume_moments(self, order: int, about: NDArray) -> Moments:
        """Return the moments of the cone from a point (3,) to the region: its share in those of a body."""
        area, degree = self.area_moments(order, about), monomials(order).sum(axis=1)
        height = float((self.center - about) @ self.normal)
        reach = float(np.sqrt(((self.points - about) ** 2).sum(axis=-1).max()))
        error = abs(height) * area.rounding_error + 16.0 * U * area.total * reach ** (degree + 1.0)
        return Moments(height * area.raw / (degree + 3.0), about, Measure.VOLUME, error / (degree + 3.0))

    def slab_moments(self, heights: NDArray, steps: NDArray, order: int, about: NDArray) -> Moments:
        """Return the volume moments of a slab on the region, from its sections at heights (n,) with weights (n,)."""
        sections = [self.area_moments(order, about - height * self.normal) for height in heights]
        raw, error = (
            sum(step * row for step, row in zip(steps, rows))
            for rows in zip(*((one.raw, one.rounding_error) for one in sections))
        )
        return Moments(np.asarray(raw), about, Measure.VOLUME, np.asarray(error))

    def quads(self, each: int) -> NDArray[np.float64]:
        """Return (n, 4, 3) corners of trapezoids that fill the polygon through `each` samples per span."""
        loops = [np.concatenate([curve.samples(each)[:-1] for curve in loop]) for loop in self.loops]
        begin = (np.concatenate(loops) - self.center) @ self._frame
        grain = SAME_HEIGHT_RTOL * float(np.ptp(begin, axis=0).max())
        begin[:, 1] = np.round(begin[:, 1] / grain) * grain
        starts = np.cumsum([0, *map(len, loops)])
        end = np.concatenate([np.roll(begin[a:b], -1, axis=0) for a, b in zip(starts[:-1], starts[1:])])
        heights = np.unique(begin[:, 1])
        low, high = np.minimum(begin[:, 1], end[:, 1]), np.maximum(begin[:, 1], end[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (end[:, 0] - begin[:, 0]) / (end[:, 1] - begin[:, 1])
        found: list[NDArray[np.float64]] = []
        step = max(1, PAIRS_PER_BLOCK // len(low))
        for start in range(0, len(heights) - 1, step):
            bottom, top = heights[start : start + step], heights[start + 1 : start + 1 + step]
            bottom = bottom[: len(top)]
            row, edge = np.nonzero((low <= bottom[:, None]) & (high >= top[:, None]))
            x = begin[edge, 0] + (np.stack([bottom[row], top[row]]) - begin[edge, 1]) * slope[edge]
            order = np.lexsort((x.sum(axis=0), row))
            (x0, x1), y0, y1 = x[:, order], bottom[row[order]], top[row[order]]
            left, right = slice(0, None, 2), slice(1, None, 2)
            corners = [(x0[left], y0[left]), (x0[right], y0[right]), (x1[right], y1[right]), (x1[left], y1[left])]
            found.append(np.moveaxis(np.array(corners, np.float64), 2, 0))
        return np.concatenate(found) @ self._frame.T + self.center

    @cached_property
    def _frame(self) -> NDArray[np.float64]:
        """(3, 2) two unit vectors along the plane; the normal is their cross product."""
        along = np.cross(self.normal, np.eye(3)[np.argmin(np.abs(self.normal))])
        along /= np.linalg.norm(along)
        return np.array([along, np.cross(self.normal, along)], np.float64).T


def split_faces(faces: Sequence[Face]) -> tuple[list[Patch], list[FlatFace]]:
    """Return the patches and the flat faces."""
    return (
        [face for face in faces if isinstance(face, Patch)],
        [face for face in faces if isinstance(face, FlatFace)],
    )
