# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets of real thickness along patches: bounds of storage errors, and convergence."""

import numpy as np
import pytest
from body_moments.core.numerics.bspline import clamped_space
from body_moments.core.nurbs import Patch, measure_sheet

from tests.close import close
from tests.core.exact_splines import sphere, tube


def flat(width, height):
    spaces = clamped_space(3), clamped_space(2)
    x, y = np.array([0.0, width / 2.0, width])[:, None], np.array([0.0, height])
    return Patch(spaces, np.stack(np.broadcast_arrays(x, y, 0.0), axis=-1))


STORED = 1e-6
SHEETS = {
    "strip": (flat(2.0, 0.01), -0.001, 0.001),
    "rectangle": (flat(2.0, 3.0), -0.25, 0.25),
    "outside of a ball": (sphere(), 0.0, 0.5),
    "inside of a ball": (sphere(), -0.5, 0.0),
    "tube": (tube(), -0.2, 0.2),
}


@pytest.mark.parametrize("name", SHEETS)
@pytest.mark.parametrize("place", [0.0, 7.0])
def test_storage_error_stays_within_a_tight_bound(name, place):
    """Stretched along each axis by as much, and along all, and a rectangle's control points
    anyhow.
    """
    patch, inner, outer = SHEETS[name]
    patch = Patch(patch.spaces, patch.points + place, patch.weights)
    sheet, area, _ = measure_sheet([patch], inner, outer, stored=STORED)
    arms = patch.points - place - (patch.points - place).mean(axis=(0, 1))
    ways = [arms * axes for axes in (np.ones(3), *np.eye(3), 1.0 - np.eye(3)[2])]
    if not np.ptp(arms[..., 2]):
        ways += [*np.random.default_rng(0).normal(size=(4, *arms.shape)), np.sign(arms)]
    shares = []
    for way in ways:
        if not way.any():
            continue
        points = patch.points + STORED * way / np.linalg.norm(way, axis=2).max()
        for found, given in zip(
            measure_sheet([Patch(patch.spaces, points, patch.weights)], inner, outer), (sheet, area)
        ):
            change = np.abs(found.about_point(given.about).raw - given.raw)
            bound = given.input_error + given.rounding_error + found.rounding_error
            assert (change <= bound).all()
            shares.append(change[0] / bound[0])
    assert max(shares[::2]) > 0.4 and max(shares[1::2]) > 0.4


@pytest.mark.parametrize(
    "inner, outer, thickness",
    [(0.0, 0.5, 19.0 / 24.0), (-0.3, 0.1, 0.4), (-0.5, -0.25, 0.25), (0.25, 0.5, 1.421875 / 3.0)],
)
def test_sheet_grows_with_its_area_by_its_thickness(inner, outer, thickness):
    """On the outside of a ball a sheet has more volume than its area times its thickness."""
    sheet, area, _ = measure_sheet([sphere()], inner, outer, stored=STORED)
    assert close(sheet.input_error, thickness * area.input_error, rel=1e-9)


def test_a_sheet_without_an_area_has_no_volume():
    sheet, area, _ = measure_sheet([flat(2.0, 0.0)], -0.1, 0.1, stored=STORED)
    assert sheet.total == area.total == 0.0 and np.isfinite(sheet.input_error).all()
