# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of B-spline patches with any knots into patches with Blender's knots.

Blender's splines have no knots of their own. If every knot is inserted until its multiplicity is the degree, a patch
consists of Bézier patches side by side, and the distances of their knots change its parameters but not its points.
So Blender's flags *Bézier* and *Endpoint* describe the same surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ..numerics.bspline import SplineSpace
from .bezier import homogeneous
from .blender_knots import blender_space
from .curve import Curve
from .patch import Patch

SAME_KNOT_RTOL = 1e-12  # Relative to the domain: ends of a part that are nearer to a knot are moved to it.


def bezier_patches(patch: Patch, domain: tuple[tuple[float, float] | None, tuple[float, float] | None]) -> list[Patch]:
    """Convert a patch with any knots into patches of the same surface with Blender's flags *Bézier* and *Endpoint*.

    There are several if the surface may jump, at knots with the multiplicity of the order. domain: (low, high) of s and
    of t, the part to convert; None for all of it. ValueError if the part is not in the domain, or an order is 1.

    By Boehm's knot insertion, as blossoms: each new control point is the same affine combination of old ones, whether
    the knots are inserted one at a time or at once.
    """
    pieces = [list(_pieces(space, part)) for space, part in zip(patch.spaces, domain)]
    old_net = patch.points if patch.weights is None else homogeneous(patch.points, patch.weights)
    found, (s_space, t_space) = [], patch.spaces
    for s_matrix, t_matrix in product(*pieces):
        spaces = bezier_space(len(s_matrix), s_space.order), bezier_space(len(t_matrix), t_space.order)
        net = np.einsum("bj,ajd->abd", t_matrix, np.einsum("ai,ijd->ajd", s_matrix, old_net))
        weights = None if patch.weights is None else net[..., 3]
        found.append(Patch(spaces, net if weights is None else net[..., :3] / weights[..., None], weights))
    return found


def bezier_curves(curve: Curve, part: tuple[float, float] | None = None) -> list[Curve]:
    """Convert a part (low, high) of a curve, None for all of it, in the same way, into curves without jumps."""
    net = curve.points
    if curve.weights is not None:
        net = homogeneous(curve.points, curve.weights)
    found = []
    for matrix in _pieces(curve.space, part):
        row = matrix @ net
        weights = None if curve.weights is None else row[:, 3]
        points = row if weights is None else row[:, :3] / weights[:, None]
        found.append(Curve(bezier_space(len(matrix), curve.space.order), points, weights))
    return found


def bezier_space(count: int, order: int) -> SplineSpace:
    """Return the space of Bézier pieces side by side that Blender's flags *Bézier* and *Endpoint* describe."""
    return cast("SplineSpace", blender_space(count, order, cyclic=False, bezier=True, endpoint=True))


def _pieces(space: SplineSpace, part: tuple[float, float] | None) -> Iterator[NDArray[np.float64]]:
    """Yield, for each piece without a jump, (n, count) the weights of the old control points in the new ones."""
    low, high = space.domain if part is None else _snapped(space, part)
    edges = np.clip(space.intervals, low, high)
    inside = edges[:, 0] < edges[:, 1]
    if space.order < 2:
        raise ValueError("a space of steps")
    spans, edges = space.spans[inside], edges[inside]
    weights = space.bezier_weights(spans, edges)
    controls = space.controls_of_spans(spans)
    knots = np.asarray(space.knots)
    rows: list[NDArray[np.float64]] = []
    for edge, block, columns in zip(edges, weights, controls):
        dense = np.zeros((space.order, space.count))
        np.add.at(dense.T, columns, block.T)
        if rows and np.count_nonzero(knots == edge[0]) >= space.order:
            yield np.concatenate(rows)
            rows = []
        rows.append(dense[1:] if rows else dense)
    yield np.concatenate(rows)


def _snapped(space: SplineSpace, part: tuple[float, float]) -> tuple[float, float]:
    """Return the ends of a part of the domain, moved to a knot if they differ from it by rounding alone."""
    low, high = space.domain
    knots = np.concatenate([space.intervals[:, 0], [high]])
    tolerance = SAME_KNOT_RTOL * (high - low)
    ends = []
    for end in part:
        nearest = float(knots[np.abs(knots - end).argmin()])
        ends.append(nearest if abs(nearest - end) <= tolerance else float(end))
    if not low <= ends[0] < ends[1] <= high:
        raise ValueError("part beyond the domain")
    return ends[0], ends[1]
