# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Least moves that balance a body: they reach the point, and none is smaller."""

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.statics.balancing import (
    _Fans,
    balance,
)
from body_moments.core.statics.gradient import area_gradient, volume_gradient
from body_moments.core.verdict import MeasureError

from tests.core import bodies
from tests.core.findings import refused

SHEAR = np.array([[1.0, 0.4, -0.2], [0.1, 0.7, 0.3], [0.0, -0.25, 1.5]])
HORIZONTAL = np.eye(3)[:2]


def center(points, triangles, shell=False):
    return polyhedron_moments(bodies.surface((points, triangles)), area_order=3, allow_open=shell)[
        shell
    ].center


def upper(part, share=0.6):
    z = part[0][:, 2]
    return np.flatnonzero(z > z.min() + share * np.ptp(z))


def areas(part):
    corners = part[0][part[1]]
    double = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return np.bincount(part[1].ravel(), np.repeat(double / 6, 3), len(part[0]))


@pytest.fixture(params=[False, True], ids=["solid", "shell"])
def shell(request):
    return request.param


@pytest.mark.parametrize("across", [HORIZONTAL, np.eye(3)], ids=["horizontal", "all"])
@pytest.mark.parametrize("place", [(0, 0, 0), (500.0, -300.0, 100.0)], ids=["near", "far"])
def test_the_center_comes_to_the_point_and_nothing_else_moves(shell, across, place):
    part = bodies.moved(bodies.torus(20, 14), bodies.rotation(2) @ SHEAR, place)
    start = center(*part, shell)
    target = start + np.array([0.03, -0.02, 0.04]) * (0.3 if shell else 1.0)
    movable = upper(part)
    found = balance(bodies.surface(part), movable, target, across=across, shell=shell)
    assert np.abs(across @ (center(found.points, part[1], shell) - target)).max() < 1e-13 * (
        1 + np.abs(place).max()
    )
    rest = np.setdiff1d(np.arange(len(part[0])), movable)
    assert np.array_equal(found.points[rest], part[0][rest])
    assert np.abs(found.before - start).max() < 1e-12


def test_no_other_move_is_smaller_to_first_order(shell):
    part = bodies.moved(bodies.sphere(1), SHEAR)
    movable = upper(part, 0.4)
    moments = polyhedron_moments(bodies.surface(part), area_order=3)[shell]
    derive = area_gradient if shell else volume_gradient
    slope = derive(bodies.surface(part), moments.center)[movable, 1:3] / moments.total
    root = np.sqrt(np.repeat(areas(part)[movable], 3))
    rows = slope.transpose(1, 0, 2).reshape(2, -1) / root
    off = []
    for size in (1e-3, 1e-4):
        step = size * np.array([1.0, 0.5, 0.0])
        found = balance(
            bodies.surface(part), movable, moments.center + step, across=HORIZONTAL, shell=shell
        )
        ours = (found.points - part[0])[movable].ravel() * root
        # the shortest of all moves to the point
        least = np.linalg.lstsq(rows, step[:2], rcond=None)[0]
        off.append(np.linalg.norm(ours - least) / np.linalg.norm(least))
    assert off[0] < 100 * 1e-3 and 8.0 < off[0] / off[1] < 12.0


def test_limit_holds_for_every_vertex_and_the_point_is_reached(shell):
    part = bodies.sphere(3)
    movable = upper(part, 0.5)
    target = np.array([0.02, 0.01, 0.0])
    free = balance(bodies.surface(part), movable, target, across=HORIZONTAL, shell=shell)
    most = np.linalg.norm(free.points - part[0], axis=1).max()
    held = balance(
        bodies.surface(part), movable, target, across=HORIZONTAL, limit=0.8 * most, shell=shell
    )
    lengths = np.linalg.norm(held.points - part[0], axis=1)
    assert lengths.max() <= 0.8 * most * (1 + 1e-12) and np.count_nonzero(lengths > 0.79 * most) > 3
    assert np.abs((center(held.points, part[1], shell) - target)[:2]).max() < 1e-13
    cost = [(areas(part)[:, None] * (one.points - part[0]) ** 2).sum() for one in (free, held)]
    assert cost[0] < cost[1] < 1.5 * cost[0]


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("spare", [1.001, 1.05, 1.5])
def test_limit_above_the_least_moves_changes_nothing(shell, count, spare):
    """Newton's steps past the solution found no way back, so that reachable points were refused."""
    part = bodies.moved(bodies.sphere(1), bodies.rotation(3) @ np.diag([1.0, 2.0, 0.5]))
    random = np.random.default_rng(count)
    for _ in range(8):
        movable = random.choice(len(part[0]), count, replace=False)
        points = part[0].copy()
        points[movable] += random.normal(size=3) * 0.05
        target = center(points, part[1], shell)
        try:
            free = balance(bodies.surface(part), movable, target, across=HORIZONTAL, shell=shell)
        except MeasureError:
            continue
        most = np.linalg.norm(free.points - part[0], axis=1).max()
        held = balance(
            bodies.surface(part),
            movable,
            target,
            across=HORIZONTAL,
            limit=spare * most,
            shell=shell,
        )
        assert np.abs(held.points - free.points).max() <= 1e-13


