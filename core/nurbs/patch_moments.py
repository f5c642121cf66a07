# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of bodies bounded by B-spline patches, of the patches themselves, and of sheets upon
them.

Soldea, Elber and Rivlin, sections 2 and 3, with the radial flux in place of their z-flux, so that
no axis is special:

    ∫ x^p y^q z^r dV = 1 / (p+q+r+3) · ∫∫ x^p y^q z^r S · (S_s x S_t) ds dt.

For a polynomial patch of degree d the integrand has degree (n + 3) d - 2 in each parameter for
moments of order n (the top coefficient of S · (S_s x S_t) cancels), so a Gauss rule of ceil(((n +
3) d - 1) / 2) points in every span is exact. A rational integrand, an area's square root and the
jacobian of a sheet have no finite degree: there the rules grow by halves until two of them agree,
and if the finest rule does not suffice, cells are cut in four. The sum of the remaining differences
is reported as an estimate: it is the coarser rule's error, while the result is the finer one's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from math import ceil

import numpy as np

from ..moments.raw import Measure, Moments, U, monomials, sum_moments
from ..numerics import (
    Array,
    NDArray,
    SplineSpace,
    cross,
    dot,
    gauss_legendre,
    gauss_legendre_with_ends,
)
from ..verdict import MeasureError
from .bezier import (
    ROUNDING,
    VOLUME_RTOL,
    BezierCells,
    Integrand,
    Rule,
    Weights,
    cells_of,
    integrand_in_blocks,
    sum_over_points,
    undersampled_areas,
    weighted_monomials,
)
from .findings import WALL_THICKER_THAN_CURVATURE
from .flat_face import split_faces
from .splines import Face, Patch, patches_center, patches_size

AREA_RTOL = 1e-11
# Factor on the difference of two rules that do not agree yet when all points are spent.
UNCONVERGED_FACTOR = 8.0
# Largest by smallest weight of a cell: beyond these, rules may differ by less than their error, or
# miss the same part.
MAX_WEIGHT_RATIOS = 1e2, 1e6
# Factor on the difference of two rules: if a patch folds back, its area has kinks, and both rules
# may err alike.
FOLD_FACTOR = 8.0
MIN_REVERSED_NORMAL = (
    1e-9  # a normal that points against its neighbor by less than this is rounding
)
RULES = (16, 24, 36)  # points along each direction; each rule is compared with the one before
COARSE_RULES = (8, 12, 18)  # Used for tolerances from `AREA_RTOL` upward.
MAX_DEPTH = 14  # Limit of successive cuts of a cell.
MAX_POINTS = 6_000_000  # Limit of evaluated points.
# Gauss points in a span, and spans at a time, for the area's gradient
SLOPE_POINTS = 6
SLOPE_SPANS = 8


@dataclass(frozen=True, eq=False)
class Integral:
    """An integral over cells: (K,) values, their truncation estimate divided by `unit`, and the
    cells' total size.
    """

    values: Array
    estimate: float
    size: float
    converged: bool


def volume_moments(
    faces: Sequence[Face],
    order: int = 3,
    about: NDArray | None = None,
) -> tuple[Moments, bool]:
    """Return the volume moments of the body in outward patches, and whether they converged; about:
    a point (3,), by default the middle of the control points' box.
    """
    about = patches_center(faces) if about is None else np.asarray(about, np.float64)
    patches, flat = split_faces(faces)
    degree = _degrees(order)
    flux = partial(flux_sums, order=order)
    values = np.zeros(len(degree))
    estimate = 0.0
    size = 0.0
    converged = True
    reach = 0.0
    orders = 0
    rational = []
    for part in cells_of(patches, about):
        reach = max(reach, part.reach)
        orders = max(orders, sum(part.orders))
        if len(part.net) == 4:
            rational.append(part)
            continue
        rule = (exact_points(part.orders[0], order),), (exact_points(part.orders[1], order),)
        sums = np.add.reduce(integrand_in_blocks(part, rule, flux)[0], axis=1)
        values += sums[:-1]
        size += float(sums[-1])
    unit = reach ** (degree + 1.0)
    if rational:
        integral = integrate_adaptively(rational, flux, unit, VOLUME_RTOL, order)
        values = values + integral.values
        estimate = integral.estimate
        converged = integral.converged
        size += integral.size
    error = (estimate + (ROUNDING * U * size) * (orders + degree)) * unit / (degree + 3.0)
    curved = Moments(values / (degree + 3.0), about, Measure.VOLUME, error)
    return sum_moments([curved, *(face.volume_moments(order, about) for face in flat)]), converged


