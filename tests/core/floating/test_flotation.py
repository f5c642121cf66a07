# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating bodies against closed forms."""

import numpy as np
import pytest
from body_moments.core import MeasureError
from body_moments.core.floating import FloatingBody, Tank, Vessel, righting_curve

from tests.core.bodies import box, lathed

UP = (0.0, 0.0, 1.0)
BOX_FACES = box()[1]


def box_points(low, high):
    return box(low, high)[0]


def log(length, width, height, share, place=(0.0, 0.0, 0.0), **more):
    half = np.array([length, width, height]) / 2.0
    points = box_points(place - half, place + half)
    mass = 1000.0 * share * length * width * height
    return FloatingBody(points, BOX_FACES, mass, np.array(place), 1000.0, **more)


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (100.0, -30.0, 7.0)])
def test_box_has_closed_form_numbers(place):
    rest = log(6.0, 2.0, 1.0, 0.4, place).settle([0.0, 1e-3, 1.0])
    size = 1e-12 * max(1.0, np.abs(place).max())
    bounds = rest.error_bounds
    kb = float(rest.up @ rest.center_of_buoyancy) - rest.keel
    assert abs(rest.draught - 0.4) <= bounds["draught"][0] < size
    assert abs(kb - 0.2) <= bounds["kb"][0] < size
    off = rest.metacentric_heights - [4 / 4.8 - 0.3, 36 / 4.8 - 0.3]
    assert np.abs(off).max() <= bounds["gm"][0] < 1e-10
    assert rest.residual < 1e-9
    assert rest.draught == pytest.approx(0.4, abs=size)
    assert rest.level == pytest.approx(place[2] - 0.1, abs=size)
    assert rest.center_of_buoyancy == pytest.approx(np.add(place, (0, 0, -0.3)), abs=1e2 * size)
    assert rest.center_of_flotation == pytest.approx(np.add(place, (0, 0, -0.1)), abs=1e2 * size)
    assert rest.plane.area == pytest.approx(12.0, abs=1e-12)
    assert rest.waterplane_moments == pytest.approx([4.0, 36.0], rel=1e-12)
    assert rest.metacentric_radii == pytest.approx([4.0 / 4.8, 36.0 / 4.8], rel=1e-12)
    assert rest.metacentric_heights == pytest.approx([4 / 4.8 - 0.3, 36 / 4.8 - 0.3], rel=1e-12)
    assert np.abs(rest.heel_axis) == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("slope", [0.0, 0.4])
def test_bounds_cover_numbers_of_points_stored_as_float32(slope):
    points = box_points((-3.0, -1.1, -0.7), (3.3, 1.0, 0.6)) + [200.0, 0.1, 0.3]
    points[4:, 1] += slope * np.sign(points[4:, 1])  # the sides flare
    moved = np.spacing(np.abs(points).max(axis=0).astype(np.float32)) / 2.0
    center = np.array([200.1, 0.05, 0.2])
    exact = FloatingBody(points, BOX_FACES, 5000.0, center, 1000.0).at([0.02, -0.03, 1.0])
    stored = FloatingBody(
        points.astype(np.float32), BOX_FACES, 5000.0, center, 1000.0, displacement=moved
    ).at(exact.up)
    bounds = {name: bound.sum() for name, bound in stored.error_bounds.items()}
    assert abs(stored.draught - exact.draught) <= bounds["draught"] < 1e-3
    buoyancy = exact.up @ (stored.center_of_buoyancy - exact.center_of_buoyancy)
    assert abs(buoyancy - stored.keel + exact.keel) <= bounds["kb"] < 1e-2
    off = stored.metacentric_heights - exact.metacentric_heights
    assert 0.0 < np.abs(off).max() <= bounds["gm"] < 0.1


@pytest.mark.parametrize(
    ("shares", "tilt"),
    [
        ((0.05, 0.1, 0.2, 0.211, 0.789, 0.8, 0.95), 0.0),
        ((0.22, 0.235, 0.25, 0.75, 0.765, 0.78), None),  # by the wall-sided formula
        ((0.282, 0.35, 0.5, 0.65, 0.718), np.pi / 4.0),
    ],
    ids=["flat", "tilted", "on an edge"],
)
def test_log_floats_flat_tilted_or_on_its_edge(shares, tilt):
    for share in shares:
        rest = log(20.0, 1.0, 1.0, share).settle([0.0, 0.01, 1.0])
        light = min(share, 1.0 - share)
        radius = 1.0 / (12.0 * light)
        height = light / 2.0 + radius - 0.5
        expected = np.arctan(np.sqrt(-2.0 * height / radius)) if tilt is None else tilt
        found = np.arctan2(*np.abs(rest.up[1:]))
        assert found == pytest.approx(expected, rel=1e-8, abs=1e-8)
        assert rest.residual < 1e-9


