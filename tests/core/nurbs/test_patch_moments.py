# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of patches against rational arithmetic and closed forms; estimates against finer rules."""

import numpy as np
import pytest
from body_moments.core.moments.moments import U, monomials
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.numerics.quadrature import gauss_legendre_with_ends
from body_moments.core.nurbs import patch_moments
from body_moments.core.nurbs.bezier import cells_of
from body_moments.core.nurbs.patch import Patch
from body_moments.core.nurbs.patch_moments import (
    area_moments,
    exact_points,
    sheet_moments,
    sum_over_points,
    volume_moments,
    weighted_monomials,
)

from tests.close import close
from tests.core.exact_splines import flux_moment, sphere, torus
from tests.core.findings import refused

ORIGIN = np.zeros(3)


def random_patch(rng, spaces, weights=None):
    """Control points with few bits, so that rational arithmetic stays small."""
    shape = (spaces[0].count, spaces[1].count)
    return Patch(spaces, rng.integers(-8, 9, (*shape, 3)) / 8.0, weights)


def z_flux_difference(patch, exponents):
    """What the flux of the cone from the origin over the rim adds to the z-flux of the patch: the radial flux is the
    patch's alone, and both are one for a closed body, so the rim's cones are measured exactly as patches too."""
    total = flux_moment(patch, exponents)
    for axis, end, forward in ((1, 0, True), (0, 1, True), (1, 1, False), (0, 0, False)):
        curve = patch.side(axis, end)
        cone = Patch((clamped_space(2), curve.space), np.stack([np.zeros_like(curve.points), curve.points]))
        total += flux_moment(cone.reverse_orientation() if forward else cone, exponents)
    return total


@pytest.mark.parametrize("orders", [(2, 2), (3, 2), (3, 3), (4, 4), (5, 3), (5, 5), (6, 6)])
def test_polynomial_patches_are_exact_at_every_order(orders):
    rng = np.random.default_rng(sum(orders))
    patch = random_patch(rng, tuple(clamped_space(order) for order in orders))
    moments, converged = volume_moments([patch], 3, ORIGIN)
    assert converged
    exponents = [(0, 0, 0), (1, 0, 0), (0, 0, 2), (1, 1, 1)] if max(orders) < 6 else [(0, 0, 0), (0, 1, 0), (1, 1, 0)]
    for row in exponents:
        exact = float(z_flux_difference(patch, row))
        scale = np.linalg.norm(patch.points, axis=2).max() ** sum(row) * max(abs(moments.total), 1e-3)
        assert abs(moments[row] - exact) <= 1e-13 * scale
        assert abs(moments[row] - exact) <= moments.rounding_error[np.argwhere((monomials(3) == row).all(axis=1))[0, 0]]


def test_several_spans_with_uneven_and_repeated_knots_are_exact():
    rng = np.random.default_rng(3)
    spaces = clamped_space(3, (0.25, 0.375)), SplineSpace((0.0, 0.5, 1.0, 1.5, 2.0, 2.0, 3.0, 3.25, 4.0, 5.0), 4, 6)
    patch = random_patch(rng, spaces)
    moments, _ = volume_moments([patch], 2, ORIGIN)
    for row in [(0, 0, 0), (0, 1, 0), (1, 0, 1)]:
        exact = float(z_flux_difference(patch, row))
        assert abs(moments[row] - exact) <= 1e-14


@pytest.mark.parametrize("order, degree, count", [(4, 0, 4), (4, 1, 6), (4, 2, 7), (4, 3, 9), (4, 4, 10), (2, 0, 1)])
def test_the_number_of_gauss_points_is_what_the_degree_needs(order, degree, count):
    assert exact_points(order, degree) == count


def test_one_gauss_point_fewer_would_not_do():
    rng = np.random.default_rng(0)
    patch = random_patch(rng, (clamped_space(4), clamped_space(4)))
    exact = float(z_flux_difference(patch, (1, 0, 0)))

    def flux(number):
        return fixed_flux(next(cells_of([patch], ORIGIN)), number, 1)[1] / 4.0

    needed = exact_points(4, 1)
    assert abs(flux(needed) - exact) <= 1e-14
    assert abs(flux(needed - 1) - exact) > 1e-9


