# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass properties against closed forms and rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties, combine
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import Moments, monomials, sum_moments
from body_moments.core.solid.measure import measure_solid

from tests.close import close
from tests.core import exact
from tests.core.findings import refused


def box(low, high):
    raw = [
        np.prod([(high[i] ** (n + 1) - low[i] ** (n + 1)) / (n + 1) for i, n in enumerate(row)])
        for row in monomials(3).tolist()
    ]
    return Moments(np.array(raw), np.zeros(3))


L_PRISM = sum_moments([box((0, 0, 0), (3, 1, 1)), box((0, 1, 0), (1, 3, 1))])


def test_l_prism_has_its_closed_form_and_product_sign():
    body = MassProperties.from_moments(L_PRISM, 1.0)
    assert close(body.mass, 5.0, rel=1e-14)
    assert close(body.center, (1.1, 1.1, 0.5), rel=1e-14)
    assert np.allclose(
        body.inertia,
        [[121 / 30, 1.8, 0], [1.8, 121 / 30, 0], [0, 0, 217 / 30]],
        rtol=1e-14,
        atol=1e-14,
    )
    assert close(body.principal.moments, (67 / 30, 175 / 30, 217 / 30), rel=1e-14)


def test_its_bounds_are_python_s_own_numbers():
    """The bounds go into JSON and ID properties."""
    body = MassProperties.from_moments(L_PRISM, 1.0)
    assert {
        type(value) for bound in (body.rounding_error, body.input_error) for value in bound.values()
    } == {float}


def test_density_scales_mass_and_inertia_and_leaves_the_center():
    light, heavy = (
        MassProperties.from_moments(L_PRISM, 1.0),
        MassProperties.from_moments(L_PRISM, 7850.0),
    )
    assert heavy.mass == pytest.approx(7850 * light.mass)
    assert np.allclose(heavy.inertia, 7850 * light.inertia)
    assert np.allclose(heavy.center, light.center)
    assert np.allclose(heavy.radii_of_gyration, light.radii_of_gyration)
    assert close(heavy.rounding_error["inertia"], 7850 * light.rounding_error["inertia"], rel=1e-6)


def test_the_parallel_axis_theorem_holds():
    body = MassProperties.from_moments(box((0, 0, 0), (1, 2, 3)), 2.0)
    # About its corner: I_xx = m (b² + c²) / 3, I_xy = -m a b / 4.
    assert np.allclose(
        body.inertia_about((0, 0, 0)),
        12
        * np.array([[13 / 3, -2 / 4, -3 / 4], [-2 / 4, 10 / 3, -6 / 4], [-3 / 4, -6 / 4, 5 / 3]]),
    )


def test_a_frame_turns_center_tensor_and_axes_together():
    rotation = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    body = MassProperties.from_moments(L_PRISM)
    local = body.in_frame(rotation, np.array([1.0, 2.0, 3.0]))
    assert np.allclose(rotation @ local.center + (1, 2, 3), body.center)
    assert np.allclose(rotation @ local.inertia @ rotation.T, body.inertia)
    assert np.allclose(rotation @ local.principal.axes, body.principal.axes)
    axes = local.principal.axes
    assert np.allclose(axes.T @ local.inertia @ axes, np.diag(local.principal.moments), atol=1e-14)


def test_combined_halves_match_the_whole():
    whole = MassProperties.from_moments(box((0, 0, 0), (2, 1, 3)), 500.0)
    halves = combine([(box((0, 0, 0), (1, 1, 3)), 500.0), (box((1, 0, 0), (2, 1, 3)), 500.0)])
    assert halves.mass == pytest.approx(whole.mass, rel=1e-14)
    assert close(halves.center, whole.center, rel=1e-14)
    assert close(halves.inertia, whole.inertia, rel=1e-14)


def test_different_densities_combine_by_mass():
    total = combine([(box((0, 0, 0), (1, 1, 1)), 1000.0), (box((1, 0, 0), (2, 1, 1)), 3000.0)])
    assert total.mass == pytest.approx(4000.0)
    assert np.allclose(total.center, (1.25, 0.5, 0.5))