@pytest.mark.parametrize("share", [0.25, 0.3, 0.5])
def test_rests_are_minima_in_every_direction(share):
    body = log(1.3, 1.0, 1.0, share)
    rests = body.find_rests()
    for rest in rests:
        assert rest.residual < 1e-9
        for angle in np.arange(12) * np.pi / 6.0:
            toward = rest.axes @ [np.cos(angle), np.sin(angle)]
            assert body.at(rest.up + 0.02 * toward).energy > rest.energy - 1e-14
    assert [rest.energy for rest in rests] == sorted(rest.energy for rest in rests)


def test_log_that_floats_tilted_rests_in_eight_positions():
    rests = log(6.0, 1.0, 1.0, 0.25).find_rests()
    ups = [rest.up[1:] for rest in rests]
    assert np.sort(np.abs(ups)) == pytest.approx(np.sqrt([[0.2, 0.8]] * 8), abs=1e-9)
    assert len({(abs(y) > abs(z), y > 0.0, z > 0.0) for y, z in ups}) == 8


def test_cube_of_half_density_rests_on_corners():
    rests = log(1.0, 1.0, 1.0, 0.5).find_rests()
    assert len(rests) == 8
    assert np.abs([rest.up for rest in rests]) == pytest.approx(np.sqrt(1 / 3), abs=1e-9)


def test_wedge_floats_at_root_of_its_share():
    points = [[x, *corner] for x in (-2.0, 2.0) for corner in ((0.0, 0.0), (1.0, 1.0), (-1.0, 1.0))]
    faces = [
        [0, 2, 1],
        [3, 4, 5],
        *([0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]),
    ]
    rest = FloatingBody(points, faces, 1000.0, [0.0, 0.0, 0.3], 1000.0).settle(UP)
    depth = 0.5
    assert rest.draught == pytest.approx(depth, rel=1e-12)
    assert rest.center_of_buoyancy == pytest.approx([0.0, 0.0, 2.0 * depth / 3.0], abs=1e-12)
    assert rest.waterplane_moments[0] == pytest.approx(4.0 * (2.0 * depth) ** 3 / 12.0, rel=1e-12)
    assert rest.metacentric_heights[0] == pytest.approx(2.0 / 3.0 - 0.3, rel=1e-12)


def test_round_hull_has_closed_form_numbers():
    count, radius = 48, 1.5
    profile = (0.0, 0.0), (radius, 0.0), (radius, 1.0), (0.0, 1.0)
    points, faces = lathed(*profile, sides=count)
    area = count / 2.0 * np.sin(2.0 * np.pi / count) * radius**2
    side = 2.0 * radius * np.sin(np.pi / count)
    rest = FloatingBody(points, faces, 400.0 * area, [0.0, 0.0, 0.3], 1000.0).settle(UP)
    assert rest.draught == pytest.approx(0.4, rel=1e-12)
    moment = area * (6.0 * radius**2 - side**2) / 24.0
    assert rest.waterplane_moments == pytest.approx([moment, moment], rel=1e-12)
    assert rest.metacentric_heights == pytest.approx(moment / (0.4 * area) + 0.2 - 0.3, rel=1e-12)


def test_paraboloid_converges_to_closed_form():
    # Of z = r²: V = π h² / 2, KB = 2 h / 3, BM = 1 / 2 whatever the draught.
    errors = []
    for count in (40, 80):
        heights = np.linspace(1e-3, 1.0, count) ** 2
        profile = (0.0, heights[0]), *zip(np.sqrt(heights), heights), (0.0, heights[-1])
        points, faces = lathed(*profile, sides=2 * count)
        mass = 1000.0 * np.pi * 0.5**2 / 2.0
        rest = FloatingBody(points, faces, mass, [0.0, 0.0, 0.6], 1000.0).settle([0.02, 0.0, 1.0])
        errors.append(
            [
                rest.level - 0.5,
                rest.center_of_buoyancy[2] - 1.0 / 3.0,
                rest.metacentric_radii[0] - 0.5,
            ]
        )
    coarse, fine = np.array(errors)
    assert np.abs(fine).max() < 2e-4
    assert (np.abs(fine) < np.abs(coarse) / 3.0).all()


