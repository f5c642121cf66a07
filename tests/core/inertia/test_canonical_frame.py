# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One pose for a body however it lies and whatever its faces; every frame that a symmetric body leaves, no other."""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.inertia.canonical_frame import (
    CLEAR_HARMONIC,
    MAX_START_GAP,
    START_DIRECTIONS,
    SecondMomentAxes,
    _normalization,
    _sphere_directions,
)
from body_moments.core.inertia.principal_frames import (
    equivalent_frames,
    nearest_frame,
    pose_matrix,
    principal_frame,
    zhang_chen_frame,
)
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import Moments, monomial_index, monomials
from body_moments.core.moments.symmetric_tensors import invert_through_point
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.solid.measure import measure_solid

from tests.close import close
from tests.core import bodies, shapes
from tests.core.findings import refused
from tests.core.recursion import moments


def pose(part, prefer=None):
    found = moments(part, 6)
    frame = principal_frame(found.truncate(3), prefer, higher=lambda: found)
    return frame, pose_matrix(found.center, frame.axes)


def placed(part, matrix):
    return part[0] @ matrix[:3, :3].T + matrix[:3, 3]


def size(part):
    return np.ptp(part[0], axis=0).max()


@pytest.mark.parametrize("name", shapes.ASYMMETRIC)
def test_copies_lie_on_each_other_after_any_motion_and_with_any_faces(name):
    part = shapes.ASYMMETRIC[name]
    first, matrix = pose(part)
    assert first.is_unique and first.finding is None
    wanted, rng = placed(part, matrix), np.random.default_rng(1)
    for seed in range(100):
        image = bodies.moved(part, bodies.rotation(seed), rng.normal(size=3) * 10)
        frame, matrix = pose(shapes.refined(image, seed), prefer=bodies.rotation(1000 + seed))
        assert frame.is_unique
        assert np.abs(placed(image, matrix) - wanted).max() < 1e-9 * size(part)


@pytest.mark.parametrize("name", shapes.ASYMMETRIC)
def test_a_mirror_image_never_lies_on_the_body(name):
    part = shapes.ASYMMETRIC[name]
    _, matrix = pose(part)
    image = shapes.mirrored(part)
    _, other = pose(image)
    assert np.abs(placed(image, other) - placed(part, matrix)).max() > 0.05 * size(part)
    alike, reflected = equivalent_frames(moments(part, 6)), equivalent_frames(moments(image, 6))
    assert (np.abs(alike.values - reflected.values) > 100.0 * alike.noise).any()


@pytest.mark.parametrize("name", shapes.SYMMETRIC)
def test_symmetric_bodies_are_flagged_and_come_to_lie_on_themselves(name):
    part, group = shapes.SYMMETRIC[name]
    first, matrix = pose(part)
    assert first.is_unique == (group == "Cs") and (first.finding is not None) == (group != "Cs")
    wanted = placed(part, matrix)
    for seed in range(10):
        image = bodies.moved(part, bodies.rotation(seed), (1, 2, 3))
        frame, matrix = pose(shapes.refined(image, seed), prefer=bodies.rotation(100 + seed))
        points = placed(image, matrix)
        assert frame.symmetry == first.symmetry
        gap = np.linalg.norm(points[:, None] - wanted[None], axis=2).min(axis=1)
        assert gap.max() < 1e-9 * size(part)  # a corner on each corner, though not always on its own


@pytest.mark.parametrize("name", shapes.SYMMETRIC)
def test_of_equal_frames_the_one_nearest_to_the_preferred_axes_is_taken(name):
    part, _ = shapes.SYMMETRIC[name]
    found = moments(part, 6)
    frames = equivalent_frames(found).frames
    for seed in range(5):
        prefer = bodies.rotation(seed)
        axes = nearest_frame(equivalent_frames(found), prefer)
        assert np.trace(prefer.T @ axes) == pytest.approx(max(np.trace(prefer.T @ frame) for frame in frames))
        again = principal_frame(found.truncate(3), axes, higher=lambda: found)
        assert np.allclose(again.axes, axes, atol=1e-9)


def test_a_cube_turned_within_its_object_gets_its_own_axes():
    turn = bodies.rotation(3)
    frame, _ = pose(bodies.moved(bodies.box((-1, -1, -1), (1, 1, 1)), turn))
    cosines = np.abs(turn.T @ frame.axes)
    assert np.allclose(np.sort(cosines, axis=0), [[0] * 3, [0] * 3, [1] * 3], atol=1e-12)
    assert frame.symmetry == "isotropic" and frame.finding.code == "axes_all_free_by_shape"


