# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What second and third moments say of frames, and what of it is noise, against the closed forms of a box's moments."""

from dataclasses import fields
from itertools import permutations, product

import numpy as np
import pytest
from body_moments.core.inertia.third_moment_frames import (
    HALF_TURN_SIGNS,
    _allowed_signs,
    _are_decided,
    third_moment_frames,
)
from body_moments.core.moments.moments import Measure, Moments, monomials, stack_moments

from tests.close import close

TABLE = [tuple(row) for row in monomials(3).tolist()]
NOISE = 1e-5


def lopsided_box(sides, skewness, scale=1.0):
    """(20,) the raw moments of a box about its center, with a third moment along x besides."""
    sides, raw = scale * np.array(sides), np.zeros(20)
    raw[0] = sides.prod()
    for axis in range(3):
        power = [0, 0, 0]
        power[axis] = 2
        raw[TABLE.index(tuple(power))] = raw[0] * sides[axis] ** 2 / 12.0
    raw[TABLE.index((3, 0, 0))] = skewness * raw[0] * (sides[0] ** 2 / 12.0) ** 1.5
    return raw


def expected(raw, rounding_error, input_error):
    """The tilt, the step, and the noise of each axis' skewness, by plain numbers of one box."""
    second = np.array([raw[TABLE.index(power)] for power in ((2, 0, 0), (0, 2, 0), (0, 0, 2))]) / raw[0]
    largest = max(error for power, error in zip(TABLE, rounding_error) if sum(power) == 2)
    scale = second.sum()
    rounding = 4.0 * largest / (raw[0] * scale) + 8.0 * 2.0**-52
    spread = second / scale
    size = np.sqrt(spread)
    step = input_error[0] / raw[0] * size[2]
    doubtful = [2.0 * step * size[k] + rounding for k in (0, 1)]
    gaps = spread[:2] - spread[1:]
    tilt = {(0, 1): doubtful[0] / gaps[0], (1, 2): doubtful[1] / gaps[1], (0, 2): max(doubtful) / gaps.sum()}
    scores, errors = np.zeros((3, 3)), np.zeros((3, 3))
    for i in range(3):
        for k in range(3):
            power = [0, 0, 0]
            power[i] += 1
            power[k] += 2
            place = TABLE.index(tuple(power))
            unit = raw[0] * np.sqrt(second[i]) * second[k]
            scores[i, k], errors[i, k] = raw[place] / unit, rounding_error[place] / unit
    worst = (np.abs(scores) + errors).max(axis=1)
    noise = [
        NOISE
        + 4.0 * step / size[i]
        + 3.0 * sum(worst[k] * tilt[min(i, k), max(i, k)] for k in range(3) if k != i)
        + errors[i, i]
        for i in range(3)
    ]
    return max(tilt[0, 1], tilt[1, 2]), step * np.sqrt(scale), noise


@pytest.mark.parametrize("place", range(20))
@pytest.mark.parametrize("moved", [0.0, 1e-5])
def test_bounds_of_moments_become_bounds_of_axes_and_scores(place, moved):
    """Of a stack of two boxes, one of them a hundred times as large, of which one moment at a time is doubtful."""
    shapes = [((6.0, 4.0, 2.0), 0.3, 1.0), ((5.0, 3.0, 2.5), -0.2, 100.0)]
    raw = np.array([lopsided_box(*shape) for shape in shapes])
    degree = monomials(3).sum(axis=1)
    rounding_error, input_error = np.zeros((2, 20)), np.zeros((2, 20))
    for row, (_, _, scale), share in zip(range(2), shapes, (1e-6, 3e-6)):
        rounding_error[row, place] = share * raw[row, 0] * scale ** degree[place]
        input_error[row] = moved * (1.0 + row) * raw[row, 0] * np.append(1.0, np.full(19, 7.0))
    found = third_moment_frames(Moments(raw, np.zeros((2, 3)), Measure.VOLUME, rounding_error, input_error))
    for row in range(2):
        tilt, step, noise = expected(raw[row], rounding_error[row], input_error[row])
        assert close(found.tilt[row], tilt, 1e-9) and close(found.skewness_error[row], noise, 1e-9)
        assert close(found.step[row], step, 1e-12)
        assert close(np.abs(found.skewness[row]), [abs(shapes[row][1]), 0.0, 0.0], 1e-12)
        assert close(np.abs(found.axes[row]), np.eye(3), 1e-15) and close(np.linalg.det(found.axes[row]), 1.0, 1e-15)
        second = raw[row, [TABLE.index(power) for power in ((2, 0, 0), (0, 2, 0), (0, 0, 2))]]
        assert close(found.moments[row], [second[1] + second[2], second[0] + second[2], second[0] + second[1]], 1e-14)
        assert close(found.size[row], np.sqrt(second / raw[row, 0]), 1e-14)
        assert found.is_body[row] and found.symmetry[row] == 0
        assert found.allowed[row].sum() == 2  # one of four axes' signs is known


