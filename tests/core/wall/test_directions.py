# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where vertices go when faces move: which planes count as one, who may slide, and how well that is known."""

import numpy as np
import pytest
from body_moments.core.moments.moments import U
from body_moments.core.wall.directions import offset_directions
from body_moments.core.wall.walls import offset_solid

from tests.close import close
from tests.core import bodies


def crease(angle, rows=1, lean=0.0):
    """A sheet of two flat halves on either side of the line y = 0, which differ by an angle; its crease has rows + 1
    vertices, the first ones. One half leans, so that its corners at the ends of the crease are not as wide as the
    other's."""
    x, away = np.linspace(0.0, 1.0, rows + 1), np.array([0.0, np.cos(angle / 2), -np.sin(angle / 2)])
    line = np.column_stack([x, 0 * x, 0 * x])
    points = np.concatenate([line, line + away + [lean, 0, 0], line + away * [1, -1, 1]])
    n = rows + 1
    quads = [[i, i + 1, n + i + 1, n + i] for i in range(rows)] + [
        [2 * n + i, 2 * n + i + 1, i + 1, i] for i in range(rows)
    ]
    return points, bodies.split(quads)


def heights(part, vectors):
    """(m, 3) by how much the plane of each face moves at its corners."""
    corners = part[0][part[1]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return np.einsum("mi,mki->mk", normals, vectors[part[1]])


@pytest.mark.parametrize("angle, is_one", [(0.0195, True), (0.022, False), (0.1, False), (0.5, False)])
def test_planes_within_about_a_degree_are_one(angle, is_one):
    """Where corners of 45° and 135° meet ones of 90°, the smaller eigenvalue is 2/9 φ² and 6/25 φ² of the larger one,
    and 1e-4 the limit. Along the one direction that is left no vertex meets both planes."""
    part = crease(angle, lean=1.0)
    found = offset_solid(bodies.surface(part))
    moved = heights(part, found.vectors)[np.isin(part[1], (0, 1))]
    off = np.abs(moved - 1.0).max()
    assert 0.1 * angle**2 < off < 0.12 * angle**2 if is_one else off < 1e-12
    assert found.inexact_vertices == (2 if is_one else 0)


@pytest.mark.parametrize("angle, count", [(0.0028, 0), (0.0032, 1), (0.0039, 1), (0.0042, 2)])
def test_what_is_off_by_more_than_a_millionth_is_uneven(angle, count):
    """One plane is moved by φ²/9 too little at a corner of 45°, and by 3/50 φ² at one of 135°."""
    assert offset_solid(bodies.surface(crease(angle, lean=1.0))).inexact_vertices == count


@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("height, stored, is_known", [(1.1e-9, 0.0, True), (0.9e-9, 0.0, False)])
def test_a_sliver_has_a_normal_from_a_billionth_of_its_length_on(size, height, stored, is_known):
    points = size * np.array([[0, 0, 0], [1, 0, 0], [0.5, height, 0]])
    assert offset_directions(points, np.array([[0, 1, 2]])).has_normal.tolist() == [is_known]


@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("height, is_known", [(1.1, True), (0.9, False)])
def test_a_face_has_a_normal_from_a_thousand_times_what_storing_moves_it_by_on(size, height, is_known):
    points = size * np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-3 * height, 0]])
    assert offset_directions(points, np.array([[0, 1, 2]]), size * 1e-6).has_normal.tolist() == [is_known]


@pytest.mark.parametrize("size", [1.0, 2.0**10])
@pytest.mark.parametrize("stored", [0.0, 1e-7])
def test_how_well_the_directions_of_a_cube_s_corners_are_known(size, stored):
    """Each of three planes at right angles turns by 16 roundings, or by 2 √2 of what storing moved by, and shares a
    third of the sum. d is √3 long, and a turn of the normals by one turns it by 2 √3 √3 at most; the face of the least
    angle, a sixth of all, is moved by √6 √3 turns."""
    points, triangles = bodies.box((0, 0, 0), (size, size, size))
    found = offset_directions(points, triangles, stored)
    turn = np.array([16.0 * U, 2.0 * 2.0**0.5 * stored / size]) + [8.0 * U, 0.0]
    assert close(found.tangential_error, np.repeat(6.0 * turn[:, None], 8, axis=1), rel=1e-9)
    assert close(found.normal_error, np.repeat(turn[:, None] * 18.0**0.5, 8, axis=1), rel=1e-9)


