# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of a patch with moving control points, from tables made once for its function space.

Soldea, Elber and Rivlin (section 3) precompute Φ, integrals of products of six and more basis functions, and contract
them with the control points. Every entry of Φ is a difference of products of two integrals over one parameter each, so
that only the matrices from control points to Bézier ones (`bezier`) are precomputed: 4 kB instead of 0.4 to 140 MB for
an 8 x 8 bicubic patch, and fewer operations (`phi` is their scheme, to compare with). A control point acts on k x k'
spans only; the contributions of other spans are kept.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..moments.moments import Moments, monomials
from .bezier import MAX_CELLS, cells_of_nets, homogeneous
from .patch import Patch
from .patch_moments import exact_points, flux_sums, integrand_in_blocks

RATIONAL_GAUSS_POINTS = 16  # Gauss points in a span of a rational patch


class IncrementalPatchMoments:
    """Moments of a patch in a fixed function space and with fixed weights, its control points free to move.

    Gauss rules are exact for polynomial patches; for rational ones there is no error estimate. `area` is the area of
    the patch as last evaluated, by the same points: an approximation.
    """

    def __init__(self, patch: Patch, order: int, about: NDArray):
        self.spaces, self.weights, self.about = patch.spaces, patch.weights, about
        along_s, along_t = (
            (exact_points(space.order, order) if self.weights is None else RATIONAL_GAUSS_POINTS,)
            for space in self.spaces
        )
        self._rule = along_s, along_t
        self._flux = partial(flux_sums, order=order, area=True)
        self._divisor = monomials(order).sum(axis=1) + 3.0
        self._points, self._anchor = np.full_like(patch.points, np.nan), about
        self._sums = np.zeros((len(self._divisor) + 1, *(len(space.spans) for space in self.spaces)))
        self.area = 0.0

    def moments(self, points: NDArray) -> Moments:
        """Return the patch's flux as moments; only spans on which moved control points act are evaluated anew."""
        moved = (points != self._points).any(axis=2)
        self._points = points.copy()
        if moved.all():
            self._anchor = self._points[0, 0]
        net, anchor = self._points - self._anchor, (self._anchor - self.about)[None]
        net = net if self.weights is None else homogeneous(net, self.weights)
        s_spans, t_spans = (
            np.flatnonzero(moved.any(axis=1 - axis)[space.active_controls].any(axis=1))
            for axis, space in enumerate(self.spaces)
        )
        step = max(1, MAX_CELLS // max(1, len(t_spans)))
        for start in range(0, len(s_spans) if len(t_spans) else 0, step):
            spans = s_spans[start : start + step], t_spans
            cells = cells_of_nets(net[None], anchor, self.spaces, spans, (False, False), 0.0)
            sums = integrand_in_blocks(cells, self._rule, self._flux)[0]
            self._sums[:, spans[0][:, None], t_spans] = sums.reshape(len(sums), len(spans[0]), -1)
        total = np.add.reduce(self._sums, axis=(1, 2))
        self.area = float(total[-1])
        return Moments(total[:-1] / self._divisor, self.about)