@pytest.mark.parametrize(
    "sizes, decided",
    [
        ((9.0, 1.0, 0.0), True),  # the first one counts, whatever the next are
        ((1.0, 9.0, 0.0), False),
        ((0.0, 9.0, 0.0), True),
        ((0.0, 9.0, 1.0), False),
        ((0.0, 0.0, 0.0), True),
        ((0.0, 0.0, 1.0), False),
    ],
)
def test_third_moments_are_decided_where_better_ones_leave_what_counts(sizes, decided):
    size, error, noise = np.zeros((1, 3, 3)), np.full((1, 3, 3), 0.5), np.ones((1, 3, 3))
    size[0, 0] = sizes
    fixed = np.array([[True, False, False]])
    assert _are_decided(size, error, noise, fixed).tolist() == [decided]
    assert _are_decided(size, error, noise, np.zeros_like(fixed)).all()


def test_each_body_of_a_stack_is_known_as_it_is_by_itself():
    """Sizes, places, skewness and doubts of all of them differ; two of four axes are nearly free."""
    shapes = [
        ((6.0, 4.0, 2.0), 0.3, 1.0),
        ((5.0, 3.0, 2.5), -0.2, 100.0),
        ((3.0, 2.0, 2.0), 0.1, 0.01),
        ((2.0, 2.0, 1.0), 1e-4, 7.0),
    ]
    degree, draw, made = monomials(3).sum(axis=1), np.random.default_rng(1), []
    for number, (sides, skewness, scale) in enumerate(shapes):
        raw = lopsided_box(sides, skewness, scale)
        size = raw[0] * scale**degree
        center = np.array([3.0, -1.0, 2.0]) * scale * number
        moments = Moments(raw, center, Measure.VOLUME, 1e-9 * size * draw.uniform(1.0, 9.0, 20), 1e-7 * size)
        made.append(moments.about_point(center + draw.normal(size=3) * scale))
    found = third_moment_frames(stack_moments(made))
    for row, moments in enumerate(made):
        alone = third_moment_frames(moments.at(None))
        for entry in fields(found):
            if entry.name != "noise":
                values = (np.asarray(getattr(frames, entry.name), float) for frames in (found, alone))
                assert close(next(values)[row], next(values)[0], 1e-12), entry.name
    assert found.symmetry.tolist() == [0, 0, 1, 2]


@pytest.mark.parametrize("order", permutations(range(3)))
@pytest.mark.parametrize("signs", product((1.0, -1.0), repeat=3))
@pytest.mark.parametrize("nearly", [0.0, 0.9e-4, 1.1e-4])
def test_of_three_scores_the_weakest_is_dropped_and_of_equal_ones_the_last(order, signs, nearly):
    sizes = np.array([1.0, 1.0 + nearly, 3.0])[list(order)]
    weak = np.flatnonzero(sizes == 1.0).max() if nearly > 1e-4 else np.flatnonzero(sizes < 2.0).max()
    wanted = [all(way[axis] == signs[axis] for axis in range(3) if axis != weak) for way in HALF_TURN_SIGNS.tolist()]
    assert sum(wanted) == 1
    assert _allowed_signs(1e-3 * sizes[None] * signs).tolist() == [wanted]
    two = np.where(np.arange(3) == order[0], 0.0, sizes * signs)  # both of two count
    wanted = [
        all(way[axis] == signs[axis] for axis in range(3) if axis != order[0]) for way in HALF_TURN_SIGNS.tolist()
    ]
    assert _allowed_signs(two[None]).tolist() == [wanted]