def test_wigley_hull_converges_to_its_polynomial():
    # y = B/2 (1 - (2x/L)²)(1 - (z/T)²), L = 10, B = 1, T = 0.625, with straight sides above.
    length, beam, depth = 10.0, 1.0, 0.625
    values = []
    for count in (24, 48):
        x = np.linspace(-1.0, 1.0, 2 * count + 1)
        z = np.concatenate([np.linspace(-1.0, 0.0, count + 1), [0.5]])
        width = beam / 2.0 * (1.0 - x[:, None] ** 2) * (1.0 - np.minimum(z, 0.0) ** 2)
        grid = np.stack(np.broadcast_arrays(x[:, None] * length / 2.0, width, z * depth), axis=-1)
        points = np.concatenate([grid.reshape(-1, 3), grid.reshape(-1, 3) * [1, -1, 1]])
        row, column = np.meshgrid(np.arange(len(x) - 1), np.arange(len(z) - 1), indexing="ij")
        a = (row * len(z) + column).ravel()
        b, c, d = a + 1, a + len(z) + 1, a + len(z)
        right = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
        left = right[:, ::-1] + len(grid.reshape(-1, 3))
        top = np.arange(len(x)) * len(z) + len(z) - 1
        below = top + len(grid.reshape(-1, 3))
        deck = np.concatenate(
            [
                np.stack([top[:-1], below[:-1], below[1:]], 1),
                np.stack([top[:-1], below[1:], top[1:]], 1),
            ]
        )
        mass = 1025.0 * 4.0 / 9.0 * length * beam * depth
        body = FloatingBody(
            points, np.concatenate([right, left, deck]), mass, [0.0, 0.0, -0.2], 1025.0
        )
        rest = body.at(UP)
        values.append(
            [
                rest.level,
                rest.plane.area,
                rest.center_of_buoyancy[2],
                *rest.waterplane_moments,
            ]
        )
    coarse, fine = np.array(values)
    exact = [
        0.0,
        2.0 / 3.0 * length * beam,
        -3.0 / 8.0 * depth,
        16.0 / 35.0 * beam**3 * length / 12.0,
        beam * length**3 / 30.0,
    ]
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=1e-5, abs=1e-5)


def test_righting_arms_of_box_are_wall_sided():
    rest = log(6.0, 2.0, 1.0, 0.5).settle(UP)
    angles = np.radians(np.arange(0.0, 27.0, 5.0))
    curve = righting_curve(rest, angles)
    height, radius = rest.metacentric_heights[0], rest.metacentric_radii[0]
    arms = np.sin(angles) * (height + radius * np.tan(angles) ** 2 / 2.0)
    assert curve.arms == pytest.approx(arms, abs=1e-12)


@pytest.mark.parametrize("angles", [(-90.0, 0.0, 90.0), (-90.0, 60.0)])
@pytest.mark.parametrize("share", [0.212, 0.25])
def test_capsize_is_found_between_the_angles_asked_for(share, angles):
    # From its tilt, the log turns over a flat side on one side, and over an edge on the other.
    rest = log(20.0, 1.0, 1.0, share).settle([0.0, 0.01, 1.0])
    radius = 1.0 / (12.0 * share)
    tilt = np.arctan(np.sqrt(-2.0 * (share / 2.0 + radius - 0.5) / radius))
    curve = righting_curve(rest, np.radians(angles))
    assert np.degrees(curve.angles) == pytest.approx(angles)
    expected = sorted([tilt, np.pi / 4.0 - tilt])
    assert sorted(np.abs(curve.capsize)) == pytest.approx(expected, abs=1e-6)
    assert curve.stable_range == curve.capsize


