# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of a patch with moving control points, from tables made once for its function space.

Soldea, Elber and Rivlin (section 3) precompute Φ, integrals of products of six and more basis functions, and contract
them with the control points. Every entry of Φ is a difference of products of two integrals over one parameter each, so
that only the matrices from control points to Bézier ones (`bezier`) are precomputed: 4 kB instead of 0.4 to 140 MB for
an 8 x 8 bicubic patch, and fewer operations (`phi` is their scheme, to compare with). A control point acts on k x k'
spans only; the others' contributions are kept.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..moments.moments import Moments, monomials
from ..numerics.bspline import SplineSpace
from .bezier import MAX_CELLS, cells_of_nets, homogeneous
from .patch import Patch
from .patch_moments import exact_points, flux_sums, integrand_in_blocks

RATIONAL_GAUSS_POINTS = 16  # Gauss points in a span of a rational patch


class IncrementalPatchMoments:
    """A patch in a fixed function space, its control points free to move.

    Gauss rules are exact for polynomial patches. For rational ones they have 16 points a span and come without an
    estimate, which `patch_moments` gives. order: of the moments. about: (3,) their reference point, by default the mean
    of the control points. The flux of one patch is a body's only together with those of the others. `area` is the area
    of the patch as last evaluated, by the same points: an approximation.
    """

    def __init__(self, patch: Patch, order: int = 2, about: NDArray | None = None):
        self.spaces, self.order, self.rational = patch.spaces, order, patch.weights is not None
        self.about = np.asarray(patch.points.mean(axis=(0, 1)) if about is None else about, np.float64)
        along_s, along_t = (
            (RATIONAL_GAUSS_POINTS if self.rational else exact_points(space.order, order),) for space in self.spaces
        )
        self._rule = along_s, along_t
        self._flux = partial(flux_sums, order=order, area=True)
        self._divisor = monomials(order).sum(axis=1) + 3.0
        self._anchor = self.about
        self._net = np.zeros((*patch.points.shape[:2], 3 + self.rational))
        if self.rational:
            self._net[..., 3] = patch.weights
        self._sums = np.zeros((len(self._divisor) + 1, *(len(space.spans) for space in self.spaces)))
        self.area = 0.0

    def moments(self, points: NDArray, weights: NDArray | None = None) -> Moments:
        """Return all moments for these control points (count_s, count_t, 3): the flux through the patch, about `about`.

        weights: (count_s, count_t), of a rational patch; None leaves them.
        """
        self._require_rational(weights)
        points = np.asarray(points, np.float64)
        self._anchor = points[0, 0].copy()
        net = points - self._anchor
        if self.rational:
            net = homogeneous(net, self._net[..., 3] if weights is None else np.asarray(weights))
        self._net = net
        _, u, v = self._sums.shape
        step = max(1, MAX_CELLS // v)
        for start in range(0, u, step):
            self._evaluate(slice(start, min(start + step, u)), slice(0, v))
        return self._current_moments()

    def move_control_point(self, i: int, j: int, point: NDArray, weight: float | None = None) -> Moments:
        """Return all moments after control point (i, j) has moved: only the spans on which it acts are evaluated.

        weight: of a rational patch; None leaves it. `moments` must have been called for the others.
        """
        self._require_rational(weight)
        place = np.asarray(point, np.float64) - self._anchor
        if self.rational:
            factor = float(self._net[i, j, 3]) if weight is None else weight
            place = np.append(place * factor, factor)
        self._net[i, j] = place
        for s_spans in _affected_spans(self.spaces[0], i):
            for t_spans in _affected_spans(self.spaces[1], j):
                self._evaluate(s_spans, t_spans)
        return self._current_moments()

    def _require_rational(self, weights: NDArray | float | None) -> None:
        if weights is not None and not self.rational:
            raise ValueError("made without weights")

    def _evaluate(self, s_spans: slice, t_spans: slice) -> None:
        anchor = (self._anchor - self.about)[None]
        cells = cells_of_nets(self._net[None], anchor, self.spaces, (s_spans, t_spans), (False, False), 0.0)
        sums = integrand_in_blocks(cells, self._rule, self._flux)[0]
        self._sums[:, s_spans, t_spans] = sums.reshape(len(sums), s_spans.stop - s_spans.start, -1)

    def _current_moments(self) -> Moments:
        sums = np.add.reduce(self._sums, axis=(1, 2))
        self.area = float(sums[-1])
        return Moments(sums[:-1] / self._divisor, self.about)


def _affected_spans(space: SplineSpace, control: int) -> list[slice]:
    """Return the spans on which a control point acts: several runs of them if a closed direction repeats it."""
    runs = [
        slice(*np.searchsorted(space.spans, (function, function + space.order)).tolist())
        for function in range(control, space.function_count, space.count)
    ]
    return [run for run in runs if run.start < run.stop]