def apex(width):
    """The top of a pyramid on a rectangle as wide as given, twice as deep and one high: four planes that have no
    common distance."""
    points = np.array([[0, 0, 1], [-width, -2 * width, 0], [width, -2 * width, 0], [width, 2 * width, 0]], float)
    points = np.concatenate([points, [[-width, 2 * width, 0]]])
    return points, np.array([[0, i, i % 4 + 1] for i in range(1, 5)])


@pytest.mark.parametrize("width", [0.5, 2.0])
@pytest.mark.parametrize("size", [1.0, 2.0**-12])
def test_where_planes_cannot_be_met_what_is_left_adds_to_what_is_not_known(width, size):
    points, triangles = apex(width)
    points, stored = size * points, 1e-6 * size
    corners = points[triangles]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normals = np.cross(first, second)
    double = np.linalg.norm(normals, axis=1)
    normals /= double[:, None]
    weight = np.arctan2(double, np.einsum("ij,ij->i", first, second))
    weight /= weight.sum()
    root = np.sqrt(weight)
    fitted, left, _, singular = np.linalg.lstsq(root[:, None] * normals, root, rcond=None)
    found = offset_directions(points, triangles, stored)
    assert close(found.vectors[0], fitted, rel=1e-9) or np.abs(found.vectors[0] - fitted).max() < 1e-12
    longest = np.max([np.linalg.norm(corners[:, k] - corners[:, k - 1], axis=1) for k in range(3)], axis=0)
    tilt = np.array([(8.0 * U * longest**2 / double).max() + 8.0 * U, (2.0 * stored * longest / double).max()])
    gain = 2.0 * np.linalg.norm(fitted) / singular[2] + np.sqrt(left[0]) / singular[2] ** 2
    assert close(found.tangential_error[:, 0], gain * tilt, rel=1e-6)
    lift = (np.linalg.norm(fitted) + gain * np.sqrt(left[0])) / np.sqrt(weight.min())
    assert close(found.normal_error[:, 0], lift * tilt, rel=1e-6)
    assert left[0] > 1e-4


def bar(rows):
    """A cube that is cut in rows along x only: no vertex within a side but on its edges."""
    ring = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    points = np.array([[x, y, z] for x in np.linspace(0.0, 1.0, rows + 1) for y, z in ring])
    quads = [
        [4 * i + (k + 1) % 4, 4 * i + k, 4 * i + 4 + k, 4 * i + 4 + (k + 1) % 4] for i in range(rows) for k in range(4)
    ]
    quads += [[0, 1, 2, 3], [4 * rows + k for k in (3, 2, 1, 0)]]
    return points, bodies.split(quads)[:, ::-1]


def fine_cube(n):
    faces = [
        (np.eye(3), (0, 0, 1)),
        (np.diag([1, -1, -1]), (0, 1, 0)),
        (np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]), (1, 0, 0)),
        (np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]]), (0, 0, 0)),
        (np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), (0, 1, 0)),
        (np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), (0, 0, 0)),
    ]
    return bodies.welded(bodies.joined(*(bodies.moved(bodies.grid(n), turn, offset) for turn, offset in faces)))


@pytest.mark.parametrize("part", [bar(12), fine_cube(8)], ids=["bar", "cube"])
def test_a_cube_s_vertices_move_as_if_it_were_scaled_however_it_is_cut(part):
    """Along edges too, where no vertex lies within a side. What is left of the unevenness is a trillionth."""
    found = offset_directions(*part)
    assert np.abs(found.vectors - 2.0 * (part[0] - 0.5)).max() < 2e-11
    assert 0.4999 < offset_solid(bodies.surface(part)).inward <= 0.5


@pytest.mark.parametrize("seed", range(3))
def test_a_cube_s_vertices_move_as_if_it_were_scaled_however_unevenly_it_is_cut(seed):
    """No two of its triangles are alike; what is within a side, and along an edge, lies anywhere there."""
    points, triangles = fine_cube(4)
    inside = (points > 0.0) & (points < 1.0)
    points = points + inside * np.random.default_rng(seed).uniform(-0.07, 0.07, points.shape)
    found = offset_directions(points, triangles)
    assert np.abs(found.vectors - 2.0 * (points - 0.5)).max() < 2e-11


