# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Bézier patches that B-spline patches consist of, many at once, and their values at Gauss
points.

Between its knots a B-spline patch is a Bézier patch; its control points are the B-spline's,
weighted by the blossoms of its basis (`SplineSpace.bezier_extraction`). From there on no knots are
needed: all patches of the same orders are one array, the tables at Gauss points are those of
Bernstein's polynomials, and half a patch is a Bézier patch again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..moments.exponents import monomial_count
from ..numerics import (
    Array,
    Index,
    NDArray,
    SplineSpace,
    clamped_space,
    gauss_legendre,
    gauss_legendre_with_ends,
)
from .splines import Patch, homogeneous

VOLUME_RTOL = 4e-15  # Relative to the largest possible moment: about the unavoidable rounding.
ROUNDING = (
    64.0  # Estimated rounding: units roundoff of the sum of absolute values, per order of a basis.
)
# For s and for t: the point count of one Gauss rule, or the counts of two, whose points are joined.
Rule = tuple[tuple[int, ...], tuple[int, ...]]
Weights = tuple[Array, Array]
# Up to this many cells of a patch keep a common anchor: none is so small that rounding by the
# patch's size matters.
SMALL_CELL_COUNT = 32
POINTS_PER_BLOCK = 12288  # points at a time: their arrays stay in the cache
MAX_CELLS = 8192  # Cells built at a time.
# For each highest derivative, all derivatives: how often by s and by t.
DERIVATIVES = {1: ((0, 0), (1, 0), (0, 1)), 2: ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))}


@dataclass(frozen=True, eq=False)
class BezierCells:
    """Bézier patches of the same orders k and k', polynomial or rational.

    net: (3, k, c, k') control points of c patches, or (4, k, c, k') control points times weights,
    and the weights. anchor: (3, c) or (3, 1) origins of the control points, near them, relative to
    the common reference point. constant_weights: whether the weights are constant along s, and
    along t. reach: bound of the distance of any point from the reference point.
    """

    net: Array
    anchor: Array
    constant_weights: tuple[bool, bool]
    reach: float

    @property
    def orders(self) -> tuple[int, int]:
        """Orders k and k' along s and t."""
        return self.net.shape[1], self.net.shape[3]

    def __len__(self) -> int:
        return self.net.shape[2]

    def __getitem__(self, selection: slice | NDArray) -> BezierCells:
        anchor = self.anchor if self.anchor.shape[1] == 1 else self.anchor[:, selection]
        return replace(self, net=self.net[:, :, selection], anchor=anchor)

    def split(self) -> BezierCells:
        """Split each patch into four."""
        net = self.net.swapaxes(1, 2)
        quarters = [
            np.matmul(np.matmul(s_half, net), t_half.T)
            for s_half in halves(net.shape[2])
            for t_half in halves(net.shape[3])
        ]
        anchor = self.anchor if self.anchor.shape[1] == 1 else np.tile(self.anchor, 4)
        return replace(
            self, net=np.concatenate(quarters, axis=1).swapaxes(1, 2), anchor=anchor
        ).about_anchor()

    def about_anchor(self) -> BezierCells:
        """Return the cells anchored at their first control points, so that coordinates are as small
        as the cell.
        """
        net = np.empty_like(self.net)
        first = self.net[:3, 0, :, 0]
        if len(net) == 4:
            net[3] = self.net[3]
            first = first / net[3, 0, :, 0]
            np.subtract(self.net[:3], first[:, None, :, None] * net[3], out=net[:3])
        else:
            np.subtract(self.net, first[:, None, :, None], out=net)
        return replace(self, net=net, anchor=self.anchor + first)

    def evaluate(
        self, rule: Rule, most: int = 1, ends: bool = False
    ) -> tuple[list[Array], Weights]:
        """Evaluate the patches and their derivatives at the points of Gauss rules; return them and
        the points' weights.

        most: the highest derivative, 1 or 2. ends: add the sides, with weight zero. Returns S, S_s,
        S_t and if most = 2 S_ss, S_st, S_tt, each (3, m, c, n), and the weights (m, 1 or 2) and (n,
        1 or 2), a column for each rule.
        """
        d, k, c, kk = self.net.shape
        s_basis, s_weights = bernstein(k, rule[0], most, ends)
        t_basis, t_weights = bernstein(kk, rule[1], most, ends)
        m, n = s_basis.shape[1], t_basis.shape[1]
        # half[j]: the j-th derivatives by t at the n points along t, for k control points along s.
        half = np.matmul(self.net.reshape(-1, kk), t_basis.swapaxes(1, 2)).reshape(-1, d, k, c * n)
        s_basis = s_basis.reshape(-1, k)
        # blocks[j][:, i]: its i-th derivative by s, with i + j ≤ most.
        blocks = [
            np.matmul(s_basis[: (most + 1 - j) * m], half[j]).reshape(d, -1, m, c, n)
            for j in range(most + 1)
        ]
        derivatives = [blocks[j][:, i] for i, j in DERIVATIVES[most]]
        if d == 4:
            derivatives = quotient_derivatives(derivatives)
        derivatives[0] += self.anchor[:, None, :, None]
        return derivatives, (s_weights, t_weights)


