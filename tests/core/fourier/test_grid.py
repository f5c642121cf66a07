# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Large grids to a tolerance: the fast transform against sums and closed forms, everywhere on the grid."""

import math
from functools import partial

import numpy as np
import pytest
from body_moments.core.fourier import grid as fourier_grid
from body_moments.core.fourier.grid import GridTransform, _kernel_width, _sample_indices
from body_moments.core.fourier.nufft import WIDTHS, Spreading, _kernel, aliasing
from body_moments.core.fourier.transform import run_to_completion, solid_transform, surface_transform
from body_moments.core.fourier.wave_vectors import FrequencyGrid
from body_moments.core.numerics.quadrature import triangle_rule
from body_moments.core.polyhedron import integration

from tests.close import close
from tests.core import bodies
from tests.core.findings import refused

polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)  # of faces as they are


def half_grid(half):
    along = np.arange(-half, half + 1)
    return np.stack(np.meshgrid(along, along, along[half:], indexing="ij"), axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("width", range(4, 15))
def test_the_fast_sums_are_within_the_bound_of_their_aliasing(width):
    rng, half = np.random.default_rng(width), 6
    angles, strengths = rng.uniform(-9.0, 9.0, (3, 40)), rng.normal(size=(2, 40))
    angles[:, 0] = [0.0, np.pi, -1e-20]
    spreading = Spreading(half, width, 2)
    spreading.add(angles[:, :25], strengths[:, :25])
    spreading.add(angles[:, 25:], strengths[:, 25:])
    k = half_grid(half)
    waves = np.exp(-1j * (k @ angles))
    share = aliasing(half, width)[np.abs(k)].sum(axis=1)
    for found, strength in zip(spreading.sums(), strengths):
        error = np.abs(found.reshape(-1) - waves @ strength)
        assert (error <= 1.01 * share * np.abs(strength).sum()).all()
        assert error.max() >= 1e-3 * share.max() * np.abs(strength).sum()  # the bound says something


def test_a_wider_kernel_is_a_digit_better():
    errors = [aliasing(20, width).max() for width in range(4, 15)]
    assert all(later < 0.5 * earlier for earlier, later in zip(errors, errors[1:]))
    assert errors[0] < 3e-3 and errors[-1] < 1e-11


@pytest.mark.parametrize("width", [4, 15])
def test_the_kernel_is_that_of_barnett_to_its_ends(width):
    z = np.array([-1.0, -0.9, -0.3, 0.0, 0.5, 1.0])
    exact = [math.exp(2.3 * width * (math.sqrt(1.0 - t * t) - 1.0)) for t in z.tolist()]
    assert close(_kernel(z, width), exact, 1e-12)
    assert close(_kernel(z[[0, -1]] * (1.0 + 2.0**-52), width), exact[-1], 1e-12)


def test_kernels_are_four_to_fifteen_cells_wide():
    widths = [_kernel_width(8, tolerance, False) for tolerance in (0.1, 3.3 * aliasing(8, 15).max())]
    assert widths == [4, 15]
    with pytest.raises(ValueError, match="tolerance"):
        _kernel_width(8, 2.9 * aliasing(8, 15).max(), False)
    assert aliasing(8, 15).max() < 5e-13


def cube(n):
    """A cube of n x n squares on each side: from far enough, all its triangles err alike."""
    sides = []
    for axis in range(3):
        for side in (0, 1):
            points, triangles = bodies.grid(n)
            points[:, 2] = side
            sides.append((np.roll(points, axis, axis=1), triangles if side else triangles[:, ::-1]))
    return bodies.welded(bodies.joined(*sides))


LOPSIDED = bodies.moved(bodies.torus(36, 16), [[1, 0.2, 0], [0, 0.7, 0], [0.1, 0, 1.5]], (3, -2, 5))
CASES = {
    "torus": (LOPSIDED, FrequencyGrid(18, 18.0), (1e-4, 1e-7)),
    "torus, low": (LOPSIDED, FrequencyGrid(17, 0.5), (1e-4, 1e-7)),
    "cube, waves as long as its squares": (cube(12), FrequencyGrid(24, 2 * np.pi * 12 / 2), (1e-4, 1e-6)),
    "sphere, waves shorter than its triangles": (bodies.sphere(3), FrequencyGrid(20, 60.0), (1e-3, 1e-4)),
}


@pytest.mark.parametrize("name", CASES)
def test_a_grid_is_right_to_the_tolerance_at_every_frequency(name):
    part, grid, tolerances = CASES[name]
    surface = bodies.surface(part)
    exact = solid_transform(surface, grid)
    assert exact.method == "exact"
    volume = exact.values[np.abs(exact.q).sum(axis=1).argmin()].real
    for tolerance in tolerances:
        transform = GridTransform(surface, grid, "volume", tolerance * volume)
        found = run_to_completion(transform)
        assert transform.fine and found.method == "approximate"
        assert np.array_equal(found.q, exact.q)
        error = np.abs(found.values - exact.values)
        assert error.max() <= tolerance * volume
        assert (error <= 2.0 * found.error).all()  # an estimate, by some of them
        assert found.error.max() <= 3.1 * tolerance * volume


def test_the_share_that_is_done_grows_from_the_start_to_the_end_and_all_work_is_in_the_steps(monkeypatch):
    part, grid, (tolerance, _) = CASES["torus"]
    transform = GridTransform(bodies.surface(part), grid, "volume", tolerance)
    shares = list(transform.steps())
    assert shares == sorted(shares) and shares[0] == 0.0 and shares[-1] == 1.0
    assert sum(0.0 < share < fourier_grid.SHARING_TIME for share in shares) > 1
    monkeypatch.delattr(fourier_grid.Transform, "steps")  # what `result` would have to wait for
    assert transform.result().method == "approximate"


def test_the_share_that_is_done_is_that_of_what_the_parts_cost():
    """First of the triangles in closed form, then of the points, at last of the comparison."""
    part = bodies.joined(bodies.box((-3, -3, -3), (-2, 5, 4)), bodies.sphere(3))
    transform = GridTransform(bodies.surface(part), FrequencyGrid(22, 9.0), "volume", 1e-4)
    shares = np.array(list(transform.steps()))
    first, last = fourier_grid.SHARING_TIME, 1.0 - fourier_grid.CHECKING_TIME
    direct = 12 * 23 * 23 * 12 * fourier_grid.DIRECT_COST
    points = sum(len(rows) * len(triangle_rule(n)[1]) for n, rows in transform.fine) * transform.width**3
    middle = first + (last - first) * direct / (direct + points)
    assert np.count_nonzero(np.abs(shares - middle) < 1e-12) == 1
    assert np.count_nonzero(np.abs(shares - last) < 1e-12) == 1 + 3  # and three components are collected
    expected = 524 * len(fourier_grid._trial_vectors(transform.grid)) / fourier_grid.PAIRS_PER_BLOCK
    tried = shares[shares < first]
    assert close(tried, first * np.arange(len(tried)) / (np.arange(len(tried)) + expected), rel=1e-12)
    assert (shares > last).any() and not (shares > 1.0).any()


def test_the_area_and_an_open_surface_are_right_to_the_tolerance():
    surface = bodies.surface(bodies.without(LOPSIDED, *range(300)))
    exact = surface_transform(surface, FrequencyGrid(15, 18.0))
    total = polyhedron_moments(surface, area_order=0)[1].total
    for tolerance in (1e-3, 1e-6):
        transform = GridTransform(surface, FrequencyGrid(15, 18.0), "area", tolerance * total)
        shares = np.array(list(transform.steps()))
        found = transform.result()
        # where the points are spread, their one sum is collected
        assert np.count_nonzero(np.abs(shares - 1.0 + fourier_grid.CHECKING_TIME) < 1e-12) == 1 + 1
        assert transform.fine
        assert np.abs(found.values - exact.values).max() <= tolerance * total


def test_large_and_small_triangles_go_together():
    part = bodies.joined(bodies.box((-3, -3, -3), (-2, 5, 4)), bodies.sphere(3))
    grid = FrequencyGrid(22, 9.0)
    transform = GridTransform(bodies.surface(part), grid, "volume", 1e-4)
    found = run_to_completion(transform)
    assert len(transform.direct.triangles) == 12 and sum(len(rows) for _, rows in transform.fine) == 512
    exact = solid_transform(bodies.surface(part), grid)
    assert np.abs(found.values - exact.values).max() <= 1e-4


def test_few_triangles_take_the_closed_form():
    surface = bodies.surface(bodies.box())
    found = run_to_completion(GridTransform(surface, FrequencyGrid(12, 200.0), "volume", 1e-7))
    assert found.method == "exact"
    assert np.array_equal(found.values, solid_transform(surface, FrequencyGrid(12, 200.0)).values)


def test_what_cannot_be_reached_is_refused():
    with pytest.raises(ValueError, match="tolerance"):
        GridTransform(bodies.surface(bodies.sphere(3)), FrequencyGrid(20, 20.0), "volume", 1e-16)
    with refused("fourier_of_open_surface"):
        GridTransform(bodies.surface(bodies.without(LOPSIDED, 1)), FrequencyGrid(20, 20.0), "volume", 1e-6)


@pytest.mark.parametrize("count, largest", [(1, 1.0), (0, 1.0), (8, 0.0), (8, -1.0), (8, np.nan), (8, np.inf)])
def test_grids_that_are_none_are_refused(count, largest):
    with refused("frequency_count", "frequency_range"):
        FrequencyGrid(count, largest)


def test_the_bound_of_the_points_holds():
    rng = np.random.default_rng(8)
    for span in (0.1, 1.0, 3.0, 6.0, 12.0):
        for n in range(1, 9):
            places, weights = triangle_rule(n)
            bounded = [
                tolerance
                for tolerance in 10.0 ** np.arange(-14, 3)
                if fourier_grid._points_per_side(np.array([span]), tolerance)[0] <= n
            ]
            if not bounded:
                continue
            phases = rng.uniform(0.0, span, (200, 3))
            phases -= phases.mean(axis=1)[:, None]
            fine, more = triangle_rule(24)
            error = np.exp(-1j * (phases @ places)) @ weights - np.exp(-1j * (phases @ fine)) @ more
            assert np.abs(error).max() <= bounded[0] + 1e-15


def test_compared_are_the_ends_of_axes_and_diagonals():
    grid = FrequencyGrid(9, 1.0)
    found = np.array(np.unravel_index(_sample_indices(grid), (9, 9, 9))).T - grid.half
    for way in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (0, 1, 1), (1, 0, 1), (1, 1, 0)):
        for step in (-grid.half, -1, 1):
            assert (found == np.clip(step * np.array(way), -grid.half, 8 - grid.half)).all(axis=1).any()
    assert len(found) > 30 and len(np.unique(found, axis=0)) == len(found)


