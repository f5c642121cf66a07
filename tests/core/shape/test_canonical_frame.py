# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One pose for a body however it lies and whatever its faces; every frame that a symmetric body
leaves, no other.
"""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.bodies.mesh_body import with_input_error
from body_moments.core.inertia.principal_frames import (
    pose_matrix,
    principal_frame,
    zhang_chen_frame,
)
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.images import invert_through_point
from body_moments.core.moments.raw import Moments, monomial_index, monomials
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.shape.unique_frames import equivalent_frames, nearest_frame, unique_frame
from body_moments.core.solid.measure import measure_solid

from tests.core import bodies, shapes
from tests.core.findings import refused
from tests.core.recursion import moments


def pose(part, prefer=None):
    found = moments(part, 6)
    frame = unique_frame(found, prefer)
    return frame, pose_matrix(found.center, frame.axes)


def placed(part, matrix):
    return part[0] @ matrix[:3, :3].T + matrix[:3, 3]


def size(part):
    return np.ptp(part[0], axis=0).max()


@pytest.mark.parametrize("name", shapes.ASYMMETRIC)
def test_copies_coincide_after_any_motion_and_with_any_faces(name):
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
def test_symmetric_body_is_flagged_and_maps_onto_itself(name):
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
        # a corner on each corner, though not always on its own
        assert gap.max() < 1e-9 * size(part)


@pytest.mark.parametrize("name", shapes.SYMMETRIC)
def test_equal_frames_resolve_to_the_nearest_preferred_axes(name):
    part, _ = shapes.SYMMETRIC[name]
    found = moments(part, 6)
    frames = equivalent_frames(found).frames
    for seed in range(5):
        prefer = bodies.rotation(seed)
        axes = nearest_frame(equivalent_frames(found), prefer)
        assert np.trace(prefer.T @ axes) == pytest.approx(
            max(np.trace(prefer.T @ frame) for frame in frames)
        )
        again = unique_frame(found, axes)
        assert np.allclose(again.axes, axes, atol=1e-9)


@pytest.mark.parametrize(
    "part, tolerance", [(bodies.box((-1, -1, -1), (1, 1, 1)), 1e-12), (bodies.sphere(0), 1e-9)]
)
def test_turned_cube_or_octahedron_gets_its_own_axes(part, tolerance):
    turn = bodies.rotation(3)
    frame, _ = pose(bodies.moved(part, turn))
    cosines = np.abs(turn.T @ frame.axes)
    assert np.allclose(np.sort(cosines, axis=0), [[0] * 3, [0] * 3, [1] * 3], atol=tolerance)
    assert frame.symmetry == "isotropic" and "own" in frame.finding.values["choice"]


@pytest.mark.parametrize("noise", [1e-5, 1e-2, 0.2])
def test_cube_has_its_own_axes_at_any_noise(noise):
    turn = bodies.rotation(3)
    found = equivalent_frames(
        moments(bodies.moved(bodies.box((-1, -1, -1), (1, 1, 1)), turn), 6), noise
    )
    cosines = np.sort(np.abs(turn.T @ found.frames), axis=1)
    assert len(found.frames) == 24 and np.abs(cosines - [[0], [0], [1]]).max() < 1e-10


def test_a_square_prism_gets_the_directions_of_its_sides():
    part = bodies.box((-1, -1, -2), (1, 1, 2))
    turn = bodies.rotation(4)
    frame, _ = pose(bodies.moved(part, turn))
    local = np.abs(turn.T @ frame.axes)
    assert local[2, 0] == pytest.approx(1.0)
    assert np.allclose(np.sort(local[:2, 1]), [0, 1], atol=1e-9)


def test_float32_and_float64_have_one_frame():
    for part in (
        shapes.SYMMETRIC["cube"][0],
        shapes.SYMMETRIC["icosahedron"][0],
        shapes.THREE_BOXES,
    ):
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


def test_body_with_overflowing_moments_is_refused():
    points, triangles = bodies.box()
    with refused("moments_overflow", order=6):
        pose((points * 1e-60, triangles))


@pytest.mark.parametrize("box", [(2, 2, 2), (3, 2, 1)], ids=["a cube", "a box"])
@pytest.mark.parametrize("size, mass", [(-40.0, -100.0), (55.0, -100.0)])
def test_moments_beyond_the_range_of_numbers_have_no_frames(box, size, mass):
    """Moments of sixth order by powers of ten; moments of second order are examined first and stay
    well within the limit.
    """
    known = cloud((1.0, bodies.box(-np.array(box), box)[0]))
    found = replace(known, raw=known.raw * 10.0 ** (mass + size * monomials(6).sum(axis=1)))
    with refused("moments_overflow", order=6):
        equivalent_frames(found)
    with refused("moments_overflow", order=6):
        unique_frame(found)


def test_a_lamina_has_no_skewness_across():
    plate = bodies.joined(bodies.box((0, 0, 0), (3, 1, 1e-9)), bodies.box((0, 1, 0), (1, 4, 1e-9)))
    frame, _ = pose(bodies.moved(plate, bodies.rotation(1)))
    assert np.isfinite(frame.axes).all() and frame.symmetry == "asymmetric"


def test_the_image_in_a_point_has_odd_moments_of_the_other_sign():
    part = shapes.WEDGE
    found = moments(part, 5)
    image = moments((2 * found.about - part[0], part[1][:, ::-1]), 5)
    assert np.allclose(
        invert_through_point(found).raw,
        image.about_point(found.about).raw,
        atol=1e-12 * abs(found.raw).max(),
    )


def test_strict_rule_matches_zhang_and_chen():
    for seed in range(20):
        image = moments(bodies.moved(shapes.WEDGE, bodies.rotation(seed), (1, 2, 3)), 3)
        central = image.about_center()
        axes = zhang_chen_frame(image).axes
        third = np.einsum("abc,ai,bi,ci->i", central.third(), axes, axes, axes)
        assert third[0] > 0 and third[1] > 0
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert np.all(np.diff(np.diag(axes.T @ central.second() @ axes)) < 0)


@pytest.mark.parametrize("name", ["box", "cube", "S prism"])
def test_strict_rule_refuses_ambiguous_bodies(name):
    with refused("strict_rule_undefined"):
        zhang_chen_frame(moments(shapes.SYMMETRIC[name][0], 3))


def test_a_ball_takes_the_preferred_axes():
    raw = np.zeros(84)

    raw[0], raw[[monomial_index(2, 0, 0), monomial_index(0, 2, 0), monomial_index(0, 0, 2)]] = (
        1.0,
        0.2,
    )
    for even, value in (((4, 0, 0), 3 / 35), ((2, 2, 0), 1 / 35)):
        for powers in {
            (even[i], even[j], even[k]) for i, j, k in ((0, 1, 2), (2, 0, 1), (1, 2, 0))
        }:
            raw[monomial_index(*powers)] = value
    for even, value in (((6, 0, 0), 15), ((4, 2, 0), 3), ((4, 0, 2), 3), ((2, 2, 2), 1)):
        for powers in {
            (even[i], even[j], even[k]) for i, j, k in ((0, 1, 2), (2, 0, 1), (1, 2, 0))
        }:
            raw[monomial_index(*powers)] = value / 315
    ball, prefer = Moments(raw, np.zeros(3)), bodies.rotation(5)
    frame = unique_frame(ball, prefer)
    assert (
        np.array_equal(frame.axes, prefer)
        and not frame.is_unique
        and frame.finding.code == "axes_free"
    )


@pytest.mark.parametrize("higher", [False, True])
@pytest.mark.parametrize("name", ["prism", "ball", "torus"])
def test_storage_noise_never_flips_a_nearly_free_frame(name, higher):
    """A prism as high as it is wide, whose skewness noise mixes into an axis that has none; a
    stretched ball that is fourfold by a thousandth; a torus that is hardly oval. Preferred are the
    body's own axes, in another order.
    """
    if name == "prism":
        angle = 2.0 * np.pi * np.arange(3) / 3.0
        end = np.stack([np.cos(angle), 0.8 * np.sin(angle), 0.0 * angle], axis=1)
        part = (
            np.concatenate([end, end + [0.0, 0.0, np.sqrt(1.5) * (1.0 + 1.5e-6)]]),
            np.array(
                [
                    [0, 2, 1],
                    [3, 4, 5],
                    [0, 1, 4],
                    [0, 4, 3],
                    [1, 2, 5],
                    [1, 5, 4],
                    [2, 0, 3],
                    [2, 3, 5],
                ]
            ),
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
        if higher:
            sixth = polyhedron_moments(body.repaired_surface, 6, about=body.volume.about)[0]
            frame = unique_frame(with_input_error(sixth, body.volume), turn)
        else:
            frame = principal_frame(body.volume, turn, body.exact_third_order)
        found.append(turn.T @ frame.axes)
    assert np.abs(np.array(found) - found[0]).max() < 0.2


def cloud(*parts):
    """The moments to sixth order of points with weights: (weight, (n, 3) points) each, the weight
    that of all n.
    """
    raw = sum(
        weight * np.prod(points[:, None] ** monomials(6), axis=2).mean(axis=0)
        for weight, points in parts
    )
    return Moments(raw, np.zeros(3))
