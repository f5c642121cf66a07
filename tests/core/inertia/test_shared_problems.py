# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What bodies that share the search for their axes are asked, and how the frames it finds become each one's own."""

from dataclasses import replace
from fractions import Fraction
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.inertia import shared_search
from body_moments.core.inertia.canonical_frame import EquivalentFrames, FrameRule
from body_moments.core.inertia.shared_search import (
    _bases,
    _frames_alike,
    _refined,
    _rounded_up,
    _search,
    _ways,
    _whitened,
)
from body_moments.core.inertia.third_moment_frames import HALF_TURN_SIGNS
from body_moments.core.moments.affine_maps import rotate_moments
from body_moments.core.moments.exponents import monomials
from body_moments.core.moments.moments import Moments

from tests.close import close
from tests.core import bodies, shapes

POWERS = monomials(6)
DEGREE = POWERS.sum(axis=1)
GROWTH = np.array([1.0, 1.0, 1.0, 1.0, 3.0, 8.0, 15.0])[DEGREE]
FREE = {"prolate": [1, 2], "oblate": [0, 1], "isotropic": [0, 1, 2]}
AXIS = {"prolate": 0, "oblate": 2}


def sums(points, weights):
    """(84,) of points with weights."""
    return (weights[:, None] * np.prod(points[:, None] ** POWERS, axis=2)).sum(axis=0)


def rounded_up(value):
    """The least of 4/8, 5/8, 6/8, 7/8 times a power of two that is no smaller, of 2^-30 and more."""
    value, unit = max(Fraction(value), Fraction(1, 2**30)), Fraction(1, 2**40)
    return float(
        next(unit * 2**power * k / 8 for power in range(200) for k in range(4, 8) if unit * 2**power * k >= 8 * value)
    )


def test_bounds_are_rounded_up_to_three_binary_digits():
    values = np.array(
        [0.0, 1e-12, 2.0**-30, 1.01 * 2.0**-30, 1e-7, 0.5, 0.51, 0.625, 0.7499, 0.75, 0.76, 0.99, 1.0, 3e9]
    )
    assert _rounded_up(values).tolist() == [rounded_up(value) for value in values.tolist()]


@pytest.mark.parametrize("axis", [0, 2])
def test_a_fixed_axis_points_the_ways_that_its_half_turns_allow(axis):
    ways = list(product((False, True), repeat=4))
    fixed = SimpleNamespace(allowed=np.array([[True] * 4, *ways]))
    found = _ways(fixed, np.arange(1, 17), axis)
    ahead = HALF_TURN_SIGNS[:, axis] > 0.0
    expected = [1 * any(np.array(way)[ahead]) + 2 * any(np.array(way)[~ahead]) for way in ways]
    assert found.tolist() == expected


@pytest.mark.parametrize("axis", [0, 2])
def test_a_basis_has_the_fixed_axis_and_next_to_it_what_is_left_of_a_coordinate_axis(axis):
    """Of the one that is most across, by thousandths of its cosine, so that rounding does not choose."""
    near, helpers = 0.45 + np.array([0.0, 3e-4, -3e-4]), [2, 1, 0, 0, 0, 0, 1]
    fixed = np.array([[1, 2, 0.5], [3, -1, 2], [0.1, 5, -4], *([b, 0.45, 0.7714] for b in near), [0.7, 0.6, 1]], float)
    fixed /= np.linalg.norm(fixed, axis=1)[:, None]
    found = _bases(fixed, axis)
    for basis, own, helper in zip(found, fixed, helpers):
        assert np.abs(basis.T @ basis - np.eye(3)).max() <= 1e-15 and np.linalg.det(basis) > 0.0
        assert (basis[:, axis] == own).all() and basis[helper, (axis + 1) % 3] > 0.5
        assert abs(basis[helper, (axis + 2) % 3]) <= 1e-15


def told(symmetry, count, axes=None):
    """What third moments say of bodies that come after one of which nothing is true."""
    sizes = np.array([[5.0, 4.0, 3.0], [0.07, 0.05, 0.02], [900.0, 800.0, 300.0]])[:count]
    known = {
        "axes": np.tile(np.eye(3), (count, 1, 1)) if axes is None else axes,
        "size": sizes,
        "step": np.array([0.0, 3e-8, 2e-5])[:count],
        "tilt": np.array([3e-7, 0.0, 5e-6])[:count],
        "allowed": np.ones((count, 4), bool),
    }
    wrong = {name: np.concatenate([np.full_like(values[:1], 9), values]) for name, values in known.items()}
    return SimpleNamespace(noise=1e-5, **wrong), np.arange(1, count + 1)