@pytest.mark.parametrize("shift", [0.0, 1e3])
def test_the_unit_sphere_and_a_torus_are_exact(shift):
    move = np.eye(4)
    move[:3, 3] = shift * np.array([1.0, -2.0, 0.5])
    moments, converged = volume_moments([sphere().transform(move)], 4)
    noise = 1e-14 if shift == 0.0 else 1e-11  # control points far away are rounded themselves
    assert converged
    assert abs(moments.total / (4.0 * np.pi / 3.0) - 1.0) <= noise
    for row in np.eye(3, dtype=int):
        assert abs(moments[tuple(2 * row)] / (4.0 * np.pi / 15.0) - 1.0) <= noise
        assert abs(moments[tuple(4 * row)] / (4.0 * np.pi / 35.0) - 1.0) <= noise
    R, r = 0.75, 0.25
    volume = 2.0 * np.pi**2 * R * r**2
    moments, converged = volume_moments([torus(R, r).transform(move)], 2)
    assert converged
    assert abs(moments.total / volume - 1.0) <= noise
    assert abs(moments[0, 0, 2] / (volume * r**2 / 4.0) - 1.0) <= 10.0 * noise
    assert abs(moments[2, 0, 0] / (volume * (4.0 * R**2 + 3.0 * r**2) / 8.0) - 1.0) <= noise


def test_a_sphere_stored_in_float32_encloses_what_its_weights_say():
    ball = sphere()
    points = (ball.points * np.float64(np.float32(0.99999988))).astype(np.float32)
    weights = ball.weights.astype(np.float32)
    moments, _ = volume_moments([Patch(ball.spaces, points, weights)])
    assert abs(moments.total / (4.0 * np.pi / 3.0) - 1.0) < 1e-6


@pytest.mark.parametrize(
    "matrix",
    [
        np.diag([2.0, 3.0, 0.5, 1.0]),
        np.diag([1e-6, 1e-6, 1e-6, 1.0]),
        np.array([[1, 0.3, 0, 5], [0, 1, -0.7, -2], [0.2, 0, 1, 1], [0, 0, 0, 1.0]]),
    ],
)
def test_moments_of_a_mapped_patch_are_the_mapped_moments(matrix):
    plain, _ = volume_moments([torus()])
    mapped, _ = volume_moments([torus().transform(matrix)])
    expected = plain.transform(matrix).about_point(mapped.about)
    reach = np.linalg.norm(torus().transform(matrix).points - mapped.about, axis=2).max()
    scale = reach ** monomials(3).sum(axis=1) * mapped.total
    assert (np.abs(mapped.raw - expected.raw) <= 2e-14 * scale).all()


def test_a_turned_patch_has_the_opposite_flux():
    plain, _ = volume_moments([sphere()])
    turned, _ = volume_moments([sphere().reverse_orientation()])
    assert np.abs(plain.raw + turned.raw).max() <= 1e-15


def fixed_flux(cells, points, order):
    """By one rule of so many points along each direction."""
    (s, along, across), weights = cells.evaluate(((points,), (points,)))
    density = (s * np.cross(along, across, axis=0)).sum(axis=0)
    return sum_over_points(weighted_monomials(s, density, order), weights)[0].sum(axis=1)


def truth(patch, order, pieces=4, points=40):
    """The flux by a fixed rule in pieces of every cell, with no estimate to trust."""
    cells = next(cells_of([patch], ORIGIN))
    for _ in range(pieces):
        cells = cells.split()
    return sum(fixed_flux(cells[k : k + 64], points, order) for k in range(0, len(cells), 64)) / (
        monomials(order).sum(axis=1) + 3.0
    )


def random_rational(rng, spread):
    orders = rng.integers(2, 5, 2)
    spaces = tuple(clamped_space(int(order), (0.5,) * int(rng.random() < 0.2)) for order in orders)
    shape = tuple(space.count for space in spaces)
    return Patch(spaces, rng.uniform(-1.0, 1.0, (*shape, 3)), 10.0 ** rng.uniform(-spread, spread, shape))


@pytest.mark.parametrize("seed", range(10))
def test_the_estimate_is_never_below_the_true_error_of_random_rational_patches(seed, monkeypatch):
    """1,000 patches in all, weights from 0.1 to 10, against rules of twice as many points."""
    rng = np.random.default_rng(seed)
    patches = [random_rational(rng, 1.0) for _ in range(100)]
    found = [volume_moments([patch], 2, ORIGIN) for patch in patches]
    monkeypatch.setattr(patch_moments, "RULES", tuple(2 * points for points in patch_moments.RULES))
    for patch, (moments, converged) in zip(patches, found):
        exact, _ = volume_moments([patch], 2, ORIGIN)
        assert converged
        assert (np.abs(moments.raw - exact.raw) <= moments.rounding_error).all()
        assert moments.rounding_error[0] <= 1e-12  # so it tells something