@pytest.mark.parametrize("noise", [1e-5, 1e-2, 0.2])
def test_a_cube_has_its_own_axes_however_loosely_it_is_looked_at(noise):
    turn = bodies.rotation(3)
    found = equivalent_frames(moments(bodies.moved(bodies.box((-1, -1, -1), (1, 1, 1)), turn), 6), noise)
    cosines = np.sort(np.abs(turn.T @ found.frames), axis=1)
    assert len(found.frames) == 24 and np.abs(cosines - [[0], [0], [1]]).max() < 1e-10


def test_an_octahedron_gets_the_axes_through_its_corners():
    turn = bodies.rotation(6)
    frame, _ = pose(bodies.moved(bodies.sphere(0), turn))
    assert np.allclose(np.sort(np.abs(turn.T @ frame.axes), axis=0), [[0] * 3, [0] * 3, [1] * 3], atol=1e-9)


def test_a_square_prism_gets_the_directions_of_its_sides():
    part = bodies.box((-1, -1, -2), (1, 1, 2))
    turn = bodies.rotation(4)
    frame, _ = pose(bodies.moved(part, turn))
    local = np.abs(turn.T @ frame.axes)
    assert local[2, 0] == pytest.approx(1.0)
    assert np.allclose(np.sort(local[:2, 1]), [0, 1], atol=1e-9)


def test_float32_and_float64_have_one_frame():
    for part in (shapes.SYMMETRIC["cube"][0], shapes.SYMMETRIC["icosahedron"][0], shapes.THREE_BOXES):
        image = bodies.moved(part, bodies.rotation(7), (3, 2, 1))
        exact, _ = pose(image)
        rounded, _ = pose((image[0].astype(np.float32).astype(float), image[1]), prefer=exact.axes)
        assert np.allclose(rounded.axes, exact.axes, atol=1e-5)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_tiny_and_huge_bodies_are_the_same_problem(scale):
    for part in (shapes.THREE_BOXES, shapes.SYMMETRIC["cube"][0], shapes.SYMMETRIC["S prism"][0]):
        image = bodies.moved(part, bodies.rotation(2))
        alike = equivalent_frames(moments(image, 6))
        scaled = equivalent_frames(moments((image[0] * scale, image[1]), 6))
        assert len(alike.frames) == len(scaled.frames)
        assert np.allclose(alike.values, scaled.values, atol=1e-9)


def test_a_body_whose_moments_are_no_numbers_any_more_is_refused():
    points, triangles = bodies.box()
    with refused("moments_overflow", order=6):
        pose((points * 1e-60, triangles))


@pytest.mark.parametrize("box", [(2, 2, 2), (3, 2, 1)], ids=["a cube", "a box"])
@pytest.mark.parametrize("size, mass", [(-40.0, -100.0), (55.0, -100.0)])
def test_moments_beyond_the_range_of_numbers_have_no_frames(box, size, mass):
    """Of sixth order, by the powers of ten; those of second order, which are looked at before, are well within it."""
    known = cloud((1.0, bodies.box(-np.array(box), box)[0]))
    found = replace(known, raw=known.raw * 10.0 ** (mass + size * monomials(6).sum(axis=1)))
    with refused("moments_overflow", order=6):
        equivalent_frames(found)
    with refused("moments_overflow", order=6):
        principal_frame(found.truncate(3), higher=lambda: found)


def test_a_lamina_has_no_skewness_across():
    plate = bodies.joined(bodies.box((0, 0, 0), (3, 1, 1e-9)), bodies.box((0, 1, 0), (1, 4, 1e-9)))
    frame, _ = pose(bodies.moved(plate, bodies.rotation(1)))
    assert np.isfinite(frame.axes).all() and frame.symmetry == "asymmetric"


def test_the_image_in_a_point_has_odd_moments_of_the_other_sign():
    part = shapes.WEDGE
    found = moments(part, 5)
    image = moments((2 * found.about - part[0], part[1][:, ::-1]), 5)
    assert np.allclose(
        invert_through_point(found).raw, image.about_point(found.about).raw, atol=1e-12 * abs(found.raw).max()
    )