@pytest.mark.parametrize("half", [4, 20])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_the_kernel_is_the_least_wide_one_whose_error_is_allowed(half, tolerance):
    """By the wave vector the error of each is smaller, and a narrower kernel does."""
    for divided in (False, True):
        by = np.arange(1.0, half + 1.0) if divided else np.ones(half)
        width = _kernel_width(half, tolerance, divided)
        worst = {
            one: max(3.0 * aliasing(half, one)[: k + 1].max() / by[k - 1] for k in range(1, half + 1))
            for one in range(min(WIDTHS), width + 1)
            if one in WIDTHS
        }
        assert worst.pop(width) <= tolerance and all(one > tolerance for one in worst.values())
    with pytest.raises(ValueError, match="tolerance"):
        _kernel_width(half, 1e-30, True)


@pytest.mark.parametrize("tolerance", [1e-14, 1e-6, 1e-2, 1.0, 1e3, 1e6])
def test_points_along_a_side_are_the_fewest_whose_bound_is_allowed(tolerance):
    """2 (g/4)^(2n) / (2n)! by the geometric series that follows, in a table of half percents."""

    def suffices(span, n):
        ratio = span / 4.0 / (2 * n + 1)
        return ratio < 0.9 and 2.0 * (span / 4.0) ** (2 * n) / math.factorial(2 * n) / (1.0 - ratio) <= tolerance

    spans = np.geomspace(2e-6, 90.0, 400)
    found = fourier_grid._points_per_side(spans, tolerance)
    largest = fourier_grid.MAX_POINTS_PER_SIDE
    assert (found <= largest + 1).all()
    for span, n in zip(spans.tolist(), found.tolist()):
        assert n > largest or suffices(span, n)
        assert not any(suffices(1.006 * span, fewer) for fewer in range(1, n))