@pytest.mark.parametrize("share, is_met", [(0.9, True), (1.1, False)])
@pytest.mark.parametrize("stored", [1e-5, 1e-6])
def test_four_planes_are_met_but_for_four_times_what_they_may_be_turned_by(share, is_met, stored):
    """A low pyramid whose top is not over the middle of its floor; it is as deep as makes its planes meet, or a little
    more. Where they cannot be met it goes along their mean, as a round surface's point does."""
    height, right, left = 0.1, 0.8, 2.0

    def measured(depth):
        floor = [[-left, -depth, 0], [right, -depth, 0], [right, depth, 0], [-left, depth, 0]]
        points = np.array([[0, 0, height], *floor])
        corners = points[np.array([[0, i, i % 4 + 1] for i in range(1, 5)])]
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        normals = np.cross(first, second)
        double = np.linalg.norm(normals, axis=1)
        normals /= double[:, None]
        weight = np.arctan2(double, np.einsum("ij,ij->i", first, second))
        root = np.sqrt(weight / weight.sum())
        met = np.linalg.lstsq(root[:, None] * normals, root, rcond=None)[0]
        off = np.sqrt((root**2) @ (normals @ met - 1.0) ** 2)
        longest = np.max([np.linalg.norm(corners[:, k] - corners[:, k - 1], axis=1) for k in range(3)], axis=0)
        limit = 1e-6 + 4.0 * (2.0 * stored * longest / double).max() * np.linalg.norm(met)
        return points, met, off / limit

    slopes = np.array([[height, 0.0, right], [-height, 0.0, left]])
    slopes /= np.linalg.norm(slopes, axis=1)[:, None]
    ahead = np.linalg.lstsq(slopes[:, [0, 2]], np.ones(2), rcond=None)[0][1]
    low = height / np.sqrt(ahead**2 - 1.0)  # as deep as makes all four meet
    high = 2.0 * low
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if measured(middle)[2] < share else (low, middle)
    points, met, _ = measured(low)
    vector = offset_directions(points, np.array([[0, i, i % 4 + 1] for i in range(1, 5)]), stored).vectors[0]
    assert abs(met[0]) > 1e-2 and (np.abs(vector - met).max() < 1e-9) == is_met


def roof(angle, n=8):
    """A finely cut cube whose top has a crease at a quarter of its width."""
    points, triangles = fine_cube(n)
    top = points[:, 2] == 1.0
    points = points.copy()
    points[top, 2] += np.tan(angle) * np.minimum(points[top, 0] - 0.25, 0.0)
    return (points, triangles), np.flatnonzero(top & (points[:, 0] == 0.25) & (np.abs(points[:, 1] - 0.5) < 0.5))


@pytest.mark.parametrize("angle", [2e-5, 1e-3])
def test_nothing_slides_across_a_crease_that_is_there(angle):
    part, line = roof(angle)
    moved = heights(part, offset_directions(*part).vectors)[np.isin(part[1], line)]
    assert np.abs(moved - 1.0).max() < 1e-10


@pytest.mark.parametrize("turns, slides", [(20.0, False), (12.0, True)])
def test_a_crease_within_eight_times_the_noise_on_either_side_is_flat(turns, slides):
    """Two planes whose normals storing may have turned by a share of what they differ by: tan(φ/2) against 8 turns."""
    angle = 1e-3
    stored = angle / turns / 8 / (2.0 * 2.0**0.5)  # a face of two sides 1/8 turns by 2 √2 · 8 of it
    part, line = roof(angle)
    moved = heights(part, offset_directions(*part, stored).vectors)[np.isin(part[1], line)]
    assert (np.abs(moved - 1.0).max() > 1e-5) == slides


def test_where_planes_cannot_be_met_a_vertex_does_not_slide_to_even_others():
    """Two bars that touch in one vertex of an edge each, a quarter along the one: there all planes are along the bars,
    and none can be moved. Its neighbors slide."""
    points, triangles = bar(4)
    other = np.column_stack([points[:, 0] * 3.5 - 0.625, -points[:, 1], -points[:, 2]])
    part = bodies.welded(bodies.joined((points, triangles), (other, triangles)))
    found = offset_directions(*part).vectors
    touch = (part[0] == [0.25, 0.0, 0.0]).all(axis=1)
    assert touch.sum() == 1 and len(part[0]) == 39 and not found[touch].any()
    beside = (part[0] == [0.5, 1.0, 1.0]).all(axis=1)
    assert np.abs(found[beside][0, 1:] - 1.0).max() < 1e-12


