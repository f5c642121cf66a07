# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Large grids to a tolerance: the fast transform against sums and closed forms, everywhere on the
grid.
"""

from functools import partial

import numpy as np
import pytest
from body_moments.core.fourier import FrequencyGrid
from body_moments.core.fourier import grid as fourier_grid
from body_moments.core.fourier.grid import GridTransform, Spreading, aliasing
from body_moments.core.fourier.transform import (
    run_to_completion,
    solid_transform,
    surface_transform,
)
from body_moments.core.numerics.quadrature import triangle_rule
from body_moments.core.polyhedron import integration

from tests.core import bodies
from tests.core.findings import refused

# open faces count as given
polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)


@pytest.mark.parametrize("width", range(4, 15))
def test_the_fast_sums_are_within_the_bound_of_their_aliasing(width):
    rng, half = np.random.default_rng(width), 6
    angles, strengths = rng.uniform(-9.0, 9.0, (3, 40)), rng.normal(size=(2, 40))
    angles[:, 0] = [0.0, np.pi, -1e-20]
    spreading = Spreading(half, width, 2)
    spreading.add(angles[:, :25], strengths[:, :25])
    spreading.add(angles[:, 25:], strengths[:, 25:])
    along = np.arange(-half, half + 1)
    k = np.stack(np.meshgrid(along, along, along[half:], indexing="ij"), axis=-1).reshape(-1, 3)
    waves = np.exp(-1j * (k @ angles))
    share = aliasing(half, width)[np.abs(k)].sum(axis=1)
    for found, strength in zip(spreading.sums(), strengths):
        error = np.abs(found.reshape(-1) - waves @ strength)
        assert (error <= 1.01 * share * np.abs(strength).sum()).all()
        # the bound says something
        assert error.max() >= 1e-3 * share.max() * np.abs(strength).sum()


LOPSIDED = bodies.moved(bodies.torus(36, 16), [[1, 0.2, 0], [0, 0.7, 0], [0.1, 0, 1.5]], (3, -2, 5))


def test_the_area_and_an_open_surface_are_right_to_the_tolerance():
    surface = bodies.surface(bodies.without(LOPSIDED, *range(300)))
    exact = surface_transform(surface, FrequencyGrid(15, 18.0))
    total = polyhedron_moments(surface, area_order=0)[1].total
    for tolerance in (1e-3, 1e-6):
        transform = GridTransform(surface, FrequencyGrid(15, 18.0), "area", tolerance * total)
        shares = np.array(list(transform.steps()))
        found = transform.result()
        # spread points are collected in one sum
        assert np.count_nonzero(np.abs(shares - 1.0 + fourier_grid.CHECKING_TIME) < 1e-12) == 1 + 1
        assert transform.point_groups
        assert np.abs(found.values - exact.values).max() <= tolerance * total


def test_large_and_small_triangles_go_together():
    part = bodies.joined(bodies.box((-3, -3, -3), (-2, 5, 4)), bodies.sphere(3))
    grid = FrequencyGrid(22, 9.0)
    transform = GridTransform(bodies.surface(part), grid, "volume", 1e-4)
    found = run_to_completion(transform)
    assert (
        len(transform.direct.triangles) == 12
        and sum(len(rows) for _, rows in transform.point_groups) == 512
    )
    exact = solid_transform(bodies.surface(part), grid)
    assert np.abs(found.values - exact.values).max() <= 1e-4


def test_few_triangles_take_the_closed_form():
    surface = bodies.surface(bodies.box())
    found = run_to_completion(GridTransform(surface, FrequencyGrid(12, 200.0), "volume", 1e-7))
    assert found.method == "exact"
    assert (
        np.abs(found.values - solid_transform(surface, FrequencyGrid(12, 200.0)).values).max()
        <= 1e-14
    )


def test_unreachable_tolerance_is_refused():
    with pytest.raises(ValueError, match="tolerance"):
        GridTransform(bodies.surface(bodies.sphere(3)), FrequencyGrid(20, 20.0), "volume", 1e-16)
    with refused("fourier_of_open_surface"):
        GridTransform(
            bodies.surface(bodies.without(LOPSIDED, 1)), FrequencyGrid(20, 20.0), "volume", 1e-6
        )


@pytest.mark.parametrize(
    "count, largest", [(1, 1.0), (0, 1.0), (8, 0.0), (8, -1.0), (8, np.nan), (8, np.inf)]
)
def test_invalid_frequency_grid_is_refused(count, largest):
    with refused("frequencies_invalid", "frequencies_invalid"):
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