def test_inverted_body_is_moved_like_its_reverse(shell):
    part = bodies.moved(bodies.torus(9, 7), SHEAR)
    target = center(*part, shell) + [0.02, 0.01, 0.0]
    found, other = (
        balance(bodies.surface(each), upper(part), target, across=HORIZONTAL, shell=shell)
        for each in (part, bodies.inverted(part))
    )
    assert (
        np.abs(found.points - other.points).max() < 1e-12
        and np.abs(found.before - other.before).max() < 1e-12
    )


def test_willing_vertices_move_more():
    part = bodies.sphere(3)
    everything = np.arange(len(part[0]))
    willing = np.where(part[0][:, 0] > 0, 1.0, 0.1)
    found = balance(bodies.surface(part), everything, (0.01, 0.0, 0.0), weights=willing)
    lengths = np.linalg.norm(found.points - part[0], axis=1)
    assert lengths[part[0][:, 0] > 0.5].mean() > 5 * lengths[part[0][:, 0] < -0.5].mean()


def test_unreachable_point_is_refused():
    part = bodies.sphere(2)
    with refused("balance_folds_faces", "balance_short"):
        balance(bodies.surface(part), upper(part, 0.9), (5.0, 0.0, 0.0), across=HORIZONTAL)
    with refused("balance_folds_faces"):  # a limit that is not what stands against it is not blamed
        balance(bodies.surface(part), upper(part, 0.5), (0.0, 0.0, -0.5), limit=4.0, shell=True)


def test_a_shell_may_be_open():
    part = bodies.without(bodies.torus(9, 7), 3)
    target = center(*part, True) + [0.02, 0.01, 0.0]
    found = balance(bodies.surface(part), upper(part), target, across=HORIZONTAL, shell=True)
    assert np.abs((center(found.points, part[1], True) - target)[:2]).max() < 1e-13


