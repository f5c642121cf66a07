# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of several bodies as one, field by field."""

import numpy as np
from body_moments.blender.bodies.assembly.combined import combined_measurement
from body_moments.blender.bodies.assembly.given import properties_of
from body_moments.core.moments.moments import Measure, Moments, monomials
from body_moments.core.verdict.finding import finding
from body_moments.core.verdict.method import Method, Verdict

from tests.close import close

SIDES, CENTER, DENSITY = np.array([1.0, 2.0, 3.0]), np.array([4.0, -5.0, 6.0]), 700.0
TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def mass_of_a_box():
    """About its center, with bounds that are all different."""
    powers = monomials(3)
    means = np.where(powers % 2, 0.0, (SIDES / 2.0) ** powers / (powers + 1.0))
    raw = DENSITY * SIDES.prod() * means.prod(axis=1)
    bounds = 1e-9 * (1.0 + np.arange(len(raw)))
    return Moments(raw, CENTER, Measure.MASS, bounds, 3.0 * bounds)


def combined(**more):
    return combined_measurement(
        **{
            "name": "Two",
            "type": "COLLECTION",
            "kind": "assembly",
            "mass": mass_of_a_box(),
            "volume": (5.0, 1e-3),
            "area": (20.0, 2e-3),
            "inputs": (3e-3, 4e-3),
            "rotation": TURN,
            "location": np.array([7.0, 8.0, 9.0]),
            "fingerprint": "abc",
            "findings": [finding("density_defaulted")],
            **more,
        }
    )


def test_several_bodies_have_the_mass_that_was_added_up_and_their_volume_as_it_is():
    found, mass = combined(), mass_of_a_box()
    assert (found.name, found.type, found.kind, found.fingerprint) == ("Two", "COLLECTION", "assembly", "abc")
    assert found.method == Method(Verdict.ASSEMBLY) and found.density_from.code == "density_from_members"
    assert (found.volume, found.area, found.thickness) == (5.0, 20.0, 0.0)
    weight = DENSITY * SIDES.prod()
    assert close(found.density, weight / 5.0, 1e-15)
    assert close(found.mass_properties.mass, weight, 1e-15)
    assert close(found.mass_properties.center, CENTER, 1e-15)
    squares = SIDES**2
    inertia = weight / 12.0 * (squares.sum() - squares)
    assert close(np.diag(found.mass_properties.inertia), inertia, 1e-14)
    assert close(found.mass_properties.principal.moments, np.sort(inertia), 1e-14)
    assert found.mass_moments[1] == 1.0 and np.array_equal(found.mass_moments[0].raw, mass.raw)
    assert close(found.moments_of_mass(2)[0, 0, 2], weight * 9.0 / 12.0, 1e-14)
    for moments, extent, measure in (
        (found.volume_moments, 5.0, Measure.VOLUME),
        (found.area_moments, 20.0, Measure.AREA),
    ):
        assert moments.measure == measure and np.array_equal(moments.about, CENTER)
        assert moments.raw.tolist() == [extent] + 19 * [0.0]
    assert np.array_equal(found.rotation, TURN) and found.location.tolist() == [7.0, 8.0, 9.0]
    assert found.findings == (finding("density_defaulted"),)


def test_bounds_of_several_bodies_are_those_that_were_added_up():
    found, properties = combined(), properties_of(mass_of_a_box(), TURN)
    assert found.error_bound == {
        "volume": 1e-3,
        "area": 2e-3,
        "center_of_mass": properties.rounding_error["center"],
        "inertia": properties.rounding_error["inertia"],
        "input": {
            "volume": 3e-3,
            "area": 4e-3,
            "center_of_mass": properties.input_error["center"],
            "inertia": properties.input_error["inertia"],
        },
    }
    assert properties.input_error["inertia"] > properties.rounding_error["inertia"] > 0.0
    assert properties.input_error["center"] > properties.rounding_error["center"] > 0.0
