# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces filled with a grid's density: boxes and tetrahedra with exact answers, and
additivity.
"""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density.voxel_fill import inside_moments
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import monomials
from body_moments.core.polyhedron import polyhedron_moments

from tests.close import close
from tests.core import bodies
from tests.core.findings import refused


def box(low, high):
    points, triangles = bodies.box(low, high)
    return points[triangles]


def random_densities(shape=(4, 5, 6), seed=0):
    return np.random.default_rng(seed).integers(0, 9, shape) / 4.0


def exact_box(low, high, densities, order, about):
    """Voxel by voxel in rational arithmetic."""
    total = [Fraction(0)] * len(monomials(order))
    for place in np.ndindex(*densities.shape):
        ends = [(max(Fraction(a), n), min(Fraction(b), n + 1)) for a, b, n in zip(low, high, place)]
        if any(a >= b for a, b in ends):
            continue
        ends = [(a - Fraction(float(c)), b - Fraction(float(c))) for (a, b), c in zip(ends, about)]
        for n, powers in enumerate(monomials(order).tolist()):
            term = Fraction(float(densities[place]))
            for (a, b), power in zip(ends, powers):
                term *= (b ** (power + 1) - a ** (power + 1)) / (power + 1)
            total[n] += term
    return total


@pytest.mark.parametrize(
    "low, high",
    [
        ((0, 0, 0), (4, 5, 6)),
        ((1, 1, 1), (2, 3, 4)),
        ((0.25, 0.5, 0.125), (3.5, 4.75, 5.5)),
        ((-3, 0.5, -2), (9, 2.5, 11)),
        ((1.25, 1.5, 3.25), (1.5, 1.75, 3.5)),
        ((-2, -2, 2.5), (7, 8, 30)),
    ],
)
def test_boxes_are_exact(low, high):
    densities = random_densities()
    found, volume = inside_moments(box(low, high), densities, 4)
    exact = exact_box(low, high, densities, 4, found.about)
    off = np.array([abs(float(Fraction(value) - truth)) for value, truth in zip(found.raw, exact)])
    assert (off <= found.rounding_error).all()
    assert off.max() <= 1e-12 * max(abs(float(truth)) for truth in exact)
    inner = [max(0, min(b, n) - max(a, 0)) for a, b, n in zip(low, high, densities.shape)]
    assert close(volume, np.prod(inner), rel=1e-13)


def blob(seed=0, count=24):
    """A closed star-shaped surface around (3, 3, 3), not aligned with anything."""
    rng = np.random.default_rng(seed)
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, count, endpoint=False),
        np.linspace(0, np.pi, count),
        indexing="ij",
    )
    points = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=-1)
    points[:, 1:-1] *= rng.uniform(0.8, 1.2, (count, count - 2, 1))
    points = 2.3 * points + 3.1
    points[:, 0], points[:, -1] = points[0, 0], points[0, -1]
    corners = [
        (points, np.roll(points, -1, axis=0))[i][:, j : count - 1 + j]
        for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))
    ]
    quads = np.stack(corners, axis=2).reshape(-1, 4, 3)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def test_a_uniform_density_is_the_solid():
    triangles = blob()
    found, volume = inside_moments(triangles, np.full((7, 7, 7), 2.5))
    points = triangles.reshape(-1, 3)
    solid = polyhedron_moments(
        Surface(points, np.arange(len(points), dtype=np.int32).reshape(-1, 3))
    )[0]
    expected = 2.5 * solid.about_point(found.about)
    assert volume == pytest.approx(solid.total, rel=1e-12)
    assert (
        np.abs(found.raw - expected.raw)
        <= found.rounding_error + 1e-12 * np.abs(expected.raw).max()
    ).all()
    assert found.total == pytest.approx(2.5 * solid.total, rel=1e-12)


def test_a_monte_carlo_sum_agrees():
    """A check by counting, not by any formula: points in a tetrahedron."""
    corners = np.array([(0.3, 0.2, 0.4), (6.1, 0.7, 0.2), (1.2, 5.9, 0.9), (0.8, 1.1, 6.4)])
    triangles = corners[[(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]]
    densities = random_densities((7, 7, 7))
    found, volume = inside_moments(triangles, densities)
    rng = np.random.default_rng(0)
    shares = rng.dirichlet(np.ones(4), 400_000)
    points = shares @ corners
    exact = abs(np.linalg.det(corners[1:] - corners[0])) / 6
    sampled = densities[tuple(points.astype(int).T)]
    assert volume == pytest.approx(exact, rel=1e-13)
    assert found.total == pytest.approx(exact * sampled.mean(), rel=5e-3)
    assert found.center == pytest.approx(sampled @ points / sampled.sum(), rel=5e-3)


def test_inverted_surface_counts_negative_and_far_one_zero():
    densities = random_densities((7, 7, 7))
    triangles = blob()
    found, _ = inside_moments(triangles, densities)
    turned, volume = inside_moments(triangles[:, ::-1], densities)
    assert turned.raw == pytest.approx(-found.raw, rel=1e-12, abs=1e-10)
    assert volume < 0
    for offset in ((50, 0, 0), (0, -50, 0), (0, 0, 50), (0, 0, -50)):
        away, volume = inside_moments(triangles + offset, densities)
        assert abs(volume) < 1e-10
        assert np.abs(away.raw).max() <= away.rounding_error.max() + 1e-9


def test_nonfinite_values_are_refused():
    with refused("density_non_finite"):
        inside_moments(blob(), np.full((7, 7, 7), np.nan))
    with refused("density_non_finite"):
        # a signaling NaN
        inside_moments(blob(), np.full((2, 3, 4), 0x7FA00000, np.uint32).view(np.float32))