def of_second_moments(diagonal, total=2.0, rounding=0.0, moved=0.0):
    """Of one body, along the coordinate axes; the bound of a second moment, and what storing may move of the total."""
    raw, error, stored = np.zeros((1, 20)), np.zeros((1, 20)), np.zeros((1, 20))
    raw[0, 0], raw[0, [4, 7, 9]] = total, total * np.array(diagonal)
    error[0, 6], stored[0, 0] = rounding, moved * total
    return Moments(raw, np.zeros((1, 3)), Measure.VOLUME, error, stored)


@pytest.mark.parametrize("share", [0.99, 1.01])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize(
    "rounding, moved, factor", [(0, 0, 1), (0, 0, 50), (1e-4, 0, 1), (0, 1e-4, 1), (2e-5, 3e-5, 9)]
)
def test_moments_are_equal_within_a_millionth_and_what_is_doubtful(share, scale, rounding, moved, factor):
    """A doubtful bound counts four times by the sum of the three; what storing moves counts twice."""
    for pair, wanted in ((0, 2), (1, 1)):
        diagonal = np.array([3.0, 2.0, 1.0])
        diagonal[pair + 1] = diagonal[pair]
        for _ in range(9):  # the limit depends on the moments a little
            size = np.sqrt(diagonal)
            doubt = 4.0 * rounding + 2.0 * moved * size[2] * size[pair]
            diagonal[pair + 1] = diagonal[pair] - share * (factor * 1e-6 * diagonal[pair] + doubt)
        given = of_second_moments(scale**2 * diagonal, 2.0, 2.0 * rounding * scale**2, moved)
        found = third_moment_frames(given, None, factor)
        assert found.symmetry.tolist() == [wanted if share < 1.0 else 0]
        assert close(found.noise, factor * NOISE, 1e-15)
        gap = factor * 1e-6 * diagonal[pair] + doubt
        others = np.delete(diagonal, pair)
        if share > 1.0:
            assert found.tilt[0] >= doubt / (1.02 * gap) - 1e-9 and (others > 0.0).all()


@pytest.mark.parametrize("share, is_body", [(0.9, True), (1.1, False)])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("rounding", [0.0, 1e-9])
def test_second_moments_below_zero_by_more_than_rounding_are_those_of_no_body(share, is_body, scale, rounding):
    limit = 4.0 * rounding + 8.0 * 2.0**-52 * 3.0
    given = of_second_moments(scale**2 * np.array([2.0, 1.0, -share * limit]), 2.0, 2.0 * rounding * scale**2)
    assert third_moment_frames(given).is_body.tolist() == [is_body]


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_across_a_lamina_there_is_hardly_any_extent_and_no_skewness(scale):
    given = of_second_moments(scale**2 * np.array([4.0, 1.0, 0.0]), moved=1e-6)
    given.raw[0, [TABLE.index((0, 0, 3)), TABLE.index((2, 0, 1))]] = 0.0
    found = third_moment_frames(given)
    assert close(found.size[0], scale * np.array([2.0, 1.0, 2e-15]), 1e-6)
    assert found.is_body[0] and found.symmetry[0] == 0 and found.skewness[0].tolist() == [0.0, 0.0, 0.0]
    assert close(found.step[0], 1e-6 * 2e-15 * scale, 1e-6)