@pytest.mark.parametrize("count, shares", [(7, [1.0, 0.6, 0.35]), (36, [1.0, 0.6, 0.35, 0.2, 0.1])])
def test_errors_are_compared_at_frequencies_of_all_sizes_from_one_step_on(count, shares):
    """Along the axes, the diagonal of the grid, and between them."""
    grid = FrequencyGrid(count, 3.0)
    q = fourier_grid._trial_vectors(grid).reshape(-1, 5, 3) / grid.largest
    assert close(np.abs(q).max(axis=2), np.multiply.outer(shares, [1.0, 1.0, 1.0, 1.0, 0.9]), rel=1e-15)
    assert all(np.array_equal(shell > 0.0, np.eye(3) > 0.0) for shell in q[:, :3])
    assert (q[:, 3] == q[:, 3, :1]).all() and (q[:, 4] != 0.0).all()


def finished(work):
    """What a generator returns at last."""
    while True:
        try:
            next(work)
        except StopIteration as stop:
            return stop.value


@pytest.mark.parametrize("name, tolerance", [("torus, low", 1e-4), ("torus, low", 1e-7), ("torus", 1e-4)])
def test_as_few_points_are_taken_as_prove_enough_together(name, tolerance):
    """From the most daring credit on; of each the triangles that would take fewer points are compared."""
    part, grid, _ = CASES[name]
    transform = GridTransform(bodies.surface(part), grid, "volume", tolerance)
    faces = transform.faces
    reach = np.sqrt(3.0) * grid.largest * faces.scale
    bound = fourier_grid._points_per_side(reach * faces.diameters, transform.each)
    q = fourier_grid._trial_vectors(grid) * faces.scale
    wanted, refused_before = bound, set()
    for credit in fourier_grid.ERROR_CREDITS:
        fewer = fourier_grid._points_per_side(reach * faces.diameters, transform.each * credit)
        fewer[reach * faces.heights >= 2.0 * np.pi] = bound[reach * faces.heights >= 2.0 * np.pi]
        tried = np.flatnonzero(fewer < bound)
        off = finished(transform._sum_over(tried, q))
        for n in sorted(set(fewer[tried].tolist())):
            off = off - finished(transform._points_over(tried[fewer[tried] == n], n, q))
        if (np.abs(off) / np.linalg.norm(q, axis=1)).max() <= transform.joint_count:
            wanted = fewer
            break
        refused_before.add(len(tried))
    assert refused_before and (wanted < bound).any()
    assert finished(transform._counts()).tolist() == wanted.tolist()


