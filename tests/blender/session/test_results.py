# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds of the errors of a sum of bodies, where the parts are few enough to tell the sum's by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.operators.session import results
from body_moments.operators.write.properties import BOUND_KEYS

from tests.close import close

pytestmark = pytest.mark.usefixtures("registered")


def part(mass, center, volume, area):
    return SimpleNamespace(volume=volume, area=area, body=SimpleNamespace(mass=mass, center=np.array(center)))


def of_sum(*parts_and_bounds):
    parts, bounds = zip(*parts_and_bounds)
    masses = np.array([one.body.mass for one in parts])
    center = masses @ [one.body.center for one in parts] / masses.sum()
    found = results._bound_of_sum(parts, center, [dict(zip(BOUND_KEYS, bound)) for bound in bounds])
    return [found[name] for name in BOUND_KEYS]


@pytest.mark.parametrize(("volume", "share"), [(4.0, 0.25 / 4.0), (0.5, 0.25 / 0.5), (0.0, 0.5 / 8.0)])
def test_one_body_is_off_by_its_own_bounds(volume, share):
    """Its mass by a share of it, that of the volume, or of the area where there is no volume."""
    mass, off, inertia = 3.0, 1e-3, 2e-3
    found = of_sum((part(mass, (5.0, 6.0, 7.0), volume, 8.0), (0.25, 0.5, off, inertia)))
    assert close(found[:3], [0.25, 0.5, off * (1.0 + share)], 1e-12)
    reach = off + off * (1.0 + share)
    assert close(found[3], inertia + mass * (1.0 + share) * reach**2, 1e-12)


def test_two_equal_bodies_that_may_weigh_more_or_less_are_off_by_that_times_how_far_they_are_apart():
    """Of masses m (1 ± e) at x = ±a the center is off by e a at most, and the inertia by 2 e m a² about there."""
    mass, away, volume, share = 2.0, 3.0, 8.0, 1e-6
    bodies = [part(mass, (side * away, 0.0, 0.0), volume, 1.0) for side in (-1.0, 1.0)]
    found = of_sum(*((body, (share * volume, 0.0, 0.0, 0.0)) for body in bodies))
    assert close(found[:3], [2.0 * share * volume, 0.0, share * away], 1e-12)
    least = 2.0 * share * mass * away**2
    grown = 2.0 * mass * (1.0 + share) * ((away + share * away) ** 2 - away**2)
    assert close(found[3], least + grown, 1e-9)
