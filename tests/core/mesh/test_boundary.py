# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Closedness by a sum over sides, compared with sorted edges, in any order and in any pieces."""

import numpy as np
import pytest
from body_moments.core.mesh import BoundarySum, Surface, find_edges

from tests.core.bodies import (
    box,
    grid,
    inverted,
    joined,
    moebius,
    ring,
    rotation,
    soup,
    sphere,
    torus,
    welded,
    with_flipped,
    without,
)


def closes(*surfaces):
    total = BoundarySum()
    for surface in surfaces:
        total.add(surface)
    return total.is_zero


PARTS = [
    (box(), True),
    (sphere(3), True),
    (torus(), True),
    (inverted(torus()), True),
    (joined(box(), box((1, 0, 0), (2, 1, 1))), True),
    (welded(joined(box(), box((1, 1, 0), (2, 2, 1)))), True),
    (without(box(), 0), False),
    (without(box(), 0, 1, 2, 3), False),  # two holes whose sides would cancel as vectors
    (with_flipped(box(), 4), False),
    (grid(5), False),
    (moebius(), False),
    ((box()[0], np.concatenate([box()[1], box()[1][:1]])), False),
]


@pytest.mark.parametrize("part, closed", PARTS)
@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_closedness_needs_each_edge_equally_often_both_ways(part, closed, scale):
    points, triangles = part
    assert closed == (
        not find_edges(welded(part)[1]).signed_use_count(np.zeros(len(triangles), bool)).any()
    )
    points = (points @ rotation(1).T + 0.1) * scale
    assert closes(Surface(points, triangles)) == closed
    apart = Surface(*soup((points, triangles)))
    assert closes(apart) == closed  # corners at the same place are one
    halves = [Surface(points, triangles[k::2]) for k in range(2)]
    assert closes(*halves) == closed
    rolled = Surface(points, np.roll(triangles[::-1], 1, axis=1))
    assert closes(rolled) == closed


def test_quads_close_with_triangles_and_without():
    points, quads = ring(12, 8)
    assert closes(Surface(points, quads=quads)) and not closes(Surface(points, quads=quads[1:]))
    assert closes(Surface(points, quads[:1, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), quads[1:]))


def test_minus_zero_closes_and_float32_keeps_its_value():
    points, triangles = box((-1, 0, 0), (0, 1, 1))
    apart = soup((points, triangles))
    apart[0][::2] = np.where(apart[0][::2] == 0.0, -0.0, apart[0][::2])
    assert closes(Surface(*apart))
    rounded = (points + 0.1).astype(np.float32)
    mixed = Surface(rounded, triangles[:5]), Surface(rounded.astype(float), triangles[5:])
    assert closes(*mixed)
    assert not closes(mixed[0], Surface(points + 0.1, triangles[5:]))
