# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Section properties against the closed forms of engineers' tables, in planes of any position."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.flat import Plane, fit_plane, measure_section, region
from body_moments.core.flat.polygon import (
    OutlineDefects,
    directed_edges,
    find_defects,
    orient_loops,
)
from body_moments.core.verdict import MeasureError
from hypothesis import given

from tests.close import close
from tests.core import bodies, rational
from tests.core.findings import refused
from tests.core.polygons import rectangle, shape
from tests.core.strategies import holds, seeds

LEVEL = Plane(np.zeros(3), np.eye(3), 0.0, "X")


def lifted(points):
    return np.column_stack([points, np.zeros(len(points))])


def measured(*outlines, offset=(0.0, 0.0)):
    points, loops = shape(*outlines)
    points = points + offset
    assert find_defects(points, orient_loops(points, loops)) == OutlineDefects(0, False, False)
    return measure_section(LEVEL, lifted(points), orient_loops(points, loops))


def i_beam(b=0.1, h=0.2, web=0.0056, flange=0.0085):
    """An I section without fillets, its centroid at the origin."""
    w, t, x, y = web / 2, h / 2 - flange, b / 2, h / 2
    return [
        (-x, -y),
        (x, -y),
        (x, -t),
        (w, -t),
        (w, t),
        (x, t),
        (x, y),
        (-x, y),
        (-x, t),
        (-w, t),
        (-w, -t),
        (-x, -t),
    ]


OFFSETS = [(0.0, 0.0), (3.0, -7.0), (1e4, 2e4)]


def near(value, truth, offset=(0.0, 0.0), size=1.0):
    """Coordinates that were rounded when they were moved away are exact for another body."""
    return close(value, truth, rel=1e-14 + 1e-15 * max(map(abs, offset)) / size)


@pytest.mark.parametrize("offset", OFFSETS)
def test_rectangle_section_matches_closed_form(offset):
    section = measured(rectangle(0, 0, 3, 8), offset=offset)
    assert near(section.area, 24) and near(section.perimeter, 22)
    assert close(section.centroid, np.add((1.5, 4), offset), rel=1e-14)
    assert near(section.second[0], 3 * 8**3 / 12, offset) and near(
        section.second[1], 8 * 3**3 / 12, offset
    )
    assert abs(section.second[2]) <= section.rounding_error["second"]
    assert close(section.principal, (128, 18), rel=1e-14) and section.angle == 0.0
    assert near(section.polar, 146, offset)
    assert close(section.radii, [8 / 12**0.5, 3 / 12**0.5] * 2, rel=1e-13)
    assert section.moduli == pytest.approx([32, 12, 32, 12], rel=1e-12)
    assert (section.outlines, section.holes) == (1, 0)


@pytest.mark.parametrize("offset", OFFSETS)
def test_rectangle_with_eccentric_hole_matches_closed_form(offset):
    section = measured(rectangle(0, 0, 6, 10), rectangle(1, 1, 2, 3), offset=offset)
    area, x, y = 54.0, (60 * 3 - 6 * 2) / 54, (60 * 5 - 6 * 2.5) / 54
    truth = (
        6 * 10**3 / 12 + 60 * (5 - y) ** 2 - 2 * 3**3 / 12 - 6 * (2.5 - y) ** 2,
        10 * 6**3 / 12 + 60 * (3 - x) ** 2 - 3 * 2**3 / 12 - 6 * (2 - x) ** 2,
        60 * (3 - x) * (5 - y) - 6 * (2 - x) * (2.5 - y),
    )
    assert near(section.area, area) and (section.outlines, section.holes) == (1, 1)
    assert close(section.centroid, np.add((x, y), offset), rel=1e-14)
    assert section.second == pytest.approx(truth, rel=1e-13 + 1e-15 * max(map(abs, offset)))
    mean, radius = (truth[0] + truth[1]) / 2, math.hypot((truth[0] - truth[1]) / 2, truth[2])
    assert section.principal == pytest.approx((mean + radius, mean - radius), rel=1e-12)
    assert math.tan(2 * section.angle) == pytest.approx(
        -2 * truth[2] / (truth[0] - truth[1]), rel=1e-9
    )


