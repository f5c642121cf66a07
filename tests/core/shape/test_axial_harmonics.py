# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Axes of prisms with seven sides and more: harmonics in exact arithmetic, frames of turned copies,
groups.
"""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.shape import equivalent_frames, nearest_frame, symmetry
from body_moments.core.shape.axial_harmonics import axial_harmonics, axis_last, turn_by_harmonics

from tests.close import close
from tests.core import bodies, shapes
from tests.core.recursion import moments


def harmonics_of(part, center, frame, area=False, **more):
    return axial_harmonics(
        [Surface.from_triangles(*part)], np.asarray(center, float), frame, area=area, **more
    )


def exact_mean(corners, m, k):
    """E[(x+iy)^m z^k] over a simplex, as a sum over all ways to share m + k factors out among its
    corners.
    """
    count = len(corners)
    total = [Fraction(0), Fraction(0)]
    factors = [(0, 1)] * m + [(2,)] * k

    def walk(i, uses, real, imaginary):
        if i == len(factors):
            weight = Fraction(
                math.prod(math.factorial(use) for use in uses) * math.factorial(count - 1)
            )
            weight /= math.factorial(len(factors) + count - 1)
            total[0] += weight * real
            total[1] += weight * imaginary
            return
        for j, corner in enumerate(corners):
            more = (*uses[:j], uses[j] + 1, *uses[j + 1 :])
            if factors[i] == (2,):
                walk(i + 1, more, real * corner[2], imaginary * corner[2])
            else:
                walk(
                    i + 1,
                    more,
                    real * corner[0] - imaginary * corner[1],
                    real * corner[1] + imaginary * corner[0],
                )

    walk(0, (0,) * count, Fraction(1), Fraction(0))
    return complex(*map(float, total))


@pytest.mark.parametrize("area", [False, True])
def test_harmonics_match_exact_arithmetic(area):
    corners = [(0, 0, 0), (3, 1, 0), (1, 2, -1), (0, 1, 3)]
    part = np.array(corners, float), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    found = harmonics_of(part, (0, 0, 0), np.eye(3), area, order=5)
    reach, height = math.hypot(3, 1), 3.0
    pieces = [[corners[i] for i in triangle] for triangle in part[1]] if area else [corners]
    sizes = [
        np.linalg.norm(np.cross(*(np.subtract(piece[k], piece[0]) for k in (1, 2))))
        if area
        else 1.0
        for piece in pieces
    ]
    for k in (0, 1):
        for m in range(1, 6):
            exact = [
                exact_mean([tuple(map(Fraction, corner)) for corner in piece], m, k)
                for piece in pieces
            ]
            mean = np.dot(exact, sizes) / sum(sizes) / (reach**m * height**k)
            assert abs(found.values[k, m] - mean) < 1e-14


def test_harmonics_in_another_frame_match_a_direct_computation():
    part = bodies.moved(shapes.prism(9, top=0.3, twist=0.2), bodies.rotation(2))
    base = bodies.rotation(2)
    first = harmonics_of(part, (0, 0, 0), base)
    turn = np.array([[np.cos(1.1), -np.sin(1.1), 0], [np.sin(1.1), np.cos(1.1), 0], [0, 0, 1]])
    for frame in (base @ turn, base * (1, -1, -1), base @ turn * (-1, 1, -1)):
        np.testing.assert_allclose(
            first.in_frame(frame).values, harmonics_of(part, (0, 0, 0), frame).values, atol=1e-14
        )
    image = -part[0], part[1][:, ::-1]
    np.testing.assert_allclose(
        first.inverted().values, harmonics_of(image, (0, 0, 0), base).values, atol=1e-14
    )


def posed(part):
    """The points in the body's own frame, and the equivalent frames."""
    center = moments(part, 1).center
    alike = equivalent_frames(moments(part, 6))
    assert len(alike.revolution_axes) == 1
    alike = turn_by_harmonics(alike, harmonics_of(part, center, axis_last(alike)))
    return (part[0] - center) @ nearest_frame(alike, np.eye(3)), alike


