# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations between the closed components of one body: apart, nested or intersecting.

Pairs whose boxes overlap are found by a sweep. Each pair is then tested twice: points just under
the skin of the smaller component are located in the larger one (`core/mesh/bvh.py`); then edges of
one that pierce triangles of the other are looked for (`core/mesh/piercing.py`). Contact within the
tolerance is no crossing.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..mesh import Bvh, SortedComponents, intersecting_pairs, overlapping_box_pairs, sort_components
from ..numerics import (
    Array,
    Floats,
    Index,
    Integers,
    Mask,
    NDArray,
    cross_rows,
    lengths,
    segment_ranges,
)

NO_PAIRS = np.empty((0, 2), np.intp)
NO_LENGTHS = np.empty(0)
MAX_COMPONENT_PAIRS = 100_000
# Points under the skin of a component of few faces, tested for being surrounded twice.
MAX_OVERLAP_SAMPLES = 4096
FIRST_SAMPLES = 8  # The first of so many samples decides for most pairs that intersect.


class _Share(NamedTuple):
    """Limits of the work for one pair, or component, and for all of them together."""

    most: int
    least: int
    together: int

    def for_each(self, count: int) -> int:
        """Return the share of each of `count`."""
        return max(self.least, min(self.together // count, self.most))


POINTS_UNDER_SKIN = _Share(256, 8, 50_000)
BREAKTHROUGH_TRIANGLES = _Share(4096, 8, 20_000)  # with edges tested for reaching out
MAX_STEPS_PER_EDGE = 16


@dataclass(frozen=True, eq=False)
class ComponentRelations:
    """Relations between components, as (k, 2) pairs: `contained_in`, inner and outer one, and
    `intersecting`.

    The latter share a part of their interiors without one containing the other, or are the same.
    `undecided_pairs`: number of pairs that would have been too much work. `mostly_in`: inner and
    outer component of the intersecting pairs of opposite orientation with most of the inner one in
    the outer one, as a cavity that breaks through its wall. `breakthrough`: (k,) how far they reach
    out (unit).
    """

    contained_in: Index
    intersecting: Index
    undecided_pairs: int
    mostly_in: Index = field(default_factory=NO_PAIRS.view)
    breakthrough: Array = field(default_factory=NO_LENGTHS.view)

    def containers(self) -> Index:
        """Return (2, k) inner and outer components of the pairs that are decided as if one
        contained the other.
        """
        return np.concatenate([self.contained_in, self.mostly_in]).T


def classify_pairs(
    points: Floats,
    components: SortedComponents,
    candidates: Mask,
    tolerance: float,
) -> ComponentRelations:
    """Find the relations of the `candidates`, (c,), closed and not flat.

    Points nearer than `tolerance` touch.
    """
    chosen = np.flatnonzero(candidates)
    i, j, untested_count = overlapping_box_pairs(
        components.low[chosen], components.high[chosen], tolerance, MAX_COMPONENT_PAIRS
    )
    if not len(i):
        return ComponentRelations(NO_PAIRS, NO_PAIRS, untested_count)
    i, j = chosen[i], chosen[j]
    size = np.abs(components.volume)
    i_is_larger = (size[i] > size[j]) | ((size[i] == size[j]) & (i < j))
    small = np.where(i_is_larger, j, i)
    large = np.where(i_is_larger, i, j)

    selected = np.zeros(len(size), bool)
    selected[small] = selected[large] = True
    tree = Bvh(points, components, selected)
    inside_count, outside_count = _classify_by_samples(
        points, components, tree, small, large, tolerance
    )
    is_inside, is_outside = inside_count > 0, outside_count > 0
    # The larger one contains no more than the smaller one: they are copies.
    is_same = is_inside & ~is_outside & (size[large] - size[small] <= 1e-9 * size[large])
    intersects = (is_inside & is_outside) | is_same
    rest = ~intersects  # their edges decide
    pierced, unfinished = intersecting_pairs(tree, small[rest], large[rest], tolerance)
    is_unsure = ~(is_inside | is_outside)
    is_unsure[rest] |= unfinished
    intersects[rest] = pierced
    pair = np.stack([small, large], axis=1)
    opposite = components.volume[small] * components.volume[large] < 0.0
    mostly_in = pair[intersects & ~is_same & opposite & (inside_count > outside_count)]
    return ComponentRelations(
        contained_in=pair[is_inside & ~intersects & ~is_unsure],
        intersecting=pair[intersects],
        undecided_pairs=untested_count + int(np.count_nonzero(is_unsure & ~intersects)),
        mostly_in=mostly_in,
        breakthrough=_breakthrough(components, tree, mostly_in, tolerance),
    )


def _breakthrough(components: SortedComponents, tree: Bvh, pairs: Index, tolerance: float) -> Array:
    """Return (k,) how far inner and outer component reach out of each other, at least `tolerance`:
    the depth of points on edges of the inner one outside, and of the outer one inside.
    """
    depth = np.full(len(pairs), tolerance)
    if not len(pairs):
        return depth
    share = BREAKTHROUGH_TRIANGLES.for_each(len(pairs))
    for (component, other), reaches_inside in ((pairs.T, False), (pairs.T[::-1], True)):
        triangle_counts = components.start[component + 1] - components.start[component]
        # By pair, as `component` is.
        chosen_counts = np.minimum(triangle_counts, share)
        pair = np.repeat(np.arange(len(pairs)), chosen_counts)
        # The chosen triangles are spread evenly over all of the component.
        k_of_triangle = segment_ranges(chosen_counts) * triangle_counts[pair] // chosen_counts[pair]
        triangle = components.start[component][pair] + k_of_triangle
        corners = [tree.vertex_columns[:, vertex].T for vertex in components.triangles[triangle].T]
        # A few triangles may have long edges: the fewer, the more points on each.
        steps = BREAKTHROUGH_TRIANGLES.together // len(pair)
        points_per_edge = int(np.clip(steps, 1, MAX_STEPS_PER_EDGE))
        place = np.concatenate(
            [
                corners[i] + k / points_per_edge * (corners[i - 1] - corners[i])
                for i in range(3)
                for k in range(points_per_edge)
            ]
        )
        pair = np.tile(pair, 3 * points_per_edge)
        winding, sure = tree.winding_numbers(place, other[pair], 0.0)
        reaches = np.flatnonzero(sure & ((winding != 0) == reaches_inside))
        distances = tree.distances(place[reaches], other[pair[reaches]])
        np.maximum.at(depth, pair[reaches], distances)
    return depth


def surfaces_intersect(
    points: Floats,
    triangles: Integers,
    component: Index,
    pairs: Integers,
    vertex: Integers,
    tolerance: float,
) -> bool:
    """Return whether surfaces are found to go through each other or themselves by over
    `tolerance`.

    component: (t,) of each triangle, ascending. pairs: (k, 2) components, the same twice for a
    surface with itself. vertex: (n,) numbers; triangles with a common number are not compared.
    """
    surfaces = sort_components(points, triangles, component, int(component[-1]) + 1)
    tree = Bvh(points, surfaces, np.ones(len(surfaces.volume), bool))
    return bool(intersecting_pairs(tree, pairs[:, 0], pairs[:, 1], tolerance, vertex)[0].any())


def self_overlaps(
    points: Floats,
    components: SortedComponents,
    candidates: Mask,
    tolerance: float,
) -> bool:
    """Return whether a closed candidate surrounds a point under its skin twice, though no edge need
    pierce a face.
    """
    chosen = np.flatnonzero(candidates)
    if not len(chosen):
        return False
    tree = Bvh(points, components, candidates)
    triangle_counts = (components.start[1:] - components.start[:-1])[chosen]
    sample_counts = np.clip(
        POINTS_UNDER_SKIN.together // len(chosen),
        POINTS_UNDER_SKIN.least,
        np.maximum(triangle_counts, MAX_OVERLAP_SAMPLES),
    )
    component = np.repeat(chosen, sample_counts)
    place = _interior_samples(
        points,
        components,
        tree,
        component,
        segment_ranges(sample_counts),
        np.repeat(sample_counts, sample_counts),
        tolerance,
    )
    winding, sure = tree.winding_numbers(place, component, tolerance)
    return bool((sure & (np.abs(winding) > 1)).any())


def orient_nested_components(
    components: SortedComponents, relations: ComponentRelations, candidates: Mask
) -> tuple[Mask, Mask, Mask]:
    """Return (c,) masks of the components to turn, of outward ones in the material of others, and
    of cavities.

    From the outermost inward: an inward component that no material surrounds is inside out. It is
    turned, with any consistent contents (a hollow body turned inside out as a whole). A cavity that
    breaks through its wall remains a cavity.
    """
    number = len(candidates)
    given = np.where(candidates, np.sign(components.volume), 0.0)
    sign = given.copy()
    inner, outer = relations.containers()
    depth = np.bincount(inner, minlength=number)
    parent = _innermost_container(relations, number)
    order = np.argsort(depth[inner], kind="stable")
    inner, outer = inner[order], outer[order]
    layers_around = np.zeros(number)  # layers of material, cavities subtracted
    for level in np.unique(depth[candidates]):
        at_level = np.flatnonzero(candidates & (depth == level))
        if level:
            parents = parent[at_level]
            # The contents of a turned component turn with it if they faced the other way.
            follows = sign[parents] != given[parents]
            follows &= given[at_level] == -given[parents]
            sign[at_level[follows]] *= -1.0
            pairs = slice(*np.searchsorted(depth[inner], [level, level + 1]))
            layers_around += np.bincount(inner[pairs], sign[outer[pairs]], minlength=number)
        is_inside_out = (sign[at_level] < 0.0) & (layers_around[at_level] <= 0.0)
        sign[at_level[is_inside_out]] = 1.0
    in_material = layers_around >= 1.0
    return sign != given, (sign > 0.0) & in_material, (sign < 0.0) & in_material


def cavity_host(relations: ComponentRelations, cavity: Mask) -> Index:
    """Return (c,) hosts: for a cavity the innermost component around it that is not cut yet, else
    itself.
    """
    host = np.arange(len(cavity))
    parent = _innermost_container(relations, len(cavity))
    pending = np.flatnonzero(cavity)
    container = parent[pending]
    # On the way outward a cavity opens a hole, and a body closes one.
    holes = np.ones(len(pending), np.intp)
    while len(pending):
        holes = holes + np.where(cavity[container], 1, -1)
        resolved = (holes == 0) | (parent[container] < 0)
        host[pending[resolved]] = container[resolved]
        pending = pending[~resolved]
        container = parent[container[~resolved]]
        holes = holes[~resolved]
    return host


def _innermost_container(relations: ComponentRelations, number: int) -> Index:
    """Return the (number,) innermost components around the components, -1 for none."""
    inner, outer = relations.containers()
    depth = np.bincount(inner, minlength=number)
    parent = np.full(number, -1)
    order = np.lexsort((outer, depth[outer]))
    parent[inner[order]] = outer[order]  # the last assignment counts: the deepest container
    return parent


def _classify_by_samples(
    points: NDArray,
    components: SortedComponents,
    tree: Bvh,
    small: NDArray,
    large: NDArray,
    tolerance: float,
) -> tuple[Index, Index]:
    """Count, by pair, decidable points under the smaller component's skin inside and outside the
    larger one.
    """
    number = POINTS_UNDER_SKIN.for_each(len(small))
    samples = np.arange(number)
    counts = np.zeros((2, len(small)), np.intp)
    # A pair of opposite orientation may be a cavity that breaks through its wall: whether most of
    # it is inside, only all samples say.
    needs_all = components.volume[small] * components.volume[large] < 0.0
    is_first = samples % FIRST_SAMPLES == 0 if number > POINTS_UNDER_SKIN.least else samples >= 0
    for chosen in (samples[is_first], samples[~is_first]):
        # Pairs with samples inside and outside intersect, whatever further samples say.
        open_pairs = np.flatnonzero(needs_all | ~counts.all(axis=0))
        pair = open_pairs.repeat(len(chosen))
        if not len(pair):
            continue
        k = np.tile(chosen, len(open_pairs))
        sampled = small[pair]
        place = _interior_samples(points, components, tree, sampled, k, number, tolerance)
        self_winding, self_sure = tree.winding_numbers(place, sampled, tolerance)
        is_interior = self_sure & (self_winding != 0)
        place, pair = place[is_interior], pair[is_interior]
        winding, sure = tree.winding_numbers(place, large[pair], tolerance)
        for count, is_counted in zip(counts, (sure & (winding != 0), sure & (winding == 0))):
            count += np.bincount(pair[is_counted], minlength=len(small))
    return counts[0], counts[1]


def _interior_samples(
    points: NDArray,
    components: SortedComponents,
    tree: Bvh,
    component: NDArray,
    k: NDArray,
    number: int | Integers,
    tolerance: float,
) -> Array:
    """Return the `k`-th of `number` points under the skin of each `component`, (n, 3) about the
    tree's origin.
    """
    triangle = (
        components.start[component]
        + k * (components.start[component + 1] - components.start[component]) // number
    )
    corner = points[components.triangles[triangle]].astype(np.float64) - tree.origin
    # Three numbers that never put two samples of a triangle in one place, nor any on a line of
    # symmetry: multiples of 1/ρ, 1/ρ² and ρ - 1, modulo 1, for the plastic number ρ = 1.3247179572;
    # the offsets are chosen.
    weight = np.stack(
        [
            0.17 + k * 0.7548776662 % 1.0,
            0.11 + k * 0.5698402910 % 1.0,
            0.23 + k * 0.3247179572 % 1.0,
        ]
    )
    weight /= weight.sum(axis=0)
    place = np.einsum("kn,nkj->nj", weight, corner)
    normal = cross_rows(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    double_area = lengths(normal)[:, 0]
    # A hundredth to a ten-thousandth of the triangle's size: a thin shell needs less than a thick
    # one allows. Four tolerances keep samples clear of touching surfaces.
    depth = 10.0 ** (-2 - k % 3) * np.sqrt(double_area)
    inward = -np.sign(components.volume[component]) * np.maximum(depth, 4.0 * tolerance)
    return (
        place
        + normal
        * np.divide(inward, double_area, out=np.zeros_like(double_area), where=double_area > 0.0)[
            :, None
        ]
    )