def flux_sums(cells: BezierCells, rule: Rule, order: int, area: bool = False) -> Array:
    """Return (rules, K + 1, c) sums of `flux_terms`."""
    derivatives, weights = cells.evaluate(rule)
    return sum_over_points(flux_terms(derivatives, order, area), weights)


def flux_terms(derivatives: Sequence[NDArray], order: int, area: bool = False) -> Array:
    """Return (K + 1, ...) fluxes of monomials times position at points with their slopes, (3, ...)
    each; the last row: area or its bound |S_s| |S_t|.
    """
    s, along, across = derivatives
    normal = cross(along, across)
    terms = weighted_monomials(s, dot(s, normal), order, 1)
    np.sqrt(dot(normal, normal) if area else dot(along, along) * dot(across, across), out=terms[-1])
    return terms


def area_terms(derivatives: Sequence[NDArray], order: int) -> Array:
    """Return (K + 1, ...) monomials times the element of area, whose last row is the element."""
    s, along, across = derivatives
    terms = weighted_monomials(s, _length(np.stack(cross(along, across))), order, 1)
    terms[-1] = terms[0]
    return terms


def area_moments(
    faces: Sequence[Face], order: int = 0, about: NDArray | None = None
) -> tuple[Moments, bool]:
    """Return the area moments of faces, and whether they converged; about: as for `volume_moments`.

    Flat faces have closed forms; patches are integrated by quadrature.

    If a patch turns over between two neighboring points, or a cell's side and the next point, the
    area between them counts as error, so that such a cell is cut.
    """
    about = patches_center(faces) if about is None else np.asarray(about, np.float64)
    patches, flat = split_faces(faces)
    of_flat = [face.area_moments(order, about) for face in flat]
    if not patches:
        return sum_moments(of_flat), True
    parts = list(cells_of(patches, about))
    unit = max(part.reach for part in parts) ** _degrees(order)

    def area(cells: BezierCells, rule: Rule) -> NDArray:
        derivatives, weights = cells.evaluate(rule, ends=True)
        lost = _reversed_areas(np.stack(cross(*derivatives[1:])), weights, rule)[None, None]
        return np.concatenate(
            [sum_over_points(area_terms(derivatives, order), weights), lost], axis=1
        )

    integral = integrate_adaptively(parts, area, unit, AREA_RTOL)
    orders = max(sum(part.orders) for part in parts)
    error = (FOLD_FACTOR * integral.estimate + ROUNDING * U * orders * integral.size) * unit
    curved = Moments(integral.values, about, Measure.AREA, error)
    return sum_moments([curved, *of_flat]), integral.converged


def _reversed_areas(normal: NDArray, weights: Weights, rule: Rule) -> Array:
    """Return (c,) areas between neighboring points with opposed normals (3, m, c, n): rules may
    miss such kinks.
    """
    total = np.zeros(normal.shape[2])
    # First between neighbors along s, then, with s and t exchanged, along t.
    for (points,), other_weights in zip(rule, weights[::-1]):
        nodes, _ = gauss_legendre_with_ends(points)
        length = _length(normal)
        # At a pole the normal is rounding.
        over = (
            dot(normal[:, :-1], normal[:, 1:])
            < -MIN_REVERSED_NORMAL * np.maximum(length[:-1], length[1:]) ** 2
        )
        # The trapezoid rule along one direction, then the Gauss weights of the other one.
        size = np.where(over, length[:-1] + length[1:], 0.0) * np.diff(nodes)[:, None, None] / 2.0
        total += size.sum(axis=0) @ other_weights[:, 0]
        normal = normal.swapaxes(1, 3)
    return total


def area_slope(faces: Sequence[Face]) -> float:
    """Estimate, by a fixed rule, the largest change of the area per unit of displacement of all
    control points.
    """
    patches, flat = split_faces(faces)
    total = sum(face.slope for face in flat)
    for patch in patches:
        net = np.moveaxis(patch.points - patch.points[0, 0], -1, 0)
        if patch.weights is not None:
            net = np.concatenate([net * patch.weights, patch.weights[None]])
        gradient = np.zeros((3, *patch.points.shape[:2]))
        for s, s_slope, s_steps, s_controls in _slope_tiles(patch.spaces[0]):
            for t, t_slope, t_steps, t_controls in _slope_tiles(patch.spaces[1]):
                tile_net = np.ascontiguousarray(net[:, s_controls[:, None], t_controls])
                force = _slope_of_tile(
                    (s, s_slope), (t, t_slope), s_steps[:, None] * t_steps, tile_net
                )
                gradient[:, s_controls[:, None], t_controls] += force
        if patch.weights is not None:
            gradient *= patch.weights
        total += float(_length(gradient).sum())
    return total