def test_an_equal_angle_has_its_strong_axis_at_minus_45_degrees():
    a, t = 0.1, 0.01
    section = measured([(0, 0), (a, 0), (a, t), (t, t), (t, a), (0, a)])
    area = t * (2 * a - t)
    center = (a * a + a * t - t * t) / (2 * (2 * a - t))
    assert near(section.area, area)
    assert close(section.centroid, (center, center), rel=1e-13)
    legs = [(a, t, a / 2, t / 2), (t, a - t, t / 2, (a + t) / 2)]
    second = sum(w * h**3 / 12 + w * h * (y - center) ** 2 for w, h, _, y in legs)
    product = sum(w * h * (x - center) * (y - center) for w, h, x, y in legs)
    assert close(section.second, (second, second, product), rel=1e-12)
    # I_xy is negative, so axis 1, about which the second moment is largest, is at +45°: the angle's
    # line of symmetry
    assert product < 0.0 and section.angle == pytest.approx(math.pi / 4, abs=1e-12)
    assert close(section.principal, (second - product, second + product), rel=1e-12)


def test_triangle_section_modulus_uses_the_farther_corner():
    b, h = 3.0, 2.0
    section = measured([(0, 0), (b, 0), (0, h)])
    assert near(section.area, b * h / 2) and close(section.centroid, (b / 3, h / 3), rel=1e-14)
    assert close(section.second, (b * h**3 / 36, h * b**3 / 36, -(b * b) * h * h / 72), rel=1e-13)
    assert close(section.moduli[:2], (b * h**2 / 24, h * b**2 / 24), rel=1e-13)


def test_polygon_converges_to_the_circle_quadratically():
    errors = []
    for n in (50, 100):
        angle = 2 * np.pi * np.arange(n) / n
        section = measured(np.stack([np.cos(angle), np.sin(angle)], axis=1) * 0.5)
        assert section.axes_undetermined and section.angle == 0.0
        truth = {"area": math.pi / 4, "polar": math.pi / 32, "perimeter": math.pi}
        errors.append([1.0 - getattr(section, name) / value for name, value in truth.items()])
    assert np.array(errors[0]) / errors[1] == pytest.approx([4.0] * 3, rel=0.01)


@pytest.mark.parametrize("angle", [-80, -45, -10, 0, 30, 60, 89, 90])
def test_the_strong_axis_turns_with_the_section_and_never_flips(angle):
    turn = np.radians(angle)
    matrix = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    section = measured(np.array(i_beam()) @ matrix.T)
    assert math.degrees(section.angle) == pytest.approx(angle, abs=1e-9)
    assert close(section.principal, measured(i_beam()).principal, rel=1e-12)


@pytest.mark.parametrize("size", [1e-6, 1e4])
@pytest.mark.parametrize("offset", OFFSETS)
def test_bounds_hold_against_rationals(size, offset):
    points, loops = shape(np.array(i_beam()) @ np.array([[0.9, 0.2], [-0.4, 1.3]]).T * size)
    points = points + np.array(offset) * size
    edges = orient_loops(points, loops)
    section = measure_section(LEVEL, lifted(points), edges)
    exactly = rational.fractions(points)
    area, *first = (
        rational.enclosed(exactly, edges.tolist(), row) for row in ((0, 0), (1, 0), (0, 1))
    )
    center = [value / area for value in first]
    central = [tuple(x - c for x, c in zip(p, center)) for p in exactly]
    second = [rational.enclosed(central, edges.tolist(), row) for row in ((0, 2), (2, 0), (1, 1))]
    assert abs(Fraction(section.area) - area) <= Fraction(section.rounding_error["area"])
    drift = math.hypot(*(float(Fraction(c) - t) for c, t in zip(section.centroid, center)))
    assert drift <= section.rounding_error["centroid"]
    for value, truth in zip(section.second, second):
        assert abs(Fraction(value) - truth) <= Fraction(section.rounding_error["second"])
    away = max(1.0, max(map(abs, offset)))
    assert section.rounding_error["area"] < 1e-10 * section.area * away
    assert section.rounding_error["second"] < 1e-11 * max(section.second[:2]) * away


def test_float32_coordinates_move_a_section_within_its_bound():
    rng = np.random.default_rng(0)
    points, loops = shape(np.array(i_beam()) + 3.0)
    edges = orient_loops(points, loops)
    step = 1e-7
    section = measure_section(LEVEL, lifted(points), edges, error=step)
    for _ in range(50):
        moved = measure_section(
            LEVEL, lifted(points + rng.choice([-step, step], size=points.shape)), edges
        )
        assert abs(moved.area - section.area) <= section.input_error["area"]
        assert np.hypot(*(moved.centroid - section.centroid)) <= section.input_error["centroid"]
        assert np.abs(moved.second - section.second).max() <= section.input_error["second"]
        assert abs(moved.perimeter - section.perimeter) <= section.input_error["perimeter"]