def test_the_strict_rule_is_that_of_zhang_and_chen():
    for seed in range(20):
        image = moments(bodies.moved(shapes.WEDGE, bodies.rotation(seed), (1, 2, 3)), 3)
        central = image.about_center()
        axes = zhang_chen_frame(image).axes
        third = np.einsum("abc,ai,bi,ci->i", central.third(), axes, axes, axes)
        assert third[0] > 0 and third[1] > 0
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert np.all(np.diff(np.diag(axes.T @ central.second() @ axes)) < 0)


@pytest.mark.parametrize("name", ["box", "cube", "S prism"])
def test_the_strict_rule_refuses_what_it_cannot_pose(name):
    with refused("strict_rule_equal_moments", "strict_rule_no_skewness"):
        zhang_chen_frame(moments(shapes.SYMMETRIC[name][0], 3))


def test_higher_moments_are_asked_for_only_where_they_are_needed():
    found = moments(shapes.WEDGE, 6)
    principal_frame(found.truncate(3), higher=lambda: pytest.fail("asked for higher moments"))
    asked = []
    box = moments(bodies.box(), 6)
    principal_frame(box.truncate(3), higher=lambda: asked.append(True) or box)
    assert asked


def test_a_ball_takes_the_preferred_axes():
    raw = np.zeros(84)
    from body_moments.core.moments.moments import monomial_index

    raw[0], raw[[monomial_index(2, 0, 0), monomial_index(0, 2, 0), monomial_index(0, 0, 2)]] = 1.0, 0.2
    for even, value in (((4, 0, 0), 3 / 35), ((2, 2, 0), 1 / 35)):
        for powers in {(even[i], even[j], even[k]) for i, j, k in ((0, 1, 2), (2, 0, 1), (1, 2, 0))}:
            raw[monomial_index(*powers)] = value
    for even, value in (((6, 0, 0), 15), ((4, 2, 0), 3), ((4, 0, 2), 3), ((2, 2, 2), 1)):
        for powers in {(even[i], even[j], even[k]) for i, j, k in ((0, 1, 2), (2, 0, 1), (1, 2, 0))}:
            raw[monomial_index(*powers)] = value / 315
    ball, prefer = Moments(raw, np.zeros(3)), bodies.rotation(5)
    frame = principal_frame(ball.truncate(3), prefer, higher=lambda: ball)
    assert np.array_equal(frame.axes, prefer) and not frame.is_unique and frame.finding.code == "axes_all_free"


def test_the_strict_rule_looks_closer_before_it_refuses():
    """Of a large mesh with long triangles third moments are known roughly at first."""
    part = shapes.WEDGE
    exact = moments(part, 3)
    rough = replace(
        exact,
        rounding_error=exact.rounding_error + np.where(monomials(3).sum(axis=1) == 3, np.abs(exact.raw).max(), 0.0),
    )
    with refused("strict_rule_no_skewness"):
        zhang_chen_frame(rough)
    assert (zhang_chen_frame(rough, lambda: exact).axes == zhang_chen_frame(exact).axes).all()


