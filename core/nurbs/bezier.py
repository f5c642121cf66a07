# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Bézier patches that B-spline patches consist of, many at once, and their values at Gauss points.

Between its knots a B-spline patch is a Bézier patch, whose control points are those of the B-spline weighed by the
blossoms of its basis (`Space.blossoms`). From there on no knots are needed: all patches of the same orders are one
array, the tables at Gauss points are those of Bernstein's polynomials, and halving a patch is a Bézier patch again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..numerics.bspline import Space, clamped
from ..numerics.quadrature import gauss, gauss_and_ends
from .patch import Patch

Rule = tuple[tuple[int, ...], tuple[int, ...]]  # along s and t the points of a Gauss rule, or of two side by side
Weights = tuple[NDArray[np.float64], NDArray[np.float64]]
FEW = 32  # cells of a patch: none of them is so small that rounding by the size of the patch would matter to it
MOST_CELLS = 8192  # made at a time
DERIVATIVES = (((0, 0),), ((0, 0), (1, 0), (0, 1)), ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))


@dataclass(frozen=True, eq=False)
class Cells:
    """Bézier patches of the same orders k and k', polynomial or rational.

    net: (3, k, c, k') their control points, or (4, k, c, k') those times their weights, and the weights. home: (3, c)
    or (3, 1) what the control points are about, near them, itself about the point that everything is taken about.
    steady: whether the weights are the same along s, and along t. reach: how far any point can be from that point.
    """

    net: NDArray[np.float64]
    home: NDArray[np.float64]
    steady: tuple[bool, bool]
    reach: float

    @property
    def orders(self) -> tuple[int, int]:
        """k and k'."""
        return self.net.shape[1], self.net.shape[3]

    def __len__(self) -> int:
        return self.net.shape[2]

    def __getitem__(self, rows: slice | NDArray) -> Cells:
        home = self.home if self.home.shape[1] == 1 else self.home[:, rows]
        return Cells(self.net[:, :, rows], home, self.steady, self.reach)

    def split(self) -> Cells:
        """Each as four."""
        rows = self.net.swapaxes(1, 2)
        quarters = [
            np.matmul(np.matmul(one, rows), other.T) for one in halves(rows.shape[2]) for other in halves(rows.shape[3])
        ]
        home = self.home if self.home.shape[1] == 1 else np.tile(self.home, 4)
        return Cells(np.concatenate(quarters, axis=1).swapaxes(1, 2), home, self.steady, self.reach).at_home()

    def at_home(self) -> Cells:
        """The same about their own first control points: what is added up is as small as the cell then, and so is its
        rounding."""
        net, first = np.empty_like(self.net), self.net[:3, 0, :, 0]
        if len(net) == 4:
            net[3] = self.net[3]
            first = first / net[3, 0, :, 0]
            np.subtract(self.net[:3], first[:, None, :, None] * net[3], out=net[:3])
        else:
            np.subtract(self.net, first[:, None, :, None], out=net)
        return Cells(net, self.home + first, self.steady, self.reach)

    def at(self, rule: Rule, most: int = 1, ends: bool = False) -> tuple[list[NDArray[np.float64]], Weights]:
        """The patches and their derivatives at the points of Gauss rules, and the weights of those points.

        most: the highest derivative, 1 or 2. ends: the sides too, without weight.
        Returns S, S_s, S_t and with most = 2 S_ss, S_st, S_tt, each (3, m, c, n), and the weights (m, 1 or 2) and
        (n, 1 or 2), for each rule a column.
        """
        d, k, c, kk = self.net.shape
        one, s_weights = bernstein(k, rule[0], most, ends)
        other, t_weights = bernstein(kk, rule[1], most, ends)
        m, n = one.shape[1], other.shape[1]
        half = np.matmul(self.net.reshape(-1, kk), other.swapaxes(1, 2)).reshape(-1, d, k, c * n)
        one = one.reshape(-1, k)
        blocks = [np.matmul(one[: (most + 1 - j) * m], half[j]).reshape(d, -1, m, c, n) for j in range(most + 1)]
        found = [blocks[j][:, i] for i, j in DERIVATIVES[most]]
        if d == 4:
            found = _divided(found)
        found[0] += self.home[:, None, :, None]
        return found, (s_weights, t_weights)


def cells_of(patches: Sequence[Patch], about: NDArray) -> Iterator[Cells]:
    """The Bézier patches of some patches, those of the same orders together, some at a time, about a point (3,)."""
    groups: dict[tuple, list[Patch]] = {}
    for patch in patches:
        groups.setdefault((patch.spaces, patch.weights is None, patch.steady), []).append(patch)
    waiting: dict[tuple, list[Cells]] = {}
    for (spaces, exact, steady), group in groups.items():
        own = waiting.setdefault((spaces[0].order, spaces[1].order, exact, steady), [])
        for cells in _cells_of_group(spaces, group, about):
            own.append(cells)
            if sum(map(len, own)) >= MOST_CELLS:
                yield _joined(own)
                own.clear()
    yield from map(_joined, filter(None, waiting.values()))


