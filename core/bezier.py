# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Bézier patches that B-spline patches consist of, many at once, and their values at Gauss points.

Between its knots a B-spline patch is a Bézier patch, whose control points are those of the B-spline weighed by the
blossoms of its basis (`Space.blossoms`). From there on no knots are needed: all patches of the same orders are one
array, the tables at Gauss points are those of Bernstein's polynomials, and halving a patch is a Bézier patch again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .bspline import Space, clamped
from .patch import Patch
from .quadrature import gauss, gauss_and_ends

Rule = tuple[int, int]  # Gauss points along s and t
Weights = tuple[NDArray[np.float64], NDArray[np.float64]]
FEW = 32  # cells: of so many none is so small that rounding by the size of them all would matter to it
DERIVATIVES = (((0, 0),), ((0, 0), (1, 0), (0, 1)), ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))


@dataclass(frozen=True, eq=False)
class Cells:
    """Bézier patches of the same orders k and k', polynomial or rational.

    net: (3, k, c, k') their control points, or (4, k, c, k') those times their weights, and the weights. home: (3, c)
    what the control points are about, itself about the point that everything is taken about; None if it is that one.
    steady: whether the weights are the same along s, and along t.
    """

    net: NDArray[np.float64]
    home: NDArray[np.float64] | None
    steady: tuple[bool, bool]

    def __len__(self) -> int:
        return self.net.shape[2]

    def __getitem__(self, rows) -> Cells:
        return Cells(self.net[:, :, rows], None if self.home is None else self.home[:, rows], self.steady)

    def split(self) -> Cells:
        """Each as four."""
        rows = self.net.swapaxes(1, 2)
        quarters = [np.matmul(np.matmul(one, rows), other.T)
                    for one in _halves(rows.shape[2]) for other in _halves(rows.shape[3])]
        home = None if self.home is None else np.tile(self.home, 4)
        return Cells(np.concatenate(quarters, axis=1).swapaxes(1, 2), home, self.steady).at_home()

    def at_home(self) -> Cells:
        """The same about their first control points: what is added up is as small as the cell then, and so is its
        rounding."""
        home = self.net[:3, 0, :, 0]
        move = home[:, None, :, None]
        if len(self.net) == 4:
            home = home / self.net[3, 0, :, 0]
            move = home[:, None, :, None] * self.net[3]
        net = self.net.copy()
        net[:3] -= move
        return Cells(net, home.copy() if self.home is None else self.home + home, self.steady)

    def at(self, rules: Sequence[Rule], most: int = 1, ends: bool = False
           ) -> tuple[list[NDArray[np.float64]], Weights]:
        """The patches and their derivatives at the points of Gauss rules, and the weights of those points.

        most: the highest derivative, 1 or 2. ends: the sides too, without weight.
        Returns S, S_s, S_t and with most = 2 S_ss, S_st, S_tt, each (3, m, c, n), and the weights of each of r rules
        (m, r) and (n, r), those of points of the others being zero.
        """
        d, k, c, kk = self.net.shape
        s_rule, t_rule = zip(*rules)
        one, s_weights = bernstein(k, s_rule, most, ends)
        other, t_weights = bernstein(kk, t_rule, most, ends)
        m, n = one.shape[1], other.shape[1]
        half = np.matmul(self.net.reshape(-1, kk), other.swapaxes(1, 2)).reshape(-1, d, k, c * n)
        one = one.reshape(-1, k)
        blocks = [np.matmul(one[:(most + 1 - j) * m], half[j]).reshape(d, -1, m, c, n) for j in range(most + 1)]
        found = [blocks[j][:, i] for i, j in DERIVATIVES[most]]
        if d == 4:
            found = _divided(found)
        if self.home is not None:
            found[0] += self.home[:, None, :, None]
        return found, (s_weights, t_weights)


def cells_of(patches: Sequence[Patch], about: NDArray) -> list[Cells]:
    """The Bézier patches of some patches, those of the same orders together, about a point (3,)."""
    groups: dict[tuple, list[Patch]] = {}
    for patch in patches:
        groups.setdefault((patch.spaces, patch.weights is None), []).append(patch)
    found: dict[tuple, list[Cells]] = {}
    for (spaces, exact), group in groups.items():
        net = np.array([patch.points for patch in group]) - about
        steady = (True, True)
        if not exact:
            weights = np.array([patch.weights for patch in group])
            steady = bool((weights == weights[:, :1]).all()), bool((weights == weights[:, :, :1]).all())
            net = homogeneous(net, weights)
        orders = spaces[0].order, spaces[1].order
        found.setdefault((orders, exact, steady), []).append(cells_of_nets(net, spaces, steady))
    return [_joined(group) for group in found.values()]


def homogeneous(points: NDArray, weights: NDArray) -> NDArray[np.float64]:
    """(..., 4) points times their weights, and the weights."""
    net = np.empty((*weights.shape, 4))
    net[..., 3] = weights
    np.multiply(points, weights[..., None], out=net[..., :3])
    return net


def cells_of_nets(nets: NDArray, spaces: tuple[Space, Space], steady: tuple[bool, bool],
                  spans: tuple[slice, slice] = (slice(None), slice(None))) -> Cells:
    """The Bézier patches of g control nets (g, count_s, count_t, d), those of some spans of s and t only, in the order
    of nets, spans of s, spans of t."""
    (s, rows), (t, columns) = ((space.blossoms[own], space.acting[own]) for space, own in zip(spaces, spans))
    u, k = rows.shape
    v, kk = columns.shape
    g, _, count, d = nets.shape
    half = np.matmul(s, nets.swapaxes(0, 1).take(rows, axis=0).reshape(u, k, -1)).reshape(u, k, g, count, d)
    whole = np.matmul(t, half.transpose(3, 4, 1, 2, 0).take(columns, axis=0).reshape(v, kk, -1))
    net = whole.reshape(v, kk, d, k, g, u).transpose(2, 3, 4, 5, 0, 1).reshape(d, k, g * u * v, kk)
    return Cells(net, None, steady)


def _joined(parts: Sequence[Cells]) -> Cells:
    found = parts[0] if len(parts) == 1 else Cells(
        np.concatenate([part.net for part in parts], axis=2), None, parts[0].steady)
    return found.at_home() if len(found) > FEW else found


@lru_cache(maxsize=128)
def bernstein(order: int, rule: tuple[int, ...], most: int = 1, ends: bool = False
              ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Bernstein's polynomials and their derivatives (most + 1, n, order) at the points of one Gauss rule or several, and
    the weights of each rule (n, r); not to be written to. Rules that are the same share their points."""
    own = {points: gauss_and_ends(points) if ends else gauss(points) for points in rule}
    nodes = np.concatenate([nodes for nodes, _ in own.values()])
    starts = dict(zip(own, np.cumsum([0] + [len(nodes) for nodes, _ in own.values()]).tolist()))
    weights = np.zeros((len(nodes), len(rule)))
    for k, points in enumerate(rule):
        weights[starts[points]:starts[points] + len(own[points][1]), k] = own[points][1]
    space = clamped(order)
    return np.array(space.derivatives(space.spans, nodes, most)), weights


@lru_cache
def _halves(order: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