def test_the_estimate_holds_where_points_were_not_enough(monkeypatch):
    rng = np.random.default_rng(21)
    patches = [random_rational(rng, 2.0) for _ in range(40)]
    exact = [volume_moments([patch], 2, ORIGIN)[0] for patch in patches]
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 3000)
    unconverged = 0
    for patch, one in zip(patches, exact):
        moments, converged = volume_moments([patch], 2, ORIGIN)
        unconverged += not converged
        assert (np.abs(moments.raw - one.raw) <= moments.rounding_error + one.rounding_error).all()
    assert unconverged >= 20


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 4e-15])
def test_the_estimate_holds_against_a_fixed_fine_rule(tolerance):
    rng = np.random.default_rng(8)
    for _ in range(8):
        patch = random_rational(rng, 1.0)
        moments, converged = volume_moments([patch], 2, ORIGIN, tolerance=tolerance)
        assert converged
        assert (np.abs(moments.raw - truth(patch, 2)) <= moments.rounding_error + 1e-14).all()


@pytest.mark.parametrize("weight", [1e8, 1e12, 1e30])
@pytest.mark.parametrize("heavy", [(1, 1), (2, 2)])
def test_the_estimate_holds_where_a_weight_draws_all_but_a_rim_to_a_point(weight, heavy, monkeypatch):
    """The more, the nearer comes an octant of the sphere to the cone over its rim, while rules see a point."""
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 300_000)
    ball = sphere()
    points, weights = ball.points[:3, :3], ball.weights[:3, :3].copy()
    rim = closed_by_cones(Patch((clamped_space(3),) * 2, points, weights), points[heavy])[1:]
    volume = -volume_moments(rim, 0, ORIGIN)[0].total
    area = area_moments(rim)[0].total
    weights[heavy] = weight
    octant = Patch((clamped_space(3),) * 2, points, weights)
    for (found, converged), limit in ((volume_moments([octant], 0, ORIGIN), volume), (area_moments([octant]), area)):
        assert abs(found.total - limit) <= found.rounding_error[0] + 100.0 / weight * limit
        assert not converged


def test_areas_of_spheres_and_tori_come_with_an_estimate_that_holds():
    moments, converged = area_moments([sphere()], 2)
    assert converged and abs(moments.total - 4.0 * np.pi) <= moments.rounding_error[0] <= 1e-9
    assert abs(moments[2, 0, 0] - 4.0 * np.pi / 3.0) <= moments.rounding_error[4]
    moments, _ = area_moments([torus()], 0)
    assert abs(moments.total - 4.0 * np.pi**2 * 0.75 * 0.25) <= moments.rounding_error[0] <= 1e-9


def test_the_area_of_a_patch_that_folds_back_has_an_estimate_that_holds():
    """A line that runs forth and back, dragged aside: its length, between its turns, is the area."""
    for third in (0.4, -0.1, -0.7, 0.99, 0.999):  # with the last ones it turns beyond all points of the coarse rules
        x = np.array([0.0, 1.0, third])  # x = 2 t (1 - t) + third t²
        turn = 1.0 / (2.0 - third)
        peak = 2.0 * turn * (1.0 - turn) + third * turn * turn
        points = np.stack([np.stack([x, 0.0 * x + side, 0.0 * x], axis=1) for side in (0.0, 1.0)], axis=1)
        moments, _ = area_moments([Patch((clamped_space(3), clamped_space(2)), points)])
        assert abs(moments.total - (2.0 * peak - third)) <= moments.rounding_error[0] <= 1e-6


def test_sheets_have_real_thickness():
    for low, high in ((-0.05, 0.05), (0.0, 0.1), (-0.3, -0.1)):
        moments, converged = sheet_moments([sphere()], low, high)
        assert converged
        assert abs(moments.total / (4.0 * np.pi / 3.0 * ((1 + high) ** 3 - (1 + low) ** 3)) - 1.0) <= 1e-13
        second = 4.0 * np.pi / 15.0 * ((1 + high) ** 5 - (1 + low) ** 5)
        assert abs(moments[0, 0, 2] / second - 1.0) <= 1e-13
    sheet, _ = sheet_moments([torus()], -0.05, 0.05)
    R, r = 0.75, 0.25
    shells = [2.0 * np.pi**2 * R * (r + h) ** 2 for h in (0.05, -0.05)]
    assert abs(sheet.total / (shells[0] - shells[1]) - 1.0) <= 1e-13


def test_the_estimate_of_a_sheet_tells_what_heavy_weights_hide(monkeypatch):
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 300_000)
    weights = np.ones((3, 3))
    weights[1, 1] = 1e12
    square = Patch((clamped_space(3),) * 2, [[(i, j, 0) for j in range(3)] for i in range(3)], weights)
    found, converged = sheet_moments([square], 0.0, 1e-3)
    assert not converged and abs(found.total - 4e-3) <= found.rounding_error[0] <= 0.1