SQUARE = (lifted(np.array(rectangle(0, 0, 1, 1), float)), np.array([[0, 1, 2], [0, 2, 3]]))


@holds(4)
@given(seed=seeds)
def test_section_in_any_plane_keeps_its_flat_properties(seed):
    rotation, offset = bodies.rotation(seed), np.array([5.0, -3.0, 8.0])
    flat, loops = shape(i_beam())
    edges = orient_loops(flat, loops)
    points = lifted(flat) @ rotation.T + offset
    triangles = np.array([[0, 1, 2], [0, 2, 11], [6, 7, 8], [5, 6, 8]])
    plane = fit_plane(points, triangles, rotation, offset)
    assert plane.x_axis_name == "X" and np.abs(plane.axes - rotation).max() < 1e-13
    assert np.linalg.det(plane.axes) == pytest.approx(1.0, abs=1e-14)
    section = measure_section(plane, points, edges)
    truth = measured(i_beam())
    assert close(section.area, truth.area, rel=1e-12)
    assert close(section.second[:2], truth.second[:2], rel=1e-12)
    assert section.center == pytest.approx(offset, abs=1e-14)


def test_plane_faces_as_most_faces_and_near_preferred_axes():
    points, triangles = SQUARE
    assert fit_plane(points, triangles, np.eye(3), np.zeros(3)).axes[:, 2] == pytest.approx(
        [0, 0, 1]
    )
    down = fit_plane(points, triangles[:, ::-1], np.eye(3), np.zeros(3))
    assert down.axes == pytest.approx(np.diag([1.0, -1.0, -1.0])) and down.x_axis_name == "X"
    # in the plane of y, z
    upright = fit_plane(points[:, [2, 0, 1]], triangles, np.eye(3), np.array([9.0, 1.0, 1.0]))
    assert upright.x_axis_name == "Y" and upright.axes[:, 0] == pytest.approx([0, 1, 0])
    assert upright.origin == pytest.approx([0, 1, 1])


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (100.0, -50.0, 30.0)])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_points_off_the_plane_are_refused_relative_to_size(size, place):
    points, triangles = SQUARE
    bent = points.copy()
    bent[2, 2] = 2e-6
    assert fit_plane(bent * size, triangles, np.eye(3), np.zeros(3)).out_of_plane > 0.0
    bent[2, 2] = 1e-3
    with pytest.raises(MeasureError) as refusal:
        fit_plane((bent + place) * size, triangles, np.eye(3), np.zeros(3))
    (code, share), normal = (
        (refusal.value.finding.code, refusal.value.finding.values["share"]),
        [-1e-3, -1e-3, 2.0],
    )
    heights = bent @ normal / np.linalg.norm(normal)
    assert code == "section_not_flat" and close(
        share, np.ptp(heights) / 2.0 / np.sqrt(2.0 + 1e-6), rel=1e-9
    )
    assert (
        fit_plane(bent * size, triangles, np.eye(3), np.zeros(3), error=1e-3 * size).out_of_plane
        > 0.0
    )


def test_section_without_area_is_refused():
    points = np.array([[0.0, 0, 0], [1, 1, 0], [2, 2, 0]])
    for triangles in ([[0, 1, 2]], np.zeros((0, 3), int)):
        with refused("no_section_area"):
            fit_plane(points, triangles, np.eye(3), np.zeros(3))
    for edges in ([[0, 1], [1, 0]], np.zeros((0, 2), np.intp)):
        with refused("no_section_area"):
            measure_section(LEVEL, points, np.array(edges))
    # flat, and an outside
    for outline in (
        [(0, 0), (1, 1), (3, 3)],
        [(0, 0), (0, 2), (2, 2), (2, 0)],
    ):
        with refused("no_section_area"):
            measure_section(
                LEVEL, lifted(np.array(outline, float)), directed_edges([range(len(outline))])
            )