@pytest.mark.parametrize("shape", [(1, 2, 3), (1, 1, 1e-9), (1e-9, 2e-9, 3e-9), (1e6, 1e6, 2e6)])
def test_body_without_volume_is_refused_but_thin_one_is_not(shape):
    assert close(MassProperties.from_moments(box((0, 0, 0), shape)).mass, np.prod(shape), rel=1e-6)
    with refused("no_certain_volume"):
        MassProperties.from_moments(Moments(np.zeros(20), np.zeros(3)))


def test_lamina_keeps_the_triangle_inequality_at_any_density():
    rng, flat = np.random.default_rng(1), monomials(3)[:, 2] == 0
    for _ in range(200):
        lamina = Moments(box((0, 0, 0), (*rng.uniform(0.1, 10.0, 2), 1.0)).raw * flat, np.zeros(3))
        a, b, c = MassProperties.from_moments(
            lamina, density=rng.uniform(1.0, 1e4)
        ).principal.moments
        assert a + b >= c > b


def test_the_bounds_hold_against_rationals_for_perturbed_moments():
    rng = np.random.default_rng(0)
    low, high = (0.5, -1.0, 2.0), (1.5, 1.0, 4.0)
    truth = [Fraction(1)] * 20
    for k, row in enumerate(monomials(3).tolist()):
        for i, n in enumerate(row):
            truth[k] *= (Fraction(high[i]) ** (n + 1) - Fraction(low[i]) ** (n + 1)) / (n + 1)
    mass = truth[0]
    center = [x / mass for x in truth[1:4]]
    second = {(0, 0): 4, (0, 1): 5, (0, 2): 6, (1, 1): 7, (1, 2): 8, (2, 2): 9}
    central = {key: truth[k] - center[key[0]] * center[key[1]] * mass for key, k in second.items()}
    inertia = {
        (i, j): (sum(central[k, k] for k in range(3)) - central[i, i]) if i == j else -central[i, j]
        for i, j in central
    }
    for _ in range(200):
        delta = np.array([float(x) for x in truth]) * rng.uniform(0, 1e-6, 20)
        off = delta * rng.uniform(-1, 1, 20)
        body = MassProperties.from_moments(
            Moments(
                np.array([float(x) for x in truth]) + off, np.zeros(3), rounding_error=np.abs(delta)
            )
        )
        assert abs(body.mass - float(mass)) <= body.rounding_error["mass"]
        assert (
            np.linalg.norm(body.center - [float(x) for x in center])
            <= body.rounding_error["center"]
        )
        assert all(
            abs(body.inertia[key] - float(value)) <= body.rounding_error["inertia"]
            for key, value in inertia.items()
        )
        assert body.rounding_error["inertia"] < 1e-3 * np.trace(body.inertia)


@pytest.mark.parametrize("exponent", [-190, -100, 100, 160])
def test_the_bounds_hold_at_any_size(exponent):
    """Squares of inertias of tiny bodies vanish, and those of huge ones are no numbers."""
    points = np.ldexp(
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + np.array([0.3, 0.7, 0.1]), exponent
    )
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    body = MassProperties.from_moments(
        measure_solid(Surface.from_triangles(points, triangles)).volume
    )
    raw = exact.volume_moments(points, triangles)
    center = [x / raw[0] for x in raw[1:4]]
    product, moment = (
        raw[5] - raw[0] * center[0] * center[1],
        raw[7] + raw[9] - raw[0] * (center[1] ** 2 + center[2] ** 2),
    )
    assert 0.0 < body.rounding_error["inertia"] < 1e-12 * body.inertia[0, 0]
    assert abs(Fraction(body.inertia[0, 0]) - moment) <= Fraction(body.rounding_error["inertia"])
    assert abs(Fraction(body.inertia[0, 1]) + product) <= Fraction(body.rounding_error["inertia"])
    assert all(
        abs(Fraction(a) - b) <= Fraction(body.rounding_error["center"])
        for a, b in zip(body.center.tolist(), center)
    )


def test_low_order_and_invalid_density_are_refused():
    with pytest.raises(ValueError, match="third order"):
        MassProperties.from_moments(box((0, 0, 0), (1, 1, 1)).truncate(2))
    for density in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="density"):
            MassProperties.from_moments(box((0, 0, 0), (1, 1, 1)), density)