def test_a_sheet_thicker_than_its_radius_is_refused():
    with refused("wall_thicker_than_curvature"):
        sheet_moments([torus()], -0.3, 0.3)
    sheet_moments([torus()], -0.24, 0.24)
    with refused("wall_thicker_than_curvature"):
        sheet_moments([sphere()], -1.5, 1.5)  # beyond the center both curvatures are: their product is positive again


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, np.inf])
def test_weights_that_are_not_positive_are_refused(bad):
    weights = np.ones((3, 3))
    weights[1, 1] = bad
    with refused("non_positive_weights"):
        Patch((clamped_space(3), clamped_space(3)), np.zeros((3, 3, 3)), weights)


def test_points_that_are_not_finite_are_refused():
    points = np.zeros((3, 3, 3))
    points[0, 0, 0] = np.nan
    with refused("non_finite_control_points"):
        Patch((clamped_space(3), clamped_space(3)), points)


def test_equal_weights_make_a_polynomial_patch():
    assert Patch((clamped_space(3), clamped_space(3)), np.zeros((3, 3, 3)), np.full((3, 3), 0.7)).weights is None


@pytest.mark.parametrize("far", [2.0**7, 2.0**14, 2.0**20])
@pytest.mark.parametrize("weighted", [False, True])
def test_a_patch_far_from_the_point_is_as_exact_as_its_bound_says(weighted, far):
    """Its tangents must not be differences of what is as large as the distance, nor its rules disagree by it."""
    rng = np.random.default_rng(1)
    shape = (6, 5)
    points = rng.integers(-(2**20), 2**20, (*shape, 3)) / 2.0**20  # with the distance added still exact
    weights = 10.0 ** rng.uniform(-0.5, 0.5, shape) if weighted else None
    spaces = clamped_space(4, (0.25, 0.5)), clamped_space(3, (0.125, 0.75))
    here, _ = volume_moments(closed_by_cones(Patch(spaces, points, weights)), 2, ORIGIN)
    there, converged = volume_moments(closed_by_cones(Patch(spaces, points + far, weights), far), 2, ORIGIN)
    expected = here.about_point(np.full(3, -far))
    assert converged
    assert (np.abs(there.raw - expected.raw) <= there.rounding_error + expected.rounding_error).all()


def test_a_far_point_of_many_digits_does_not_round_the_patch():
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (6, 5, 3))
    patch = Patch((clamped_space(4, (0.25, 0.5)), clamped_space(3, (0.125, 0.75))), points)
    far = np.array([41000.1, -164000.7, -103000.3])
    there = volume_moments([patch], 0, far)[0]
    # S · (S_s x S_t) is linear in the point that S is about.
    expected = volume_moments([patch], 0, ORIGIN)[0].total - far @ patch_moments.vector_area([patch]) / 3.0
    assert abs(there.total - expected) <= there.rounding_error[0]


def closed_by_cones(patch, place=0.0):
    """With the cones from a point to its rim."""
    found = [patch]
    for axis, end, forward in ((1, 0, True), (0, 1, True), (1, 1, False), (0, 0, False)):
        curve = patch.side(axis, end)
        rim = np.round(curve.points * 2.0**20) / 2.0**20  # as they were
        ends = (np.full_like(rim, place), rim)[:: 1 if forward else -1]
        weights = None if curve.weights is None else np.stack([curve.weights] * 2, axis=1)
        found.append(Patch((curve.space, clamped_space(2)), np.stack(ends, axis=1), weights))
    return found


def test_nothing_is_computed_with_what_memory_held_before(monkeypatch):
    place, density = np.ones((3, 4)), np.ones(4)
    monkeypatch.setattr(np, "empty", lambda shape: np.full(shape, np.inf))
    assert (patch_moments.weighted_monomials(place, density, 3, 2)[-2:] == 0.0).all()
    assert (patch_moments.weighted_monomials(place, density, 3) == 1.0).all()


@pytest.mark.parametrize("kind", ["volume", "area", "sheet"])
@pytest.mark.parametrize("rational", [False, True])
def test_moments_and_their_bounds_scale_exactly_with_powers_of_two(kind, rational):
    rng = np.random.default_rng(2)
    spaces = clamped_space(3), clamped_space(4)
    points = np.stack(np.meshgrid(np.arange(3.0), np.arange(4.0), [0.0], indexing="ij"), axis=-1)[:, :, 0]
    points = points + 0.2 * rng.uniform(-1, 1, points.shape)
    weights = rng.uniform(0.5, 2.0, (3, 4)) if rational else None

    def measured(size):
        patches = [Patch(spaces, size * points, weights)]
        if kind == "volume":
            return volume_moments(patches, 3)[0]
        return area_moments(patches, 3)[0] if kind == "area" else sheet_moments(patches, 0.0, 0.01 * size, 3)[0]

    plain, scaled = measured(1.0), measured(0.125)
    powers = -3.0 * (monomials(3).sum(axis=1) + (2 if kind == "area" else 3))
    assert (scaled.about == 0.125 * plain.about).all()
    for name in ("raw", "rounding_error"):
        assert close(getattr(scaled, name), getattr(plain, name) * 2.0**powers, rel=1e-9), name


