# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What decides between half turns, and whether a body is round, against sums over points and frames one by one."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.inertia.canonical_stack import _along_axes, _choose, _harmonics, choose_about_axis
from body_moments.core.inertia.third_moment_frames import HALF_TURN_SIGNS
from body_moments.core.moments.exponents import monomials
from body_moments.core.moments.moments import Moments

from tests.close import close
from tests.core import bodies

POWERS = monomials(6)
DEGREE = POWERS.sum(axis=1)
GROWTH = np.array([1.0, 1.0, 1.0, 1.0, 3.0, 8.0, 15.0])
PROLATE, OBLATE = 1, 2
NOISE = 3e-5
SCALES = np.array([3.0, 0.02, 300.0, 2.0])  # of the points, and the extents that they are taken to have
SIZES = np.array([[5.0, 3.0, 2.0], [0.04, 0.02, 0.01], [700.0, 699.0, 100.0], [2.0, 1.9, 0.9e-6 * 2.0]])


def sums(points, weights, order=6):
    """(K,) of points with weights."""
    return (weights[:, None] * np.prod(points[:, None] ** monomials(order), axis=2)).sum(axis=0)


def clouds(count):
    """Points about their center, one cloud for each body, and what they weigh."""
    rng = np.random.default_rng(5)
    weights = rng.uniform(0.5, 3.0, (count, 9))
    points = rng.normal(size=(count, 9, 3)) * SCALES[:count, None, None]
    return points - (weights[..., None] * points).sum(axis=1, keepdims=True) / weights.sum(axis=1)[
        :, None, None
    ], weights


def told(sizes, **given):
    """What third moments say of bodies of these extents, which come after one of which nothing is true."""
    count = len(sizes)
    known = {
        "axes": np.tile(np.eye(3), (count, 1, 1)),
        "size": sizes,
        "step": 1e-7 * sizes[:, 2] * np.arange(count),
        "tilt": 1e-6 * (3.0 + np.arange(count)),
        "allowed": np.ones((count, 4), bool),
        **given,
    }
    wrong = {name: np.concatenate([np.full_like(values[:1], 9), values]) for name, values in known.items()}
    return SimpleNamespace(noise=NOISE, **wrong), np.arange(1, count + 1)


def least_of(size, step, tilt):
    """(74,) what is noise in normalized moments, by plain numbers of one body without rounding; and their units."""
    size = np.where(size > 1e-6 * size.max(), size, np.inf)
    found, units = [], []
    for powers, degree in zip(POWERS[10:].tolist(), DEGREE[10:]):
        thin = min(extent for extent, power in zip(size, powers) if power)
        found.append(GROWTH[degree] * (NOISE + 4.0 * step / thin + degree * tilt))
        units.append(np.prod([extent**power for extent, power in zip(size, powers)]))
    return np.array(found), np.array(units)


@pytest.mark.parametrize("doubt", [0.0, 1e-4])
def test_moments_along_axes_are_those_of_points_that_are_turned_and_so_are_their_bounds(doubt):
    points, weights = clouds(4)
    fixed, which = told(SIZES, axes=np.array([bodies.rotation(i) for i in range(4)]))
    rough = np.random.default_rng(6).uniform(0.1, 1.0, (4, 7, 3)) * SCALES[:, None, None]
    error = doubt * np.array([sums(cloud, np.ones(7)) for cloud in rough])
    moments = Moments(np.array(list(map(sums, points, weights))), np.zeros((4, 3)), rounding_error=error)
    with np.errstate(all="raise"):
        values, least, raw = _along_axes(moments, fixed, which)
    for i, body in enumerate(which):
        axes, total = fixed.axes[body], weights[i].sum()
        noise, units = least_of(fixed.size[body], fixed.step[body], fixed.tilt[body])
        along = sums(points[i] @ axes, weights[i]) / total
        reach = sums(np.abs(points[i] @ axes), weights[i]) / total
        assert (np.abs(raw[i] - along) <= 1e-13 * reach).all()
        assert (np.abs(values[i] - along[10:] / units) <= 1e-12 * reach[10:] / units).all()
        assert ((values[i] == 0.0) == np.isinf(units)).all() and np.isinf(units).any() == (i == 3)
        bound = sums(rough[i] @ np.abs(axes), np.ones(7))[10:] * doubt / total
        assert close(least[i], noise + bound / units, 1e-6)


def best(values, least, allowed):
    """Of the half turns that are allowed, (4,), those that are left once each moment in turn has to be the largest."""
    left = [number for number in range(4) if allowed[number]]
    for powers, value, noise in zip(POWERS[10:].tolist(), values, least):
        turned = {number: value * np.prod(HALF_TURN_SIGNS[number] ** powers) for number in left}
        left = [number for number in left if turned[number] >= max(turned.values()) - noise]
    return [number in left for number in range(4)]


WAYS = [allowed for allowed in product((False, True), repeat=4) if any(allowed)]


@pytest.mark.parametrize("order, share", [(3, 0.3), (5, 0.1), (6, 0.02), (6, 1.0)])
def test_the_half_turns_chosen_have_the_largest_moments_one_after_the_other(order, share):
    """Of a share of the moments most are noise, some just at its limit; of some bodies all are."""
    rng, count = np.random.default_rng(order), int((order >= DEGREE).sum()) - 10
    allowed = np.array(WAYS * 8)
    least = rng.choice([0.25, 0.5, 2.0], (len(allowed), count))
    values = least * rng.choice([0.0, 0.49, 0.5, 0.51, 3.0], least.shape, p=[0.2, 0.2, 0.2, 0.2, 0.2])
    values *= rng.choice([-1.0, 1.0], values.shape) * (rng.random(values.shape) < share)
    with np.errstate(all="raise"):
        found = _choose(values, least, allowed)
    assert found.tolist() == [best(*one) for one in zip(values, least, allowed)]


