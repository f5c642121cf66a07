# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitted colliders, pieces and distances, against closed forms and an independent check of sampled
points.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from body_moments.core.colliders import Wanted, distances, make_colliders
from body_moments.core.colliders.convex_pieces import cut_into_pieces
from body_moments.core.inertia import MassProperties
from body_moments.core.mesh import Surface, convex_hull
from body_moments.core.numerics import spread_directions
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots import Pose, Shape, moments_of
from body_moments.core.verdict import MeasureError

from tests.core import bodies
from tests.core.steps import run

TURN = bodies.rotation(3)
L_POINTS = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]], float)
PLACES = {"here": (1.0, 0.0), "tiny": (1e-5, 0.0), "huge": (1e4, 0.0), "far": (1.0, 1000.0)}


def prism(outline, lid, height=1.0):
    count = len(outline)
    points = np.concatenate([np.column_stack([outline, np.full(count, z)]) for z in (0.0, height)])
    i, lid = np.arange(count), np.array(lid)
    j = (i + 1) % count
    sides = [np.stack([i, j, j + count], axis=1), np.stack([i, j + count, i + count], axis=1)]
    return points, np.concatenate([lid[:, ::-1], lid + count, *sides])


L_SHAPE = prism(L_POINTS, [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]])
TORUS = bodies.torus(24, 12, minor=0.35)


def make(part, shape, outward=0.0, inward=0.0, pieces=16, vertices=64):
    surface = Surface.from_triangles(*part)
    body = MassProperties.from_moments(polyhedron_moments(surface)[0], 1000.0)
    return run(make_colliders(surface, body, Wanted(shape, outward, inward, pieces, vertices)))


def volumes(shapes):
    return [float(moments_of(shape).total) for shape in shapes]


def turned(part, scale=1.0, offset=0.0):
    return scale * (part[0] @ TURN.T + offset), part[1]


def points_inside(part, count):
    """Return random points of a body, by the parity of crossings of a ray with its triangles."""
    points, triangles = part
    rng = np.random.default_rng(0)
    places = rng.uniform(points.min(axis=0), points.max(axis=0), (3 * count, 3))
    crossings = np.zeros(len(places), int)
    for a, b, c in points[triangles]:
        first, second, offset = b - a, c - a, places - a
        det = first[0] * second[1] - first[1] * second[0]
        if det:
            u = (offset[:, 0] * second[1] - offset[:, 1] * second[0]) / det
            v = (first[0] * offset[:, 1] - first[1] * offset[:, 0]) / det
            above = u * first[2] + v * second[2] > offset[:, 2]
            crossings += (u > 0) & (v > 0) & (u + v < 1) & above
    return places[crossings % 2 == 1][:count]


def depth_outside(places, shapes):
    """Return how far places are outside the nearest of some hulls, by their planes."""
    nearest = np.full(len(places), np.inf)
    for shape in shapes:
        corners = shape.surface.points[shape.surface.triangles]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        height = places @ normal.T - (normal * corners[:, 0]).sum(axis=1)
        nearest = np.minimum(nearest, height.max(axis=1))
    return nearest


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("shape", ["box", "axes_box", "hull", "automatic"])
def test_turned_box_becomes_itself(shape, place):
    scale, offset = PLACES[place]
    part = turned(bodies.box((0, 0, 0), (1, 2, 3)), scale, offset)
    (collider,) = make(part, shape, 1e-3 * scale, 1e-3 * scale)
    assert volumes([collider])[0] == pytest.approx(6.0 * scale**3, rel=1e-6)
    assert collider.kind == ("mesh" if shape == "hull" else "box")


@pytest.mark.parametrize(
    ("shape", "volume"),
    [
        ("sphere", 4.0 / 3.0 * np.pi * 14.0**1.5 / 8.0),
        ("cylinder", np.pi * 13.0 / 4.0),  # as flat as it can be,
    ],
)
def test_round_shapes_of_a_box_have_closed_forms(shape, volume):
    shapes = make(turned(bodies.box((0, 0, 0), (1, 2, 3))), shape)
    assert volumes(shapes)[0] == pytest.approx(volume, rel=1e-6)


def test_automatic_prefers_the_simplest_shape_within_the_tolerance():
    ball = bodies.sphere(3)
    assert [shape.kind for shape in make(ball, "automatic", 0.05, 0.05)] == ["sphere"]
    assert [shape.kind for shape in make(L_SHAPE, "automatic", 0.01, 0.01)] == ["mesh", "mesh"]
    assert sum(volumes(make(L_SHAPE, "automatic", 0.01, 0.01))) == pytest.approx(5.0, rel=1e-6)


@pytest.mark.parametrize("kind", ["box", "ellipsoid", "capsule"])
def test_equal_inertia_shapes_keep_the_mass_of_the_body(kind):
    (shape,) = make(bodies.box((0, 0, 0), (1, 1, 3)), "equal_" + kind)
    assert shape.kind == kind
    assert shape.pose.position == pytest.approx((0.5, 0.5, 1.5), abs=1e-9)


@pytest.mark.parametrize("mirror", [1.0, -1.0])
@pytest.mark.parametrize("place", PLACES)
def test_pieces_of_an_l_are_two_exact_boxes(place, mirror):
    scale, offset = PLACES[place]
    points, triangles = turned(L_SHAPE, scale, offset)
    part = points * (mirror, 1.0, 1.0), triangles[:, :: int(mirror)]
    shapes = make(part, "pieces")
    assert len(shapes) == 2
    assert sum(volumes(shapes)) == pytest.approx(5.0 * scale**3, rel=1e-5)


