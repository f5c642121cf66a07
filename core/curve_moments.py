# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of B-spline curves: of their length, as wires, and of the plane regions that closed ones bound.

A region's moments are those of the flux through its boundary, by Green's theorem about a point of its plane,

    ∫ x^p y^q z^r dA = 1 / (p+q+r+2) · ∮ x^p y^q z^r n · (C x C') dt,

whose integrand is a polynomial of degree (n + 2) d - 1 where the curve is one of degree d: exact by Gauss's rule. Where
it is rational, and for the length's square root, rules are compared as in `patch_moments`, and the difference is
reported as an estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil

import numpy as np
from numpy.typing import NDArray

from .curve import Curve
from .moments import Moments, U, monomials
from .patch_moments import ROUNDING, TOLERANCE
from .quadrature import gauss_and_ends

LENGTH_TOLERANCE = 1e-13
RULES = (8, 12, 18, 27)  # points; each is compared with the one before
DEEPEST = 26  # times that a piece is halved: one that turns back is as short as rounding then


def curves_center(curves: Sequence[Curve]) -> NDArray[np.float64]:
    """(3,) the middle of the box around all control points: the reference point."""
    low = np.min([curve.points.min(axis=0) for curve in curves], axis=0)
    high = np.max([curve.points.max(axis=0) for curve in curves], axis=0)
    return low + (high - low) / 2.0


def length_moments(curves: Sequence[Curve], order: int = 3) -> Moments:
    """∫ x^p y^q z^r ds along the curves, about the middle of their box; `error` is an estimate."""
    about = curves_center(curves)
    reach, degree = _reach(curves, about), monomials(order).sum(axis=1)

    def length(place: NDArray, velocity: NDArray) -> NDArray:
        return np.sqrt((velocity ** 2).sum(axis=0))

    values, estimate, size = _integrated(curves, length, 1.0, order, about, reach, LENGTH_TOLERANCE)
    scale = size * reach ** degree.astype(np.float64)
    return Moments(values, about, "length", estimate * reach ** degree.astype(np.float64) + ROUNDING * U * 8 * scale)


def plane_moments(curves: Sequence[Curve], normal: NDArray, order: int = 3, about: NDArray | None = None) -> Moments:
    """The area moments of the region in a plane that closed curves bound, counter-clockwise seen from the normal's tip.

    normal: (3,) unit. about: (3,) a point of the plane, by default the mean of the control points. A curve that runs
    clockwise bounds a hole. Of polynomial curves the moments are exact and `error` is rounding.
    """
    about = np.mean([curve.points.mean(axis=0) for curve in curves], axis=0) if about is None else np.asarray(about)
    reach, degree = _reach(curves, about), monomials(order).sum(axis=1)

    def flux(place: NDArray, velocity: NDArray) -> NDArray:
        x, y, z = place
        a, b, c = velocity
        return normal[0] * (y * c - z * b) + normal[1] * (z * a - x * c) + normal[2] * (x * b - y * a)

    values, estimate, size = np.zeros(len(degree)), 0.0, 0.0
    exact = [curve for curve in curves if curve.weights is None]
    for curve in exact:
        points = ceil((order + 2) * (curve.space.order - 1) / 2)
        rows, length, _ = _pieces(curve, curve.space.intervals, curve.space.spans, max(points, 1), flux, order, about)
        values, size = values + rows.sum(axis=0), size + length.sum()
    rational = [curve for curve in curves if curve.weights is not None]
    if rational:
        more, estimate, length = _integrated(rational, flux, reach, order, about, reach, TOLERANCE)
        values, size = values + more, size + length
    powers = reach ** (degree + 1.0)
    error = (estimate / max(reach, 1e-300) * powers + ROUNDING * U * 8 * size * powers) / (degree + 2.0)
    return Moments(values / (degree + 2.0), about, "area", error)


def _reach(curves: Sequence[Curve], about: NDArray) -> float:
    return max(float(np.sqrt(((curve.points - about) ** 2).sum(axis=1).max())) for curve in curves)


def _integrated(curves: Sequence[Curve], density: Callable, largest: float, order: int, about: NDArray, reach: float,
                tolerance: float) -> tuple[NDArray, float, float]:
    """The integral of density times monomials, the estimate of its truncation by unit of reach to the degree, and the
    curves' length. largest: what the density is at most, for each unit of length."""
    degree = monomials(order).sum(axis=1)
    unit = reach ** degree.astype(np.float64)
    values, estimate, whole = np.zeros(len(degree)), 0.0, 0.0
    for curve in curves:
        bounds, spans, coarse, rule, depth = curve.space.intervals, curve.space.spans, None, 0, 0
        while len(bounds):
            if coarse is None:
                coarse, *_ = _pieces(curve, bounds, spans, RULES[rule], density, order, about)
            fine, size, unseen = _pieces(curve, bounds, spans, RULES[rule + 1], density, order, about)
            differ = np.where(unit > 0.0, np.abs(fine - coarse) / np.where(unit > 0.0, unit, 1.0), 0.0).max(axis=1)
            differ += unseen * largest
            good = (differ <= tolerance * size * largest) | (depth >= DEEPEST)
            values += fine[good].sum(axis=0)
            estimate += float(differ[good].sum())
            whole += float(size[good].sum())
            bounds, spans, coarse = bounds[~good], spans[~good], fine[~good]
            rule += 1
            if rule + 1 == len(RULES):
                middle = bounds.mean(axis=1)
                bounds = np.stack([bounds[:, 0], middle, middle, bounds[:, 1]], axis=1).reshape(-1, 2)
                spans, coarse, rule, depth = np.repeat(spans, 2), None, 0, depth + 1
    return values, estimate, whole


def _pieces(curve: Curve, bounds: NDArray, spans: NDArray, points: int, density: Callable, order: int,
            about: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """(c, K) the contributions of pieces of a curve, bounds (c, 2) each within its span, (c,) their lengths, and (c,)
    those of their ends that turn back before the first or after the last point, where no rule would see it."""
    nodes, weights = gauss_and_ends(points)
    size = (bounds[:, 1] - bounds[:, 0])[:, None]
    values, slopes = curve.space.derivatives(spans[:, None], bounds[:, :1] + size * nodes, 1)
    controls = curve.space.controls(spans)
    home = curve.points[controls[:, :1]]
    net = (curve.points[controls] - home)
    if curve.weights is not None:
        net = np.concatenate([net * curve.weights[controls][..., None], curve.weights[controls][..., None]], axis=2)
    place, velocity = (np.einsum("cmk,ckd->dcm", table, net) for table in (values, slopes))
    if curve.weights is not None:
        bottom = place[3]
        velocity = (velocity[:3] - place[:3] / bottom * velocity[3]) / bottom
        place = place[:3] / bottom
    place = place + (home - about).transpose(2, 0, 1)
    element = density(place, velocity) * (size * weights)
    columns = [(element * place[0] ** p * place[1] ** q * place[2] ** r).sum(axis=1)
               for p, q, r in monomials(order).tolist()]
    speed = np.sqrt((velocity ** 2).sum(axis=0))
    unseen = sum(np.where((velocity[..., a] * velocity[..., b]).sum(axis=0) < 0.0, speed[:, a] + speed[:, b], 0.0)
                 for a, b in ((0, 1), (-1, -2)))
    return np.stack(columns, axis=1), (speed * size * weights).sum(axis=1), unseen * nodes[1] * size[:, 0]
