# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Welded bodies that touch, each with its own layer of the wall between them: whichever of them are
inside out.
"""

import itertools

import numpy as np
import pytest
from body_moments.core.solid.measure import measure_solid
from hypothesis import given

from tests.close import close
from tests.core.bodies import (
    CORNERS,
    SIDES,
    box,
    inverted,
    joined,
    mesh,
    moved,
    rotation,
    surface,
    welded,
    without,
)
from tests.core.findings import codes, only
from tests.core.strategies import holds, seeds

ROW = [box((k, 0, 0), (k + 1, 1, 1)) for k in range(3)]
BLOCK = [
    box((i, j, k), (i + 1, j + 1, k + 1)) for i in range(2) for j in range(2) for k in range(2)
]


def quads(cells):
    """Unit cubes as (corner, inside out), of quads, welded."""
    points = np.concatenate([CORNERS + corner for corner, _ in cells])
    faces = [(SIDES[:, ::-1] if turned else SIDES) + 8 * k for k, (_, turned) in enumerate(cells)]
    points, index = np.unique(points, axis=0, return_inverse=True)
    return mesh(points, index.reshape(-1)[np.concatenate(faces)].tolist())


@pytest.mark.parametrize("turned", list(itertools.product([False, True], repeat=3)))
@pytest.mark.parametrize("cut", [0, 1])
def test_cubes_in_a_row_are_turned_one_by_one(turned, cut):
    row = list(ROW)
    if cut:  # the shared sides are cut along the other diagonal
        row[1] = (
            row[1][0],
            np.concatenate([row[1][1][:8], [[0, 4, 2], [4, 6, 2], [1, 3, 5], [3, 7, 5]]]),
        )
    row = [inverted(part) if flip else part for part, flip in zip(row, turned)]
    points, triangles = joined(*row)
    # in whatever order its faces are: which copy of a face comes first says nothing
    for seed in (
        None,
        0,
        1,
        2,
    ):
        order = np.arange(36) if seed is None else np.random.default_rng(seed).permutation(36)
        turn = np.eye(3) if seed is None else rotation(seed)
        result = measure_solid(surface(welded(moved((points, triangles[order]), turn, (4, 5, 6)))))
        assert close(result.volume.total, 3.0, rel=1e-12)
        assert (
            result.method == ("reoriented" if any(turned) else "exact")
            and result.health.components == 3
        )
        assert codes(result) == ["inverted_components"] * any(turned)
        if any(turned):
            assert only(result).values == {"count": sum(turned), "total": 3}
            whole = np.flatnonzero(np.repeat(turned, 12)[order])
            found = only(result).elements
            assert len(found) == (0 if all(turned) else len(whole))
            walls = np.isin(order % 12, (8, 9, 10, 11))  # either layer may belong to either body
            assert set(found) - set(np.flatnonzero(walls)) == (
                set() if all(turned) else set(whole[~walls[whole]])
            )


@holds(8)
@given(seed=seeds)
def test_a_block_of_cubes_whichever_are_inside_out(seed):
    turned = np.random.default_rng(seed).random(8) < 0.4
    corners = [corner for corner in itertools.product(range(2), repeat=3)]
    for body in (
        quads(list(zip(corners, turned))),
        surface(
            welded(joined(*(inverted(part) if flip else part for part, flip in zip(BLOCK, turned))))
        ),
    ):
        result = measure_solid(body)
        assert close(result.volume.total, 8.0, rel=1e-12)
        assert (
            result.health.inverted_components == np.count_nonzero(turned)
            and result.health.components == 8
        )
        assert codes(result) == ["inverted_components"] * bool(turned.any())


def test_a_wall_of_one_layer_is_open_as_ever():
    result = measure_solid(surface(welded(joined(ROW[0], without(ROW[1], 8, 9)))))
    assert result.method == "open" and codes(result) == ["non_manifold_components"]


def test_body_meeting_itself_at_a_wall_is_closed():
    """A ring of seven of eight cubes; its ends are two layers of one wall, of one body."""
    places = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
    cubes = [quads([((x, y, 0), False)]) for x, y in places]
    points = np.concatenate([cube.points for cube in cubes])
    faces = np.concatenate([cube.quads + 8 * k for k, cube in enumerate(cubes)])
    points, index = np.unique(points, axis=0, return_inverse=True)
    faces = index.reshape(-1)[faces]
    middle = points[faces].mean(axis=1)
    inner = [(0.5, 1.0)] + [
        tuple((np.array(a) + b) / 2.0 + 0.5) for a, b in zip(places, [*places[1:], places[0]])
    ]
    first = inner[1]
    keep = [not any(np.allclose(place[:2], at) for at in inner[2:]) for place in middle]
    body = mesh(points, faces[keep].tolist())
    result = measure_solid(body)
    assert any(np.allclose(place[:2], first) for place in middle[keep])
    assert result.method == "exact" and close(result.volume.total, 8.0, rel=1e-12)


@pytest.mark.parametrize(
    "gap, reported, scale",
    [
        *(
            (gap, gap == 1e-6, scale)
            for gap in (3e-17, 2e-8, 5e-8, 1e-6)
            for scale in (1e-6, 1.0, 1e6)
        ),
        (1e-6, True, 1e40),  # beyond what float32 has numbers for
    ],
)
def test_welding_within_float32_precision_is_not_reported(gap, reported, scale):
    """Along the open edges of a box that has no top, and of the top."""
    top = box()[0], box()[1][2:4]
    part = joined(without(box(), 2, 3), moved(top, offset=(gap, 0, 0)))
    # small numbers are finer there than large ones
    part = moved(part, scale * np.eye(3), (-0.5 * scale,) * 3)
    result = measure_solid(surface(part))
    assert result.method == "exact" and result.health.welded
    assert codes(result) == ["vertices_welded"] * reported
    if reported:
        assert only(result).values["slight"]
        assert close(only(result).values["share"], gap / 3.0**0.5, rel=1e-3)
