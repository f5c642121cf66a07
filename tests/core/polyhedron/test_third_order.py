# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of meshes against rational arithmetic and closed forms.

Small blocks make small meshes take the path of large ones; the bounds that come with the numbers
are the tolerance wherever there is one.
"""

from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface, flipped_quads
from body_moments.core.polyhedron import integration
from body_moments.core.polyhedron import third_order as polyhedron
from hypothesis import given
from hypothesis import strategies as st

from tests.close import close
from tests.core import exact
from tests.core.bodies import grid_torus, rotation
from tests.core.strategies import holds, random_meshes, seeds

# open faces count as given
polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)

MONOMIALS = exact.MONOMIALS
L_OUTLINE = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
L_CAPS = [(0, 1, 2, 3), (0, 3, 4, 5)]
TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


@pytest.fixture(params=["exact", "fast", "few"])
def path(request, monkeypatch):
    """Both ways through the third order, in blocks of a few faces, and the way of small bodies."""
    if request.param == "few":
        return request.param
    monkeypatch.setattr(polyhedron, "FACES_PER_BLOCK", 32)
    monkeypatch.setattr(polyhedron, "MAX_SMALL_TRIANGLES", 16)
    monkeypatch.setattr(polyhedron, "MIN_TRIANGLES_PER_THREAD", 8)
    if request.param == "fast":
        monkeypatch.setattr(polyhedron, "MAX_TRIANGLES_EXACT_THIRD", 0)
    return request.param


def assert_within(moments, truth, error=None):
    """Every moment is as near to the truth as its bound says."""
    error = moments.rounding_error if error is None else error
    for value, bound, right, monomial in zip(moments.raw, error, truth, MONOMIALS):
        assert abs(Fraction(float(value)) - right) <= Fraction(float(bound)), monomial


def assert_bounds_hold(surface):
    """The moments of the volume, with and without areas, and of the area are as near to the truth
    as they say.
    """
    triangles = surface.all_triangles()[0]
    volume, area = polyhedron_moments(surface, area_order=3)
    truth = exact.volume_moments(surface.points, triangles, volume.about)
    assert_within(volume, truth)
    assert_within(polyhedron_moments(surface)[0], truth)
    assert_within(area, exact.area_moments(surface.points, triangles, area.about))


def assert_exact(surface, truth_at_origin, ulps=8):
    """The moments about the origin equal the closed form to rounding: `ulps` of the largest of
    their order.
    """
    moments = polyhedron_moments(surface)[0].about_point(np.zeros(3))
    truth = np.array([float(value) for value in truth_at_origin])
    for order in range(3):
        part = [i for i, m in enumerate(MONOMIALS) if sum(m) == order]
        assert (
            np.abs(moments.raw[part] - truth[part]).max()
            <= ulps * np.finfo(float).eps * np.abs(truth[part]).max()
        )


def test_box_is_its_closed_form(path):
    low, high = (1, 2, 3), (3, 5, 8)
    points, truth = np.array(exact.box(low, high), float), exact.box_moments(low, high)
    assert_exact(Surface(points, quads=np.array(exact.BOX_QUADS)), truth)
    assert_exact(Surface(points, np.array(exact.fan(exact.BOX_QUADS))), truth)


def test_box_about_its_centre_is_exact(path):
    surface = Surface(
        np.array(exact.box((0, 0, 0), (2, 3, 5)), float), quads=np.array(exact.BOX_QUADS)
    )
    volume, area = polyhedron_moments(surface, area_order=0)
    assert volume.total == 30.0 and area.total == 62.0
    assert volume.about.tolist() == [1.0, 1.5, 2.5]
    assert volume.raw[1:10].tolist() == [0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 22.5, 0.0, 62.5]


def test_corner_tetrahedron_is_dirichlets_integral(path):
    points = np.array([(0, 0, 0), (2, 0, 0), (0, 3, 0), (0, 0, 5)], float)
    assert_exact(Surface(points, np.array(TETRAHEDRON)), exact.corner_tetrahedron_moments(2, 3, 5))


def test_l_prism_has_the_published_inertia(path):
    points, faces = exact.prism(L_OUTLINE, 0, 1, L_CAPS)
    moments = polyhedron_moments(Surface(np.array(points, float), np.array(exact.fan(faces))))[0]
    assert close(moments.total, 5.0, rel=1e-14)
    assert close(moments.center, [1.1, 1.1, 0.5], rel=1e-14)
    second = moments.about_center().second()
    inertia = np.trace(second) * np.eye(3) - second
    assert close(np.diag(inertia), [121 / 30, 121 / 30, 217 / 30], rel=4e-15)
    assert close(inertia[0, 1], 1.8, rel=4e-15)
    third = polyhedron_moments(
        Surface(np.array(points, float), np.array(exact.fan(faces))), exact=True
    )[0].about_center()
    assert [
        third[3, 0, 0],
        third[0, 3, 0],
        third[2, 1, 0],
        third[1, 2, 0],
        third[0, 0, 3],
    ] == pytest.approx([2.16, 2.16, -0.84, -0.84, 0.0], abs=2e-14)


def test_surface_accepts_integer_types_and_refuses_others():
    points, triangles = exact.box((0, 0, 0), (2, 3, 5)), exact.fan(exact.BOX_QUADS)
    for kind in (np.uint8, np.int16, np.uint32, np.int64, np.uint64, ">i4", "<i8", ">u2"):
        assert_exact(
            Surface.from_triangles(np.array(points, int), np.array(triangles, kind)),
            exact.box_moments((0, 0, 0), (2, 3, 5)),
        )
    wrong = [
        (np.array(points)[:, :2], triangles),
        (points, exact.BOX_QUADS),
        (points, np.array(triangles, float)),
        (points, np.array(triangles) - 1),
        (points[:-1], triangles),
    ]
    for these, corners in wrong:
        with pytest.raises(ValueError):
            Surface.from_triangles(these, corners)


@holds(200)
@given(mesh=random_meshes(40, 1e-60))
def test_the_bound_holds_for_random_meshes(path, mesh):
    assert_bounds_hold(Surface(*mesh))


@holds(8)
@given(seed=seeds)
def test_the_bound_holds_for_slivers(path, seed):
    rng = np.random.default_rng(seed)
    points, quads = grid_torus(6, 5, noise=1e-3, seed=seed)
    points[quads[:, 1]] = points[quads[:, 0]] + 10.0 ** rng.uniform(-14, -3) * rng.standard_normal(
        (len(quads), 3)
    )
    points += 10.0 ** rng.uniform(-3, 6)
    triangles = Surface(points, quads=quads).all_triangles()[0]
    assert_bounds_hold(Surface(points, triangles))


def fine_box(n):
    """Quads of the box from (1, 2, 3) to (3, 5, 8) with n² on each side, n a power of two: points
    and quads.
    """
    i, j = (values.ravel() for values in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    corners = np.stack([[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]])  # (4, 2, n²)
    sides = []
    for axis in range(3):
        for end in (0, n):
            grid = np.insert(corners if end else corners[::-1], 0, end, axis=1)
            sides.append(np.roll(grid, axis, axis=1).transpose(2, 0, 1))
    places, quads = np.unique(np.concatenate(sides).reshape(-1, 3), axis=0, return_inverse=True)
    return np.array([1.0, 2.0, 3.0]) + np.array([2.0, 3.0, 5.0]) / n * places, quads.reshape(-1, 4)


def test_third_moments_of_many_triangles_match_the_closed_form():
    """Without `exact` the third moments of a large mesh state how much they leave out."""
    points, quads = fine_box(128)
    truth = exact.box_moments((-1, -1.5, -2.5), (1, 1.5, 2.5))
    for threads in (1, 2):
        for surface in (
            Surface(points, quads=quads),
            Surface(points, Surface(points, quads=quads).all_triangles()[0]),
        ):
            fine, coarse = (
                polyhedron_moments(surface, exact=choice, threads=threads)[0]
                for choice in (True, False)
            )
            assert fine.about.tolist() == coarse.about.tolist() == [2.0, 3.5, 5.5]
            assert_within(fine, truth)
            assert_within(coarse, truth)
            assert fine.rounding_error[10:].max() < 1e-10 < 1e-6 < coarse.rounding_error[10:].max()


@pytest.mark.parametrize("cut", [False, True])
def test_many_triangles_are_summed_to_the_last_digits(cut):
    """Adding the same cones one after the other loses four digits."""
    points, quads = fine_box(128)
    surface = Surface(points / 3.0, quads=quads)
    triangles = surface.all_triangles()[0]
    volume = polyhedron_moments(Surface(surface.points, triangles) if cut else surface)[0]
    corners = (surface.points - volume.about)[triangles]
    naive = np.cumsum(np.linalg.det(corners))[-1] / 6.0
    ends = ([Fraction(x) - Fraction(o) for x, o in zip(box, volume.about)] for box in surface.box)
    truth = exact.box_moments(*ends)
    for i in (0, 4, 7, 9):  # 1, xx, yy, zz
        assert abs(Fraction(volume.raw[i]) / truth[i] - 1) < 8 * 2.0**-53
    assert abs(Fraction(naive) / truth[0] - 1) > 10_000 * 2.0**-53


def test_the_bound_is_not_vacuous_for_a_clean_body():
    points, quads = grid_torus(250, 200)
    moments = polyhedron_moments(Surface(points, Surface(points, quads=quads).all_triangles()[0]))[
        0
    ]
    assert moments.rounding_error[0] < 1e-12 * moments.total
    # the body is about one unit in size
    assert moments.rounding_error[1:4].max() < 1e-12 * moments.total
    assert moments.rounding_error[4:10].max() < 1e-12 * np.trace(moments.second())


@holds(20)
@given(seed=seeds)
def test_the_input_bound_covers_every_float32_half_ulp(path, seed):
    rng = np.random.default_rng(seed)
    points, quads = grid_torus(7, 5, noise=0.03, seed=seed)
    points = (points * 10.0 ** rng.uniform(-3, 2) + 10.0 ** rng.uniform(-2, 3)).astype(np.float32)
    surface = Surface(points, Surface(points, quads=quads).all_triangles()[0])
    volume, area = polyhedron_moments(surface, area_order=3)
    moved = points.astype(float) + surface.coordinate_error * rng.choice([-1.0, 1.0], points.shape)
    for moments, formula in ((volume, exact.volume_moments), (area, exact.area_moments)):
        assert_within(
            moments,
            formula(moved, surface.triangles, moments.about),
            moments.rounding_error + moments.input_error,
        )


def test_float64_points_have_no_input_bound():
    points, quads = grid_torus()
    assert not polyhedron_moments(Surface(points, quads=quads))[0].input_error.any()


def test_brick_one_kilometer_away_is_right_to_float32():
    corners = np.array(exact.box((1000.0, 1000.0, 0.0), (1000.02, 1000.03, 0.05)), np.float32)
    surface = Surface(corners, quads=np.array(exact.BOX_QUADS))
    volume, area = polyhedron_moments(surface, area_order=0)
    assert abs(volume.total - 3e-5) <= volume.input_error[0] + volume.rounding_error[0]
    assert abs(area.total - 0.0062) <= area.input_error[0] + area.rounding_error[0]
    step = np.linalg.norm(surface.coordinate_error)  # 4e-5, a tenth of a percent of the brick
    assert volume.input_error[0] < 1.1 * step * area.total


@pytest.mark.parametrize("factor", [1e4, 1e6])
def test_relative_errors_stay_below_1e_14_far_from_the_origin(factor):
    points, quads = grid_torus(40, 30, noise=1e-2)
    points = np.round((points + factor * np.array([1.0, -2.0, 3.0])) * 2.0**20) / 2.0**20
    triangles = Surface(points, quads=quads).all_triangles()[0]
    moments = polyhedron_moments(Surface(points, triangles))[0]
    truth = exact.volume_moments(points, triangles, moments.about)
    assert abs(Fraction(moments.total) / truth[0] - 1) < 1e-14
    centre = [value / truth[0] for value in truth[1:4]]
    assert (
        max(
            abs(Fraction(float(m)) / Fraction(moments.total) - c)
            for m, c in zip(moments.raw[1:4], centre)
        )
        < 1e-14
    )
    size = float(truth[4] + truth[7] + truth[9])
    assert (
        max(
            abs(float(value) - float(right)) for value, right in zip(moments.raw[4:10], truth[4:10])
        )
        < 1e-14 * size
    )


@pytest.mark.parametrize("exponent", [8, 110, -105])
@pytest.mark.parametrize("area_order", [None, 0, 3])
@pytest.mark.parametrize("about", [None, (0.25, -0.5, 0.125)])
def test_float32_bounds_scale_exactly_with_powers_of_two(path, about, area_order, exponent):
    """Bounds hold even if they would leave the range of numbers unscaled."""
    points, quads = grid_torus(noise=0.05)
    points = (np.round(points * 2.0**16) / 2.0**16).astype(np.float32)
    if about is None:
        points[0], points[1] = 2.0, -2.0  # so that the middle is one of their numbers
    triangles = Surface(points, quads=quads).all_triangles()[0]
    plain, scaled = (
        polyhedron_moments(
            Surface(np.ldexp(points, n), triangles),
            area_order=area_order,
            about=None if about is None else np.ldexp(about, n),
        )
        for n in (0, exponent)
    )
    for one, other, dimension in zip(plain, scaled, (3, 2)):
        if one is None:
            assert other is None
            continue
        powers = exponent * (np.array([sum(m) for m in MONOMIALS[: len(one.raw)]]) + dimension)
        assert np.array_equal(other.about, np.ldexp(one.about, exponent))
        for name in ("raw", "rounding_error", "input_error"):
            assert close(getattr(other, name), np.ldexp(getattr(one, name), powers), rel=1e-12), (
                name
            )


@pytest.mark.parametrize("exponent", [-190, -140, -30, 30, 100])
def test_moments_scale_exactly_with_powers_of_two(exponent):
    points, quads = grid_torus(noise=0.05)
    triangles = Surface(points, quads=quads).all_triangles()[0]
    plain = polyhedron_moments(Surface(points, triangles))[0]
    scaled = polyhedron_moments(Surface(np.ldexp(points, exponent), triangles))[0]
    powers = exponent * np.array([sum(m) + 3 for m in MONOMIALS])
    assert scaled.about.tolist() == np.ldexp(plain.about, exponent).tolist()
    difference = np.abs(scaled.raw - np.ldexp(plain.raw, powers))
    assert (difference <= np.ldexp(plain.rounding_error, powers) + np.finfo(float).tiny).all()
    assert (scaled.rounding_error >= difference).all()


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_bound_holds_for_float32_points_near_a_far_center(path, scale):
    rng = np.random.default_rng(5)
    points, quads = grid_torus(8, 6, noise=0.05)
    points = (points + [1.0, 2.0, 0.5]) * scale
    points[::3] *= 1e-14 * rng.random((len(points[::3]), 1))
    points[::5, 1] = 1e-30
    assert_bounds_hold(Surface(points.astype(np.float32), quads=quads))


def test_errors_in_threads_reach_the_caller():
    points, quads = grid_torus(600, 450)
    quads[-1, -1] = len(points)
    with pytest.raises(ValueError, match="vertex"):
        polyhedron_moments(Surface(points, quads=quads), threads=2)[0]


@holds(20)
@given(seed=seeds, scale=st.sampled_from([1.0, 1e-12, 1e-3, 1e9, 1e12]))
def test_quads_are_cut_as_blender_cuts_them(path, seed, scale):
    rng = np.random.default_rng(seed)
    points, quads = grid_torus(8, 6, noise=0.12, seed=seed)
    points = (points * scale).astype(np.float32)
    # Nearly flat against the rule, collinear corners and quads folded onto themselves.
    loose = rng.integers(0, len(points), (40, 4))
    quads = np.concatenate([quads, loose, quads[:5, [0, 1, 1, 2]], quads[:5, [0, 2, 1, 3]]])
    surface = Surface(points, quads=quads)
    assert flipped_quads(points, quads).any() or scale in (1e-12, 1e12)
    assert_bounds_hold(surface)


def test_corners_beyond_float32_are_cut_without_a_warning():
    points = np.array([[-3e38, 0, 0], [3e38, 0, 0], [3e38, 3e38, 0], [-3e38, 3e38, 0]], np.float32)
    assert not flipped_quads(points, np.array([[0, 1, 2, 3]])).any()


def test_quads_on_the_edge_of_the_rule_are_decided_in_float32(path):
    """Arrow heads with normals at right angles to within rounding: float64 alone would often decide
    otherwise.
    """
    rng = np.random.default_rng(3)
    count = 300
    a, c = np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    b = np.stack([rng.uniform(0.2, 0.8, count), np.cos(angle), np.sin(angle)], axis=1)
    d = np.stack([rng.uniform(0.2, 0.8, count), -np.sin(angle), np.cos(angle)], axis=1)
    points = np.stack(
        [np.broadcast_to(a, b.shape), b, np.broadcast_to(c, b.shape), d], axis=1
    ).reshape(-1, 3)
    points = (points @ rotation(3).T + rng.uniform(-3.0, 3.0, 3)).astype(np.float32)
    quads = np.arange(len(points)).reshape(-1, 4)
    flips = flipped_quads(points, quads)
    assert 50 < flips.sum() < 250
    assert_bounds_hold(Surface(points, quads=quads))


def test_area_of_slivers_keeps_its_digits():
    for height in (1e-6, 1e-8, 1e-12):
        points = np.array([(0, 0, 0), (1, 0, 0), (0.37, height, 0)])
        assert close(
            polyhedron_moments(Surface(points, np.array([[0, 1, 2]])), area_order=0)[1].total,
            height / 2,
            rel=1e-15,
        )
