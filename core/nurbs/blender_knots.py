# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's NURBS: valid settings, their knots, samples of the display mesh; patches of any knots
as such patches.

Blender's files and its Python interface have no knots: they follow from the number of points, the
order and three flags (blender/source/blender/blenkernel/intern/curve.cc: calcknots, makeknots,
nurb_check_valid; the same in 4.2 to 5.2). They are small integers, so that float32 and float64
agree.

If every knot is inserted until its multiplicity is the degree, a patch consists of Bézier patches
side by side, and the distances of their knots change its parameters but not its points. So the
flags *Bézier* and *Endpoint* describe the same surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import cast

import numpy as np

from ..numerics import Array, NDArray, SplineSpace
from .splines import Curve, Patch, homogeneous, projected

SAME_KNOT_RTOL = (
    1e-12  # Relative to the domain: ends of a part that are nearer to a knot are moved to it.
)


def is_valid(count: int, order: int, cyclic: bool, bezier: bool, endpoint: bool) -> bool:
    """Return whether Blender evaluates a spline direction with these settings; it shows nothing
    otherwise.
    """
    return count >= max(2, order) and (
        not bezier or (count % (order - 1) == 0 if cyclic else endpoint or count > order)
    )


def blender_knots(count: int, order: int, cyclic: bool, bezier: bool, endpoint: bool) -> Array:
    """Return the knot vector of a valid direction: count + order knots, and order - 1 more if it is
    cyclic.
    """
    # As makeknots: `head` equal knots, then `repeat` knots of each next whole number. The last
    # `tail` knots go on from there with the distances of the first ones. With both *Endpoint* and
    # *Cyclic* a single 0 stands before all, and the others begin at 1.
    repeat = order - 1 if bezier else 1
    head = min(2, repeat)
    tail = 0
    if endpoint:
        head = order - 1 if cyclic else order
        tail = order
    if cyclic:
        tail = 2 * order - 1
    length = count + order + (order - 1 if cyclic else 0)
    knots = np.zeros(length)
    first = 1 if endpoint and cyclic else 0
    # The values of these knots, and the next one, with which the tail begins.
    places = np.arange(length - tail - first + 1)
    values = first + np.maximum((places - head + repeat) // repeat, 0)
    knots[first : length - tail] = values[:-1]
    for i in range(tail):  # One by one: a tail longer than the rest copies its own first knots.
        knots[length - tail + i] = values[-1] + knots[i] - knots[0]
    return knots


@lru_cache(maxsize=256)  # keeps the cached tables of a space from frame to frame
def blender_space(
    count: int, order: int, cyclic: bool, bezier: bool, endpoint: bool
) -> SplineSpace | None:
    """Return the function space of one direction of a Blender spline, or None if Blender shows
    nothing for it.
    """
    if not is_valid(count, order, cyclic, bezier, endpoint):
        return None
    knots = blender_knots(count, order, cyclic, bezier, endpoint)
    if not knots[order - 1] < knots[len(knots) - order]:
        return None
    return SplineSpace(tuple(knots.tolist()), order, count)


def display_parameters(space: SplineSpace, resolution: int) -> Array:
    """Return (count * resolution,) parameters of Blender's display mesh, with the drift of its
    float32 sums.
    """
    cyclic = space.function_count > space.count
    total = space.count * resolution
    low = np.float32(space.domain[0])
    high = np.float32(space.domain[1])
    steps = np.full(total, (high - low) / np.float32(total if cyclic else total - 1), np.float32)
    steps[0] = low
    return np.add.accumulate(steps, dtype=np.float32).astype(np.float64)


def display_table(space: SplineSpace, parameters: NDArray) -> Array:
    """Return (n, count) weights of the control points in Blender's display mesh at n parameters."""
    table = space.collocation_matrix(np.minimum(parameters, space.domain[1]))
    # Float32 sums may drift past the domain; Blender then evaluates the same functions beyond it.
    # Knots after the last make them known there, and the functions that these add are left out.
    # (The last parameter of a cyclic space is a whole step before the end.)
    past = (parameters > space.domain[1]) & (space.knots[-1] > space.domain[1])
    if past.any():
        knots = space.knots + tuple(space.knots[-1] + 1.0 + i for i in range(space.order))
        longer = SplineSpace(knots, space.order, len(knots) - space.order)
        table[past] = longer.collocation_matrix(parameters[past])[:, : space.count]
    return table


def bezier_patches(
    patch: Patch, domain: tuple[tuple[float, float] | None, tuple[float, float] | None]
) -> list[Patch]:
    """Convert a patch with any knots into patches of the same surface with Blender's flags *Bézier*
    and *Endpoint*.

    A surface that may jump, at knots with the multiplicity of the order, gives several patches.
    domain: (low, high) of s and of t, the part to convert; None for all of it. ValueError if the
    part is not in the domain, or an order is 1.

    Knots are inserted by Boehm's algorithm, as blossoms: each new control point is the same affine
    combination of old ones, whether the knots are inserted one at a time or at once.
    """
    pieces = [list(_pieces(space, part)) for space, part in zip(patch.spaces, domain)]
    old_net = homogeneous(patch.points, patch.weights)
    patches = []
    (s_space, t_space) = patch.spaces
    for s_matrix, t_matrix in product(*pieces):
        spaces = (
            bezier_space(len(s_matrix), s_space.order),
            bezier_space(len(t_matrix), t_space.order),
        )
        net = np.einsum("bj,ajd->abd", t_matrix, np.einsum("ai,ijd->ajd", s_matrix, old_net))
        patches.append(Patch(spaces, *projected(net)))
    return patches


def bezier_curves(curve: Curve, part: tuple[float, float] | None = None) -> list[Curve]:
    """Convert a part (low, high) of a curve, None for all of it, as `bezier_patches` does, into
    curves without jumps.
    """
    net = homogeneous(curve.points, curve.weights)
    return [
        Curve(bezier_space(len(matrix), curve.space.order), *projected(matrix @ net))
        for matrix in _pieces(curve.space, part)
    ]


def bezier_space(count: int, order: int) -> SplineSpace:
    """Return the space of Bézier pieces side by side that Blender's flags *Bézier* and *Endpoint*
    describe.
    """
    return cast(
        "SplineSpace", blender_space(count, order, cyclic=False, bezier=True, endpoint=True)
    )


def _pieces(space: SplineSpace, part: tuple[float, float] | None) -> Iterator[Array]:
    """Yield, for each piece without a jump, (n, count) the weights of the old control points in the
    new ones.
    """
    low, high = space.domain if part is None else _snapped(space, part)
    edges = np.clip(space.intervals, low, high)
    inside = edges[:, 0] < edges[:, 1]
    if space.order < 2:
        raise ValueError("a space of steps")
    spans = space.spans[inside]
    edges = edges[inside]
    weights = space.bezier_weights(spans, edges)
    controls = space.controls_of_spans(spans)
    knots = np.asarray(space.knots)
    rows: list[Array] = []
    for edge, block, columns in zip(edges, weights, controls):
        dense = np.zeros((space.order, space.count))
        np.add.at(dense.T, columns, block.T)
        # At a knot of the order's multiplicity the curve may jump; at others, the first control
        # point of a Bézier piece is the last one of the piece before.
        if rows and np.count_nonzero(knots == edge[0]) >= space.order:
            yield np.concatenate(rows)
            rows = []
        rows.append(dense[1:] if rows else dense)
    yield np.concatenate(rows)


def _snapped(space: SplineSpace, part: tuple[float, float]) -> tuple[float, float]:
    """Return the ends of a part of the domain, moved to a knot if they differ from it by rounding
    alone.
    """
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
