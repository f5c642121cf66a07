# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Length moments of B-spline curves (wires), and area moments of the plane regions that closed
curves bound.

A region's moments follow from the flux through its boundary, by Green's theorem about a point of
its plane,

    ∫ x^p y^q z^r dA = 1 / (p+q+r+2) · ∮ x^p y^q z^r n · (C x C') dt,

with an integrand of degree (n + 2) d - 1 for a polynomial curve of degree d: exact by Gauss's rule.
For rational curves, and for the square root in lengths, rules are compared as in `patch_moments`,
and the difference is reported as an estimate. Lengths have kinks where curves turn back; two rules
may miss them alike. The tangents of a Bézier curve lie in the cone of its control polygon's edges
(Floater 1992), so that such places are found and halved until they are too short to matter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, NDArray, check_type, cross, dot
from ..verdict import check_size
from .bezier import ROUNDING, VOLUME_RTOL, bernstein, halves
from .splines import Curve, homogeneous

LENGTH_TOLERANCE = 1e-13
RULES = (8, 12, 18, 27)  # Gauss points per piece; each rule is compared with the one before.
CURVES_PER_BLOCK = 256  # curves of one degree integrated at a time
MAX_DEPTH = 60  # Limit of successive halvings of a piece.
MAX_WEIGHT_RATIO = (
    1e8  # Largest by smallest weight of a piece: beyond it two rules may miss the same.
)


def curves_center(curves: Sequence[Curve]) -> Array:
    """Return the (3,) middle of the box around all control points: the reference point."""
    for curve in curves:
        check_type("curves", curve, Curve)
    low = np.min([curve.points.min(axis=0) for curve in curves], axis=0)
    high = np.max([curve.points.max(axis=0) for curve in curves], axis=0)
    check_size(*(high - low).tolist())
    return low + (high - low) / 2.0


def length_moments(curves: Sequence[Curve], order: int = 3) -> Moments:
    """Return ∫ x^p y^q z^r ds along curves, about the middle of the control points' bounding box.

    Parameters
    ----------
    curves : sequence of Curve
    order : int

    Returns
    -------
    Moments
        Length moments; `rounding_error` is an estimate, by comparing Gauss rules.

    Examples
    --------
    >>> from body_moments.core.nurbs import Curve, length_moments
    >>> from body_moments.core.numerics import clamped_space
    >>> line = Curve(clamped_space(2), np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0]]))
    >>> round(length_moments([line]).total, 9)
    5.0
    """
    about = curves_center(curves)
    reach = _reach(curves, about)
    degree = monomials(order).sum(axis=1)

    def length(place: NDArray, velocity: NDArray) -> NDArray:
        return np.sqrt((velocity**2).sum(axis=0))

    values, estimate, size = _integrate(
        curves, length, 1.0, order, about, reach, LENGTH_TOLERANCE, kinks=True
    )
    powers = reach ** degree.astype(np.float64)
    # 8: chosen, above the order of most curves.
    error = estimate * powers + ROUNDING * U * 8 * (size * powers)
    return Moments(values, about, Measure.LENGTH, error)


def plane_moments(
    curves: Sequence[Curve], normal: NDArray, order: int = 3, about: NDArray | None = None
) -> Moments:
    """Return the area moments of the plane region between curves, counter-clockwise about the (3,)
    unit normal.
    """
    center: Array = (
        np.mean([curve.points.mean(axis=0) for curve in curves], axis=0)
        if about is None
        else np.asarray(about)
    )
    reach = _reach(curves, center)
    degree = monomials(order).sum(axis=1)

    def flux(place: NDArray, velocity: NDArray) -> NDArray:
        return dot(normal, cross(place, velocity))

    values, estimate, size = _integrate(curves, flux, reach, order, center, reach, VOLUME_RTOL)
    powers = reach ** (degree + 1.0)
    # The estimate has the factor `reach` of the flux already. 8: as for lengths.
    error = (estimate / max(reach, 1e-300) * powers + ROUNDING * U * 8 * size * powers) / (
        degree + 2.0
    )
    return Moments(values / (degree + 2.0), center, Measure.AREA, error)


def _reach(curves: Sequence[Curve], about: NDArray) -> float:
    return max(float(np.sqrt(((curve.points - about) ** 2).sum(axis=1).max())) for curve in curves)


def _integrate(
    curves: Sequence[Curve],
    density: Callable,
    largest: float,
    order: int,
    about: NDArray,
    reach: float,
    tolerance: float,
    kinks: bool = False,
) -> tuple[NDArray, float, float]:
    """Return ∫ density times monomials, the truncation in units of reach^degree, and the total
    length of the curves.

    largest: bound of the density per unit of length. kinks: True if the density has kinks where a
    curve turns back. A piece is done when two rules agree within the tolerance, relative to its
    length or to the mean length of pieces.
    """
    unit = reach ** monomials(order).sum(axis=1).astype(np.float64)
    values = np.zeros(len(unit))
    estimate = 0.0
    total_length = 0.0
    for net, anchor in _blocks_of_pieces(curves, about):
        coarse = None
        rule = 0
        depth = 0
        mean_length = 0.0
        while len(net):
            if coarse is None:
                coarse, _ = _piece_integrals(net, anchor, RULES[rule], density, order)
            fine, lengths = _piece_integrals(net, anchor, RULES[rule + 1], density, order)
            mean_length = mean_length or float(lengths.mean())
            differences = np.where(
                unit > 0.0, np.abs(fine - coarse) / np.where(unit > 0.0, unit, 1.0), 0.0
            ).max(axis=1)
            differences += _doubtful_lengths(net, kinks, largest)
            # A piece whose moments overflow is not halved.
            limits = tolerance * np.maximum(lengths, mean_length) * largest
            is_done = ~(differences > limits) | (depth >= MAX_DEPTH)
            values += fine[is_done].sum(axis=0)
            estimate += float(differences[is_done].sum())
            total_length += float(lengths[is_done].sum())
            net = net[~is_done]
            anchor = anchor[~is_done]
            coarse = fine[~is_done]
            rule += 1
            if rule + 1 == len(RULES):
                # The finest rule did not suffice: halve the pieces, and begin with the first.
                net = np.concatenate(
                    [np.einsum("ij,cjd->cid", half, net) for half in halves(net.shape[1])]
                )
                net, anchor = _about_first_control(net, np.tile(anchor, (2, 1)))
                coarse = None
                rule = 0
                depth += 1
    return values, estimate, total_length


def _blocks_of_pieces(curves: Sequence[Curve], about: NDArray) -> Iterator[tuple[Array, Array]]:
    """Yield the control points and anchors of `_bezier_pieces`, of many curves of one form."""
    by_form: dict[tuple[int, ...], list[tuple[Array, Array]]] = {}
    for curve in curves:
        net, anchor = _bezier_pieces(curve, about)
        by_form.setdefault(net.shape[1:], []).append((net, anchor))
    for pieces in by_form.values():
        for start in range(0, len(pieces), CURVES_PER_BLOCK):
            nets, anchors = zip(*pieces[start : start + CURVES_PER_BLOCK])
            yield np.concatenate(nets), np.concatenate(anchors)


def _bezier_pieces(curve: Curve, about: NDArray) -> tuple[Array, Array]:
    """Return control points (c, order, 3 or 4) of Bézier pieces from anchors (c, 3), and the
    anchors, from `about`.
    """
    space = curve.space
    origin = curve.points[0]
    net = homogeneous(curve.points - origin, curve.weights)
    net = np.einsum("sij,sjd->sid", space.bezier_extraction, net[space.active_controls])
    return _about_first_control(net, np.tile(origin - about, (len(net), 1)))


def _about_first_control(net: NDArray, anchor: NDArray) -> tuple[Array, Array]:
    """Return the control points and anchors of Bézier curves, anchored anew at their first control
    points.
    """
    rational = net.shape[2] == 4
    first = net[:, :1, :3] / net[:, :1, 3:] if rational else net[:, :1]
    points = net[..., :3] - (first * net[..., 3:] if rational else first)
    return np.concatenate([points, net[..., 3:]], axis=2), anchor + first[:, 0]


def _doubtful_lengths(net: NDArray, kinks: bool, largest: float) -> Array:
    """Return (c,) bounds of the length that rules may miss: if pieces may turn back, or have very
    unequal weights.
    """
    edges = np.diff(net[..., :3] / net[..., 3:] if net.shape[2] == 4 else net, axis=1)
    length = np.sqrt((edges**2).sum(axis=2)).sum(axis=1)
    doubtful = np.zeros(len(net))
    # A piece can turn back only if an edge of its control polygon points against the sum of all.
    if kinks:
        doubtful += length * ~(np.einsum("ckd,cd->ck", edges, edges.sum(axis=1)).min(axis=1) >= 0.0)
    if net.shape[2] == 4:
        weights = net[..., 3]
        doubtful += (
            largest * length * (weights.max(axis=1) > MAX_WEIGHT_RATIO * weights.min(axis=1))
        )
    return doubtful


def _piece_integrals(
    net: NDArray, anchor: NDArray, points: int, density: Callable, order: int
) -> tuple[Array, Array]:
    """Return the (c, K) contributions of pieces of a curve by a Gauss rule, and (c,) their
    lengths.
    """
    tables, weights = bernstein(net.shape[1], (points,))
    place, velocity = np.einsum("jnk,ckd->jdcn", tables, net)
    if len(place) == 4:
        bottom = place[3]
        velocity = (velocity[:3] - place[:3] / bottom * velocity[3]) / bottom
        place = place[:3] / bottom
    place = place + anchor.T[:, :, None]
    element = density(place, velocity) * weights[:, 0]
    columns = [
        (element * place[0] ** p * place[1] ** q * place[2] ** r).sum(axis=1)
        for p, q, r in monomials(order).tolist()
    ]
    speed = np.sqrt((velocity**2).sum(axis=0))
    return np.stack(columns, axis=1), (speed * weights[:, 0]).sum(axis=1)