def apart(first, second):
    """Return the largest distance of a point from its nearest neighbor among others."""
    return np.linalg.norm(first[:, None] - second, axis=2).min(axis=1).max()


@pytest.mark.parametrize(
    "part, count",
    [
        *((shapes.prism(n), 2 * n) for n in (7, 8, 12, 20, 30)),
        (shapes.antiprism(8), 16),
        (shapes.prism(9, top=0.3), 9),
        (shapes.prism(9, twist=0.1), 18),
    ],
)
def test_turned_copies_of_a_prism_have_one_pose(part, count):
    part = part[0] * (1.0, 1.0, 1.3), part[1]
    expected, alike = posed(part)
    assert len(alike.frames) == count and not alike.revolution_axes
    for seed in range(4):
        copy = bodies.moved(part, bodies.rotation(seed), (4 * seed, 5, 6))
        found, alike = posed(copy)
        assert len(alike.frames) == count
        assert apart(found, expected) < 1e-5
        found, _ = posed((copy[0].astype(np.float32).astype(float), copy[1]))
        assert apart(found, expected) < 1e-5


def test_two_harmonics_without_a_common_divisor_leave_one_frame():
    """Seven waves and eight of them around a cone: no turn takes the body to itself, nor does any
    moment to order six say how it is turned.
    """
    points, triangles = shapes.prism(360, top=0.5)
    angle = np.arctan2(points[:, 1], points[:, 0])
    waves = 1.0 + 2e-3 * (np.cos(7 * angle) + np.cos(8 * angle + 0.5))
    part = points * np.stack([waves, waves, np.ones(len(waves))], axis=1), triangles
    expected, alike = posed(part)
    assert len(alike.frames) == 1
    for seed in range(4):
        found, alike = posed(bodies.moved(part, bodies.rotation(seed), (1, 2, 3)))
        assert len(alike.frames) == 1 and np.abs(found - expected).max() < 1e-4


@pytest.mark.parametrize("name", shapes.ROUND)
def test_the_group_of_a_prism_is_its_own_by_harmonics(name):
    part, group, exact = shapes.ROUND[name]
    image = bodies.moved(part, bodies.rotation(5), (1, 2, 3))
    center = moments(image, 1).center
    found = symmetry(moments(image, 6), axial=lambda frame: harmonics_of(image, center, frame))
    assert (found.group, found.order) == (exact, 30)
    assert symmetry(moments(image, 6)).group == group and symmetry(moments(image, 6)).order == 6


def test_body_without_harmonics_to_order_30_is_round():
    part = shapes.prism(32)
    alike = equivalent_frames(moments(part, 6))
    harmonics = harmonics_of(part, moments(part, 1).center, axis_last(alike))
    assert turn_by_harmonics(alike, harmonics) is alike
    found = symmetry(moments(part, 6), axial=harmonics.in_frame)
    assert (found.group, found.order) == ("D∞h", 30)


def test_sheets_have_harmonics_of_their_area():
    part = shapes.prism(8)
    sides = bodies.without(part, *range(12))
    found = harmonics_of(sides, (0, 0, 0.85), np.eye(3), True)
    assert abs(found.values[0, 8]) > 1e-2 and np.abs(found.values[0, 1:8]).max() < 1e-14
    assert close(found.values[0, 0].real, 1.0, rel=1e-14)


def test_uncertain_axis_has_no_harmonics():
    """About one that leans a little the prism is the same by none of its turns."""
    part = shapes.prism(7)
    alike = equivalent_frames(moments(part, 6))
    harmonics = harmonics_of(part, moments(part, 1).center, axis_last(alike))
    assert not turn_by_harmonics(alike, harmonics).revolution_axes
    leaning = replace(alike, tilt=0.02)
    assert turn_by_harmonics(leaning, harmonics) is leaning
