# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines through bodies: they meet triangles where they say, slip through nowhere, and see each body as if alone."""

import numpy as np
import pytest
from body_moments.core.mesh import scan_lines
from body_moments.core.mesh.scan_lines import LINE_SLOPES, LineGrids, find_crossings
from body_moments.core.mesh.surface import Surface

from tests.close import close
from tests.core.bodies import box, joined, moved, ring, rotation, sphere, split, surface, torus, welded


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


@pytest.mark.parametrize("shape", [sphere(3), torus(), box((0, 0, 0), (1, 2, 3)), moved(box(), rotation(4), (5, 6, 7))])
@pytest.mark.parametrize("scale", [1e-7, 1.0, 1e7])
def test_lines_meet_triangles_where_they_do(shape, scale):
    points, triangles = moved(shape, scale * np.eye(3))
    body = Surface.from_triangles(points, triangles)
    grid = grid_of(body)
    found = find_crossings(body, grid)
    assert len(found.row) > 300 and found.rows_apart.tolist() == [1]
    for key in range(0, len(found.row), 17):
        place = place_of(grid, found.row[key], found.column[key], found.along[key])
        corners = points[triangles[found.triangle[key]]]
        share = np.linalg.solve(
            np.vstack([corners.T / scale, np.ones(3)])[[0, 1, 2, 3]].T @ np.vstack([corners.T / scale, np.ones(3)]),
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


def test_lines_through_a_lattice_of_vertices_slip_through_nowhere():
    """All lines are the same distance apart as the vertices, whatever they meet."""
    count = 40
    points, quads = ring(count, count)
    for turn in (np.eye(3), rotation(2)):
        body = Surface(points @ turn.T, quads=quads)
        for lines in (64, 400, 1600):
            for line in lines_of(find_crossings(body, grid_of(body, lines))).values():
                signs = [sign for _, sign in line]
                assert sum(signs) == 0 and len(set(np.cumsum(signs).tolist())) == 2


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_body_is_met_by_the_same_lines_alone_and_among_others(dtype):
    parts = [sphere(2), box((0, 0, 0), (4, 1, 9)), moved(torus(), rotation(3)), moved(sphere(3), 1e-5 * np.eye(3))]
    bodies = [Surface(part[0].astype(dtype), part[1]) for part in parts]
    boxes = [body.box for body in bodies]
    lines = scan_lines.line_counts(np.array([len(body.triangles) for body in bodies]))
    grids = LineGrids.over_boxes(*(np.array(side) for side in zip(*boxes)), lines)
    points, triangles = joined(*parts)
    of_point = np.repeat(np.arange(4), [len(body.points) for body in bodies])
    together = find_crossings(Surface(points.astype(dtype), triangles), grids, of_point)
    shift = np.cumsum([0] + [len(body.triangles) for body in bodies])
    for k, body in enumerate(bodies):
        low, high = body.box
        alone = find_crossings(body, LineGrids.over_boxes(low[None], high[None], lines[k : k + 1]))
        mine = together.body == k
        order, order_alone = (np.lexsort((found.along, found.column, found.row)) for found in (together, alone))
        order = order[mine[order]]
        np.testing.assert_array_equal(together.along[order], alone.along[order_alone])
        np.testing.assert_array_equal(together.sign[order], alone.sign[order_alone])
        np.testing.assert_array_equal(together.column[order], alone.column[order_alone])
        np.testing.assert_array_equal(together.triangle[order] - shift[k], alone.triangle[order_alone])


def test_quads_are_met_where_their_triangles_are():
    points, quads = ring(30, 20)
    points = points + 0.02 * np.random.default_rng(0).normal(size=points.shape)  # so that some are cut the other way
    body = Surface(points, quads=quads)
    cut = Surface.from_triangles(points, body.all_triangles()[0])
    grid = grid_of(body)
    first, second = find_crossings(body, grid), find_crossings(cut, grid)
    for name in ("row", "column", "triangle", "along", "sign"):
        order = [np.lexsort((found.along, found.column, found.row)) for found in (first, second)]
        np.testing.assert_array_equal(getattr(first, name)[order[0]], getattr(second, name)[order[1]])


def test_too_much_work_leaves_rows_out_and_says_how_many(monkeypatch):
    body = surface(torus(60, 40))
    grid = grid_of(body)
    whole = lines_of(find_crossings(body, grid))
    for name in ("MAX_PAIRS", "MAX_CROSSINGS"):
        with monkeypatch.context() as limited:
            limited.setattr(scan_lines, name, (100, 0.05))
            found = find_crossings(body, grid)
        apart = int(found.rows_apart[0])
        assert apart > 1
        assert lines_of(found) == {key: line for key, line in whole.items() if key[1] % apart == 0}


@pytest.mark.parametrize("name", ["MAX_PAIRS", "MAX_CROSSINGS"])
def test_how_many_rows_are_left_out_follows_from_a_body_s_own_triangles(name, monkeypatch):
    """Twice as many as it has quads, whatever other bodies there are."""
    points, quads = ring(40, 30)
    body = Surface(points, quads=quads)
    cut, count = Surface(points, body.all_triangles()[0]), 2 * len(quads)
    low, high = body.box
    twice = LineGrids.over_boxes(np.array([low, low]), np.array([high, high]), np.array([400, 400]))
    both = np.concatenate([points, points])
    some = Surface(both, split(quads[:300]), np.concatenate([quads[300:], quads + len(points)]))
    apart = []
    for limit in ((100, 0.05), (100.0 + 0.05 * count, 0.0), (100, 0.0)):
        monkeypatch.setattr(scan_lines, name, limit)
        alone = [int(find_crossings(each, grid_of(body)).rows_apart[0]) for each in (body, cut)]
        together = find_crossings(some, twice, np.repeat([0, 1], len(points))).rows_apart.tolist()
        assert together[1] == alone[0]
        apart.append([*alone, *together])
    assert apart[0] == apart[1] and min(apart[0]) > 1 and (np.array(apart[0]) < apart[2]).all()


def test_one_line_through_a_point_counts_how_often_it_is_surrounded():
    body = surface(welded(box((0, 0, 0), (1, 2, 3))))
    for point, expected in (((0.5, 1.0, 1.5), 1), ((0.1, 1.9, 0.1), 1), ((1.1, 1.0, 1.0), 0), ((0.5, 1.0, -0.1), 0)):
        found = find_crossings(body, LineGrids.through_points(np.array([point]), np.array([4.0])))
        assert abs(int(found.sign[found.along > 0.0].sum())) == expected


def test_each_of_several_bodies_has_the_one_line_through_its_point():
    """As far from its point as the crossing lies, on the lines that lean as all do."""
    parts = [box((0, 0, 0), (1, 2, 3)), moved(box(), None, (9.0, 0.0, 0.0)), moved(sphere(2), 1e-3 * np.eye(3))]
    places = np.array([[0.5, 1.0, 1.5], [9.25, 0.5, 0.75], [1e-4, 2e-4, -3e-4]])
    points, triangles = joined(*parts)
    of_point = np.repeat(np.arange(3), [len(part[0]) for part in parts])
    lines = LineGrids.through_points(places, np.array([4.0, 2.0, 3e-3]))
    found = find_crossings(Surface(points, triangles), lines, of_point)
    assert sorted(found.body.tolist()) == [0, 0, 1, 1, 2, 2]
    assert not found.row.any() and not found.column.any()
    for k in range(3):
        along = found.along[found.body == k]
        assert along.min() < 0.0 < along.max() and found.sign[found.body == k].sum() == 0
    slope = np.array([*LINE_SLOPES, 1.0])
    squares = lines.squared_distances(found.body, found.row, found.column, found.along)
    assert close(squares, found.along**2 * (slope @ slope), rel=1e-14)
    ends = places[found.body] + found.along[:, None] * slope
    low, high = np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0]]), np.array([[1.0, 2.0, 3.0], [10.0, 1.0, 1.0]])
    for body, end in zip(found.body, ends):
        if body < 2:
            assert min(np.abs(end - low[body]).min(), np.abs(end - high[body]).min()) <= 1e-14 * 10.0


