# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the closed shells of one body lie to each other: apart, one in another, or through one another.

Pairs whose boxes overlap are found by a sweep. Each pair is then asked twice (`shell_tree`): points just under the skin
of the smaller shell are located in the larger one; then edges of one that pierce triangles of the other are looked for.
What touches within the tolerance does not cross.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh.boxes import overlapping_boxes
from ..mesh.bvh import Shells, Tree, pierced_pairs, sort_shells
from ..numerics.arrays import ramp

MOST_PAIRS = 100_000  # of shells
MOST_TWICE = 4096  # points under the skin of a shell of few faces that are asked whether it surrounds them twice
SAMPLES = 256, 8, 50_000  # points under the skin for one pair: at most, at least; and for all pairs together


@dataclass(frozen=True, eq=False)
class Relations:
    """inside: (k, 2) pairs (inner shell, outer shell). crossing: (k, 2) pairs of shells that share a part of
    their interiors without one containing the other, or that are the same. unchecked: pairs that would have been too
    much work."""

    inside: NDArray[np.intp]
    crossing: NDArray[np.intp]
    unchecked: int


def relate(points: NDArray[np.floating], shells: Shells, ask: NDArray[np.bool_], tolerance: float) -> Relations:
    """How the shells selected by `ask`, all closed and none of them flat, lie relative to each other.

    tolerance: (length) what counts as touching.
    """
    chosen = np.flatnonzero(ask)
    i, j, skipped = overlapping_boxes(shells.low[chosen], shells.high[chosen], tolerance, MOST_PAIRS)
    none = np.empty((0, 2), np.intp)
    if not len(i):
        return Relations(none, none, skipped)
    i, j = chosen[i], chosen[j]
    size = np.abs(shells.volume)
    swap = (size[i] > size[j]) | ((size[i] == size[j]) & (i < j))
    small, large = np.where(swap, j, i), np.where(swap, i, j)

    wanted = np.zeros(len(size), bool)
    wanted[small] = wanted[large] = True
    tree = Tree(points, shells, wanted)
    within, without, unsure = _locate(points, shells, tree, small, large, tolerance)
    same = within & ~without & (size[large] - size[small] <= 1e-9 * size[large])
    through = (within & without) | same
    open_question = ~through
    pierced, unfinished = pierced_pairs(tree, small[open_question], large[open_question], tolerance)
    through[open_question] = pierced
    unsure = unsure.copy()
    unsure[open_question] |= unfinished & ~pierced
    inside = within & ~through & ~unsure
    pair = np.stack([small, large], axis=1)
    return Relations(pair[inside], pair[through], skipped + int(np.count_nonzero(unsure & ~through)))


def pierced(
    points: NDArray[np.floating],
    triangles: NDArray[np.integer],
    shell: NDArray[np.intp],
    pairs: NDArray[np.integer],
    vertex: NDArray[np.integer],
    tolerance: float,
) -> bool:
    """Whether surfaces go through each other, or through themselves, by more than the tolerance, as far as is found
    within bounds of time. Triangles that share a vertex are neighbours and do not count.

    triangles: (m, 3), shell: (m,) the surface that each belongs to, ascending; pairs: (k, 2) of surfaces; vertex: (n,)
    which vertex a point is.
    """
    shells = sort_shells(points, triangles, shell, int(shell[-1]) + 1)
    tree = Tree(points, shells, np.ones(len(shells.volume), bool))
    return bool(pierced_pairs(tree, pairs[:, 0], pairs[:, 1], tolerance, vertex)[0].any())