@pytest.mark.parametrize("order", [0, 3])
@pytest.mark.parametrize("size", [1e-3, 1.0, 50.0])
def test_what_rounding_leaves_is_64_units_of_the_tangents_product_for_each_order(order, size):
    """Of a slanted parallelogram |S_s| |S_t| is more than its area; its farthest corners are at half its diagonal."""
    s, t = size * np.array([2.0, 0.0, 0.0]), size * np.array([0.8, 0.1, 0.4])
    patch = Patch((clamped_space(2), clamped_space(4)), [[i * s + j / 3.0 * t for j in range(4)] for i in range(2)])
    degree = monomials(order).sum(axis=1)
    found, _ = volume_moments([patch], order)
    reach, product = np.linalg.norm(s + t) / 2.0, np.linalg.norm(s) * np.linalg.norm(t)
    expected = 64.0 * U * product * (2 + 4 + degree) * reach ** (degree + 1) / (degree + 3)
    assert close(found.rounding_error, expected, rel=1e-12)


def rules_apart(patch, order, coarse, fine):
    """What two rules differ by in each cell, the worst of all moments by what it could be at most."""
    cells, degree = next(cells_of([patch], ORIGIN)), monomials(order).sum(axis=1)
    one, other = ([fixed_flux(cells[k : k + 1], n, order) for k in range(len(cells))] for n in (coarse, fine))
    unit = np.linalg.norm(patch.points, axis=2).max() ** (degree + 1.0)
    return [np.max(np.abs(a - b) / unit) for a, b in zip(one, other)], unit / (degree + 3.0)


def test_where_rules_do_not_agree_yet_eight_times_what_they_differ_by_is_the_estimate(monkeypatch):
    """Two cells, of which the weights of one are all alike but for the other's: with no more points to spend."""
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 0)
    rng = np.random.default_rng(5)
    spaces = clamped_space(4, (0.5, 0.5, 0.5)), clamped_space(3)
    weights = rng.uniform(0.9, 1.1, (7, 3))
    weights[5, 1] = 60.0
    patch = Patch(spaces, rng.uniform(-1.0, 1.0, (7, 3, 3)), weights)
    found, converged = volume_moments([patch], 2, ORIGIN)
    (steady, steep), unit = rules_apart(patch, 2, 16, 24)
    assert not converged and steady < 1e-14 < 1e-7 < steep
    assert close(found.rounding_error, (steady + 8.0 * steep) * unit, rel=1e-4)


def test_where_rules_agree_what_they_differ_by_is_the_estimate():
    rng = np.random.default_rng(5)
    patch = Patch(
        (clamped_space(4), clamped_space(3)), rng.uniform(-1.0, 1.0, (4, 3, 3)), rng.uniform(0.2, 5.0, (4, 3))
    )
    found, converged = volume_moments([patch], 2, ORIGIN, tolerance=1e-3)
    (apart,), unit = rules_apart(patch, 2, 8, 12)
    assert converged and 1e-10 < apart < 1e-3 and close(found.rounding_error, apart * unit, rel=1e-3)


@pytest.fixture
def rules(monkeypatch):
    """(cells, points) of each rule that is evaluated, in their order."""
    asked, evaluate = [], patch_moments.integrand_in_blocks

    def note(cells, rule, integrand):
        asked.append((len(cells), *{points for along in rule for points in along}))
        return evaluate(cells, rule, integrand)

    monkeypatch.setattr(patch_moments, "integrand_in_blocks", note)
    return asked


def uneven_patch(weight):
    """Of one cell, one of whose weights is larger; it is bent a little, and does not fold."""
    weights = np.ones((4, 3))
    weights[1, 1] = weight
    weights[0, 2] = 0.9
    return Patch((clamped_space(4), clamped_space(3)), bent_sheet(0.2), weights)


def bent_patch(height):
    return Patch((clamped_space(4), clamped_space(3)), bent_sheet(height))