def test_lines_run_along_the_same_axis_however_a_processor_sorts_what_is_equal(monkeypatch):
    sort = np.argsort

    def argsort(values, axis=-1, kind=None):
        if kind:
            return sort(values, axis=axis, kind="stable")
        return values.shape[axis] - 1 - sort(np.flip(values, axis), axis=axis, kind="stable")

    monkeypatch.setattr(np, "argsort", argsort)
    high = np.array([[1.0, 1.0, 1.0], [2.0, 3.0, 3.0], [4.0, 1.0, 4.0]])
    grids = LineGrids.over_boxes(np.zeros((3, 3)), high, np.full(3, 400))
    assert grids.axes.tolist() == [[0, 1, 2], [1, 2, 0], [0, 2, 1]]


def test_bodies_of_more_triangles_have_more_lines_between_a_least_and_a_largest_number():
    """Five times the root of their number."""
    found = scan_lines.line_counts(np.array([1, 13_000, 40_000, 160_000, 10**7]))
    assert found.tolist() == [576, 576, 1000, 2000, 2048]


@pytest.mark.parametrize("sides", [(4.0, 2.0, 1.0), (1.0, 9.0, 3.0), (2.0, 0.0, 2.0), (0.0, 5.0, 0.0), (0.0, 0.0, 0.0)])
@pytest.mark.parametrize("lines", [576, 2000])
def test_a_box_has_about_as_many_lines_through_it_as_are_asked_for_and_none_is_beyond_the_grid(sides, lines):
    """Along its shortest side; however flat it is."""
    low = np.array([7.0, -3.0, 50.0])
    grids = LineGrids.over_boxes(low[None], (low + sides)[None], np.array([lines]))
    assert (np.diff(np.array(sides)[grids.axes[0]]) <= 0.0).all()
    corners = low + np.array(list(np.ndindex(2, 2, 2))) * sides
    row, column, along = grids.places(corners, None)
    assert (row > 0.0).all() and (row < grids.rows - 1).all()
    assert (column > 0.0).all() and (column < grids.columns - 1).all()
    assert np.abs(along).max() == min(sides) / 2.0
    slopes, cell = np.array(LINE_SLOPES), grids.cell[0]
    width = np.array(sides)[grids.axes[0]][:2] + slopes * min(sides)  # across the lines
    if width.min() > 0.0:
        assert abs(np.prod(width / cell) / lines - 1.0) < 0.05 and 0.9 < cell[0] / cell[1] < 1.1
    assert (cell > 0.0).all()
