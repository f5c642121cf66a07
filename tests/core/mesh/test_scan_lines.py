# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines through bodies: crossings at the expected places, none lost, independent of other
bodies.
"""

import numpy as np
import pytest
from body_moments.core.mesh import LINE_SLOPES, LineGrids, Surface, find_crossings, scan_lines

from tests.close import close
from tests.core.bodies import box, moved, ring, rotation, sphere, surface, torus


def grid_of(body, lines=400):
    low, high = body.box
    return LineGrids.over_boxes(low[None], high[None], np.array([lines]))


def lines_of(found):
    """{(body, row, column): [(along, sign), …] in their order}"""
    lines = {}
    for key, along, sign in zip(zip(found.body, found.row, found.column), found.along, found.sign):
        lines.setdefault(tuple(map(int, key)), []).append((float(along), int(sign)))
    return {key: sorted(line) for key, line in lines.items()}


def place_of(grid, row, column, along, body=0):
    """The point of a line, in the body's coordinates."""
    across = np.array([row, column], float) - grid.origin[body]
    across[1] += scan_lines.COLUMN_SLOPE * across[0]
    place = np.empty(3)
    place[grid.axes[body]] = [*(across * grid.cell[body] + np.array(LINE_SLOPES) * along), along]
    middle = np.empty(3)
    middle[grid.axes[body]] = grid.center[body]
    return place + middle


@pytest.mark.parametrize(
    "shape", [sphere(3), torus(), box((0, 0, 0), (1, 2, 3)), moved(box(), rotation(4), (5, 6, 7))]
)
@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_lines_meet_triangles_at_the_expected_places(shape, scale):
    points, triangles = moved(shape, scale * np.eye(3))
    body = Surface.from_triangles(points, triangles)
    grid = grid_of(body)
    found = find_crossings(body, grid)
    assert len(found.row) > 300 and found.rows_apart.tolist() == [1]
    for key in range(0, len(found.row), 17):
        place = place_of(grid, found.row[key], found.column[key], found.along[key])
        corners = points[triangles[found.triangle[key]]]
        share = np.linalg.solve(
            np.vstack([corners.T / scale, np.ones(3)])[[0, 1, 2, 3]].T
            @ np.vstack([corners.T / scale, np.ones(3)]),
            np.vstack([corners.T / scale, np.ones(3)]).T @ np.append(place / scale, 1.0),
        )
        assert (share > -1e-9).all() and np.abs(share @ corners - place).max() < 1e-9 * scale
    for line in lines_of(found).values():  # a closed surface is left as often as it is entered
        assert sum(sign for _, sign in line) == 0


def test_the_lengths_within_a_body_add_up_to_its_volume():
    body = surface(moved(sphere(5), rotation(1), (3, 4, 5)))
    grid = grid_of(body, 4000)
    found = find_crossings(body, grid)
    volume = abs(float((found.sign * found.along).sum() * np.prod(grid.cell)))
    assert close(volume, 4.0 / 3.0 * np.pi, rel=5e-3)


def test_lines_through_a_lattice_of_vertices_miss_nothing():
    """All lines are the same distance apart as the vertices, whatever they meet."""
    count = 40
    points, quads = ring(count, count)
    for turn in (np.eye(3), rotation(2)):
        body = Surface(points @ turn.T, quads=quads)
        for lines in (64, 400, 1600):
            for line in lines_of(find_crossings(body, grid_of(body, lines))).values():
                signs = [sign for _, sign in line]
                assert sum(signs) == 0 and len(set(np.cumsum(signs).tolist())) == 2


def test_quads_are_met_as_their_triangles():
    points, quads = ring(30, 20)
    # so that some are cut the other way
    points = points + 0.02 * np.random.default_rng(0).normal(size=points.shape)
    body = Surface(points, quads=quads)
    cut = Surface.from_triangles(points, body.all_triangles()[0])
    grid = grid_of(body)
    first, second = find_crossings(body, grid), find_crossings(cut, grid)
    order = [np.lexsort((found.along, found.column, found.row)) for found in (first, second)]
    for name in ("row", "column", "triangle", "sign"):
        np.testing.assert_array_equal(
            getattr(first, name)[order[0]], getattr(second, name)[order[1]]
        )
    assert np.abs(first.along[order[0]] - second.along[order[1]]).max() <= 1e-12


def test_line_axis_is_independent_of_the_order_of_equal_keys(monkeypatch):
    sort = np.argsort

    def argsort(values, axis=-1, kind=None):
        if kind:
            return sort(values, axis=axis, kind="stable")
        return values.shape[axis] - 1 - sort(np.flip(values, axis), axis=axis, kind="stable")

    monkeypatch.setattr(np, "argsort", argsort)
    high = np.array([[1.0, 1.0, 1.0], [2.0, 3.0, 3.0], [4.0, 1.0, 4.0]])
    grids = LineGrids.over_boxes(np.zeros((3, 3)), high, np.full(3, 400))
    assert grids.axes.tolist() == [[0, 1, 2], [1, 2, 0], [0, 2, 1]]
