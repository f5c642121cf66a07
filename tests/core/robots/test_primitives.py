# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The box, the ellipsoid and the capsule of a link have its mass, center and inertia, by closed
forms.
"""

import numpy as np
import pytest
from body_moments.core.robots.model import Inertial
from body_moments.core.robots.primitives import (
    box_sides,
    capsule_size,
    ellipsoid_axes,
    equal_inertia_shape,
)

from tests.close import close
from tests.core import bodies

SIZES = [(3.0, 2.0, 1.0), (1.0, 1.0, 1.0), (9.0, 8.0, 0.25), (1e-3, 7e-4, 2e-5), (4e4, 3e3, 2e3)]


def moments_of(size, mass, share):
    """Principal moments of a box with these sides (1/12) or an ellipsoid with these semi-axes
    (1/5).
    """
    squares = np.square(size)
    return mass * share * (squares.sum() - squares)


def capsule_moments(radius, length, mass):
    """Along the axis, and across: of a cylinder and of two half balls, each about the capsule's
    center.
    """
    cylinder, ball = np.pi * radius**2 * length, 4.0 / 3.0 * np.pi * radius**3
    density = mass / (cylinder + ball)
    along = density * (cylinder * radius**2 / 2.0 + ball * 0.4 * radius**2)
    across = cylinder * (length**2 / 12.0 + radius**2 / 4.0)
    across += ball * (0.4 * radius**2 + length**2 / 4.0 + 0.375 * length * radius)
    return along, density * across


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("mass", [1e-6, 0.7, 3e5])
def test_sides_and_semiaxes_match_closed_forms(size, mass):
    assert close(box_sides(mass, moments_of(size, mass, 1 / 12)), size, 1e-9)
    assert close(ellipsoid_axes(mass, moments_of(size, mass, 1 / 5)), size, 1e-9)


@pytest.mark.parametrize(
    "radius, length", [(1.0, 1.0), (0.5, 7.0), (2e-3, 1e-3), (30.0, 4e4), (1.0, 1e-3)]
)
@pytest.mark.parametrize("mass", [1e-4, 50.0])
def test_a_capsule_is_found_again_by_its_moments(radius, length, mass):
    along, across = capsule_moments(radius, length, mass)
    assert close(capsule_size(mass, np.array([along, across, across])), (radius, length), 1e-9)
    uneven = (
        np.array([along, 0.9 * across, 1.1 * across])
        if along < 0.9 * across
        else np.array([along, *[across] * 2])
    )
    assert close(capsule_size(mass, uneven), (radius, length), 1e-9)


def test_body_thicker_than_a_ball_becomes_the_mean_ball():
    for moments in ((0.4, 0.4, 0.4), (0.3, 0.3, 0.3 * (1.0 + 1e-15)), (0.5, 0.3, 0.3)):
        radius, length = capsule_size(2.0, np.array(moments))
        assert length < 1e-6 and close(2.0 * 2.0 / 5.0 * radius**2, np.mean(moments), 1e-6)
    assert (
        capsule_size(1.0, np.array([0.5, 0.3, 0.3]))[1]
        == 0.0
        < capsule_size(1.0, np.array([0.2, 0.3, 0.3]))[1]
    )


@pytest.mark.parametrize("moments", [(1.0, 1.0, 2.0), (0.0, 1.0, 1.0)])
def test_laminas_and_rods_have_no_side_of_zero(moments):
    for find in (box_sides, ellipsoid_axes, capsule_size):
        found = np.array(find(1.0, np.array(moments)))
        assert np.isfinite(found).all() and (found[: 2 if find is capsule_size else 3].max() > 0.1)
        assert (found > 0.0).all() or find is capsule_size
    sides = np.sort(box_sides(1.0, np.array(moments)))
    assert sides[0] < 1e-7 * sides[2]


@pytest.mark.parametrize("kind", ["box", "ellipsoid", "capsule"])
def test_fitted_shape_has_pose_and_tensor_of_the_link(kind):
    mass, center, axes = 2.5, np.array([1.0, -2.0, 3.0]), bodies.rotation(3)
    moments = moments_of((1.0, 2.0, 3.0), mass, 1 / 12)
    if kind == "capsule":
        moments = np.array([capsule_moments(0.5, 2.0, mass)[index] for index in (0, 1, 1)])
    order = np.argsort(moments)
    link = Inertial(mass, center, axes @ np.diag(moments[order]) @ axes.T, moments[order], axes)
    shape = equal_inertia_shape(link, kind)
    own = {
        "box": lambda: moments_of(shape.size, mass, 1 / 12),
        "ellipsoid": lambda: moments_of(shape.size, mass, 1 / 5),
        "capsule": lambda: np.array(capsule_moments(*shape.size, mass))[[1, 1, 0]],
    }[kind]()
    turn = shape.pose.rotation
    assert (
        shape.kind == kind
        and (shape.pose.position == center).all()
        and close(np.linalg.det(turn), 1.0, 1e-12)
    )
    assert np.abs(turn @ np.diag(own) @ turn.T - link.inertia).max() < 1e-9 * moments.max()