@pytest.mark.parametrize("size", [0.01, 1.0, 300.0])
def test_half_of_the_tolerance_is_for_the_points_and_half_for_the_kernel(size):
    """Of a box of 1 by 2 by 3: by the area, and of a volume by the wave vector, at the corners of the grid at most."""
    surface = bodies.surface(bodies.box((0.0, 0.0, 0.0), (size, 2.0 * size, 3.0 * size)))
    grid, area = FrequencyGrid(20, 5.0 / size), 22.0 * size**2
    for tolerance in (1e-3, 1e-6):
        volume = GridTransform(surface, grid, "volume", tolerance * size**3)
        mean = tolerance * size**3 / area / 2.0
        assert close(volume.each, mean * np.sqrt(3.0) * grid.largest / 2.0, rel=1e-12)
        assert close(volume.joint_count * volume.faces.scale**3, tolerance * size**3 / 2.0 / 3.0, rel=1e-12)
        assert volume.width == _kernel_width(grid.half, mean * grid.step, True)
        surfaces = GridTransform(surface, grid, "area", tolerance * size**2)
        assert close(surfaces.each, tolerance * size**2 / area / 2.0 / 2.0, rel=1e-12)
        assert close(surfaces.joint_count * surfaces.faces.scale**2, tolerance * size**2 / 2.0 / 3.0, rel=1e-12)
        assert surfaces.width == _kernel_width(grid.half, tolerance * size**2 / area / 2.0, False)