@pytest.mark.parametrize("order", [3, 4, 5, 6])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_any_one_moment_decides(order, sign):
    """The others are at the limit of noise."""
    count = int((order >= DEGREE).sum()) - 10
    for column in range(count):
        values, least = np.full((len(WAYS), count), -0.5e-3), np.full((len(WAYS), count), 1e-3)
        values[:, column] = sign * 0.6e-3
        wanted = []
        for allowed in WAYS:  # the one moment has a sign after each half turn
            turned = sign * np.prod(HALF_TURN_SIGNS ** POWERS[10 + column], axis=1)
            largest = turned > 0.0 if (turned[list(allowed)] > 0.0).any() else np.ones(4, bool)
            wanted.append((largest & allowed).tolist())
        assert _choose(values, least, np.array(WAYS)).tolist() == wanted


def harmonics(order):
    """The degree, m and k of those that turn with a body."""
    for degree in range(3, order + 1):
        for m in range(1, degree + 1):
            for k in range(degree - m + 1):
                if (degree - m - k) % 2 == 0:
                    yield degree, m, k


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_harmonics_are_made_from_moments_as_they_are_from_points(axis, order):
    (points,), (masses,) = clouds(1)
    weights, columns, forms = _harmonics(axis, order)
    x, y, z = np.roll(points, -1 - axis, axis=1).T
    found = forms @ sums(points, masses, order)[10:]
    for number, (degree, m, k) in enumerate(harmonics(order)):
        terms = masses * (x + 1j * y) ** m * (x * x + y * y) ** ((degree - m - k) // 2) * z**k
        assert abs(found[number] - terms.sum()) <= 1e-13 * np.abs(terms).sum()
        powers = np.roll((degree - k, 0, k), axis + 1)
        assert POWERS[10 + columns[number]].tolist() == powers.tolist()
        assert weights[number] == 2.0 ** (degree - k)
    assert len(found) == number + 1 == len(columns) == len(weights)


def with_one_moment(powers, values):
    """(n, 84) moments that are zero but for the total, and one that is different for each body."""
    raw = np.zeros((len(values), 84))
    raw[:, 0] = 1.0
    raw[:, (powers == POWERS).all(axis=1).argmax()] = values
    return Moments(raw, np.zeros((len(values), 3)))


@pytest.mark.parametrize("symmetry, axis", [(PROLATE, 0), (OBLATE, 2)])
@pytest.mark.parametrize("degree, k", sorted({(degree, k) for degree, _, k in harmonics(6)}))
def test_a_body_is_round_where_no_harmonic_is_more_than_the_noise_of_the_moments_it_is_made_from(
    symmetry, axis, degree, k
):
    """E[x^(n-k) z^k] is what each of its harmonics is, where the other moments are zero."""
    powers = np.roll((degree - k, 0, k), axis + 1)
    share = np.array([0.99, 1.01, 0.99, -1.01, 0.99, 1.01])
    sizes = np.array([[5.0, 3.0, 2.0], [0.05, 0.03, 0.01], [9.0, 8.0, 1.0]])[[0, 0, 1, 1, 2, 2]]
    fixed, which = told(sizes, symmetry=np.array([symmetry] * 4 + [0, 3]))
    limits = [least_of(fixed.size[body], fixed.step[body], fixed.tilt[body]) for body in which]
    column = (POWERS[10:] == powers).all(axis=1).argmax()
    values = [2.0 ** (degree - k) * least[column] * units[column] for least, units in limits]
    is_round, allowed = choose_about_axis(with_one_moment(powers, share * values), fixed, which)
    assert is_round.tolist() == [True, False, True, False, True, True]
    along = with_one_moment(np.roll((0, 0, degree), axis + 1), 1e3 * np.array(values))
    assert choose_about_axis(along, fixed, which)[0].all()


@pytest.mark.parametrize("symmetry, axis", [(PROLATE, 0), (OBLATE, 2)])
@pytest.mark.parametrize("allowed", WAYS)
def test_of_half_turns_about_a_round_axis_the_first_of_each_way_is_left_and_a_skewness_chooses(symmetry, axis, allowed):
    fixed, which = told(SIZES[:3], symmetry=np.full(3, symmetry), allowed=np.array([allowed, allowed, allowed]))
    ways = HALF_TURN_SIGNS[:, axis].tolist()
    ahead, back = ([number for number in range(4) if allowed[number] and ways[number] == way] for way in (1.0, -1.0))
    first = {*ahead[:1], *back[:1]}
    powers = np.roll((0, 0, 3), axis + 1)
    skewed = 10.0 * SIZES[:3, axis] ** 3 * GROWTH[3] * NOISE
    found = choose_about_axis(with_one_moment(powers, skewed * (0.0, 1.0, -1.0)), fixed, which)
    assert found[0].all()
    for chosen, wanted in zip(found[1], (first, set(ahead[:1]) or first, set(back[:1]) or first)):
        assert set(np.flatnonzero(chosen).tolist()) == wanted