@pytest.mark.parametrize("place", range(4, 10))
def test_about_a_point_beside_its_center_bounds_of_second_moments_are_bounds_of_third_ones(place):
    """Three times the distance along an axis, of all the worst; in a stack of which another body is at its center."""
    raw = np.array([lopsided_box((6.0, 4.0, 2.0), 0.3), lopsided_box((5.0, 3.0, 2.5), -0.2)])
    error = np.zeros((2, 20))
    error[:, place] = 1e-5
    body = Moments(raw, np.zeros((2, 3))).about_point(np.array([[0.5, -3.0, 2.0], [0.0, 0.0, 0.0]]))
    found = third_moment_frames(Moments(body.raw, body.about, Measure.VOLUME, error))
    for row, shift in ((0, 3.0), (1, 0.0)):
        second = raw[row, [4, 7, 9]] / raw[row, 0]
        units = np.array([[np.sqrt(second[i]) * second[k] for k in range(3)] for i in range(3)])
        errors = 3.0 * shift * 1e-5 / raw[row, 0] / units
        rounding = 4.0 * 1e-5 / (raw[row, 0] * second.sum()) + 8.0 * 2.0**-52
        gaps = -np.diff(second / second.sum())
        tilts = np.zeros((3, 3))
        tilts[0, 1] = tilts[1, 0] = rounding / gaps[0]
        tilts[1, 2] = tilts[2, 1] = rounding / gaps[1]
        tilts[0, 2] = tilts[2, 0] = rounding / gaps.sum()
        sizes = np.zeros((3, 3))
        sizes[0, 0] = abs((0.3, -0.2)[row])
        worst = (sizes + errors).max(axis=1)
        assert close(found.skewness_error[row], NOISE + 3.0 * tilts @ worst + errors.diagonal(), 1e-8)


def decided_by_plain_rules(size, error, noise, fixed):
    """Of one body: whether each fixed axis is scored by a moment that is clear, ahead of which none is doubtful, or by
    none; and whether the weakest of three scores is further from each other one than twice their bounds."""
    scores = []
    for axis in range(3):
        clear = [size[axis, k] - error[axis, k] > noise[axis, k] for k in range(3)]
        none = [size[axis, k] + error[axis, k] <= noise[axis, k] for k in range(3)]
        if fixed[axis] and not clear[0] and not all(a or b for a, b in zip(clear, none)):
            return False
        if fixed[axis] and any(clear):
            scores.append((size[axis, clear.index(True)], error[axis, clear.index(True)]))
    if len(scores) < 3:
        return True
    (low, low_error), *others = sorted(scores)
    return all(bool(size - low > 2.0 * (low_error + error)) for size, error in others)


def test_of_three_scores_the_largest_may_be_the_weakest_where_its_bound_is_wide():
    size, error, noise = np.zeros((1, 3, 3)), np.full((1, 3, 3), 0.1), np.ones((1, 3, 3))
    size[0, :, 0] = 3.0, 4.0, 5.0
    for bound, decided in ((0.85, True), (0.95, False)):
        error[0, 2, 0] = bound
        assert _are_decided(size, error, noise, np.ones((1, 3), bool)).tolist() == [decided]


def test_each_of_many_bodies_is_decided_by_itself():
    rng, count = np.random.default_rng(11), 4000
    size = rng.choice([0.0, 0.4, 1.0, 2.0, 2.3, 3.0, 5.0], (count, 3, 3), p=[0.3, 0.1, 0.05, 0.15, 0.1, 0.15, 0.15])
    size += 1e-3 * rng.random(size.shape)
    error = rng.choice([0.01, 0.05, 0.3], size.shape, p=[0.6, 0.3, 0.1])
    noise, fixed = rng.choice([0.5, 1.5], size.shape), rng.random((count, 3)) < 0.8
    fixed[: count // 2] = True
    size[: count // 2, :, 0] = rng.choice([2.5, 2.54, 2.7, 4.0], (count // 2, 3))
    wanted = [decided_by_plain_rules(*one) for one in zip(size, error, noise, fixed)]
    assert _are_decided(size, error, noise, fixed).tolist() == wanted
    assert 0.2 < np.mean(wanted) < 0.8