def bent_sheet(height):
    """(4, 3, 3) control points over a square."""
    flat = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0), [0.5], indexing="ij"), axis=-1)[:, :, 0] / (3, 2, 1)
    flat[..., 2] += height * np.random.default_rng(6).uniform(-1.0, 1.0, (4, 3))
    return flat


def fixed_area(cells, points, order):
    (s, along, across), weights = cells.evaluate(((points,), (points,)))
    length = np.linalg.norm(np.cross(along, across, axis=0), axis=0)
    return sum_over_points(weighted_monomials(s, length, order), weights)[0].sum(axis=1)


def volume_apart(patch, coarse, fine):
    """What two rules differ by, of ∫ |S_s| |S_t|."""
    (s, along, across), (s_weights, t_weights) = next(cells_of([patch], ORIGIN)).evaluate(((36,), (36,)))
    lengths = np.linalg.norm(along, axis=0) * np.linalg.norm(across, axis=0)
    size = np.einsum("mcn,mr,nr->", lengths, s_weights, t_weights)
    return rules_apart(patch, 2, coarse, fine)[0][0] / size


def area_apart(patch, coarse, fine):
    """What two rules differ by, of the area."""
    cells, reach = next(cells_of([patch], ORIGIN)), np.linalg.norm(patch.points, axis=2).max()
    one, other = (fixed_area(cells, points, 2) for points in (coarse, fine))
    return np.max(np.abs(one - other) / reach ** monomials(2).sum(axis=1)) / other[0]


@pytest.mark.parametrize(
    "of, points, share", [(volume_moments, (16, 24, 36), 1), (area_moments, (8, 12, 18), 2)], ids=["volume", "area"]
)
def test_rules_grow_by_halves_then_cells_are_cut_until_the_points_are_spent(rules, monkeypatch, of, points, share):
    """Of areas, half as many are enough."""
    few, some, many = points
    whole = [(1, few), (1, some), (1, many)]
    spent = few**2 + some**2 + many**2
    for limit, expected in (
        (0, whole[:2]),
        (share * (few**2 + some**2) - 1, whole[:2]),
        (share * (few**2 + some**2), whole),
        (share * spent - 1, whole),
        (share * spent, [*whole, (4, few), (4, some)]),
        (share * (spent + 4 * (few**2 + some**2)) - 1, [*whole, (4, few), (4, some)]),
    ):
        monkeypatch.setattr(patch_moments, "MAX_POINTS", limit)
        rules.clear()
        _, converged = of([uneven_patch(60.0)], 2, ORIGIN)
        assert (rules, converged) == (expected, False), limit
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 6_000_000)
    assert of([uneven_patch(60.0)], 2, ORIGIN)[1]
    rules.clear()
    assert of([uneven_patch(1.05)], 2, ORIGIN)[1] and rules[:2] == whole[:2]


@pytest.mark.parametrize(
    "of, apart, points, tolerance, patches",
    [
        (volume_moments, volume_apart, (16, 24, 36), 4e-15, [uneven_patch(1.02 * 1.3**k) for k in range(12)]),
        (area_moments, area_apart, (8, 12, 18), 1e-11, [bent_patch(0.01 * 1.3**k) for k in range(12)]),
    ],
    ids=["volume", "area"],
)
def test_rules_suffice_that_agree_to_the_tolerance(rules, of, apart, points, tolerance, patches):
    """Of sheets of ever more uneven weights, or bent ever more, until the finest rule is needed."""
    needed = []
    for patch in patches:
        share = apart(patch, *points[:2]) / tolerance
        if not 0.3 < share < 3.0:
            rules.clear()
            of([patch], 2, ORIGIN)
            asked = [number for _, number in rules[:3]]
            assert asked[:2] == list(points[:2]) and (points[2] in asked) == (share >= 3.0)
            needed += [share >= 3.0] * int(share < 1000.0)
    assert set(needed) == {False, True}


@pytest.mark.parametrize("share, is_cut", [(0.95, False), (1.05, True)])
def test_cells_are_cut_at_once_where_a_weight_is_a_million_times_another(rules, monkeypatch, share, is_cut):
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 16**2 + 24**2)
    volume_moments([uneven_patch(0.9e6 * share)], 2, ORIGIN)
    assert rules == [(1, 16), (1, 24), *([(4, 16), (4, 24)] if is_cut else [(1, 36)])]