def test_a_sharp_edge_that_noise_touches_is_no_less_one():
    """Planes that differ by 2° from a fold back: their edge runs 57 thicknesses ahead, and what noise there does to
    it is that much larger."""
    half = np.radians(1.0)
    part = crease(np.pi - 2.0 * half, 6)
    noise = 1e-7
    points = part[0] + noise * np.random.default_rng(1).uniform(-1.0, 1.0, part[0].shape)
    found = offset_directions(points, part[1], noise * 3.0**0.5)
    ahead = np.linalg.norm(found.vectors[1:6], axis=1)
    assert close(ahead, np.full(5, 1.0 / np.sin(half)), rel=1e-3)
    assert (found.tangential_error[1, 1:6] > 2.0 / np.sin(half) ** 2 * noise).all()


def test_a_vertex_of_needles_alone_stays_where_it_is():
    points, triangles = bodies.grid(3)
    needle = [[0.5, -1e-13, 0.0]]
    last = len(points)
    row = next(tuple(row) for row in triangles if (points[row][:, 1] == 0.0).sum() == 2)
    a, b = sorted((i for i in row if points[i][1] == 0.0), key=lambda i: points[i][0])
    found = offset_directions(np.concatenate([points, needle]), np.concatenate([triangles, [[b, a, last]]]))
    assert found.has_normal.tolist() == [True] * len(triangles) + [False]
    assert not found.vectors[last].any() and close(found.vectors[:last, 2], np.ones(last), rel=1e-12)


def fans(count):
    """Vertices around which seven faces go up and down: their corners, normals and angles, and the direction that is
    fitted to the planes, where they say what it is."""
    triangles = np.array([[0, i, i % 7 + 1] for i in range(1, 8)])
    for seed in range(count):
        rng = np.random.default_rng(seed)
        angle, height = np.sort(rng.uniform(0.0, 2 * np.pi, 7)), rng.uniform(-2.5, 2.5, 7)
        points = np.concatenate([np.zeros((1, 3)), np.column_stack([np.cos(angle), np.sin(angle), height])])
        corners = points[triangles]
        normals = np.cross(corners[:, 1], corners[:, 2])
        double = np.linalg.norm(normals, axis=1)
        normals /= double[:, None]
        weight = np.arctan2(double, np.einsum("ij,ij->i", corners[:, 1], corners[:, 2]))
        fitted, _, _, singular = np.linalg.lstsq(np.sqrt(weight)[:, None] * normals, np.sqrt(weight), rcond=None)
        if singular[2] ** 2 > 0.03 * singular[0] ** 2:
            yield points, triangles, normals, weight, fitted


def test_the_fitted_direction_is_kept_where_every_face_gets_a_tenth_of_the_thickness():
    kept, left = [], []
    for points, triangles, normals, _, fitted in fans(200):
        low = (normals @ fitted).min()
        if low > 0.0:
            vector = offset_directions(points, triangles).vectors[0]
            (kept if np.abs(vector - fitted).max() < 1e-12 else left).append(low)
    assert min(kept) > 0.1 > max(left) and min(kept) < 0.11 and max(left) > 0.095


def test_where_the_mean_is_behind_a_face_the_direction_is_nearly_the_best_there_is():
    tries = np.random.default_rng(0).normal(size=(20000, 3))
    tries /= np.linalg.norm(tries, axis=1)[:, None]
    changed = kept = 0
    for points, triangles, normals, weight, fitted in fans(120):
        before = (normals @ fitted).min()
        if before >= 0.09:
            continue
        vector = offset_directions(points, triangles).vectors[0]
        moved = normals @ vector
        best = (tries @ normals.T).min(axis=1).max()
        if best < 0.0:
            kept += 1
            assert np.abs(vector - fitted).max() < 1e-12
        else:
            changed += 1
            # as far as is best for all planes together along the direction
            assert abs(weight @ (moved * (moved - 1.0))) <= 1e-12 * weight.sum()
            assert moved.min() > max(before, 0.9 * best * np.linalg.norm(vector))
    assert changed > 20 and kept > 5
