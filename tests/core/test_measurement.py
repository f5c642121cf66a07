# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of a measured object's mass by their source and known order."""

from dataclasses import fields, replace

import numpy as np
import pytest
from body_moments.core import measurement, polyhedron, verdict
from body_moments.core.moments.raw import Measure, Moments

from tests.core import bodies

VOLUME, AREA = polyhedron.polyhedron_moments(
    bodies.surface(bodies.moved(bodies.box(), np.diag([1.0, 2.0, 3.0]))), 5, area_order=4
)


def measured(**changes):
    """A body with `mass_moments` known to third order, others to higher orders."""
    nothing = dict.fromkeys(field.name for field in fields(measurement.Measurement))
    known = {
        "mass_moments": (VOLUME.truncate(3), 7.0),
        "volume_moments": VOLUME,
        "area_moments": AREA,
    }
    return measurement.Measurement(
        **{**nothing, "density_from": measurement.DENSITY_FROM_MASS, **known, **changes}
    )


@pytest.mark.parametrize("order", [0, 2, 3, 4, 5])
def test_uniform_solid_uses_volume_moments(order):
    mass = measured().moments_of_mass(order)
    assert mass.measure == Measure.MASS and mass.order == order
    assert np.array_equal(mass.raw, 7.0 * VOLUME.truncate(order).raw)


def test_shell_uses_area_moments():
    shell = measured(volume_moments=None, mass_moments=(AREA.truncate(3), 2.0))
    assert np.array_equal(shell.moments_of_mass(4).raw, 2.0 * AREA.raw)
    assert shell.moments_of_mass(5) is None


def test_varying_density_uses_its_own_moments():
    own = replace(VOLUME, measure=Measure.MASS) * 3.0
    body = measured(density_from=verdict.finding("density_from_polynomial"), higher_mass=own)
    assert np.array_equal(body.moments_of_mass(4).raw, own.truncate(4).raw)
    assert np.array_equal(body.moments_of_mass(3).raw, 7.0 * VOLUME.truncate(3).raw)


@pytest.mark.parametrize(
    "changes",
    [
        {"density_from": verdict.finding("density_from_polynomial")},
        {"length": 2.0},
        {"volume_moments": VOLUME.truncate(3)},
    ],
)
def test_missing_order_is_none(changes):
    assert measured(**changes).moments_of_mass(4) is None
    assert isinstance(measured(**changes).moments_of_mass(3), Moments)