@pytest.mark.parametrize(
    ("part", "pieces", "most"), [(L_SHAPE, 2, 1.001), (TORUS, 10, 1.1), (TORUS, 4, 1.35)]
)
def test_pieces_cover_the_body_and_keep_their_number(part, pieces, most):
    shapes = make(part, "pieces", pieces=pieces, vertices=256)
    assert len(shapes) <= pieces
    volume = polyhedron_moments(Surface.from_triangles(*part))[0].total
    assert 0.999 < sum(volumes(shapes)) / volume < most
    places = points_inside(part, 10_000)
    assert len(places) == 10_000
    assert depth_outside(places, shapes).max() < 1e-4


def test_cavity_stays_with_the_body_around_it():
    part = bodies.joined(
        bodies.box((0, 0, 0), (3, 3, 3)), bodies.inverted(bodies.box((1, 1, 1), (2, 2, 2)))
    )
    shapes = make(part, "pieces", pieces=8)
    assert depth_outside(points_inside(part, 2_000), shapes).max() < 1e-6
    assert 25.99 < sum(volumes(shapes)) < 27.01


def test_lids_with_points_of_their_own_close_the_body():
    points, triangles = L_SHAPE
    lids = np.isin(triangles, np.arange(6)).all(axis=1) | np.isin(triangles, np.arange(6, 12)).all(
        axis=1
    )
    part = (
        np.concatenate([points, points]),
        np.where(lids[:, None], triangles + len(points), triangles),
    )
    shapes = make(part, "pieces")
    assert len(shapes) == 2
    assert sum(volumes(shapes)) == pytest.approx(5.0, rel=1e-6)


def test_circumscribed_round_shapes_leave_nothing_outside():
    surface = Surface.from_triangles(*bodies.box((-1, -1, -1), (1, 1, 1)))
    for shape in (
        Shape("sphere", (3.0**0.5,)),
        Shape("cylinder", (2.0**0.5, 2.0)),
        Shape("capsule", (2.0**0.5, 2.0)),
    ):
        assert distances(surface, [shape])[1] == pytest.approx(0.0, abs=1e-12)


def test_separate_bodies_become_pieces_of_their_own():
    part = bodies.joined(bodies.box((0, 0, 0), (1, 1, 1)), bodies.box((5, 0, 0), (6, 1, 1)))
    assert sorted(volumes(make(part, "pieces"))) == pytest.approx([1.0, 1.0], rel=1e-6)


def test_distances_of_a_larger_box_are_its_corners():
    surface = Surface.from_triangles(*bodies.box((-1, -1, -1), (1, 1, 1)))
    outward, inward, bound = distances(surface, [Shape("box", (4.0, 4.0, 4.0))])
    assert outward == pytest.approx(3.0**0.5, abs=bound + 1e-12)
    assert inward == 0.0
    outward, inward, bound = distances(
        surface, [Shape("box", (1.0, 2.0, 2.0), Pose(np.array([-0.5, 0.0, 0.0])))]
    )
    assert outward == pytest.approx(0.0, abs=1e-9)
    assert inward == pytest.approx(1.0, abs=bound + 1e-9)


def test_slivers_along_an_edge_are_no_walls():
    """A triangle between the corners of an edge and a point on it closes the surface."""
    box = convex_hull(bodies.box((0, 0, 0), (1, 1, 1))[0])
    for seed in range(60):
        rng = np.random.default_rng(seed)
        points = box.points * rng.uniform(0.5, 2.0, 3)
        points = points + np.cross(3e-8 * rng.normal(size=3), points)
        first, second, third = np.roll(box.triangles[0], seed)
        points = np.concatenate([points, [0.4 * points[first] + 0.6 * points[second]]])
        split = [[first, 8, third], [8, second, third], [first, second, 8]]
        shape = Shape("mesh", surface=Surface(points, np.concatenate([box.triangles[1:], split])))
        assert max(distances(Surface(points[:8], box.triangles), [shape])[:2]) < 1e-10


def test_points_on_a_line_are_refused():
    line = np.linspace(0.0, 1.0, 4)[:, None] * np.ones(3), np.array([[0, 1, 2], [1, 2, 3]])
    body = MassProperties.from_moments(
        polyhedron_moments(Surface.from_triangles(*L_SHAPE))[0], 1000.0
    )
    with pytest.raises(MeasureError):
        run(make_colliders(Surface.from_triangles(*line), body, Wanted("hull", 0.0, 0.0, 4, 16)))


def test_steps_of_a_division_can_be_left_early():
    steps = cut_into_pieces(Surface.from_triangles(*TORUS), 0.0, 8, 64)
    assert 0.0 < next(steps) < 1.0
    steps.close()


def test_no_two_pieces_of_a_rock_have_a_common_hull_within_tolerance():
    directions = convex_hull(spread_directions(100))
    radius = 1.0 + 0.25 * np.sin(directions.points @ [[4, 1, 0], [0, -3, 5], [-6, 2, 2]]).sum(
        axis=1
    )
    rock = directions.points * radius[:, None], directions.triangles
    surface = Surface.from_triangles(*rock)
    shapes = make(rock, "automatic", outward=0.15, inward=0.002, pieces=32, vertices=255)
    assert len(shapes) > 1
    for one, other in combinations(shapes, 2):
        points = np.concatenate([one.surface.points, other.surface.points])
        hull = convex_hull(points)
        common = Shape("mesh", surface=Surface.from_triangles(hull.points, hull.triangles))
        assert distances(surface, [common])[0] > 0.149