@lru_cache(maxsize=64)
def _slope_tiles(space: SplineSpace) -> tuple[tuple[NDArray, NDArray, NDArray, NDArray], ...]:
    """Return tiles of a few spans: basis values and slopes (m, k), Gauss weights (m,), active
    control indices (k,).
    """
    nodes, weights = gauss_legendre(SLOPE_POINTS)
    tiles = []
    for start in range(0, len(space.spans), SLOPE_SPANS):
        low, high = space.intervals[start : start + SLOPE_SPANS].T
        size = (high - low)[:, None]
        parameters = (low[:, None] + size * nodes).ravel()
        acting = np.unique(space.controls_of_spans(space.spans[start : start + SLOPE_SPANS]))
        tiles.append(
            (
                space.collocation_matrix(parameters)[:, acting],
                space.collocation_matrix(parameters, 1)[:, acting],
                (size * weights).ravel(),
                acting,
            )
        )
    return tuple(tiles)


def _slope_of_tile(
    along: tuple[NDArray, NDArray], across: tuple[NDArray, NDArray], weights: NDArray, net: NDArray
) -> Array:
    """Return the (3, k, k') gradient of the area by the control points, times their weights if
    rational, of a tile.

    along, across: values and slopes of the basis, (m, k) and (n, k'). weights: (m, n), of the
    points. net: (3 or 4, k, k') homogeneous control points.
    """
    (s, s_slope), (t, t_slope) = along, across
    place, by_s, by_t = (
        np.matmul(np.matmul(s_table, net), np.ascontiguousarray(t_table.T))
        for s_table, t_table in ((s, t), (s_slope, t), (s, t_slope))
    )
    s_bottom = t_bottom = None
    if len(net) == 4:  # rational
        bottom = place[3]
        place = place[:3] / bottom
        s_bottom = by_s[3] / bottom
        t_bottom = by_t[3] / bottom
        by_s = by_s[:3] / bottom - place * s_bottom
        by_t = by_t[:3] / bottom - place * t_bottom
        weights = weights / bottom
    normal = np.stack(cross(by_s, by_t))
    length = _length(normal)
    unit = normal / np.where(length > 0.0, length, 1.0) * weights
    # The change of the area is (dS_s x S_t + S_s x dS_t) · u = dS_s · (S_t x u) + dS_t · (u x S_s).
    s_force = np.stack(cross(by_t, unit))
    t_force = np.stack(cross(unit, by_s))
    parts = [(s_slope, s_force, t), (s, t_force, t_slope)]
    # Of P / w with a moved P: dS_s = (dP_s - dP w_s / w) / w; the weights have the last divisor.
    if s_bottom is not None and t_bottom is not None:
        parts.append((s, -(s_force * s_bottom + t_force * t_bottom), t))
    products = (
        np.matmul(np.matmul(np.ascontiguousarray(s_table.T), force), t_table)
        for s_table, force, t_table in parts
    )
    return sum(products, np.zeros(()))


def sheet_moments(
    faces: Sequence[Face], inner: float, outer: float, order: int = 3, about: NDArray | None = None
) -> tuple[Moments, bool]:
    """Return the volume moments of {S + h n : inner ≤ h ≤ outer}, n the unit normal, and whether
    they converged.

    Across the sheet the integrand has degree order + 2 in h, so a rule of ceil((order + 3) / 2)
    points is exact. MeasureError if the sheet is thicker than its surface's radius of curvature, so
    that it runs through itself.
    """
    about = patches_center(faces) if about is None else np.asarray(about, np.float64)
    nodes, steps = gauss_legendre(ceil((order + 3) / 2))
    heights = inner + (outer - inner) * nodes
    steps = (outer - inner) * steps
    patches, flat = split_faces(faces)
    of_flat = [face.slab_moments(heights, steps, order, about) for face in flat]
    if not patches:
        return sum_moments(of_flat), True
    parts = list(cells_of(patches, about))
    unit = (max(part.reach for part in parts) + max(abs(inner), abs(outer))) ** _degrees(order)

    def sheet(cells: BezierCells, rule: Rule) -> NDArray:
        derivatives, weights = cells.evaluate(rule, 2)
        return sum_over_points(sheet_terms(derivatives, heights, steps, order), weights)

    integral = integrate_adaptively(parts, sheet, unit, AREA_RTOL, thickness=outer - inner)
    orders = max(sum(part.orders) for part in parts)
    error = (integral.estimate + ROUNDING * U * orders * integral.size) * unit
    curved = Moments(integral.values, about, Measure.VOLUME, error)
    return sum_moments([curved, *of_flat]), integral.converged