def extents(sizes, name):
    """Those along equal axes are their root mean square."""
    found = sizes.copy()
    found[FREE[name]] = np.sqrt((sizes[FREE[name]] ** 2).mean())
    return found


@pytest.mark.parametrize("name", FREE)
def test_moments_are_taken_along_the_basis_in_units_of_the_extents_and_so_are_the_largest_bounds_of_each_degree(name):
    rng = np.random.default_rng(3)
    fixed, which = told(name, 3)
    weights = rng.uniform(1.0, 3.0, (3, 9))
    points = rng.normal(size=(3, 9, 3)) * fixed.size[which][:, :1, None] / 3.0
    points -= (weights[..., None] * points).sum(axis=1, keepdims=True) / weights.sum(axis=1)[:, None, None]
    rough = np.abs(points[:, :4]) * 0.7
    error = 1e-5 * np.array([sums(cloud, np.ones(4)) for cloud in rough])
    moments = Moments(np.array(list(map(sums, points, weights))), np.zeros((3, 3)), rounding_error=error)
    basis = np.array([bodies.rotation(i) for i in range(3)])
    raw, bound, extent = _whitened(moments, fixed, which, basis, name)
    for i, body in enumerate(which):
        own = np.eye(3) if name == "isotropic" else basis[i]
        size = extents(fixed.size[body], name)
        assert close(extent[i], size, 1e-15)
        along = sums(points[i] @ own / size, weights[i]) / weights[i].sum()
        reach = sums(np.abs(points[i] @ own / size), weights[i]) / weights[i].sum()
        assert (np.abs(raw[i] - along) <= 1e-13 * reach).all()
        bounds = 1e-5 * sums(rough[i] @ np.abs(own) / size, np.ones(4)) / weights[i].sum()
        wanted = [rounded_up((1.0 + 1e-9) * bounds[degree == DEGREE].max()) for degree in range(7)]
        assert bound[i].tolist() == wanted


@pytest.fixture
def searches(monkeypatch):
    """What is searched for, of which the first problem has no rule."""
    keys = []

    def search(*key):
        keys.append(key)
        rule = None if len(keys) == 1 else FrameRule(0, 2, None, 1.0)
        return EquivalentFrames(np.eye(3)[None], np.empty(0), np.empty(0), (), 0.5, rule)

    monkeypatch.setattr(shared_search, "_search", search)
    return keys


def cells_of(key):
    return np.frombuffer(key[3], np.int32)


def normal(sizes, count=1):
    """(n, 84) moments with extents, of total 2: those of points along the axes."""
    corners = np.sqrt(3.0) * np.concatenate([np.eye(3), -np.eye(3)])
    return np.array([sums(corners * size, np.full(6, 1.0 / 3.0)) for size in sizes])


@pytest.mark.parametrize("name", FREE)
def test_a_problem_is_what_is_known_of_a_body_on_a_grid(searches, name):
    """Two of three bodies are one problem."""
    fixed, which = told(name, 3, np.array([bodies.rotation(5)] * 3))
    if name != "isotropic":
        fixed.allowed[1] = HALF_TURN_SIGNS[:, AXIS[name]] < 0.0
    sizes = np.array([extents(size, name) for size in fixed.size[1:]])
    fixed.size[1:] = sizes
    fixed.step[3], fixed.tilt[3] = fixed.step[2] / sizes[1].min() * sizes[2].min(), 0.0
    basis = np.eye(3) if name == "isotropic" else _bases(fixed.axes[1:2, :, AXIS[name]], AXIS[name])[0]
    raw = normal(sizes)
    off = np.random.default_rng(4).integers(-90, 90, 84)
    raw[1:] += 2e-6 * np.prod(sizes[1:, None] ** POWERS, axis=2) * GROWTH * np.where(DEGREE > 2, off + 0.4, 0.0)
    moments = Moments(raw, np.zeros((3, 3)))
    moments = replace(moments, raw=rotate_moments(raw, 6, basis))
    found = _frames_alike(moments, fixed, which, name)
    ways = 3 if name == "isotropic" else 2
    assert len(searches) == 2
    plain = np.rint(normal(np.ones((1, 3)))[0] / 2.0 / (1e-6 * GROWTH))[10:]
    for number, key in enumerate(searches):
        assert key[:3] == (name, 1e-5, 3 if number or name == "isotropic" else ways)
        assert cells_of(key).tolist() == (plain + (off[10:] if number else 0)).tolist()
        assert (np.frombuffer(key[4]) == 2.0**-30).all() and len(np.frombuffer(key[4])) == 7
        step, tilt = fixed.step[1 + number] / sizes[number].min(), fixed.tilt[1 + number]
        assert key[5:] == (rounded_up(step), rounded_up(tilt) if tilt else 0.0)
    assert found[0] is None and found[1].tilt == 0.5
    for frames in found[1:]:
        assert np.abs(frames.frames - basis).max() <= 1e-15