@pytest.mark.parametrize("height", [1.0, 1e3, 1e6])
def test_point_in_reach_of_one_vertex_is_reached_at_any_distance(height):
    """A tetrahedron's center is a quarter of its height above its base."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.3, 0.0], [0.3, 0.3, 0.9]])
    body = Surface.from_triangles(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    found = balance(body, [3], [0.0, 0.0, height], across=np.eye(3)[2:])
    assert abs(found.points[3, 2] - 4.0 * height) <= 1e-14 * 4.0 * height


def test_one_vertex_cannot_move_the_center_every_way():
    flat = bodies.moved(bodies.box(), np.diag([1.0, 1.0, 1.0]))
    middle = np.concatenate([flat[0], [[0.5, 0.5, 1.0]]])
    top = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]
    part = middle, np.concatenate([np.delete(flat[1], bodies.TOP, axis=0), top])
    with refused("balance_no_effect"):
        balance(bodies.surface(part), np.array([8]), (0.6, 0.5, 0.5))
    two = [[4, 5, 8], [5, 7, 9], [5, 9, 8], [7, 6, 9], [6, 8, 9], [6, 4, 8]]
    part = (
        np.concatenate([flat[0], [[0.3, 0.4, 1.0], [0.7, 0.6, 1.0]]]),
        np.concatenate([part[1][:10], two]),
    )
    with refused("balance_no_effect"):
        balance(bodies.surface(part), np.array([8, 9]), (0.6, 0.5, 0.5))


def test_selection_without_faces_is_refused():
    points, triangles = bodies.sphere(1)
    points = np.concatenate([points, [[3.0, 0.0, 0.0]]])
    with refused("balance_no_effect"):
        balance(bodies.surface((points, triangles)), np.array([len(points) - 1]), (0.0, 0.0, 0.0))


def test_a_tiny_body_and_a_large_one_are_the_same_problem():
    part = bodies.moved(bodies.torus(9, 7), SHEAR)
    shapes = []
    for scale in (1e-5, 1.0, 1e4, 1e20):
        body = part[0] * scale, part[1]
        target = center(*body) + np.array([0.02, 0.01, 0.0]) * scale
        shapes.append(balance(bodies.surface(body), upper(part), target).points / scale)
    assert all(np.abs(shape - shapes[1]).max() < 1e-8 for shape in shapes)


@pytest.mark.parametrize("sides", [4, 5, 8])
def test_moves_are_independent_of_face_diagonals(shell, sides):
    angle = np.arange(sides) * 2 * np.pi / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([np.column_stack([ring, np.full(sides, z)]) for z in (0.0, 1.0, 2.0)])
    faces = [list(range(sides))[::-1], list(range(2 * sides, 3 * sides))]
    faces += [
        [k + i, k + (i + 1) % sides, k + sides + (i + 1) % sides, k + sides + i]
        for k in (0, sides)
        for i in range(sides)
    ]
    fans = _Fans(bodies.mesh(points, faces), shell)
    gradient = fans.center_gradient(np.array([0.0, 0.0, 1.0]))
    # y → -y
    mirror = np.concatenate([k + (-np.arange(sides)) % sides for k in (0, sides, 2 * sides)])
    flip = np.diag([1.0, -1.0, 1.0])
    assert np.abs(flip @ gradient[mirror] @ flip - gradient).max() < 1e-14
    turned = np.concatenate([k + (np.arange(sides) + 1) % sides for k in (0, sides, 2 * sides)])
    turn = np.array(
        [
            [np.cos(angle[1]), -np.sin(angle[1]), 0],
            [np.sin(angle[1]), np.cos(angle[1]), 0],
            [0, 0, 1],
        ]
    )
    assert np.abs(turn @ gradient @ turn.T - gradient[turned]).max() < 1e-14
    assert np.abs(fans.areas - fans.areas[turned]).max() < 1e-14


def test_concave_face_pulls_by_its_true_area(shell):
    outline = np.array([[0, 0], [2, 0], [2, 1], [1, 0.2], [0, 1]], float)
    points = np.concatenate([np.column_stack([outline, np.full(5, z)]) for z in (0.0, 1.0)])
    faces = [[0, 4, 3, 2, 1], [5, 6, 7, 8, 9]] + [
        [i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5] for i in range(5)
    ]
    cut = np.array([[3, 0, 1], [3, 1, 2], [3, 4, 0]])
    triangles = np.concatenate([cut[:, ::-1], cut + 5, bodies.split(faces[2:])])
    owner = np.array([0] * 3 + [1] * 3 + [2, 2, 3, 3, 4, 4, 5, 5, 6, 6])
    fans = _Fans(Surface(points, triangles, triangle_faces=owner), shell)
    assert fans.opposed.sum() > 0 or not shell
    middle = center(points, triangles, shell)
    total = fans.center_gradient(middle).sum(axis=0)
    assert np.abs(total - np.eye(3)).max() < 1e-14  # moving everything moves the center as far
    turned = np.einsum("nik,nk->i", fans.center_gradient(middle), np.cross([0, 0, 1.0], points))
    assert np.abs(turned - np.cross([0, 0, 1.0], middle)).max() < 1e-14
    assert (
        abs(
            fans.areas.sum()
            - polyhedron_moments(bodies.surface((points, triangles)), area_order=0)[1].total
        )
        < 1e-14
    )


@pytest.mark.parametrize("far", [0.0, 1e3])
def test_a_body_without_volume_has_no_center_to_move(far):
    flat = bodies.moved(bodies.box(), np.diag([1.0, 1.0, 0.0]), (0.0, 0.0, far))
    with refused("no_certain_volume"):
        balance(bodies.surface(flat), np.arange(8), (0.6, 0.5, far), across=HORIZONTAL)
    assert (
        balance(
            bodies.surface(flat), np.arange(8), (0.6, 0.5, far), across=HORIZONTAL, shell=True
        ).after[0]
        > 0.59
    )