@pytest.mark.parametrize("share, is_hidden", [(0.95, False), (1.05, True)])
def test_where_a_weight_is_a_hundred_times_another_what_it_may_hide_is_in_the_estimate(monkeypatch, share, is_hidden):
    """The square of the diagonal of its cell's box, where there are no more points to spend; beside a steady cell."""
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 0)
    rng, weights = np.random.default_rng(5), np.ones((7, 3))
    weights[5, 1], weights[0, 2] = 100.0 * share, 1.1
    spaces = clamped_space(4, (0.5, 0.5, 0.5)), clamped_space(3)
    patch = Patch(spaces, rng.uniform(-1.0, 1.0, (7, 3, 3)), weights)
    found, converged = volume_moments([patch], 2, ORIGIN)
    (steady, steep), unit = rules_apart(patch, 2, 16, 24)
    hidden = (np.ptp(patch.points[3:], axis=(0, 1)) ** 2).sum() * is_hidden
    assert not converged and steady < 1e-13
    assert close(found.rounding_error, (8.0 * steep + hidden) * unit, rel=1e-4)


@pytest.mark.parametrize("cell, share", [(0, 5.0), (1, 9.0)])
def test_a_cell_is_done_where_rules_agree_to_the_tolerance_of_its_size_or_its_share(rules, cell, share):
    """Of two cells of sizes 1 and 9. As soon as it is, no finer rule is asked for."""
    spaces = clamped_space(4, (0.5, 0.5, 0.5)), clamped_space(3)
    weights = np.random.default_rng(0).uniform(0.5, 2.0, (7, 3))
    (cells,) = cells_of([Patch(spaces, np.random.default_rng(1).normal(size=(7, 3, 3)), weights)], ORIGIN)
    first = cells.net[0, 0, 0, 0]
    for off, done in ((0.99, True), (1.01, False)):

        def terms(part, rule, off=off):
            which = (part.net[0, 0, :, 0] != first).astype(int)
            found = np.ones((1, 2, len(part)))
            found[0, 0] += (which == cell) * (rule[0] == (8,)) * off * 1e-3 * share
            found[0, 1] = np.array([1.0, 9.0])[which]
            return found

        rules.clear()
        found = patch_moments.integrate_adaptively([cells], terms, np.ones(1), 1e-3)
        assert rules == [(2, 8), (2, 12)] + [(1, 18)] * (not done)
        assert found.converged and close(found.values, [2.0], rel=1e-12) and found.size == 10.0
        assert close(found.estimate, off * 1e-3 * share, rel=1e-9) if done else found.estimate < 1e-12


@pytest.mark.parametrize("depth", [1, 3])
def test_cells_are_cut_so_often_and_at_once_where_a_weight_hides_what_lies_between(rules, monkeypatch, depth):
    monkeypatch.setattr(patch_moments, "MAX_DEPTH", depth)
    _, converged = volume_moments([uneven_patch(1e20)], 0, ORIGIN)
    assert not converged and {points for _, points in rules} == {16, 24}
    counts = [count for count, _ in rules]
    assert counts[::2] == counts[1::2] and counts[0] == 1 and counts[2] == 4 and len(counts) == 2 * (depth + 1)


def test_a_cell_is_cut_14_times(rules):
    """Where one part in each of its parts has a kink."""

    def kinked(cells, _rule):
        terms = np.zeros((1, 3, len(cells)))  # a moment, a size, a kink
        terms[:, 1], terms[:, 2, 0] = 1.0, 1.0
        return terms

    cells = next(cells_of([uneven_patch(1.0)], ORIGIN))
    found = patch_moments.integrate_adaptively([cells], kinked, np.ones(1), 1e-9)
    assert not found.converged and found.size == 1.0
    assert [count for count, _ in rules] == [1, 1, *[4, 4] * 14]


def test_of_areas_eight_times_what_rules_differ_by_is_the_estimate_and_64_times_where_they_do_not_agree(monkeypatch):
    """As patches may fold."""
    monkeypatch.setattr(patch_moments, "MAX_POINTS", 0)
    for height, factor in ((0.1, 8.0), (0.5, 64.0)):
        patch = Patch((clamped_space(4), clamped_space(3)), bent_sheet(height))
        found, converged = area_moments([patch], 2, ORIGIN)
        unit = np.linalg.norm(patch.points, axis=2).max() ** monomials(2).sum(axis=1)
        cells = next(cells_of([patch], ORIGIN))
        apart = np.max(np.abs(fixed_area(cells, 8, 2) - fixed_area(cells, 12, 2)) / unit)
        assert converged == (factor == 8.0) and apart > 1e-13
        assert close(found.rounding_error, factor * apart * unit, rel=0.1)