def _cells_of_group(spaces: tuple[Space, Space], group: Sequence[Patch], about: NDArray) -> Iterator[Cells]:
    """Those of patches in the same function spaces."""
    u, v = len(spaces[0].spans), len(spaces[1].spans)
    step, rows = max(1, MOST_CELLS // (u * v)), max(1, MOST_CELLS // v)
    for first in range(0, len(group), step):
        some = group[first : first + step]
        nets = np.array([patch.points for patch in some])
        home = nets[:, 0, 0].copy()
        nets -= home[:, None, None]  # not after `about`, far from which they would be rounded
        home -= about
        places = nets + home[:, None, None]
        reach = math.sqrt(np.maximum.reduce(np.einsum("gijd,gijd->gij", places, places), axis=None))
        if some[0].weights is not None:
            nets = homogeneous(nets, np.array([patch.weights for patch in some]))
        for start in range(0, u, rows):
            spans = slice(start, min(start + rows, u)), slice(0, v)
            yield cells_of_nets(nets, home, spaces, spans, some[0].steady, reach)


def homogeneous(points: NDArray, weights: NDArray) -> NDArray[np.float64]:
    """(..., 4) points times their weights, and the weights."""
    net = np.empty((*weights.shape, 4))
    net[..., 3] = weights
    np.multiply(points, weights[..., None], out=net[..., :3])
    return net


def cells_of_nets(
    nets: NDArray,
    home: NDArray,
    spaces: tuple[Space, Space],
    spans: tuple[slice, slice],
    steady: tuple[bool, bool],
    reach: float,
) -> Cells:
    """The Bézier patches of g control nets (g, count_s, count_t, 3 or 4) about points near them, home (g, 3): those of
    some spans of s and t, in the order of nets, spans of s, spans of t."""
    s, rows = spaces[0].blossoms[spans[0]], spaces[0].acting[spans[0]]
    t, columns = spaces[1].blossoms[spans[1]], spaces[1].acting[spans[1]]
    (u, k), (v, kk), (g, _, count, d) = rows.shape, columns.shape, nets.shape
    half = np.matmul(s, nets.swapaxes(0, 1).take(rows, axis=0).reshape(u, k, -1)).reshape(u, k, g, count, d)
    whole = np.matmul(t, half.transpose(3, 4, 1, 2, 0).take(columns, axis=0).reshape(v, kk, -1))
    net = whole.reshape(v, kk, d, k, g, u).transpose(2, 3, 4, 5, 0, 1).reshape(d, k, g * u * v, kk)
    cells = Cells(net, home.T if g == 1 else np.repeat(home.T, u * v, axis=1), steady, reach)
    return cells.at_home() if u * v > FEW else cells


def _joined(parts: Sequence[Cells]) -> Cells:
    if len(parts) == 1:
        return parts[0]
    homes = [np.broadcast_to(part.home, (3, len(part))) for part in parts]
    return Cells(
        np.concatenate([part.net for part in parts], axis=2),
        np.concatenate(homes, axis=1),
        parts[0].steady,
        max(part.reach for part in parts),
    )


@lru_cache(maxsize=128)
def bernstein(
    order: int, rule: tuple[int, ...], most: int = 1, ends: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Bernstein's polynomials and their derivatives (most + 1, n, order) at the points of one Gauss rule or of several
    side by side, and the weights (n, rules); not to be written to."""
    parts = [gauss_and_ends(points) if ends else gauss(points) for points in rule]
    nodes = np.concatenate([nodes for nodes, _ in parts])
    weights, start = np.zeros((len(nodes), len(parts))), 0
    for k, (_, own) in enumerate(parts):
        weights[start : start + len(own), k] = own
        start += len(own)
    space = clamped(order)
    return np.array(space.derivatives(space.spans, nodes, most)), weights


@lru_cache
def halves(order: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What takes the control points of a Bézier curve to those of its halves: de Casteljau's scheme."""
    first = np.eye(order)
    for row in range(1, order):
        first[row, 0] = first[row - 1, 0] / 2.0
        first[row, 1:] = (first[row - 1, 1:] + first[row - 1, :-1]) / 2.0
    return first, first[::-1, ::-1].copy()


def _divided(found: list[NDArray]) -> list[NDArray[np.float64]]:
    """The derivatives of the quotient from those of the numerator and, in the last row, the denominator; in place."""
    inverse = 1.0 / found[0][3]
    result, bottom = [row[:3] for row in found], [row[3] for row in found]
    result[0] *= inverse
    for row, (i, j) in zip(range(1, len(found)), ((0, 0), (0, 0), (1, 1), (1, 2), (2, 2))):
        if row > 2:
            result[row] -= result[i] * bottom[j]
            result[row] -= result[j] * bottom[i]
        result[row] -= result[0] * bottom[row]
        result[row] *= inverse
    return result
