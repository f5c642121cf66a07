# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass properties against closed forms and rational arithmetic."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties, are_physical, combine
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import SECOND_MOMENT_INDEX, Measure, Moments, U, monomials, sum_moments
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


def test_an_l_prism_has_the_closed_form_and_the_sign_of_its_product():
    body = MassProperties.from_moments(L_PRISM, 1.0)
    assert close(body.mass, 5.0, rel=1e-15)
    assert close(body.center, (1.1, 1.1, 0.5), rel=1e-15)
    assert np.allclose(body.inertia, [[121 / 30, 1.8, 0], [1.8, 121 / 30, 0], [0, 0, 217 / 30]], rtol=1e-14, atol=1e-14)
    assert close(body.principal.moments, (67 / 30, 175 / 30, 217 / 30), rel=1e-14)


def test_its_bounds_are_python_s_own_numbers():
    """For JSON, ID properties and whoever prints them."""
    body = MassProperties.from_moments(L_PRISM, 1.0)
    assert {type(value) for bound in (body.rounding_error, body.input_error) for value in bound.values()} == {float}


def test_density_scales_mass_and_inertia_and_leaves_the_center():
    light, heavy = MassProperties.from_moments(L_PRISM, 1.0), MassProperties.from_moments(L_PRISM, 7850.0)
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
        12 * np.array([[13 / 3, -2 / 4, -3 / 4], [-2 / 4, 10 / 3, -6 / 4], [-3 / 4, -6 / 4, 5 / 3]]),
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


def test_two_halves_are_the_whole():
    whole = MassProperties.from_moments(box((0, 0, 0), (2, 1, 3)), 500.0)
    halves = combine([(box((0, 0, 0), (1, 1, 3)), 500.0), (box((1, 0, 0), (2, 1, 3)), 500.0)])
    assert halves.mass == pytest.approx(whole.mass, rel=1e-15)
    assert close(halves.center, whole.center, rel=1e-15)
    assert close(halves.inertia, whole.inertia, rel=1e-14)


def test_different_densities_combine_by_mass():
    total = combine([(box((0, 0, 0), (1, 1, 1)), 1000.0), (box((1, 0, 0), (2, 1, 1)), 3000.0)])
    assert total.mass == pytest.approx(4000.0)
    assert np.allclose(total.center, (1.25, 0.5, 0.5))


@pytest.mark.parametrize("shape", [(1, 2, 3), (1, 1, 1e-9), (1e-9, 2e-9, 3e-9), (1e6, 1e6, 2e6)])
def test_a_body_without_volume_is_refused_and_a_thin_or_tiny_one_is_not(shape):
    assert close(MassProperties.from_moments(box((0, 0, 0), shape)).mass, np.prod(shape), rel=1e-6)
    with refused("no_certain_volume"):
        MassProperties.from_moments(Moments(np.zeros(20), np.zeros(3)))


def test_a_lamina_keeps_the_triangle_inequality_to_the_last_digit_whatever_its_density():
    rng, flat = np.random.default_rng(1), monomials(3)[:, 2] == 0
    for _ in range(200):
        lamina = Moments(box((0, 0, 0), (*rng.uniform(0.1, 10.0, 2), 1.0)).raw * flat, np.zeros(3))
        a, b, c = MassProperties.from_moments(lamina, density=rng.uniform(1.0, 1e4)).principal.moments
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
        (i, j): (sum(central[k, k] for k in range(3)) - central[i, i]) if i == j else -central[i, j] for i, j in central
    }
    for _ in range(200):
        delta = np.array([float(x) for x in truth]) * rng.uniform(0, 1e-6, 20)
        off = delta * rng.uniform(-1, 1, 20)
        body = MassProperties.from_moments(
            Moments(np.array([float(x) for x in truth]) + off, np.zeros(3), rounding_error=np.abs(delta))
        )
        assert abs(body.mass - float(mass)) <= body.rounding_error["mass"]
        assert np.linalg.norm(body.center - [float(x) for x in center]) <= body.rounding_error["center"]
        assert all(
            abs(body.inertia[key] - float(value)) <= body.rounding_error["inertia"] for key, value in inertia.items()
        )
        assert body.rounding_error["inertia"] < 1e-3 * np.trace(body.inertia)