@pytest.mark.parametrize("about", [None, (3.0, -2.0, 5.0)])
@pytest.mark.parametrize("size", [1e-3, 1.0, 50.0])
def test_what_rounding_leaves_of_flat_areas_and_sheets_is_64_units_for_each_order(size, about):
    s, t = size * np.array([2.0, 0.0, 0.0]), size * np.array([0.8, 0.1, 0.4])
    patch = Patch((clamped_space(2), clamped_space(4)), [[i * s + j / 3.0 * t for j in range(4)] for i in range(2)])
    middle = (s + t) / 2.0
    place = middle if about is None else size * np.array(about)
    reach = max(np.linalg.norm(i * s + j * t - place) for i in (0, 1) for j in (0, 1))
    area, degree = np.linalg.norm(np.cross(s, t)), monomials(3).sum(axis=1)
    found, _ = area_moments([patch], 3, None if about is None else place)
    assert close(found.total, area, rel=1e-14) and close(found.about, place, rel=1e-14)
    assert close(found.rounding_error, 64.0 * U * 6 * area * reach**degree, rel=0.2)
    inner, outer = -0.1 * size, 0.3 * size
    found, _ = sheet_moments([patch], inner, outer, 3, None if about is None else place)
    assert close(found.total, area * (outer - inner), rel=1e-14) and close(found.about, place, rel=1e-14)
    expected = 64.0 * U * 6 * area * (outer - inner) * (reach + outer) ** degree
    assert close(found.rounding_error, expected, rel=0.2)


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("spans", [1, 10])
def test_the_slope_of_the_area_is_that_of_differences_by_every_control_point(spans, rational):
    """Ten spans are more than are looked at at a time."""
    rng = np.random.default_rng(4)
    spaces = clamped_space(3, tuple(np.arange(1, spans) / spans)), clamped_space(3)
    shape = (spaces[0].count, spaces[1].count)
    flat = np.stack(np.meshgrid(*map(np.arange, shape), [0.0], indexing="ij"), axis=-1)[:, :, 0]
    points = flat + 0.2 * rng.uniform(-1.0, 1.0, flat.shape) + (5.0, -3.0, 2.0)
    weights = rng.uniform(0.8, 1.25, shape) if rational else None
    total, step = 0.0, 1e-4
    for i, j in np.ndindex(*shape):
        gradient = []
        for axis in range(3):
            ends = []
            for sign in (1.0, -1.0):
                moved = points.copy()
                moved[i, j, axis] += sign * step
                ends.append(area_moments([Patch(spaces, moved, weights)])[0].total)
            gradient.append((ends[0] - ends[1]) / (2.0 * step))
        total += np.linalg.norm(gradient)
    patch = Patch(spaces, points, weights)
    assert close(patch_moments.area_slope([patch]), total, rel=1e-5)
    larger = patch.transform(np.diag([7.0, 7.0, 7.0, 1.0]))
    assert close(patch_moments.area_slope([patch, larger]), 8.0 * total, rel=1e-5)


@pytest.mark.parametrize("rational", [False, True])
def test_the_slope_of_the_area_is_the_same_far_away(rational):
    rng = np.random.default_rng(4)
    weights = rng.uniform(0.8, 1.25, (4, 3)) if rational else None
    points = np.round(bent_sheet(0.2) * 2.0**10) / 2.0**10
    near, far = (
        patch_moments.area_slope([Patch((clamped_space(4), clamped_space(3)), points + by, weights)])
        for by in (0.0, 2.0**40)
    )
    assert close(far, near, rel=1e-12)


@pytest.mark.parametrize("size", [1.0, 50.0])
@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("last, counts", [(-2.0, True), (-1e-8, True), (-1e-10, False), (2.0, False)])
def test_where_a_patch_turns_over_the_area_between_its_points_counts(swapped, last, counts, size):
    """Of three cells the second one turns over along one direction, between two points; at a pole all is rounding."""
    counts_along = (5, 3)
    nodes, weights = zip(*(gauss_legendre_with_ends(points) for points in counts_along))
    height = np.ones((7, 3, 5))
    height[:3] = 0.7
    height[4:, 1] = last
    normal = np.multiply.outer([0.6, 0.0, -0.8], size * height)
    rule = tuple((points,) for points in counts_along)
    if swapped:
        normal, rule, weights = normal.swapaxes(1, 3), rule[::-1], weights[::-1]
    found = patch_moments._reversed_areas(normal, tuple(one[:, None] for one in weights), rule)
    width = nodes[0][4] - nodes[0][3]
    assert close(found, [0.0, size * (1.0 + abs(last)) * width / 2.0 if counts else 0.0, 0.0], rel=1e-13)


def test_volumes_and_sheets_have_moments_to_third_order_and_areas_their_total_alone():
    patch = Patch((clamped_space(4), clamped_space(3)), bent_sheet(0.1))
    found = volume_moments([patch])[0], sheet_moments([patch], 0.0, 0.01)[0], area_moments([patch])[0]
    assert [moments.order for moments in found] == [3, 3, 0]
