# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Columns in cells where the density is linear along each axis, against that density and its slopes."""

import numpy as np
import pytest
from body_moments.core.density.threshold_cells import Cells, amounts_of, columns_of, interpolate

from tests.close import close

ROOT = np.array([[2.0, 0.0, 0.0], [0.3, 1.5, 0.0], [-0.4, 0.7, 0.5]])


@pytest.mark.parametrize("metric", [np.diag([1.0, 4.0, 0.25]), ROOT @ ROOT.T], ids=["along the axes", "sheared"])
@pytest.mark.parametrize("scale", [2.0**-900, 1.0, 2.0**900])
def test_columns_are_what_the_density_is_along_them(scale, metric):
    """It changes one way along z, as cells are turned; the surface is as much larger than its floor as its normal is
    longer than that across."""
    rng = np.random.default_rng(4)
    low = rng.normal(size=(60, 2, 2))
    way = np.where(np.arange(60) % 2, -1.0, 1.0)[:, None, None]
    corners = np.stack([low, low + way * rng.uniform(0.2, 2.0, low.shape)], axis=3)
    found = columns_of(scale * corners, 5, metric)
    here, (x, y) = corners[found.cell].transpose(1, 2, 3, 0), (found.x, found.y)

    def density(x, y, z):
        first, second = here[0] + x * (here[1] - here[0])
        low, high = first + y * (second - first)
        return low + z * (high - low)

    assert close(found.density, scale * density(x, y, 0.0), 1e-9)
    assert close(found.growth, scale * (density(x, y, 1.0) - density(x, y, 0.0)), 1e-9)
    crossed = found.slope > 0.0
    level = found.level
    assert 0.3 < crossed.mean() < 0.9 and np.abs(density(x, y, level))[crossed].max() < 1e-14
    assert ((level[~crossed] == 0.0) | (level[~crossed] == 1.0)).all()
    slopes = np.stack(
        [
            density(1.0, y, level) - density(0.0, y, level),
            density(x, 1.0, level) - density(x, 0.0, level),
            density(x, y, 1.0) - density(x, y, 0.0),
        ]
    )
    longer = np.sqrt(np.einsum("ik,ij,jk->k", slopes, metric, slopes)) / np.abs(slopes[2])
    assert close(found.slope[crossed], longer[crossed], 1e-9)
    for z in np.linspace(0.01, 0.99, 50):
        clear = np.abs(density(x, y, z)) > 1e-9
        inside = (found.low < z) & (z < found.high)
        assert (inside == (density(x, y, z) > 0.0))[clear].all()
    floors = np.bincount(found.cell, found.weight, 60)
    assert (floors <= 1.0 + 1e-14).all() and close(floors[(corners > 0.0).all(axis=(1, 2, 3))], 1.0, 1e-14)


def test_a_cell_of_any_size_has_the_volume_and_the_area_of_its_columns():
    """Of planes across z at 3/4, below which it is inside."""
    corners = np.broadcast_to(np.array([0.75, -0.25]), (3, 2, 2, 2))
    cells = Cells(corners, np.zeros((3, 3)), np.array([1.0, 0.5, 0.125]))
    found = amounts_of(columns_of(corners, 2, np.eye(3)), cells)
    assert close(found, [0.75 * cells.size**3, cells.size**2], 1e-14)


@pytest.mark.parametrize("seed", range(3))
def test_parts_of_a_cell_have_its_density_where_they_lie(seed):
    rng = np.random.default_rng(seed)
    cells = Cells(rng.normal(size=(4, 2, 2, 2)), rng.normal(size=(4, 3)), np.array([1.0, 0.5, 2.0, 0.25]))
    parts = cells.cut_in_eight()
    assert len(parts.size) == 32
    for number, (corners, origin, size) in enumerate(zip(parts.corners, parts.origin, parts.size)):
        whole = number % 4
        assert size == cells.size[whole] / 2.0
        begin = (origin - cells.origin[whole]) / cells.size[whole]
        for place in rng.random((5, 3)):
            truth = interpolate(cells.corners[whole : whole + 1], *(begin + place / 2.0))[0]
            assert abs(interpolate(corners[None], *place)[0] - truth) < 1e-14
            weights = np.stack([1.0 - place, place], axis=1)
            assert abs(np.einsum("ijk,i,j,k->", corners, *weights) - truth) < 1e-14
    places = {tuple(part) for part in np.rint(2.0 * (parts.origin[::4] - cells.origin[0]) / cells.size[0]).tolist()}
    assert places == set(np.ndindex(2, 2, 2))