def sheet_terms(
    derivatives: Sequence[NDArray], heights: NDArray, steps: NDArray, order: int
) -> Array:
    """Return (K + 1, ...) monomials times the element of volume of a sheet, by a rule across it;
    the last row: the same of its middle. MeasureError if the sheet runs through itself.
    """
    s, along, across, *second = derivatives
    normal = np.stack(cross(along, across))
    length = _length(normal)
    divisor = np.where(length > 0.0, length, 1.0)
    unit = normal / divisor
    # The derivatives of the unit normal by s and by t; second: S_ss, S_st, S_tt.
    turning = []
    for k in (0, 1):
        slope = np.stack(cross(second[k], across)) + np.stack(cross(along, second[k + 1]))
        turning.append((slope - dot(slope, unit) * unit) / divisor)
    # (1 - k h) and (1 - k' h), k and k' the curvatures, must both be positive: their product, and
    # their sum too.
    bend = dot(np.stack(cross(along, turning[1])) + np.stack(cross(turning[0], across)), unit)
    middle = heights.mean()
    half = steps.sum() / 2.0
    for height in (middle - half, middle + half):
        product = _offset_jacobian(along, across, turning, unit, height)
        if ((product < 0.0) | (2.0 * length + height * bend < 0.0)).any():
            raise MeasureError(WALL_THICKER_THAN_CURVATURE)
    terms = np.zeros(())
    for height, step in zip(heights, steps):
        element = step * _offset_jacobian(along, across, turning, unit, height)
        terms = terms + weighted_monomials(s + height * unit, element, order, 1)
    terms[-1] = length * abs(steps.sum())
    return terms


def vector_area(patches: Sequence[Patch]) -> Array:
    """Return the (3,) integral of the unit normals: exact along directions of constant weights,
    else estimated.
    """
    total = np.zeros(3)
    for cells in cells_of(patches, np.zeros(3)):
        # S_s x S_t of a polynomial of degree d has degree 2 d - 1: d points are exact.
        s, t = (
            (max(1, order - 1) if same else RULES[0],)
            for order, same in zip(cells.orders, cells.constant_weights)
        )
        (_, along, across), weights = cells.evaluate((s, t))
        total += sum_over_points(np.stack(cross(along, across)), weights)[0].sum(axis=1)
    return total


def with_swept_error(moments: Moments, swept: float, reach: float) -> Moments:
    """Return moments with the input error of a change that sweeps the volume `swept` within `reach`
    of their origin.
    """
    return replace(moments, input_error=swept * reach ** monomials(moments.order).sum(axis=1))


def with_area_error(area: Moments, slope: float, stored: float, reach: float) -> Moments:
    """Return area moments with the input error of moving control points by at most `stored`; slope:
    of `area_slope`.
    """
    if reach == 0.0:
        return area  # The patches are one point, without any digits in their stored coordinates.
    return with_swept_error(area, stored * (slope + area.total / reach), reach)


def stored_area_moments(faces: Sequence[Face], order: int, *, stored: float) -> Moments:
    """Return the area moments of faces, about their box's center, with errors of stored points."""
    area = area_moments(faces, order)[0]
    return with_area_error(area, area_slope(faces), stored, patches_size(faces) + 4.0 * stored)


def exact_points(spline_order: int, order: int) -> int:
    """Return the Gauss points per span that make moments to an order exact, along a polynomial
    direction: ceil(((n + 3) d - 1) / 2) for moments of order n and a spline of degree d.
    """
    n, d = order, spline_order - 1
    return max(1, ceil(((n + 3) * d - 1) / 2))