def winds_twice(points: NDArray[np.floating], shells: Shells, ask: NDArray[np.bool_], tolerance: float) -> bool:
    """Whether a closed shell selected by `ask` surrounds a point under its own skin more than once, of those that are
    tried. So it does where it has run into itself, though no edge need pierce a face then."""
    chosen = np.flatnonzero(ask)
    if not len(chosen):
        return False
    tree = Tree(points, shells, ask)
    size = (shells.start[1:] - shells.start[:-1])[chosen]
    number = np.clip(SAMPLES[2] // len(chosen), SAMPLES[1], np.maximum(size, MOST_TWICE))
    own = np.repeat(chosen, number)
    place = _under_skin(points, shells, tree, own, ramp(number), np.repeat(number, number), tolerance)
    winding, sure = tree.inside(place, own, tolerance)
    return bool((sure & (np.abs(winding) > 1)).any())


def decide(
    shells: Shells, relations: Relations, ask: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """Which shells to turn, and which are then outward shells in the material of others or cavities; (c,) each.

    From the outermost inward: an inward shell that no material surrounds is inside out. It is turned, and so is what it
    contains where that was consistent with it (a hollow body turned inside out as a whole).
    """
    number = len(ask)
    given = np.where(ask, np.sign(shells.volume), 0.0)
    sign = given.copy()
    inner, outer = relations.inside.T
    depth = np.bincount(inner, minlength=number)
    parent = _parents(relations, number)
    order = np.argsort(depth[inner], kind="stable")
    inner, outer = inner[order], outer[order]
    around = np.zeros(number)
    for level in np.unique(depth[ask]):
        at = np.flatnonzero(ask & (depth == level))
        if level:
            own = slice(*np.searchsorted(depth[inner], [level, level + 1]))
            follows = (sign[parent[at]] != given[parent[at]]) & (given[at] == -given[parent[at]])
            sign[at[follows]] *= -1.0
            around += np.bincount(inner[own], sign[outer[own]], minlength=number)
        astray = at[(sign[at] < 0.0) & (around[at] <= 0.0)]
        sign[astray] = 1.0
    return sign != given, (sign > 0.0) & (around >= 1.0), (sign < 0.0) & (around >= 1.0)


def cut_from(relations: Relations, cavity: NDArray[np.bool_]) -> NDArray[np.intp]:
    """(c,) for each cavity the shell whose material it takes away: the innermost around it that no other cavity takes
    away before. For the other shells themselves."""
    home = np.arange(len(cavity))
    parent = _parents(relations, len(cavity))
    asking = np.flatnonzero(cavity)
    at, layers = parent[asking], np.ones(len(asking), np.intp)
    while len(asking):
        layers = layers + np.where(cavity[at], 1, -1)
        found = (layers == 0) | (parent[at] < 0)
        home[asking[found]] = at[found]
        asking, at, layers = asking[~found], parent[at[~found]], layers[~found]
    return home


def _parents(relations: Relations, number: int) -> NDArray[np.intp]:
    """(number,) the innermost shell around each, -1 for none."""
    inner, outer = relations.inside.T
    depth = np.bincount(inner, minlength=number)
    parent = np.full(number, -1)
    order = np.argsort(depth[outer], kind="stable")
    parent[inner[order]] = outer[order]  # the last one, the deepest, is kept
    return parent


def _locate(
    points: NDArray, shells: Shells, tree: Tree, small: NDArray, large: NDArray, tolerance: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """For each pair: whether some point under the smaller shell's skin is inside the larger shell, whether some is
    outside, and whether neither could be decided."""
    most, least, together = SAMPLES
    number = np.clip(together // len(small), least, most)
    pair = np.repeat(np.arange(len(small)), number)
    own = small[pair]
    place = _under_skin(points, shells, tree, own, np.tile(np.arange(number), len(small)), number, tolerance)
    self_winding, self_sure = tree.inside(place, own, tolerance)
    keep = self_sure & (self_winding != 0)
    place, pair = place[keep], pair[keep]
    winding, sure = tree.inside(place, large[pair], tolerance)
    within, without = np.zeros((2, len(small)), bool)
    within[pair[sure & (winding != 0)]] = True
    without[pair[sure & (winding == 0)]] = True
    return within, without, ~(within | without)


def _under_skin(
    points: NDArray, shells: Shells, tree: Tree, own: NDArray, k: NDArray, number: ArrayLike, tolerance: float
) -> NDArray[np.float64]:
    """(n, 3) the k-th of so many points under the skins of shells, about the tree's origin."""
    triangle = shells.start[own] + k * (shells.start[own + 1] - shells.start[own]) // number
    corner = points[shells.triangles[triangle]].astype(np.float64) - tree.origin
    # Three numbers that never put two samples of a triangle in one place, nor any on a line of symmetry.
    weight = np.stack([0.17 + k * 0.7548776662 % 1.0, 0.11 + k * 0.5698402910 % 1.0, 0.23 + k * 0.3247179572 % 1.0])
    weight /= weight.sum(axis=0)
    place = np.einsum("kn,nkj->nj", weight, corner)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = np.linalg.norm(normal, axis=1)
    depth = 10.0 ** (-2 - k % 3) * np.sqrt(area)  # a thin shell needs less than a thick one allows
    inward = -np.sign(shells.volume[own]) * np.maximum(depth, 4.0 * tolerance)
    return place + normal * np.divide(inward, area, out=np.zeros_like(area), where=area > 0.0)[:, None]