@pytest.mark.parametrize("higher", [False, True])
@pytest.mark.parametrize("name", ["prism", "ball", "torus"])
def test_noise_of_storage_never_flips_a_frame_that_nearly_equal_moments_hardly_fix(name, higher):
    """A prism as high as it is wide, whose skewness noise mixes into an axis that has none; a stretched ball that is
    fourfold by a thousandth; a torus that is hardly oval. Preferred are the body's own axes, in another order."""
    if name == "prism":
        angle = 2.0 * np.pi * np.arange(3) / 3.0
        end = np.stack([np.cos(angle), 0.8 * np.sin(angle), 0.0 * angle], axis=1)
        part = (
            np.concatenate([end, end + [0.0, 0.0, np.sqrt(1.5) * (1.0 + 1.5e-6)]]),
            np.array([[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]),
        )
    elif name == "ball":
        part = bodies.moved(bodies.sphere(2), np.diag([1.0, 1.0, 1.0005]))
    else:
        part = bodies.moved(bodies.torus(12, 8), np.diag([1.0, 1.0001, 1.1]))
    found = []
    for seed in range(24):
        turn = bodies.rotation(seed)
        points, triangles = bodies.moved(part, turn)
        body = measure_solid(Surface(points.astype(np.float32), triangles))
        frame = principal_frame(
            body.volume,
            turn,
            body.exact_third_order,
            (lambda body=body: polyhedron_moments(body.repaired_surface, 6)[0]) if higher else None,
        )
        found.append(turn.T @ frame.axes)
    assert np.abs(np.array(found) - found[0]).max() < 0.2


def cloud(*parts):
    """The moments to sixth order of points with weights: (weight, (n, 3) points) each, the weight that of all n."""
    raw = sum(weight * np.prod(points[:, None] ** monomials(6), axis=2).mean(axis=0) for weight, points in parts)
    return Moments(raw, np.zeros(3))


@pytest.mark.parametrize("share, degree", [(0.98, 6), (1.04, 4)])
def test_of_degrees_whose_moments_differ_clearly_with_the_direction_the_first_decides(share, degree):
    """Of a cube's corners with that weight E[(u·x)⁴] differs by 4/3 of it; an icosahedron's differ from sixth order
    on."""
    cube = bodies.box((-1, -1, -1), (1, 1, 1))[0] / 3.0**0.5 @ bodies.rotation(9).T
    icosahedron = shapes.ICOSAHEDRON[0] / np.linalg.norm(shapes.ICOSAHEDRON[0][0])
    found = equivalent_frames(cloud((1.0, icosahedron), (share * 0.75 * CLEAR_HARMONIC, cube)))
    assert found.rule.extreme == degree


@pytest.mark.parametrize(
    "share, harmonic", [(0.49, (6, 6, 0)), (0.51, (5, 3, 0)), (0.98, (5, 3, 0)), (1.02, (3, 3, 0))]
)
def test_about_an_axis_the_first_clear_harmonic_decides(share, harmonic):
    """Of a triangle's corners with that weight E[(x+iy)³] and E[(x+iy)³ (x²+y²)] are the weight; a hexagon has none."""
    angle = np.pi / 3.0 * np.arange(6)
    ring = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    hexagon, triangle = (np.concatenate([flat - [0, 0, 2.0], flat + [0, 0, 2.0]]) for flat in (ring, ring[::2]))
    weight = share * CLEAR_HARMONIC * 0.5**1.5
    turn = bodies.rotation(3)
    found = equivalent_frames(cloud((1.0 - weight, hexagon @ turn.T), (weight, triangle @ turn.T)))
    assert found.rule.harmonic == harmonic


def rings(radius, *points):
    """A ring of eight at height 1, round to seventh order, and points with weights on its axis: (weight, height)."""
    angle = np.pi / 4.0 * np.arange(8)
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.ones(8)], axis=1)
    return (1.0, ring), *((weight, np.array([[0.0, 0.0, height]])) for weight, height in points)


@pytest.mark.parametrize("over", [[1, 1, 1], [1, -1, -1]], ids=["as it is", "turned over"])
@pytest.mark.parametrize(
    "parts, cosine",
    [
        (rings(8.0**0.5, (1 / 6, 3.0), (1.5, -1.0)), 0.5**0.5),
        (rings(11.02**0.5, (0.9, 1.0), (1.0, -1.9)), 3.9**-0.5),
        (rings(8.0**0.5, (1.0, 1.0), (2.0, -1.0)), 3.0**-0.5),
    ],
    ids=["near the axis", "far from it", "spread as all directions are"],
)
def test_where_a_circle_of_directions_is_extreme_its_axis_is_taken(parts, cosine, over):
    """All second moments are equal. With A = E[z³] and B = E[zx²], E[(u·x)³] = A c³ + 3B c (1 - c²), of the cosine c
    with the axis, is largest at c² = B / (3B - A), where it is 2Bc > |A|."""
    turn = bodies.rotation(6) * over
    body = cloud(*((weight, points @ turn.T) for weight, points in parts))
    found, frame = equivalent_frames(body), principal_frame(body.truncate(3), higher=lambda: body)
    assert found.revolution_axes == (2,) and found.rule is None and len(found.frames) == 1
    assert np.abs(found.frames[0, :, 2] - turn[:, 2]).max() < 1e-9
    assert np.abs(frame.axes[:, 2] - turn[:, 2]).max() < 1e-9
    raw = cloud(*parts).raw
    a, b = raw[[19, 12]]
    assert close(raw[[7, 9]], raw[4], rel=1e-12) and np.abs(raw[1:4]).max() < 1e-12
    assert abs(a) < 2.0 * b * cosine and close((b / (3.0 * b - a)) ** 0.5, cosine, rel=1e-12)