def cells_of(patches: Sequence[Patch], about: NDArray) -> Iterator[BezierCells]:
    """Yield blocks of the Bézier cells of patches, grouped by orders and kind of weights, relative
    to a point (3,).
    """
    groups: dict[tuple, list[Patch]] = {}
    for patch in patches:
        groups.setdefault((patch.spaces, patch.weights is None, patch.constant_weights), []).append(
            patch
        )
    waiting: dict[tuple, list[BezierCells]] = {}
    for (spaces, exact, steady), group in groups.items():
        waiting_cells = waiting.setdefault((spaces[0].order, spaces[1].order, exact, steady), [])
        for cells in _cells_of_group(spaces, group, about):
            waiting_cells.append(cells)
            if sum(map(len, waiting_cells)) >= MAX_CELLS:
                yield _join(waiting_cells)
                waiting_cells.clear()
    yield from map(_join, filter(None, waiting.values()))


def _cells_of_group(
    spaces: tuple[SplineSpace, SplineSpace], group: Sequence[Patch], about: NDArray
) -> Iterator[BezierCells]:
    """Yield blocks of the Bézier cells of patches in the same function spaces, relative to a point
    (3,).
    """
    u, v = len(spaces[0].spans), len(spaces[1].spans)
    patches_per_step = max(1, MAX_CELLS // (u * v))
    spans_per_step = max(1, MAX_CELLS // v)
    for first in range(0, len(group), patches_per_step):
        some = group[first : first + patches_per_step]
        nets = np.array([patch.points for patch in some])
        anchor = nets[:, 0, 0].copy()
        # The anchor is subtracted before `about`: far from this, the small differences of a patch's
        # points would be rounded.
        nets -= anchor[:, None, None]
        anchor -= about
        control_points = nets + anchor[:, None, None]
        reach = math.sqrt(
            np.maximum.reduce(
                np.einsum("gijd,gijd->gij", control_points, control_points), axis=None
            )
        )
        if some[0].weights is not None:
            nets = homogeneous(nets, np.array([patch.weights for patch in some]))
        for start in range(0, u, spans_per_step):
            spans = slice(start, min(start + spans_per_step, u)), slice(0, v)
            yield cells_of_nets(nets, anchor, spaces, spans, some[0].constant_weights, reach)


def cells_of_nets(
    nets: NDArray,
    anchor: NDArray,
    spaces: tuple[SplineSpace, SplineSpace],
    spans: tuple[slice | Index, slice | Index],
    constant_weights: tuple[bool, bool],
    reach: float,
) -> BezierCells:
    """Return the Bézier cells of control nets (g, count_s, count_t, 3 or 4) over knot spans.

    anchor: (g, 3) origins of the nets. spans: u and v indices along s and t. constant_weights,
    reach: as in BezierCells.
    """
    # k, kk: orders; d: coordinates of a control point.
    s = spaces[0].bezier_extraction[spans[0]]
    active_rows = spaces[0].active_controls[spans[0]]
    t = spaces[1].bezier_extraction[spans[1]]
    columns = spaces[1].active_controls[spans[1]]
    (u, k) = active_rows.shape
    (v, kk) = columns.shape
    (g, _, count, d) = nets.shape
    half = np.matmul(s, nets.swapaxes(0, 1).take(active_rows, axis=0).reshape(u, k, -1)).reshape(
        u, k, g, count, d
    )
    whole = np.matmul(t, half.transpose(3, 4, 1, 2, 0).take(columns, axis=0).reshape(v, kk, -1))
    net = whole.reshape(v, kk, d, k, g, u).transpose(2, 3, 4, 5, 0, 1).reshape(d, k, g * u * v, kk)
    cells = BezierCells(
        net, anchor.T if g == 1 else np.repeat(anchor.T, u * v, axis=1), constant_weights, reach
    )
    return cells.about_anchor() if u * v > SMALL_CELL_COUNT else cells


def _join(parts: Sequence[BezierCells]) -> BezierCells:
    if len(parts) == 1:
        return parts[0]
    homes = [np.broadcast_to(part.anchor, (3, len(part))) for part in parts]
    return BezierCells(
        np.concatenate([part.net for part in parts], axis=2),
        np.concatenate(homes, axis=1),
        parts[0].constant_weights,
        max(part.reach for part in parts),
    )


@lru_cache(maxsize=128)
def bernstein(
    order: int, rule: tuple[int, ...], most: int = 1, ends: bool = False
) -> tuple[Array, Array]:
    """Return the derivatives (most + 1, n, order) of Bernstein polynomials at Gauss points, and
    weights (n, rules).
    """
    parts = [
        gauss_legendre_with_ends(points) if ends else gauss_legendre(points) for points in rule
    ]
    nodes = np.concatenate([nodes for nodes, _ in parts])
    weights = np.zeros((len(nodes), len(parts)))
    start = 0
    for k, (_, part_weights) in enumerate(parts):
        weights[start : start + len(part_weights), k] = part_weights
        start += len(part_weights)
    space = clamped_space(order)
    return np.array(space.derivatives(space.spans, nodes, most)), weights


@lru_cache
def halves(order: int) -> tuple[Array, Array]:
    """Return the two matrices from the control points of a Bézier curve to those of its halves (de
    Casteljau).
    """
    first = np.eye(order)
    for row in range(1, order):
        first[row, 0] = first[row - 1, 0] / 2.0
        first[row, 1:] = (first[row - 1, 1:] + first[row - 1, :-1]) / 2.0
    return first, first[::-1, ::-1].copy()


def quotient_derivatives(derivatives: list[NDArray]) -> list[Array]:
    """Return derivatives of a quotient, from those of numerator (rows 0 to 2) and denominator (row
    3), which are overwritten.
    """
    # Of q = p / w: q_s = (p_s - q w_s) / w, and q_st = (p_st - q_s w_t - q_t w_s - q w_st) / w.
    # The pairs below are the rows of the first derivatives in q_ss, q_st and q_tt, from row 3 on.
    inverse = 1.0 / derivatives[0][3]
    result = [row[:3] for row in derivatives]
    bottom = [row[3] for row in derivatives]
    result[0] *= inverse
    for row, (i, j) in zip(range(1, len(derivatives)), ((0, 0), (0, 0), (1, 1), (1, 2), (2, 2))):
        if row > 2:
            result[row] -= result[i] * bottom[j]
            result[row] -= result[j] * bottom[i]
        result[row] -= result[0] * bottom[row]
        result[row] *= inverse
    return result


Integrand = Callable[[BezierCells, Rule], NDArray]


def integrand_in_blocks(cells: BezierCells, rule: Rule, integrand: Integrand) -> Array:
    """Return (rules, K, c) values of an integrand for cells, evaluated in blocks."""
    step = max(1, POINTS_PER_BLOCK // (sum(rule[0]) * sum(rule[1])))
    if len(cells) <= step:
        return integrand(cells, rule)
    return np.concatenate(
        [integrand(cells[start : start + step], rule) for start in range(0, len(cells), step)],
        axis=2,
    )


def weighted_monomials(place: NDArray, density: NDArray, order: int, more: int = 0) -> Array:
    """Return (K + more, ...) the density times the monomials of points (3, ...), then rows of zeros
    to be filled.
    """
    terms = np.empty((monomial_count(order) + more, *density.shape))
    terms[monomial_count(order) :] = 0.0
    terms[0] = density
    if order:
        np.multiply(place, density, out=terms[1:4])
    # Monomials by degree; those of the next one are x times all of this one, y times the ones
    # without x, the last degree + 1, and z times the very last.
    start = 1
    for degree in range(1, order):
        end = monomial_count(degree)
        onward = 2 * end - start
        np.multiply(place[0], terms[start:end], out=terms[end:onward])
        np.multiply(
            place[1], terms[end - degree - 1 : end], out=terms[onward : onward + degree + 1]
        )
        np.multiply(place[2], terms[end - 1], out=terms[onward + degree + 1])
        start = end
    return terms


def sum_over_points(terms: NDArray, weights: Weights) -> Array:
    """Return (rules, K, c) sums of terms (K, m, c, n) over points, with weights (m, 1 or rules) and
    (n, 1 or rules).
    """
    count, m, c, n = terms.shape
    s_weights, t_weights = weights
    half = (terms.reshape(-1, n) @ t_weights).reshape(count, m, -1)
    # Two rules are joined along s or along t; the other direction has a single column of weights.
    sums = np.matmul(s_weights.T, half).reshape(count, s_weights.shape[1], c, -1)
    return sums.transpose(1, 3, 0, 2).reshape(-1, count, c)


def undersampled_areas(cells: BezierCells, steep: float) -> Array:
    """Return (c,) estimates of the areas that a rule may miss: squared diagonals of cells whose
    weights differ by a factor above `steep`, else 0.
    """
    lost = np.zeros(len(cells))
    if len(cells.net) == 4:
        weights = cells.net[3]
        steep_cells = np.flatnonzero(weights.max(axis=(0, 2)) > steep * weights.min(axis=(0, 2)))
        if len(steep_cells):
            points = cells.net[:3, :, steep_cells] / cells.net[3:, :, steep_cells]
            lost[steep_cells] = (np.ptp(points, axis=(1, 3)) ** 2).sum(axis=0)
    return lost