@pytest.mark.parametrize("name", FREE)
@pytest.mark.parametrize("share, is_asked", [(0.999, True), (1.001, False)])
@pytest.mark.parametrize("place", [10, 33, 40, 83])
def test_larger_moments_than_four_times_a_normal_body_s_are_looked_at_by_themselves(
    searches, name, share, is_asked, place
):
    """One body of two; the other is asked for in any case."""
    fixed, which = told(name, 2)
    sizes = np.array([extents(size, name) for size in fixed.size[1:]])
    fixed.size[1:] = sizes
    raw = normal(sizes)
    raw[1, place] = share * 2.0 * 4.0 * GROWTH[place] * np.prod(sizes[1] ** POWERS[place])
    axes = np.eye(3) if name == "isotropic" else _bases(np.eye(3)[[AXIS[name]]], AXIS[name])[0]
    moments = Moments(rotate_moments(raw, 6, axes), np.zeros((2, 3)))
    assert [frames is None for frames in _frames_alike(moments, fixed, which, name)] == [True, not is_asked]
    assert len(searches) == 1 + is_asked


@pytest.mark.parametrize("share, is_asked", [(1.1e-6, True), (0.9e-6, False)])
def test_flat_bodies_are_looked_at_by_themselves(searches, share, is_asked):
    fixed, which = told("oblate", 2)
    fixed.size[1:] = [[2.0, 2.0, 1.0], [3e5, 3e5, 3e5 * share]]
    moments = Moments(normal(fixed.size[1:]), np.zeros((2, 3)))
    assert [frames is None for frames in _frames_alike(moments, fixed, which, "oblate")] == [True, not is_asked]


@pytest.mark.parametrize("bad", ["raw", "bound"])
def test_a_body_whose_moments_or_bounds_are_no_numbers_is_looked_at_by_itself(searches, bad):
    fixed, which = told("prolate", 2)
    raw = normal(fixed.size[1:])
    error = np.zeros_like(raw)
    (raw if bad == "raw" else error)[1, 83] = np.inf
    with np.errstate(all="ignore"):
        found = _frames_alike(Moments(raw, np.zeros((2, 3)), rounding_error=error), fixed, which, "prolate")
    assert found == [None, None] and len(searches) == 1


@pytest.mark.parametrize("ways", [1, 2, 3])
@pytest.mark.parametrize("name, half_turn", [("prolate", [-1, 1, -1]), ("oblate", [1, -1, -1]), ("isotropic", None)])
def test_searched_are_the_moments_on_the_grid_from_the_ways_that_an_axis_points(monkeypatch, name, half_turn, ways):
    given = []

    def frames(*args):
        given.extend(args)
        return EquivalentFrames(np.eye(3)[None], np.ones(74), np.ones(74), (), 0.5, None)

    monkeypatch.setattr(shared_search, "canonical_frames", frames)
    cells = np.arange(74, dtype=np.int32)
    bound = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    found = _search.__wrapped__(name, 2e-5, ways, cells.tobytes(), bound.tobytes(), 0.25, 0.125)
    central, spread, starts = given
    assert close(central.raw[10:], 1e-6 * GROWTH[10:] * cells, 1e-15)
    assert central.raw[:10].tolist() == [1, 0, 0, 0, 1, 0, 0, 1, 0, 1] and not central.about.any()
    assert (central.rounding_error == DEGREE).all()
    assert (spread.axes == np.eye(3)).all() and spread.size.tolist() == [1, 1, 1]
    assert (list(spread.undetermined_axes), spread.step, spread.tilt, spread.noise) == (FREE[name], 0.25, 0.125, 2e-5)
    wanted = [np.eye(3)] if half_turn is None else [np.eye(3)] * (ways & 1) + [np.diag(half_turn)] * (ways >> 1)
    assert np.array_equal(starts, wanted)
    assert found.values.shape == found.noise.shape == (0,) and found.tilt == 0.5