@pytest.mark.parametrize("bend", [0.3, 0.01])
@pytest.mark.parametrize("size", [1.0, 0.03])
def test_a_direction_about_which_moments_hardly_change_one_way_is_found_to_rounding(size, bend):
    """E[(u·x)⁴] is w⁴ + (2 - bend) w² u² + w² v² along turned axes, so that it falls off by the bend along u."""
    turn, raw = bodies.rotation(8), np.zeros(84)
    raw[[0, 4, 7, 9]] = 1.0
    for powers, value in (((0, 0, 4), 1.0), ((2, 0, 2), (2.0 - bend) / 6.0), ((0, 2, 2), 1.0 / 6.0)):
        raw[monomial_index(*powers)] = size * value
    found = equivalent_frames(Moments(raw, np.zeros(3)).in_frame(turn.T, np.zeros(3)))
    assert found.rule.extreme == 4 and found.revolution_axes == ()
    assert np.abs(np.abs(found.frames[:, :, 2] @ turn) - [0.0, 0.0, 1.0]).max() < 1e-10


def test_an_axis_that_is_itself_extreme_stays_a_direction_that_can_be_refined():
    """A = 60 and B = 22, as above."""
    body = cloud(*((weight, points @ bodies.rotation(6).T) for weight, points in rings(44.0**0.5, (1, 4.0), (5, -1.0))))
    found = equivalent_frames(body)
    assert found.revolution_axes == (2,) and found.rule.extreme == 3 and len(found.frames) == 1
    assert np.abs(found.frames[0, :, 2] - bodies.rotation(6)[:, 2]).max() < 1e-9


def test_where_two_circles_are_extreme_their_axis_is_taken():
    """Odd moments are zero. E[(u·x)⁴] = 3 t² + 7.2 t (1 - t) + 2.16 (1 - t)², of the squared cosine t with the axis, is
    largest at t = 0.706 and least at t = 0."""
    turn = bodies.rotation(6)
    one = rings(2.4**0.5, (0.02, 10.0**0.5))
    parts = [(weight / 2.0, side * points) for side in (1.0, [1.0, 1.0, -1.0]) for weight, points in one]
    raw = cloud(*parts).raw
    assert close(raw[[4, 7, 9, 20, 25, 34]], [1.2, 1.2, 1.2, 2.16, 1.2, 3.0], rel=1e-12)
    found = equivalent_frames(cloud(*((weight, points @ turn.T) for weight, points in parts)))
    assert found.revolution_axes == (2,) and found.rule is None
    poles = found.frames[:, :, 2]
    assert np.abs(poles * np.sign(poles @ turn[:, 2])[:, None] - turn[:, 2]).max() < 1e-9


def test_where_a_plate_is_thinner_only_the_moments_across_it_are_more_of_noise():
    noise = []
    for thickness in (1e-2, 1e-4):
        plate = bodies.joined(bodies.box((0, 0, 0), (3, 1, thickness)), bodies.box((0, 1, 0), (1, 4, thickness)))
        body = measure_solid(Surface(plate[0].astype(np.float32), plate[1]))
        noise.append(equivalent_frames(polyhedron_moments(body.repaired_surface, 6)[0]).noise)
    across = monomials(6)[10:, 2] > 0
    assert (noise[1] > 20.0 * noise[0])[across].all() and close(noise[1][~across], noise[0][~across], rel=0.01)


@pytest.mark.parametrize("degree, growth", [(3, 1.0), (4, 3.0), (5, 8.0), (6, 15.0)])
def test_along_axes_of_any_direction_the_bounds_of_moments_add_up(degree, growth):
    """Where all of n indices may be off by e, a form is by √3^n e along a diagonal; one moment is off here."""
    error, turn = np.zeros(84), bodies.rotation(1)
    error[monomial_index(0, 0, degree)] = 1e-3
    central = Moments(np.append(1.0, np.zeros(83)), np.zeros(3), rounding_error=error)
    unit, noise = _normalization(central, SecondMomentAxes(turn, np.full(3, 0.5), (0, 1, 2), 0.0), degree)
    assert close(unit, 0.5**degree, 1e-14)
    worst = 3.0 ** (degree / 2.0) * 1e-3 * np.abs(turn[2]).max() ** degree
    assert close(noise, growth * 1e-5 + worst / 0.5**degree, 1e-12)


def test_no_direction_is_far_from_those_that_are_looked_from():
    places = np.random.default_rng(3).normal(size=(20_000, 3))
    places /= np.linalg.norm(places, axis=1)[:, None]
    starts = _sphere_directions()
    assert close(np.linalg.norm(starts, axis=1), 1.0, 1e-15) and starts.shape == (START_DIRECTIONS, 3)
    assert np.arccos(np.minimum((places @ starts.T).max(axis=1), 1.0)).max() < MAX_START_GAP
