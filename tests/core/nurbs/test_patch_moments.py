# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of patches against rational arithmetic and closed forms; estimates against finer
rules.
"""

import numpy as np
import pytest
from body_moments.core.moments.raw import monomials
from body_moments.core.numerics import SplineSpace, clamped_space
from body_moments.core.nurbs import Patch, bezier_patches, patch_moments
from body_moments.core.nurbs.bezier import cells_of
from body_moments.core.nurbs.patch_moments import (
    area_moments,
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
    """Return the flux of the cone from the origin over the rim that completes the z-flux of the
    patch. The radial flux belongs to the patch alone, and both agree for a closed body; the rim's
    cones are measured exactly as patches too.
    """
    total = flux_moment(patch, exponents)
    for axis, end, forward in ((1, 0, True), (0, 1, True), (1, 1, False), (0, 0, False)):
        curve = patch.side(axis, end)
        cone = Patch(
            (clamped_space(2), curve.space), np.stack([np.zeros_like(curve.points), curve.points])
        )
        total += flux_moment(cone.reverse_orientation() if forward else cone, exponents)
    return total


@pytest.mark.parametrize("orders", [(2, 2), (3, 2), (3, 3), (4, 4), (5, 3), (5, 5), (6, 6)])
def test_polynomial_patches_are_exact_at_every_order(orders):
    rng = np.random.default_rng(sum(orders))
    patch = random_patch(rng, tuple(clamped_space(order) for order in orders))
    moments, converged = volume_moments([patch], 3, ORIGIN)
    assert converged
    exponents = (
        [(0, 0, 0), (1, 0, 0), (0, 0, 2), (1, 1, 1)]
        if max(orders) < 6
        else [(0, 0, 0), (0, 1, 0), (1, 1, 0)]
    )
    for row in exponents:
        exact = float(z_flux_difference(patch, row))
        scale = np.linalg.norm(patch.points, axis=2).max() ** sum(row) * max(
            abs(moments.total), 1e-3
        )
        assert abs(moments[row] - exact) <= 1e-13 * scale
        assert (
            abs(moments[row] - exact)
            <= moments.rounding_error[np.argwhere((monomials(3) == row).all(axis=1))[0, 0]]
        )


def test_several_spans_with_uneven_and_repeated_knots_are_exact():
    rng = np.random.default_rng(3)
    spaces = (
        clamped_space(3, (0.25, 0.375)),
        SplineSpace((0.0, 0.5, 1.0, 1.5, 2.0, 2.0, 3.0, 3.25, 4.0, 5.0), 4, 6),
    )
    patch = random_patch(rng, spaces)
    moments, _ = volume_moments([patch], 2, ORIGIN)
    for row in [(0, 0, 0), (0, 1, 0), (1, 0, 1)]:
        exact = float(z_flux_difference(patch, row))
        assert abs(moments[row] - exact) <= 1e-14


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


def test_float32_sphere_encloses_the_volume_of_its_weights():
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
    assert np.abs(plain.raw + turned.raw).max() <= 1e-14


def fixed_flux(cells, points, order):
    """Integrate by one rule of this many points along each direction."""
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
    return Patch(
        spaces, rng.uniform(-1.0, 1.0, (*shape, 3)), 10.0 ** rng.uniform(-spread, spread, shape)
    )


@pytest.mark.parametrize("seed", range(10))
def test_estimate_covers_the_error_of_random_rational_patches(seed):
    """1,000 patches in all, weights from 0.1 to 10, against the sum of their quarters."""
    rng = np.random.default_rng(seed)
    patches = [random_rational(rng, 1.0) for _ in range(100)]
    found = [volume_moments([patch], 2, ORIGIN) for patch in patches]
    for patch, (moments, converged) in zip(patches, found):
        ends = [
            (low, (low + high) / 2.0, high)
            for low, high in (space.domain for space in patch.spaces)
        ]
        halves = [((low, middle), (middle, high)) for low, middle, high in ends]
        quarters = [
            part for u in halves[0] for v in halves[1] for part in bezier_patches(patch, (u, v))
        ]
        exact, _ = volume_moments(quarters, 2, ORIGIN)
        assert converged
        assert (
            np.abs(moments.raw - exact.raw) <= moments.rounding_error + exact.rounding_error
        ).all()
        assert moments.rounding_error[0] <= 1e-12  # so it tells something


def test_the_estimate_holds_against_a_fixed_fine_rule():
    rng = np.random.default_rng(8)
    for _ in range(8):
        patch = random_rational(rng, 1.0)
        moments, converged = volume_moments([patch], 2, ORIGIN)
        assert converged
        assert (np.abs(moments.raw - truth(patch, 2)) <= moments.rounding_error + 1e-14).all()


def test_area_estimate_of_spheres_and_tori_holds():
    moments, converged = area_moments([sphere()], 2)
    assert converged and abs(moments.total - 4.0 * np.pi) <= moments.rounding_error[0] <= 1e-9
    assert abs(moments[2, 0, 0] - 4.0 * np.pi / 3.0) <= moments.rounding_error[4]
    moments, _ = area_moments([torus()], 0)
    assert abs(moments.total - 4.0 * np.pi**2 * 0.75 * 0.25) <= moments.rounding_error[0] <= 1e-9


def test_area_estimate_of_a_folded_patch_holds():
    """A line that runs forth and back, dragged aside: its length, between its turns, is the
    area.
    """
    # with the last ones it turns beyond all points of the coarse rules
    for third in (
        0.4,
        -0.1,
        -0.7,
        0.99,
        0.999,
    ):
        x = np.array([0.0, 1.0, third])  # x = 2 t (1 - t) + third t²
        turn = 1.0 / (2.0 - third)
        peak = 2.0 * turn * (1.0 - turn) + third * turn * turn
        points = np.stack(
            [np.stack([x, 0.0 * x + side, 0.0 * x], axis=1) for side in (0.0, 1.0)], axis=1
        )
        moments, _ = area_moments([Patch((clamped_space(3), clamped_space(2)), points)])
        assert abs(moments.total - (2.0 * peak - third)) <= moments.rounding_error[0] <= 1e-6


def test_sheets_have_real_thickness():
    for low, high in ((-0.05, 0.05), (0.0, 0.1), (-0.3, -0.1)):
        moments, converged = sheet_moments([sphere()], low, high)
        assert converged
        assert (
            abs(moments.total / (4.0 * np.pi / 3.0 * ((1 + high) ** 3 - (1 + low) ** 3)) - 1.0)
            <= 1e-13
        )
        second = 4.0 * np.pi / 15.0 * ((1 + high) ** 5 - (1 + low) ** 5)
        assert abs(moments[0, 0, 2] / second - 1.0) <= 1e-13
    sheet, _ = sheet_moments([torus()], -0.05, 0.05)
    R, r = 0.75, 0.25
    shells = [2.0 * np.pi**2 * R * (r + h) ** 2 for h in (0.05, -0.05)]
    assert abs(sheet.total / (shells[0] - shells[1]) - 1.0) <= 1e-13


def test_a_sheet_thicker_than_its_radius_is_refused():
    with refused("wall_thicker_than_curvature"):
        sheet_moments([torus()], -0.3, 0.3)
    sheet_moments([torus()], -0.24, 0.24)
    with refused("wall_thicker_than_curvature"):
        # beyond the center both curvatures are: their product is positive again
        sheet_moments([sphere()], -1.5, 1.5)


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, np.inf])
def test_nonpositive_weights_are_refused(bad):
    weights = np.ones((3, 3))
    weights[1, 1] = bad
    with refused("control_points_invalid"):
        Patch((clamped_space(3), clamped_space(3)), np.zeros((3, 3, 3)), weights)


def test_nonfinite_points_are_refused():
    points = np.zeros((3, 3, 3))
    points[0, 0, 0] = np.nan
    with refused("control_points_invalid"):
        Patch((clamped_space(3), clamped_space(3)), points)


@pytest.mark.parametrize("far", [2.0**7, 2.0**14, 2.0**20])
@pytest.mark.parametrize("weighted", [False, True])
def test_patch_far_from_the_point_is_exact_within_its_bound(weighted, far):
    """Neither the tangents nor the agreement of rules may suffer from the distance."""
    rng = np.random.default_rng(1)
    shape = (6, 5)
    # with the distance added still exact
    points = rng.integers(-(2**20), 2**20, (*shape, 3)) / 2.0**20
    weights = 10.0 ** rng.uniform(-0.5, 0.5, shape) if weighted else None
    spaces = clamped_space(4, (0.25, 0.5)), clamped_space(3, (0.125, 0.75))
    here, _ = volume_moments(closed_by_cones(Patch(spaces, points, weights)), 2, ORIGIN)
    there, converged = volume_moments(
        closed_by_cones(Patch(spaces, points + far, weights), far), 2, ORIGIN
    )
    expected = here.about_point(np.full(3, -far))
    assert converged
    assert (
        np.abs(there.raw - expected.raw) <= there.rounding_error + expected.rounding_error
    ).all()


def test_a_far_point_of_many_digits_does_not_round_the_patch():
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (6, 5, 3))
    patch = Patch((clamped_space(4, (0.25, 0.5)), clamped_space(3, (0.125, 0.75))), points)
    far = np.array([41000.1, -164000.7, -103000.3])
    there = volume_moments([patch], 0, far)[0]
    # S · (S_s x S_t) is linear in the point that S is about.
    expected = (
        volume_moments([patch], 0, ORIGIN)[0].total - far @ patch_moments.vector_area([patch]) / 3.0
    )
    assert abs(there.total - expected) <= there.rounding_error[0]


def closed_by_cones(patch, place=0.0):
    """With the cones from a point to its rim."""
    found = [patch]
    for axis, end, forward in ((1, 0, True), (0, 1, True), (1, 1, False), (0, 0, False)):
        curve = patch.side(axis, end)
        rim = np.round(curve.points * 2.0**20) / 2.0**20  # rounded like the control points
        ends = (np.full_like(rim, place), rim)[:: 1 if forward else -1]
        weights = None if curve.weights is None else np.stack([curve.weights] * 2, axis=1)
        found.append(Patch((curve.space, clamped_space(2)), np.stack(ends, axis=1), weights))
    return found


@pytest.mark.parametrize("kind", ["volume", "area", "sheet"])
@pytest.mark.parametrize("rational", [False, True])
def test_moments_and_bounds_scale_exactly_with_powers_of_two(kind, rational):
    rng = np.random.default_rng(2)
    spaces = clamped_space(3), clamped_space(4)
    points = np.stack(np.meshgrid(np.arange(3.0), np.arange(4.0), [0.0], indexing="ij"), axis=-1)[
        :, :, 0
    ]
    points = points + 0.2 * rng.uniform(-1, 1, points.shape)
    weights = rng.uniform(0.5, 2.0, (3, 4)) if rational else None

    def measured(size):
        patches = [Patch(spaces, size * points, weights)]
        if kind == "volume":
            return volume_moments(patches, 3)[0]
        return (
            area_moments(patches, 3)[0]
            if kind == "area"
            else sheet_moments(patches, 0.0, 0.01 * size, 3)[0]
        )

    plain, scaled = measured(1.0), measured(0.125)
    powers = -3.0 * (monomials(3).sum(axis=1) + (2 if kind == "area" else 3))
    assert (scaled.about == 0.125 * plain.about).all()
    for name in ("raw", "rounding_error"):
        assert close(getattr(scaled, name), getattr(plain, name) * 2.0**powers, rel=1e-9), name


def bent_sheet(height):
    """(4, 3, 3) control points over a square."""
    flat = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0), [0.5], indexing="ij"), axis=-1)[
        :, :, 0
    ] / (3, 2, 1)
    flat[..., 2] += height * np.random.default_rng(6).uniform(-1.0, 1.0, (4, 3))
    return flat


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("spans", [1, 10])
def test_area_gradient_matches_differences_at_control_points(spans, rational):
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
        patch_moments.area_slope(
            [Patch((clamped_space(4), clamped_space(3)), points + by, weights)]
        )
        for by in (0.0, 2.0**40)
    )
    assert close(far, near, rel=1e-12)
