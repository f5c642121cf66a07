# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A measured body has moments of its own to any order; faces that do not close have none by
accident.
"""

import pytest
from body_moments.core import MassProperties, measure_solid, polyhedron_moments

from tests.close import close
from tests.core.bodies import (
    TOP,
    box,
    inverted,
    joined,
    moved,
    surface,
    torus,
    with_flipped,
    without,
)
from tests.core.findings import refused

HIGH = box((0, 0, 0), (1, 2, 3))


def box_moment(p, q, r):
    return 1.0 / (p + 1) * 2.0 ** (q + 1) / (q + 1) * 3.0 ** (r + 1) / (r + 1)


@pytest.mark.parametrize(
    "part", [HIGH, inverted(HIGH), with_flipped(HIGH, 1, 7), without(HIGH, *TOP)]
)
@pytest.mark.parametrize("order", [0, 2, 3, 4, 12])
def test_repaired_body_has_moments_to_any_order(part, order):
    body = measure_solid(surface(moved(part, offset=(5, 6, 7))))
    volume, area = body.moments(order, about=(5, 6, 7))
    assert area is None and volume.order == order and volume.about.tolist() == [5, 6, 7]
    for exponents in ((0, 0, 0), (order, 0, 0), (order // 2, 0, order // 2)):
        assert close(volume[exponents], box_moment(*exponents), rel=1e-10)
    mass = MassProperties.from_moments(body.volume, density=2.0)
    assert close(mass.mass, 12.0, rel=1e-14) and close(2.0 * volume.total, mass.mass, rel=1e-12)
    assert body.moments(order)[0].about.tolist() == body.volume.about.tolist()


def test_area_counts_only_the_given_faces():
    for part, area in (
        (HIGH, 22.0),
        (without(HIGH, *TOP), 20.0),
        (joined(HIGH, moved(HIGH, offset=(9, 0, 0))), 44.0),
    ):
        body = measure_solid(surface(part))
        found = body.moments(2, area_order=4)[1]
        assert (
            close(found.total, area, rel=1e-13)
            and close(body.area.total, area, rel=1e-13)
            and found.order == 4
        )
        assert found.about.tolist() == body.volume.about.tolist()


def test_a_flat_body_has_no_moments():
    body = measure_solid(surface(joined(box((0, 0, 0), (1, 1, 0)))))
    volume, area = body.moments(6, area_order=0)
    assert not volume.raw.any() and close(area.total, 2.0, rel=1e-14)


@pytest.mark.parametrize("order", [3, 6])
def test_nearly_flat_body_has_no_moments_within_bounds(order):
    """Its volume is 10^-15, less than the rounding error of a closed sheet of its size."""
    body = measure_solid(surface(box((0, 0, 0), (1, 1, 1e-14))))
    volume = body.moments(order)[0]
    for found in (body.volume, volume):
        assert not found.raw.any() and 1e-15 <= found.rounding_error[0] < 1e-12


@pytest.mark.parametrize(
    "part",
    [with_flipped(HIGH, 1), without(HIGH, 4), without(HIGH, *TOP, 0, 1), without(torus(), 3)],
)
@pytest.mark.parametrize("order", [0, 3, 8])
def test_open_faces_are_refused_unless_intended(part, order):
    """The README's example measured a repaired copy and took the moments of the input: 0.333 beside
    a mass of 1.
    """
    with refused("boundary_open"):
        polyhedron_moments(surface(part), order)
    with refused("boundary_open"):
        polyhedron_moments([part[0][part[1][:5]], part[0][part[1][5:]]], order)
    with refused("boundary_open"):
        polyhedron_moments(iter([surface(part)]), order, about=(0, 0, 0), reach=4.0)
    assert polyhedron_moments(surface(part), order, allow_open=True)[0].order == order
    assert measure_solid(surface(part)).moments(order)[0].total > 0.0
