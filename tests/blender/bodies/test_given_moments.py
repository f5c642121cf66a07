# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The moments of parts whose mass is given: each number and each bound, and both sides of what is possible."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.assembly.given import given_moments
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.settings.given import GivenPart
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.moments.moments import SECOND_MOMENT_INDEX, Measure, Moments, U, monomials

from tests.blender.findings import said
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

LOCATION = np.array([1.0, -2.0, 3.0])
TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
INERTIA = np.array([[3.0, 0.1, -0.2], [0.1, 4.0, 0.3], [-0.2, 0.3, 5.0]])


def cloud(order=4):
    """The volume of five points with weights, about another point, with bounds that are all different."""
    rng = np.random.default_rng(5)
    points, weights = rng.normal(size=(5, 3)), rng.uniform(1.0, 2.0, 5)
    raw = weights @ (points[:, None] ** monomials(order)).prod(axis=2)
    bounds = 1e-9 * (1.0 + np.arange(len(raw)))
    return Moments(raw, np.array([7.0, 8.0, 9.0]), Measure.VOLUME, bounds, 5.0 * bounds)


@pytest.mark.parametrize("geometry", [None, cloud()])
def test_given_inertia_turns_to_world_axes(geometry):
    plain, _ = given_moments(2.5, GivenPart(), TURN, LOCATION, geometry)
    found, findings = given_moments(2.5, GivenPart(inertia=INERTIA), TURN, LOCATION, geometry)
    assert [one.code for one in findings] == ["inertia_given"] and np.array_equal(found.about, plain.about)
    second = found.raw[SECOND_MOMENT_INDEX]
    assert close(np.trace(second) * np.eye(3) - second + 100.0, TURN @ INERTIA @ TURN.T + 100.0, 1e-15)
    assert np.array_equal(second, second.T) and not found.raw[10:].any()
    assert np.array_equal(found.raw[:4], plain.raw[:4])
    assert close(found.rounding_error[4:10], 16.0 * U * 12.0, 1e-15) and not found.rounding_error[10:].any()
    assert not found.input_error[4:].any() and np.array_equal(found.input_error[:4], plain.input_error[:4])


@pytest.mark.parametrize("with_inertia", [False, True])
def test_an_empty_that_stands_for_a_part_is_measured_as_that(with_inertia):
    bpy.context.scene.unit_settings.scale_length = 0.5
    obj = bpy.data.objects.new("Motor", None)
    bpy.context.scene.collection.objects.link(obj)
    obj.location, obj.rotation_euler = (2.0, 4.0, 6.0), (0.0, 0.0, np.pi / 2.0)
    settings = obj.body_moments
    settings.mass_from, settings.mass, settings.use_center, settings.given_center = "MASS", 2.5, True, (1.0, 0.0, 0.0)
    if with_inertia:
        settings.use_inertia = True
        settings.given_inertia_diagonal, settings.given_inertia_products = (3.0, 4.0, 5.0), (0.0, 0.0, 0.0)
    bpy.context.view_layer.update()
    found = measure_object(obj, bpy.context.evaluated_depsgraph_get())
    assert (found.name, found.type, found.kind, str(found.method)) == ("Motor", "EMPTY", "point", "given")
    assert (found.density, found.thickness, found.volume, found.area) == (0.0, 0.0, 0.0, 0.0)
    assert found.density_from.code == "density_from_mass" and found.mass_moments[1] == 1.0
    assert found.health.closed is False and found.health.components == 0
    assert found.location.tolist() == [1.0, 2.0, 3.0] and np.abs(found.rotation - TURN).max() < 1e-6
    body = found.mass_properties
    assert body.mass == 2.5 and np.abs(body.center - (1.0, 2.5, 3.0)).max() < 1e-6
    assert np.abs(body.inertia - (np.diag([4.0, 3.0, 5.0]) if with_inertia else 0.0)).max() < 1e-5
    assert said(found).keys() == {"center_given", *(["inertia_given"] if with_inertia else [])}
    for moments, measure in ((found.volume_moments, Measure.VOLUME), (found.area_moments, Measure.AREA)):
        assert moments.measure == measure and not moments.raw.any() and len(moments.raw) == 20
        assert np.array_equal(moments.about, found.mass_moments[0].about)
    rounding, moved = body.rounding_error, body.input_error
    assert found.error_bound == {
        **{"volume": 0.0, "area": 0.0, "center_of_mass": rounding["center"], "inertia": rounding["inertia"]},
        "input": {"volume": 0.0, "area": 0.0, "center_of_mass": moved["center"], "inertia": moved["inertia"]},
    }
    other = measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(mass=7.0))
    assert other.mass_properties.mass == 7.0 and other.fingerprint != found.fingerprint
