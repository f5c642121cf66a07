# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about any reference: against exact rationals, far away and tiny, within its bounds."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia import MassProperties, PlainBody, Reference, tensor_rows
from body_moments.core.moments import Measure, Moments, monomials
from body_moments.core.verdict import QueryError

from tests.close import close
from tests.core.boxes import box


def refer(reference, properties):
    """The inertia about a reference; center and inertia as arrays."""
    names = ("volume", "mass"), ("center_of_mass", "center"), ("inertia", "inertia")
    errors = properties.rounding_error, properties.input_error
    bound, inputs = ({key: error[name] for key, name in names} for error in errors)
    referred = reference.refer(
        PlainBody.of_body(properties, 1.0, 0.0, 0.0, {**bound, "input": inputs})
    )
    return replace(referred, center=np.array(referred.center)), np.array(
        tensor_rows(referred.inertia)
    )


@pytest.mark.parametrize(
    "size, center, point",
    [
        ((1, 2, 4), (0, 0, 0), (0, 0, 0)),
        ((1, 2, 4), (8, -3, 5), (1, 1, 1)),
        ((1, 2, 4), (4096, -8192, 2048), (0, 0, 0)),
        ((1e-6, 2e-6, 4e-6), (1e-5, 0, 0), (0, 3e-5, 0)),
        ((1, 2, 4), (4096, -8192, 2048), (4097, -8192, 2048)),
    ],
)
def test_the_tensor_about_a_point_is_exact_within_its_bound(size, center, point):
    moments, tensor = box(size, center, 3)
    moments = moments.about_point(np.array(center, float) + np.array(size, float))
    reference, truth = Reference(point), tensor(point)
    properties = MassProperties.from_moments(moments)
    referred, inertia = refer(reference, properties)
    error = np.linalg.norm(inertia - truth)
    assert (
        error
        <= referred.rounding_error["inertia"]
        <= 1e-11 * np.linalg.norm(truth) + 1e-9 * np.linalg.norm(properties.inertia)
    )
    arm = np.array([float(Fraction(c) - Fraction(p)) for c, p in zip(center, point)])
    assert np.linalg.norm(referred.center - arm) <= referred.rounding_error["center"]


def test_axes_turn_the_tensor():
    moments, tensor = box((1, 2, 4), (8, -3, 5), 3)
    axes = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0
    reference = Reference((1.0, 2.0, 3.0), axes.T.tolist())
    truth = axes.T @ tensor((1, 2, 3)) @ axes
    referred, inertia = refer(reference, MassProperties.from_moments(moments))
    assert np.abs(inertia - truth).max() <= 1e-14 * truth.max()
    assert close(referred.center, axes.T @ [7.0, -5.0, 2.0], 1e-14) and referred.mass == 3.0


def test_float32_coordinates_move_with_the_arm():
    moments, _ = box((1, 2, 4), (8, -3, 5), 3)
    moved = Moments(
        moments.raw, moments.about, Measure.MASS, moments.rounding_error, np.abs(moments.raw) * 1e-6
    )
    near, far = Reference(moments.about), Reference(moments.about + [1000.0, 0.0, 0.0])
    properties = MassProperties.from_moments(moved)
    small, large = (
        refer(reference, properties)[0].input_error["inertia"] for reference in (near, far)
    )
    assert large > 1e5 * small > 0.0


def test_an_axis_through_two_points():
    moments, tensor = box((1, 2, 4), (8, -3, 5), 3)
    reference = Reference.through_points((1, 1, 1), (3, 2, 3))
    along = np.array([2, 1, 2]) / 3.0
    axes = np.array(reference.axes)
    assert close(axes[2], along, 1e-14) and np.linalg.det(axes) > 0.999
    assert np.abs(axes @ axes.T - np.eye(3)).max() < 1e-14
    referred, _ = refer(reference, MassProperties.from_moments(moments))
    assert close(referred.about_z, along @ tensor((1, 1, 1)) @ along, 1e-14)
    arm = np.array([7.0, -4.0, 4.0])
    assert close(referred.distance_from_z, np.linalg.norm(np.cross(arm, along)), 1e-14)
    assert close(referred.radius_about_z, np.sqrt(referred.about_z / 3.0), 1e-14)
    for second in ((1, 1, 1), (1 + 1e-7, 1, 1), (np.nan, 0, 0)):
        with pytest.raises(QueryError):
            Reference.through_points((1, 1, 1), second)


@pytest.mark.parametrize(
    "length, mass", [(2.0**-20, 1.0), (2.0**20, 1.0), (1.0, 2.0**-30), (2.0**7, 2.0**30)]
)
def test_inertia_and_its_bounds_scale_with_length_and_mass(length, mass):
    axes = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0
    raw = box((1, 2, 4), (3, 5, -1), 5)[0].about_point((2.5, 4.0, 1.0)).raw
    powers = mass * length ** monomials(3).sum(axis=1).astype(float)

    def of(share, about, origin):
        moments = Moments(
            raw * share,
            about,
            Measure.MASS,
            np.abs(raw) * share * 1e-15,
            np.abs(raw) * share * 1e-6,
        )
        return refer(Reference(origin, axes.T.tolist()), MassProperties.from_moments(moments))

    about, origin = np.array([2.5, 4.0, 1.0]), np.array([-1.0, 7.0, 2.0])
    one, inertia = of(np.ones(20), about, origin)
    other, other_inertia = of(powers, about * length, origin * length)
    assert other.mass == one.mass * mass
    assert (other.center == one.center * length).all()
    assert close(other_inertia, inertia * mass * length**2, 1e-13)
    for bound in ("rounding_error", "input_error"):
        for name, factor in (("mass", mass), ("center", length), ("inertia", mass * length**2)):
            assert close(getattr(other, bound)[name], getattr(one, bound)[name] * factor, 1e-9), (
                bound,
                name,
            )
