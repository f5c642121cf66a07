# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and center of mixed shapes: polynomials, exact inside the range of the samples and beyond
it.
"""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.mesh import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.statics.mixes import fit_mixes, sample_count

from tests.close import close


def body(seed=1):
    """A lumpy closed surface of 48 triangles away from the origin, and offsets that change all of
    it.
    """
    random = np.random.default_rng(seed)
    grid = np.array(
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    )
    points = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    surface = Surface(points + (7.0, -3.0, 2.0) + 0.1 * random.standard_normal((8, 3)), quads=grid)
    triangles, _ = surface.all_triangles()
    return Surface.from_triangles(surface.points, triangles), random


@pytest.mark.parametrize("shapes", [1, 2, 3])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e5])
def test_all_mixes_follow_from_a_few(shapes, size):
    surface, random = body()
    surface = replace(surface, points=size * surface.points)
    offsets = 0.15 * size * random.standard_normal((shapes, 8, 3))
    mixes = fit_mixes(surface, offsets)
    assert len(mixes.coefficients) == sample_count(shapes)
    values = random.uniform(-0.5, 1.5, (20, shapes))
    volumes, centers = mixes.at(values)
    for value, volume, center in zip(values, volumes, centers):
        mixed = replace(surface, points=surface.points + np.tensordot(value, offsets, axes=1))
        truth, _ = polyhedron_moments(mixed, 1)
        assert close(volume, truth.total, 1e-12)
        assert np.abs(center - truth.center).max() <= 1e-12 * size * 10.0


def test_a_uniform_growth_is_a_cube_of_its_value():
    surface, _ = body()
    center = polyhedron_moments(surface, 1)[0].center
    mixes = fit_mixes(surface, (surface.points - center)[None])
    volumes, centers = mixes.at([[0.0], [1.0], [3.0]])
    assert close(volumes / volumes[0], [1.0, 8.0, 64.0], 1e-12)
    assert np.abs(centers - center).max() <= 1e-13 * 8.0


def test_flat_or_inverted_mix_has_no_volume():
    """A body that shrinks to its center, and on."""
    surface, _ = body()
    whole, _ = polyhedron_moments(surface, 1)
    center = whole.center
    volumes, centers = fit_mixes(surface, (center - surface.points)[None]).at(
        [[0.9], [0.999], [1.0], [1.001], [3.0]]
    )
    assert close(volumes[0] / whole.total, 1e-3, 1e-9) and np.abs(centers[0] - center).max() <= 1e-9
    assert np.isnan(volumes[1:]).all() and np.isnan(centers[1:]).all()