def test_righting_arms_integrate_to_energy():
    rest = log(6.0, 2.0, 1.0, 0.3).settle(UP)
    curve = righting_curve(rest, np.radians(np.arange(-90.0, 181.0, 1.0)))
    middle = (curve.arms[1:] + curve.arms[:-1]) / 2.0 * np.diff(curve.angles)
    work = np.concatenate([[0.0], np.cumsum(middle)])
    assert curve.energies - curve.energies[0] == pytest.approx(work, abs=1e-4)
    assert curve.stable_range[1] == pytest.approx(np.pi / 2.0, abs=1e-8)


def test_free_trim_leaves_no_trimming_arm():
    points = box_points((-3.0, -1.0, -0.5), (3.0, 1.0, 0.5)) * 1.0
    points[1::2, 1] *= 0.2  # a pointed bow
    body = FloatingBody(points, BOX_FACES, 3000.0, [-0.6, 0.0, 0.0], 1000.0)
    rest = body.settle(UP)
    angles = np.radians([10.0, 30.0, 60.0])
    free = righting_curve(rest, angles)
    fixed = righting_curve(rest, angles, free_trim=False)
    assert np.abs(free.trims).max() > 0.02
    assert (free.energies < fixed.energies).all()
    heel, trim = angles[-1], free.trims[-1]

    def energy(trim):
        side = np.cos(trim) * np.array([np.sin(heel), np.cos(heel)])
        forward = rest.heel_axis
        across = np.cross(rest.up, forward)
        return body.at(-np.sin(trim) * forward + side[0] * across + side[1] * rest.up).energy

    assert energy(trim) == pytest.approx(rest.energy + free.energies[-1], abs=1e-13)
    assert min(energy(trim - 0.01), energy(trim + 0.01)) > energy(trim)


def test_full_tank_is_a_fixed_mass():
    points = box_points((-1.0, -0.8, -0.4), (1.0, 0.8, 0.0))
    full = Tank(Vessel(points, np.array(BOX_FACES), 1.28), 800.0)
    rest = log(6.0, 2.0, 1.0, 0.3, tanks=(full,)).settle(UP)
    volume = 3.6 + 1.024
    height = volume / 24.0 - 0.5 + 4.0 / volume - 1.024 * -0.2 / volume
    assert rest.metacentric_heights[0] == pytest.approx(height, rel=1e-12)


def test_free_surface_lowers_metacenter():
    tank = Tank(
        Vessel(box_points((-1.0, -0.8, -0.4), (1.0, 0.8, 0.0)), np.array(BOX_FACES), 0.64), 800.0
    )
    empty = log(6.0, 2.0, 1.0, 0.3)
    rest = log(6.0, 2.0, 1.0, 0.3, tanks=(tank,)).settle(UP)
    volume = 3.6 + 0.512
    depth = volume / 12.0
    gravity = 0.512 * -0.3 / volume
    second = 6.0 * 8.0 / 12.0 - 0.8 * 2.0 * 1.6**3 / 12.0
    assert rest.draught == pytest.approx(depth, rel=1e-12)
    height = depth / 2.0 - 0.5 + second / volume - gravity
    assert rest.metacentric_heights[0] == pytest.approx(height, rel=1e-12)
    assert rest.body.total_mass == pytest.approx(empty.total_mass + 512.0)


@pytest.mark.parametrize(
    ("share", "code"), [(1.2, "sinks"), (1.0, "sinks"), (0.0, "float_unavailable")]
)
def test_body_that_cannot_float_is_refused(share, code):
    with pytest.raises(MeasureError) as refusal:
        log(1.0, 1.0, 1.0, share)
    assert refusal.value.finding.code == code


def test_liquid_without_density_is_refused():
    with pytest.raises(MeasureError, match="density"):
        FloatingBody(box_points((0, 0, 0), (1, 1, 1)), BOX_FACES, 1.0, [0.5, 0.5, 0.5], 0.0)


def test_opening_below_waterline_is_refused():
    body = log(6.0, 2.0, 1.0, 0.5, openings=[[0.0, 1.0, -0.2]])
    with pytest.raises(MeasureError, match="20 mm|0.2 m"):
        body.settle(UP)
    dry = log(6.0, 2.0, 1.0, 0.5, openings=[[0.0, -1.0, 0.2]])
    curve = righting_curve(dry.settle(UP), np.radians([-30.0, 0.0, 30.0]))
    assert np.abs(curve.flooding).tolist()[0 if np.isfinite(curve.flooding[0]) else 1] == (
        pytest.approx(np.arctan(0.2), abs=1e-8)
    )