def about_z(angle):
    return np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])


def ring(m, heights):
    """Points at these heights, the first of each m of them at no angle; a lower ring weighs less."""
    points = np.concatenate([[[np.cos(a), np.sin(a), h] for a in 2.0 * np.pi / m * np.arange(m)] for h in heights])
    return points, np.repeat([1.0, 0.25][: len(heights)], m)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("degree, m, k", [(3, 3, 0), (5, 3, 0), (5, 3, 2), (4, 3, 1), (6, 2, 2), (6, 4, 2), (6, 5, 1)])
def test_frames_are_turned_about_an_axis_by_what_is_left_of_the_phase_of_a_harmonic(degree, m, k, axis, sign):
    """(x+iy)^m is one where the points are; to be -1 there asks for half of the turn from one to the next."""
    points, weights = ring(m, [2.0, -1.0])
    order = np.roll([0, 1, 2], -1 - axis)  # where x, y and z of the ring go
    turns = np.array([3e-5, -2e-5, 0.0, 3e-4])
    base = bodies.rotation(2)
    raw = np.array([sums((points @ about_z(turn).T)[:, np.argsort(order)] @ base.T, weights) for turn in turns])
    off = 0.0 if sign > 0.0 else np.pi / m
    starts = [about_z(off), about_z(off + 2.0 * np.pi / m)]
    starts = np.array([base @ start[np.argsort(order)][:, np.argsort(order)] for start in starts])
    found, is_near = _refined(starts, FrameRule(0, axis, (degree, m, k), sign), raw)
    assert is_near.tolist() == [True, True, True, False]
    for frames, turn in zip(found, turns):
        small = base @ about_z(turn)[np.argsort(order)][:, np.argsort(order)] @ base.T
        assert np.abs(frames - small @ starts).max() <= 1e-13


SOLIDS = {
    "cube": (bodies.box((-1, -1, -1), (1, 1, 1))[0], [0, 0, 1], (4, 4, 0), -1.0),
    "tetrahedron": (shapes.TETRAHEDRON[0], [1, 1, 1], (3, 3, 0), None),
    "icosahedron": (shapes.ICOSAHEDRON[0], shapes.ICOSAHEDRON[0][0], (6, 5, 1), None),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_frames_along_extreme_directions_follow_a_body_that_leans(name):
    """By Newton's steps, and the others as little aside as that asks for, before the harmonic turns them."""
    corners, pole, (degree, m, k), sign = SOLIDS[name]
    pole = np.array(pole) / np.linalg.norm(pole)
    side = np.cross(pole, [0.3, -0.5, 0.2])
    side /= np.linalg.norm(side)
    across = np.cross(pole, side)
    phase = ((corners @ side + 1j * corners @ across) ** m * (corners @ pole) ** k).sum()
    sign = sign or 1.0
    angle = np.angle(sign * phase) / m
    frame = np.stack(
        [np.cos(angle) * side + np.sin(angle) * across, np.cos(angle) * across - np.sin(angle) * side, pole], 1
    )
    starts = np.array([frame, frame @ about_z(2.0 * np.pi / m)])
    leaning = [np.eye(3)]
    for size in (3e-5, 3e-4):
        lean = np.cross(np.eye(3), size * np.array([0.6, -0.5, 0.6]))
        leaning.append(np.linalg.qr(np.eye(3) + lean)[0])
        leaning[-1] *= np.sign(np.diag(leaning[-1]))
    raw = np.array([sums(corners @ turn.T, np.ones(len(corners))) for turn in leaning])
    found, is_near = _refined(starts, FrameRule(degree, 2, (degree, m, k), sign), raw)
    assert is_near.tolist() == [True, True, False]
    for frames, turn in zip(found, leaning):
        assert np.abs(frames - turn @ starts).max() <= 1e-12