@pytest.mark.parametrize("exponent", [-190, -100, 100, 160])
def test_the_bounds_hold_at_any_size(exponent):
    """Squares of inertias of tiny bodies vanish, and those of huge ones are no numbers."""
    points = np.ldexp(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) + np.array([0.3, 0.7, 0.1]), exponent)
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    body = MassProperties.from_moments(measure_solid(Surface.from_triangles(points, triangles)).volume)
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
        abs(Fraction(a) - b) <= Fraction(body.rounding_error["center"]) for a, b in zip(body.center.tolist(), center)
    )


def test_too_low_an_order_and_a_density_that_is_none_are_refused():
    with pytest.raises(ValueError, match="third order"):
        MassProperties.from_moments(box((0, 0, 0), (1, 1, 1)).truncate(2))
    for density in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="density"):
            MassProperties.from_moments(box((0, 0, 0), (1, 1, 1)), density)


def test_bounds_are_what_the_worst_signs_make_to_first_order():
    raw, density = box((0.5, -1.0, 2.0), (1.5, 1.5, 4.0)).raw, 3.0
    delta = np.random.default_rng(5).uniform(1e-9, 2e-9, 20)

    def worst(function):
        return sum(np.abs(function(raw + step) - function(raw - step)) / 2.0 for step in np.diag(delta))

    second = worst(lambda raw: raw[SECOND_MOMENT_INDEX] - np.outer(raw[1:4], raw[1:4]) / raw[0])
    expected = (
        delta[0] * density,
        np.linalg.norm(worst(lambda raw: raw[1:4] / raw[0])),
        density * np.linalg.norm(second.trace() * np.eye(3) + second),
    )
    found = MassProperties.from_moments(Moments(raw, np.zeros(3), input_error=delta), density)
    assert close(list(found.input_error.values()), expected, rel=1e-6)


@pytest.mark.parametrize("about", [(0.0, 0.0, 0.0), (7.0, -300.0, 0.5)])
def test_of_exact_moments_bounds_are_units_of_rounding_of_what_is_added_up(about):
    """One of the mass, two of the center's coordinates and six of what inertia is the difference of."""
    raw, about = box((0.5, -1.0, 2.0), (1.5, 1.5, 4.0)).raw, np.array(about)
    found = MassProperties.from_moments(Moments(raw, about), 3.0)
    assert found.input_error == {"mass": 0.0, "center": 0.0, "inertia": 0.0}
    shift = np.abs(raw[1:4]) / raw[0]
    second = np.abs(raw[SECOND_MOMENT_INDEX]) + raw[0] * np.outer(shift, shift)
    inertia = np.linalg.norm(second.trace() * np.eye(3) + second)
    units = raw[0], 2.0 * np.linalg.norm(np.abs(about) + 2.0 * shift), 6.0 * inertia
    assert close(list(found.rounding_error.values()), U * np.array([3.0, 1.0, 3.0]) * units, 1e-13)


@pytest.mark.parametrize("share, bounded", [(0.499, True), (0.501, False)])
def test_a_mass_that_may_be_none_bounds_no_center(share, bounded):
    off = np.zeros(20)
    off[0] = share * L_PRISM.raw[0]
    found = MassProperties.from_moments(Moments(L_PRISM.raw, np.zeros(3), input_error=off)).input_error
    assert [np.isfinite(found[name]) for name in ("mass", "center", "inertia")] == [True, bounded, bounded]