def integrate_adaptively(
    cells: Sequence[BezierCells],
    integrand: Integrand,
    unit: NDArray,
    tolerance: float,
    order: int | None = None,
    thickness: float = 1.0,
) -> Integral:
    """Integrate over patches, cell by cell, by the first rule that agrees with the one before.

    integrand: returns for each rule (K + 1, c) contributions and sizes of cells, and optionally a
    row of areas that count as error. unit: (K,) factors from a cell's size to bounds of its
    moments. order: of the moments, if `exact_points` are enough along directions of constant
    weights; else None. thickness: the factor from areas to sizes. Rules agree if they differ by at
    most the tolerance, relative to the cell's size or to the mean size of all cells.
    """
    k = len(unit)
    divisor = np.maximum(unit, 1e-300)[:, None]
    is_fine = tolerance < AREA_RTOL
    points = RULES if is_fine else COARSE_RULES
    max_points = MAX_POINTS if is_fine else MAX_POINTS // 2
    values = np.zeros(k)
    estimate = 0.0
    converged = True
    # Estimates of the area that no rule may have seen: in the cells that disagree at the end, and,
    # as boxes of cut cells overlap, at most in all cells before any cut.
    unseen = 0.0
    most_unseen = thickness * sum(
        float(undersampled_areas(part, MAX_WEIGHT_RATIOS[0]).sum()) for part in cells
    )
    cell_count = sum(map(len, cells))
    total_size = 0.0
    spent_points = 0
    depth = 0
    # Cells, their integrals by the coarser rule of the next comparison if known, and its index.
    work: list[tuple[BezierCells, NDArray | None, int]] = [(part, None, 0) for part in cells]
    while work:
        compared = []
        for part, coarse, level in work:
            rules = _rules(part.orders, part.constant_weights, points[level : level + 2], order)
            # A joined rule gives both estimates at once.
            estimates = [
                rule_values
                for rule in (rules if coarse is None else rules[-1:])
                for rule_values in integrand_in_blocks(part, rule, integrand)
            ]
            new_counts = points[level + (coarse is not None) : level + 2]
            spent_points += len(part) * sum(count**2 for count in new_counts)
            compared.append(
                (part, estimates[0] if coarse is None else coarse, estimates[-1], level)
            )
        total_size = total_size or sum(float(np.add.reduce(fine[k])) for _, _, fine, _ in compared)
        is_last = spent_points > max_points or depth >= MAX_DEPTH
        work = []
        for part, coarse, fine, level in compared:
            # The worst of all moments stands for each: one may agree by chance.
            differences = np.maximum.reduce(np.abs(fine[:k] - coarse[:k]) / divisor)
            kinks = fine[k + 1] if len(fine) > k + 1 else 0.0
            steep = thickness * undersampled_areas(part, MAX_WEIGHT_RATIOS[1])
            differences += kinks
            agrees = differences + steep <= tolerance * np.maximum(fine[k], total_size / cell_count)
            if is_last or agrees.all():
                converged &= bool(agrees.all())
                unseen += thickness * float(
                    undersampled_areas(part[~agrees], MAX_WEIGHT_RATIOS[0]).sum()
                )
                values += np.add.reduce(fine[:k], axis=1)
                disagreement = float(np.add.reduce(differences[~agrees]))
                estimate += float(np.add.reduce(differences)) + (
                    (UNCONVERGED_FACTOR - 1.0) * disagreement
                )
                continue
            values += np.add.reduce(fine[:k, agrees], axis=1)
            estimate += float(np.add.reduce(differences[agrees]))
            # More points do not resolve a kink: such cells are cut.
            takes_more_points = ~agrees & (kinks + steep == 0.0) & (level + 2 < len(points))
            is_cut = ~(agrees | takes_more_points)
            if takes_more_points.any():
                work.append((part[takes_more_points], fine[:, takes_more_points], level + 1))
            if is_cut.any():
                work.append((part[is_cut].split(), None, 0))
        depth += any(coarse is None for _, coarse, _ in work)
    return Integral(values, estimate + min(unseen, most_unseen), total_size, converged)


@lru_cache(maxsize=256)
def _rules(
    spline_orders: tuple[int, int],
    constant_weights: tuple[bool, bool],
    points: tuple[int, int],
    order: int | None,
) -> tuple[Rule, ...]:
    """Return two rules to compare, of `points` or fewer if exact; joined into one if equal along s
    or along t.
    """
    coarse, fine = (
        tuple(
            min(count, exact_points(spline_order, order)) if same and order is not None else count
            for spline_order, same in zip(spline_orders, constant_weights)
        )
        for count in points
    )
    if coarse[0] == fine[0]:
        return ((fine[:1], (coarse[1], fine[1])),)
    if coarse[1] == fine[1]:
        return (((coarse[0], fine[0]), fine[1:]),)
    return (coarse[:1], coarse[1:]), (fine[:1], fine[1:])


@lru_cache
def _degrees(order: int) -> Array:
    """Return the (K,) degrees of the monomials."""
    return monomials(order).sum(axis=1).astype(np.float64)


def _length(a: NDArray) -> Array:
    return np.sqrt(dot(a, a))


def _offset_jacobian(
    along: NDArray, across: NDArray, turning: list[NDArray], unit: NDArray, height: float
) -> NDArray:
    """Return the sheet's jacobian |S_s x S_t| (1 - 2 H h + K h²) by the offset surface's
    derivatives.
    """
    return dot(cross(along + height * turning[0], across + height * turning[1]), unit)