@pytest.mark.parametrize("error, turned", [(0.0, 1), (1e-7, 0)])
def test_slivers_have_no_side_to_look_to(error, turned):
    points = lifted(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, -1e-7]]))
    triangles = np.array([[0, 1, 2], [0, 1, 3]])
    assert region(LEVEL, points, triangles, np.arange(2), error)[1] == turned


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**15])
def test_section_scaled_by_a_power_of_two_scales_exactly(scale):
    points, loops = shape([(3, 1), (9, 1), (9, 3), (5, 4), (4, 8), (3, 8)], rectangle(4, 2, 1, 1))
    points, edges = (
        np.column_stack([points, np.full(len(points), 2.0)]),
        orient_loops(points, loops),
    )
    plane = Plane(np.array([0.0, 0.5, 2.0]), np.eye(3), 0.0, "X")
    one, other = (
        measure_section(
            replace(plane, origin=plane.origin * size),
            points * size,
            edges,
            1e-5 * size,
            0.25 * size,
        )
        for size in (1.0, scale)
    )
    for name, power in (
        ("area", 2),
        ("perimeter", 1),
        ("centroid", 1),
        ("second", 4),
        ("reach", 1),
    ):
        assert np.array_equal(getattr(other, name), getattr(one, name) * scale**power), name
    for name, power in (("area", 2), ("perimeter", 1), ("centroid", 1), ("second", 4)):
        for bound in ("rounding_error", "input_error"):
            assert close(
                getattr(other, bound)[name], getattr(one, bound)[name] * scale**power, 1e-13
            ), name
    assert other.angle == one.angle != 0.0


def tilted_strip(height=0.0):
    """(points, triangles, unit normal) of four triangles, one of which looks the other way, none of
    them at the origin; height: of one corner over the others.
    """
    turn = bodies.rotation(3)
    flat = np.array([[0, 0, 0], [4, 0, 0], [4, 1, 0], [0, 1, 0], [4, 2, height], [9, 9, 9]])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [3, 2, 4], [1, 0, 2]])
    return flat @ turn.T + (20.0, -30.0, 10.0), triangles, turn[:, 2]


@pytest.mark.parametrize("facing", [None, (0.1, 0.2, 0.3), (-0.1, -0.2, -0.3)])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
def test_plane_lies_amid_its_points_for_any_facing(facing, turned, size):
    points, triangles, normal = tilted_strip(1e-5)
    points, triangles = points * size, triangles[:, ::-1] if turned else triangles
    origin = np.array([3.0, -2.0, 7.0]) * size
    plane = fit_plane(
        points, triangles, np.eye(3), origin, facing=None if facing is None else np.array(facing)
    )
    sign = (-1.0 if turned else 1.0) if facing is None else np.sign(normal @ facing)
    found = plane.axes[:, 2]
    assert close(found, sign * normal, 1e-4)
    heights = (points[:5] - origin) @ found
    assert close(plane.out_of_plane, np.ptp(heights) / 2.0, 1e-6)
    assert (
        np.abs(plane.origin - origin - found * (heights.min() + heights.max()) / 2.0).max()
        <= 1e-13 * size
    )
    assert (
        np.abs(plane.axes.T @ plane.axes - np.eye(3)).max() <= 1e-14
        and np.linalg.det(plane.axes) > 0.0
    )
    assert plane.x_axis_name == "X" and plane.axes[0, 0] > 0.0
    # in the plane of the normal and X
    assert abs(np.cross(found, [1.0, 0.0, 0.0]) @ plane.axes[:, 0]) <= 1e-14


@pytest.mark.parametrize("more", [[], [[0, 0, 1], [0, 1, 0]]])
@pytest.mark.parametrize("place", [0, 2**30])
def test_tilted_plane_far_away_is_flat_despite_empty_faces(more, place):
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 4, 3], [0, 4, 3]], float) + place
    plane = fit_plane(points, np.array([[0, 1, 2], [0, 2, 3], *more]), np.eye(3), np.full(3, place))
    assert np.abs(plane.axes[:, 2] - [0.0, -0.6, 0.8]).max() <= 1e-14
    assert plane.out_of_plane <= 1e-14 and np.abs(plane.origin - place).max() <= 1e-14


def test_section_with_unknown_centroid_keeps_second_moments():
    """301 by 501 of the steps that coordinates there have: the number nearest to it is half a step
    off.
    """
    far, step = 2.0**33, 2.0**-19
    points = far + step * np.array(rectangle(0, 0, 301, 501), float)
    section = measure_section(LEVEL, lifted(points), directed_edges([range(4)]))
    assert close(section.area, 301.0 * 501.0 * step**2, 1e-14)
    assert close(
        section.second[:2], np.array([301.0 * 501.0**3, 501.0 * 301.0**3]) / 12.0 * step**4, 1e-12
    )
    assert abs(section.second[2]) <= 1e-12 * section.second[0]