def stack_of(centers, spread, about, total, first_error=0.0, second_error=0.0):
    """Moments of bodies with these centers and these central second moments (xx, yy, zz) by the total."""
    raw, error = np.zeros((2, len(centers), 10))
    for row, center in enumerate(centers):
        mean = np.array(center) - about
        second = np.diag(spread) + np.outer(mean, mean)
        raw[row] = total * np.concatenate([[1.0], mean, second[np.triu_indices(3)]])
    error[:, 2], error[:, 6] = first_error * total, second_error * total
    return Moments(raw, np.tile(about, (len(centers), 1)), Measure.VOLUME, error)


@pytest.mark.parametrize("size, first_error", [(4.0, 0.0), (4.0, 3e-6), (400.0, 0.0)])
def test_a_body_s_center_is_in_its_box_but_for_what_is_uncertain(size, first_error):
    """A millionth of the size, and what rounding leaves of the first moments."""
    low, high, about = np.array([1.0, -2.0, 3.0]), np.array([2.0, 1.0, 7.0]), np.array([1.75, 0.5, 4.0])
    tolerance = 1e-6 * size + first_error
    centers, expected = [(low + high) / 2.0], [True]
    for axis in range(3):
        for end, sign in ((low, -1.0), (high, 1.0)):
            for share in (0.99, 1.01):
                center = (low + high) / 2.0
                center[axis] = end[axis] + sign * share * tolerance
                centers.append(center)
                expected.append(share < 1.0)
    volume = stack_of(centers, (0.3, 0.2, 0.1), about, 5.0, first_error=first_error)
    boxes = (np.tile(side, (len(centers), 1)) for side in (low, high))
    assert are_physical(volume, *boxes, size).tolist() == expected


@pytest.mark.parametrize("error", [1e-9, 1e-6])
def test_a_body_s_second_moments_are_those_of_a_mass_but_for_eight_times_what_is_uncertain(error):
    center = np.array([1.5, -0.5, 5.0])
    for axis in range(3):
        for share in (-1.01, -0.99, 0.5):
            spread = np.array([0.3, 0.2, 0.4])
            spread[axis] = share * 8.0 * error
            volume = stack_of([center], spread, center, 7.0, second_error=error)
            assert are_physical(volume, center[None] - 2.0, center[None] + 2.0, 4.0).tolist() == [share > -1.0]


@pytest.mark.parametrize("share", [0.02, 0.2])
def test_large_errors_are_bounded_by_exactly_what_the_worst_signs_of_them_make(share):
    """Each of ten moments off by so much of what it is; all 1024 choices of signs."""
    raw = box((0.5, -1.0, 2.0), (1.5, 1.5, 4.0)).raw
    delta = share * np.abs(raw) * np.array([1.0, 0.5, 0.8, 0.3, 1.0, 0.2, 0.7, 0.9, 0.4, 0.6, *[0.0] * 10])
    found = MassProperties.from_moments(Moments(raw, np.zeros(3), input_error=delta), 3.0).input_error

    def derived(raw):
        first = raw[..., 1:4]
        second = raw[..., SECOND_MOMENT_INDEX] - first[..., :, None] * first[..., None, :] / raw[..., :1, None]
        return first / raw[..., :1], second

    moved = derived(raw[:10] + np.array(list(product((-1.0, 1.0), repeat=10))) * delta[:10])
    center, second = (np.abs(values - own).max(axis=0) for values, own in zip(moved, derived(raw[:10])))
    assert close(found["mass"], 3.0 * delta[0], 1e-14) and close(found["center"], np.linalg.norm(center), 1e-13)
    assert close(found["inertia"], 3.0 * np.linalg.norm(second.trace() * np.eye(3) + second), 1e-12)


def test_the_moments_of_a_mass_are_those_that_give_its_properties_again():
    body = MassProperties.from_moments(L_PRISM, 3.0)
    made = body.as_moments()
    assert made.measure == Measure.MASS and (made.about == body.center).all() and made.raw[0] == body.mass
    again = MassProperties.from_moments(made)
    assert (again.center == body.center).all() and np.abs(again.inertia - body.inertia).max() <= 1e-14 * 22.0
