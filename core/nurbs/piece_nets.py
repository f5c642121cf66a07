# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Bézier pieces of curves, as one array of homogeneous control points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..numerics import Array, NDArray, SplineSpace
from .splines import Curve, homogeneous

SAMPLES = 17  # samples of a Bézier piece of a loop


def bezier_nets(curves: Sequence[Curve]) -> tuple[Array, Array]:
    """Return (c, order, 4) homogeneous control points of the Bézier pieces of curves, raised to one
    order, about an origin, and the origin (3,).
    """
    origin = curves[0].points[0] if curves else np.zeros(3)
    order = max((curve.space.order for curve in curves), default=2)
    nets = [np.zeros((0, order, 4))]
    for curve in curves:
        net = homogeneous(curve.points - origin, curve.all_weights)[curve.space.active_controls]
        nets.append(_raised_extraction(curve.space, order) @ net)
    return np.concatenate(nets), origin


@lru_cache(maxsize=64)
def _raised_extraction(space: SplineSpace, order: int) -> Array:
    """Return (s, order, k) weights of the acting control points in Bézier points of an order;
    cached: do not modify.
    """
    table = space.bezier_extraction
    for degree in range(space.order, order):
        # Point i of the higher degree n is i / n times point i - 1, plus 1 - i / n times point i.
        share = (np.arange(degree + 1) / degree)[:, None]
        before, same = (np.pad(table, ((0, 0), ends, (0, 0))) for ends in ((1, 0), (0, 1)))
        table = share * before + (1.0 - share) * same
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
    # The last step of de Casteljau: a point divides the line between two curves of one degree less,
    # whose difference is the slope.
    lower = choose * t**powers * rest ** powers[::-1]
    begin, end = lower @ nets[:, :-1], lower @ nets[:, 1:]
    values = np.moveaxis(rest * begin + t * end, -1, 0)
    slopes = degree * np.moveaxis(end - begin, -1, 0)
    place = values[:3] / values[3]
    velocity = (slopes[:3] - place * slopes[3]) / values[3]
    return place + origin[:, None, None], velocity
