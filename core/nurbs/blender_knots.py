# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's NURBS: valid settings, the knots that follow from them, and the samples of the display mesh.

Blender's files and its Python interface have no knots: they follow from the number of points, the order and three
flags (blender/source/blender/blenkernel/intern/curve.cc: calcknots, makeknots, nurb_check_valid; the same in 4.2 to
5.2). They are small integers, so that float32 and float64 agree.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..numerics.bspline import SplineSpace


def is_valid(count: int, order: int, cyclic: bool, bezier: bool, endpoint: bool) -> bool:
    """Return whether Blender evaluates a spline direction with these settings; it shows nothing otherwise."""
    return count >= max(2, order) and (
        not bezier or (count % (order - 1) == 0 if cyclic else endpoint or count > order)
    )


def blender_knots(count: int, order: int, cyclic: bool, bezier: bool, endpoint: bool) -> NDArray[np.float64]:
    """Return the knot vector of a valid direction: count + order knots, and order - 1 more if it is cyclic."""
    repeat = order - 1 if bezier else 1
    head = (order - 1 if cyclic else order) if endpoint else (min(2, repeat) if bezier else 1)
    tail = 2 * order - 1 if cyclic else (order if endpoint else 0)
    length = count + order + (order - 1 if cyclic else 0)
    knots = np.zeros(length)
    offset = current = 1 if endpoint and cyclic else 0
    left = head
    for i in range(offset, length - tail):
        knots[i] = current
        left -= 1
        if left == 0:
            current, left = current + 1, repeat
    for i in range(tail):  # One by one: a tail longer than the rest copies its own first knots.
        knots[length - tail + i] = current + knots[i] - knots[0]
    return knots


@lru_cache(maxsize=256)  # keeps the cached tables of a space from frame to frame
def blender_space(count: int, order: int, cyclic: bool, bezier: bool, endpoint: bool) -> SplineSpace | None:
    """Return the function space of one direction of a Blender spline, or None if Blender shows nothing for it."""
    if not is_valid(count, order, cyclic, bezier, endpoint):
        return None
    knots = blender_knots(count, order, cyclic, bezier, endpoint)
    if not knots[order - 1] < knots[len(knots) - order]:
        return None
    return SplineSpace(tuple(knots.tolist()), order, count)


def display_parameters(space: SplineSpace, resolution: int) -> NDArray[np.float64]:
    """Return (count * resolution,) parameters of Blender's display mesh, with the drift of its float32 sums."""
    cyclic = space.function_count > space.count
    total = space.count * resolution
    low, high = np.float32(space.domain[0]), np.float32(space.domain[1])
    steps = np.full(total, (high - low) / np.float32(total if cyclic else total - 1), np.float32)
    steps[0] = low
    return np.add.accumulate(steps, dtype=np.float32).astype(np.float64)


def display_table(space: SplineSpace, parameters: NDArray) -> NDArray[np.float64]:
    """Return (n, count) weights of the control points in Blender's display mesh at n parameters."""
    table = space.collocation_matrix(np.minimum(parameters, space.domain[1]))
    past = (parameters > space.domain[1]) & (space.knots[-1] > space.domain[1])
    if past.any():
        knots = space.knots + tuple(space.knots[-1] + 1.0 + i for i in range(space.order))
        longer = SplineSpace(knots, space.order, len(knots) - space.order)
        table[past] = longer.collocation_matrix(parameters[past])[:, : space.count]
    return table
