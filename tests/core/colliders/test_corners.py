# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moved corners of hulls: mass, center and inertia of the body, convex, within the limit, in any
place and size.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.colliders import effect, effects, uniform_masses
from body_moments.core.inertia import MassProperties
from body_moments.core.mesh import Surface, convex_hull
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots.model import Pose, Shape
from body_moments.core.verdict import MeasureError

from tests.core import bodies
from tests.core.steps import run

L_SHAPE = bodies.joined(bodies.box((0, 0, 0), (3, 1, 1)), bodies.box((0, 1, 0), (1, 3, 1)))

LEGS = [bodies.box((x, y, 0), (x + 0.1, y + 0.1, 0.5)) for x in (0.0, 0.4) for y in (0.0, 0.4)]
CHAIR = bodies.joined(
    *LEGS, bodies.box((0, 0, 0.5), (0.5, 0.5, 0.55)), bodies.box((0, 0, 0.55), (0.05, 0.5, 1))
)


def correct_vertices(*arguments):
    return run(effects.correct_vertices(*arguments))


def hull_shape(points):
    hull = convex_hull(points)
    return Shape("mesh", surface=Surface(hull.points, hull.triangles))


def two_boxes(scale=1.0, offset=0.0):
    """Two boxes that are slightly larger than those of the L."""
    boxes = bodies.box((0, 0, 0), (3.1, 1, 1))[0], bodies.box((0, 1, 0), (1, 3.05, 1.02))[0]
    return [hull_shape(scale * (points + offset)) for points in boxes]


def placed(part, scale=1.0, offset=0.0):
    surface = Surface(scale * (part[0] + offset), part[1])
    volume = polyhedron_moments(surface)[0]
    return surface, MassProperties.from_moments(volume, 700.0), volume.total


def effect_of(shapes, body, volume, density=700.0):
    return effect(
        body, [replace(s, mass=m) for s, m in zip(shapes, uniform_masses(density, shapes))], volume
    )


def motion(before, after):
    """Return the largest distance from a corner to the nearest corner before."""
    gaps = [
        np.linalg.norm(new.surface.points[:, None] - old.surface.points, axis=2).min(axis=1).max()
        for old, new in zip(before, after)
    ]
    return float(max(gaps))


@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-4, 0.0), (1e3, 0.0), (1.0, 1000.0)])
def test_moved_corners_give_the_mass_properties_of_the_body(scale, offset):
    surface, body, volume = placed(L_SHAPE, scale, offset)
    shapes = two_boxes(scale, offset)
    moved = correct_vertices(body, shapes, surface, 0.2 * scale, 0.3 * scale)
    result = effect_of(moved, body, volume)
    assert effect_of(shapes, body, volume).inertia_change > 0.05
    assert result.mass_ratio == pytest.approx(1.0, abs=1e-6)
    assert np.linalg.norm(result.center_shift) < 1e-6 * scale
    assert result.inertia_change < 1e-6
    assert motion(shapes, moved) < 0.1 * scale  # The larger box is too long by as much.
    for shape in moved:
        assert len(convex_hull(shape.surface.points).points) == len(shape.surface.points)
        assert polyhedron_moments(shape.surface)[0].total > 0.0


def test_exact_hulls_stay_where_they_are():
    surface, body, _ = placed(L_SHAPE)
    shapes = [
        hull_shape(bodies.box(*box)[0]) for box in (((0, 0, 0), (3, 1, 1)), ((0, 1, 0), (1, 3, 1)))
    ]
    assert motion(shapes, correct_vertices(body, shapes, surface, 0.1, 0.1)) < 1e-9


def test_no_corner_moves_beyond_the_smaller_tolerance():
    surface, body, volume = placed(L_SHAPE)
    shapes = [hull_shape(L_SHAPE[0])]
    moved = correct_vertices(body, shapes, surface, 0.05, 0.2)
    assert motion(shapes, moved) <= 0.05 + 1e-9
    before, after = (
        effect_of(these, body, volume, body.mass / sum(uniform_masses(1.0, these)))
        for these in (shapes, moved)
    )
    assert after.inertia_change < 0.9 * before.inertia_change


@pytest.mark.parametrize("part", [L_SHAPE, CHAIR])
def test_single_hull_of_concave_body_takes_another_density(part):
    surface, body, volume = placed(part)
    size = np.ptp(part[0])
    moved = correct_vertices(body, [hull_shape(part[0])], surface, 0.2 * size, 0.2 * size)
    density = body.mass / sum(uniform_masses(1.0, moved))
    result = effect_of(moved, body, volume, density)
    assert density < 0.9 * 700.0
    assert np.linalg.norm(result.center_shift) < 1e-6 * size and result.inertia_change < 1e-6
    assert motion([hull_shape(part[0])], moved) <= 0.2 * size


def test_primitives_stay_and_hulls_take_their_part():
    surface, body, volume = placed(L_SHAPE)
    box = Shape("box", (3.0, 1.0, 1.0), Pose(np.array([1.5, 0.5, 0.5])))
    turned = two_boxes()[1]
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    local = (turned.surface.points - 2.0) @ turn / 2.0
    placed_hull = Shape(
        "mesh", (2.0, 2.0, 2.0), Pose(np.full(3, 2.0), turn), surface=hull_shape(local).surface
    )
    moved = correct_vertices(body, [box, placed_hull], surface, 0.2, 0.2)
    assert moved[0] is box
    assert effect_of(moved, body, volume).inertia_change < 1e-6
    assert correct_vertices(body, [box], surface, 0.2, 0.2) == [box]


def test_mirrored_bodies_have_mirrored_corners():
    mirror = np.array([-1.0, 1.0, 1.0])
    surface, body, _ = placed(L_SHAPE)
    mirrored, mirrored_body, _ = placed((L_SHAPE[0] * mirror, L_SHAPE[1][:, ::-1]))
    shapes = two_boxes()
    moved = correct_vertices(body, shapes, surface, 0.2, 0.2)
    images = [hull_shape(shape.surface.points * mirror) for shape in shapes]
    for one, image in zip(moved, correct_vertices(mirrored_body, images, mirrored, 0.2, 0.2)):
        volumes = [polyhedron_moments(shape.surface)[0].total for shape in (one, image)]
        assert volumes[0] == pytest.approx(volumes[1], rel=1e-3)


def test_flat_hull_is_refused():
    surface, body, _ = placed(L_SHAPE)
    line = np.linspace(0.0, 1.0, 4)[:, None] * np.ones(3)
    with pytest.raises(MeasureError):
        correct_vertices(
            body,
            [Shape("mesh", surface=Surface(line, np.array([[0, 1, 2], [1, 2, 3]])))],
            surface,
            1.0,
            1.0,
        )
