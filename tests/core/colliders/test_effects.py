# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Effects of colliders on the physics, and their corrected masses, against closed forms and
optimality conditions.
"""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import combinations
from math import cos, radians, sin

import numpy as np
import pytest
from body_moments.core.colliders.effects import correct_masses, effect, uniform_masses
from body_moments.core.inertia import combine
from body_moments.core.robots import Pose, Shape, moments_of
from body_moments.core.verdict import MeasureError


def box(sides, place=(0.0, 0.0, 0.0), degrees=0.0):
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return Shape(
        "box",
        tuple(sides),
        Pose(np.array(place, float), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])),
    )


def body_of(shapes, densities):
    return combine([(moments_of(shape), density) for shape, density in zip(shapes, densities)])


def with_masses(shapes, masses):
    return [replace(shape, mass=mass) for shape, mass in zip(shapes, masses)]


def random_boxes(count, offset=0.0, scale=1.0):
    rng = np.random.default_rng(count)
    return [
        box(
            scale * rng.uniform(0.1, 0.4, 3),
            scale * (rng.uniform(-1.0, 1.0, 3) + offset),
            rng.uniform(0.0, 90.0),
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("offset", [0.0, 1e4])
@pytest.mark.parametrize("scale", [1e-5, 1.0, 1e4])
def test_larger_box_has_closed_form_effect(scale, offset):
    sides, place = scale * np.array([1.0, 2.0, 3.0]), scale * (np.array([0.1, -0.2, 0.3]) + offset)
    body = body_of([box(sides, (scale * offset,) * 3)], [500.0])
    collider = [box(2.0 * sides, place, 30.0)]
    volume = 6.0 * scale**3
    result = effect(body, with_masses(collider, uniform_masses(500.0, collider)), volume)
    digits = 1e-12 * (1.0 + offset)
    assert result.volume_ratio == pytest.approx(8.0, rel=digits) == result.mass_ratio
    assert result.center_shift == pytest.approx(
        (0.1 * scale, -0.2 * scale, 0.3 * scale), rel=digits
    )
    assert result.moment_ratios == pytest.approx((32.0,) * 3, rel=digits)
    assert result.axes_turn == pytest.approx(radians(30.0), rel=10.0 * digits)
    json.dumps(result.as_record(), allow_nan=False)


def test_overlap_counts_twice_as_engines_count_it():
    body = body_of([box((1.0, 1.0, 1.0))], [1000.0])
    twice = with_masses(2 * [box((1.0, 1.0, 1.0))], [1000.0, 1000.0])
    assert effect(body, twice, 1.0).mass_ratio == pytest.approx(2.0, rel=1e-14)


def test_axes_of_symmetric_bodies_turn_by_their_fixed_axis():
    rod, cube = [box((1.0, 1.0, 3.0))], [box((2.0, 2.0, 2.0))]
    body = body_of(rod, [1.0])
    assert (
        effect(body, with_masses([box((1.0, 1.0, 3.0), degrees=20.0)], [3.0]), 3.0).axes_turn
        < 1e-12
    )
    assert effect(body, with_masses(cube, [8.0]), 3.0).axes_turn == 0.0
    across = replace(
        rod[0],
        pose=Pose(rotation=np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])),
        mass=3.0,
    )
    assert effect(body, [across], 3.0).axes_turn == pytest.approx(np.pi / 2.0, rel=1e-12)


@pytest.mark.parametrize("count", [10, 16, 40])
@pytest.mark.parametrize(("offset", "scale"), [(0.0, 1.0), (0.0, 1e-4), (1e3, 1.0)])
def test_ten_pieces_match_mass_center_and_inertia(count, offset, scale):
    shapes = random_boxes(count, offset, scale)
    body = body_of(shapes, np.random.default_rng(7).uniform(300.0, 1500.0, count))
    masses = correct_masses(body, shapes)
    result = effect(body, with_masses(shapes, masses), 1.0)
    assert min(masses) >= 0.0
    assert result.mass_ratio == pytest.approx(1.0, abs=1e-9)
    assert np.linalg.norm(result.center_shift) < 1e-9 * scale
    assert result.inertia_change < 1e-9


def test_four_pieces_match_mass_and_center():
    shapes = random_boxes(4)
    body = replace(body_of(shapes, [400.0, 900.0, 700.0, 500.0]), inertia=3.0 * np.eye(3))
    result = effect(body, with_masses(shapes, correct_masses(body, shapes)), 1.0)
    assert result.mass_ratio == pytest.approx(1.0, abs=1e-12)
    assert np.linalg.norm(result.center_shift) < 1e-9
    assert result.inertia_change > 0.1


def test_uniform_body_keeps_uniform_masses():
    shapes = random_boxes(20)
    expected = uniform_masses(800.0, shapes)
    assert correct_masses(body_of(shapes, [800.0] * 20), shapes) == pytest.approx(
        expected, rel=1e-9
    )


def test_corrected_masses_are_nearest_to_uniform():
    # Spheres along a line leave mass, center and one moment: every set of masses at zero is tried.
    shapes = [Shape("sphere", (0.2,), Pose(np.array([float(x), 0.0, 0.0]))) for x in range(6)]
    rows = np.array([[1.0, float(x), float(x * x)] for x in range(6)]).T
    body = body_of(shapes, [3000.0, 2500.0, 0.0, 10.0, 0.0, 500.0])
    masses = np.array(correct_masses(body, shapes))
    uniform = np.full(6, body.mass / 6.0)
    sums = rows @ [
        float(moments_of(s).total) * d
        for s, d in zip(shapes, (3000.0, 2500.0, 0.0, 10.0, 0.0, 500.0))
    ]
    least = np.inf
    for size in (3, 4, 5, 6):
        for free in map(list, combinations(range(6), size)):
            trial = np.zeros(6)
            part = rows[:, free]
            trial[free] = uniform[free] + part.T @ np.linalg.solve(
                part @ part.T, sums - part @ uniform[free]
            )
            if trial.min() >= -1e-9:
                least = min(least, float(((trial - uniform) ** 2).sum()))
    assert masses.min() == 0.0
    assert rows @ masses == pytest.approx(sums, rel=1e-9)
    assert ((masses - uniform) ** 2).sum() == pytest.approx(least, rel=1e-9)


def test_center_outside_all_pieces_comes_as_near_as_possible():
    shapes = [
        Shape("sphere", (0.1,), Pose(np.array(place)))
        for place in ((0.0, 0, 0), (1.0, 0, 0), (0, 1.0, 0))
    ]
    body = body_of([box((1.0, 1.0, 1.0), (2.0, 2.0, 0.0))], [1000.0])
    masses = correct_masses(body, shapes)
    assert masses == pytest.approx([0.0, 500.0, 500.0], abs=1e-6)
    result = effect(body, with_masses(shapes, masses), 1.0)
    assert result.center_shift == pytest.approx((-1.5, -1.5, 0.0), abs=1e-9)


def test_weightless_colliders_are_refused_by_name():
    body = body_of([box((1.0, 1.0, 1.0))], [1000.0])
    with pytest.raises(MeasureError) as refused:
        effect(body, with_masses([box((1.0, 1.0, 1.0))], [0.0]), 1.0)
    assert refused.value.finding.code == "colliders_flat"
    with pytest.raises(MeasureError):
        correct_masses(body, [box((1.0, 1.0, 0.0))])
