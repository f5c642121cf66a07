# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which harmonic about an axis fixes the other axes: the first clear one, else the first that is more than noise."""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.inertia.canonical_frame import (
    CLEAR_HARMONIC,
    FrameRule,
    SecondMomentAxes,
    _candidates,
    _clear_harmonic,
    _fix_rotation_about_axis,
    _normalization,
)
from body_moments.core.inertia.third_moment_frames import HALF_TURN_SIGNS
from body_moments.core.moments.affine_maps import rotate_moments
from body_moments.core.moments.exponents import monomial_index
from body_moments.core.moments.moments import Moments, monomials

from tests.close import close
from tests.core import bodies

POWERS = monomials(6)
SIZE = np.array([5.0, 3.0, 2.0])
AXES = bodies.rotation(4)
KINDS = sorted({(degree, k) for degree in range(3, 7) for k in range(degree)})


def about(axis, degree, k, values, error=0.0):
    """A body whose moments beyond the total are zero but for one, x^(n-k) z^k along its axes, by the extents there; and
    what a bound makes doubtful of all of its moments of degree n."""
    powers = np.roll((degree - k, 0, k), axis + 1)
    extents = SIZE[powers > 0]
    unit = np.prod(SIZE**powers)
    local = np.zeros(84)
    local[0], local[monomial_index(*powers)] = 1.0, values * unit
    raw = rotate_moments(local, 6, AXES)
    return Moments(raw, np.zeros(3), rounding_error=np.where(POWERS.sum(axis=1) == degree, error, 0.0)), extents.min()


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("degree, k", KINDS)
@pytest.mark.parametrize("step, tilt", [(0.0, 0.0), (1e-6, 2e-6)])
def test_a_harmonic_counts_from_where_it_is_more_than_the_noise_of_as_many_moments_as_it_holds(
    axis, degree, k, step, tilt
):
    """However much noise is told to be: that is what may have turned it."""
    spread = SecondMomentAxes(AXES, SIZE, (), step, tilt, 7e-5)
    growth = {3: 1.0, 4: 3.0, 5: 8.0, 6: 15.0}[degree]
    for share in (0.99, 1.01):
        central, thin = about(axis, degree, k, 0.0)
        least = 2.0 ** (degree - k) * growth * (1e-5 + 4.0 * step / thin + degree * tilt)
        central, _ = about(axis, degree, k, share * least)
        found = _clear_harmonic(central, spread, AXES[None], axis)
        if share < 1.0:
            assert found is None
            continue
        assert found[:3] == (degree, 1 + (degree - k + 1) % 2, k)
        assert close(np.abs(found[3]), share * least, 1e-9) and close(found[4], least, 1e-12)


def test_a_clear_harmonic_comes_before_a_weaker_one_of_lower_degree():
    spread = SecondMomentAxes(AXES, SIZE, (), 0.0)
    for share, wanted in ((0.99, (3, 1, 0)), (1.01, (5, 1, 2))):
        weak, _ = about(2, 3, 0, 0.5 * CLEAR_HARMONIC)
        strong, _ = about(2, 5, 2, share * CLEAR_HARMONIC)
        both = replace(weak, raw=weak.raw + strong.raw * (POWERS.sum(axis=1) > 0))
        assert _clear_harmonic(both, spread, AXES[None], 2)[:3] == wanted


def test_no_harmonic_is_clear_that_its_bound_makes_doubtful():
    spread = SecondMomentAxes(AXES, SIZE, (), 0.0)
    for error, is_found in ((1e-6, True), (10.0, False)):
        central, _ = about(2, 4, 0, 0.5, error)
        assert (_clear_harmonic(central, spread, AXES[None], 2) is not None) == is_found
        bound = _normalization(central, spread, 4)[1][0] - 3e-5
        across = np.abs(AXES[:, 0]).sum() ** 4  # of a bound of all moments of a degree, along an axis
        assert close(bound, error * across / SIZE[0] ** 4, 1e-6)


@pytest.mark.parametrize("share, count", [(0.95, 1), (1.05, 2)])
@pytest.mark.parametrize("size", [0.03, 1e-4])
def test_of_several_directions_those_are_kept_about_which_the_harmonic_is_as_large(share, count, size):
    """Within twice the noise, but never by a quarter of the largest. In a basis that leans a part of it is lost."""
    spread = SecondMomentAxes(np.eye(3), np.ones(3), (0, 1, 2), 0.0, 0.0, 2e-5)
    local = np.zeros(84)
    local[0], local[monomial_index(3, 0, 0)] = 1.0, size
    central = Moments(local, np.zeros(3))
    least = 8.0 * _normalization(central, replace(spread, noise=1e-5), 3)[1][0]
    allowed = min(2.0 * 2.0 * least, 0.25 * size)
    cosine = (1.0 - allowed / share / size) ** (1.0 / 3.0)
    lean = np.array([[cosine, 0, np.sqrt(1 - cosine**2)], [0, 1, 0], [-np.sqrt(1 - cosine**2), 0, cosine]])
    frames, harmonic, turn = _fix_rotation_about_axis(central, spread, np.array([np.eye(3), lean]), 2)
    assert harmonic == (3, 1, 0) and len(frames) == count and (frames[0] == np.eye(3)).all()
    assert close(turn, 2.0 * least / size, 1e-9)


def moments_of(known):
    """Of total one; {powers: value} along the coordinate axes, the others are zero."""
    raw = np.zeros(84)
    raw[0] = 1.0
    for powers, value in known.items():
        raw[monomial_index(*powers)] = value
    return Moments(raw, np.zeros(3))


@pytest.mark.parametrize("axis, free", [(0, (1, 2)), (2, (0, 1))])
@pytest.mark.parametrize("count", [1, 2, 4])
def test_about_a_fixed_axis_one_frame_is_looked_at_for_each_way_that_it_may_point(axis, free, count):
    spread = SecondMomentAxes(AXES, SIZE, free, 0.0, 3e-7)
    starts = AXES * HALF_TURN_SIGNS[:count, None]
    ways = sorted({float(signs[axis]) for signs in HALF_TURN_SIGNS[:count]})
    frames, revolution_axes, tilt, rule = _candidates(moments_of({}), spread, starts)
    assert sorted(np.rint(frames[:, :, axis] @ AXES[:, axis]).tolist()) == ways
    assert revolution_axes == (axis,) and tilt == 3e-7 and rule == FrameRule(0, axis, None, 1.0)
    for m, k, sign in ((3, 0, 1.0), (4, 0, -1.0), (2, 1, 1.0)):
        powers = [tuple(np.roll((m - i, i, k), axis + 1)) for i in range(m + 1)]
        angles = 2.0 * np.pi * np.arange(m) / m + 0.1
        local = np.zeros(84)
        local[0] = 1.0
        for i, place in enumerate(powers):  # of m points around the axis, as far as the extents are equal
            local[monomial_index(*place)] = 0.3 * (np.cos(angles) ** (m - i) * np.sin(angles) ** i).mean()
        central = Moments(rotate_moments(local, 6, AXES), np.zeros(3))
        even = replace(spread, size=np.ones(3))
        frames, revolution_axes, tilt, rule = _candidates(central, even, starts)
        assert revolution_axes == () and len(frames) == m * len(ways)
        assert rule == FrameRule(0, axis, (m + k, m, k), sign) and tilt > 3e-7


@pytest.mark.parametrize("size", [0.5, 3e-3])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_body_that_is_cubic_in_fourth_order_has_the_axes_of_a_cube_however_weakly_it_is(size, sign):
    """E[(u·x)⁴] is extreme along six axes, and the other way along eight diagonals."""
    known = {powers: sign * size for powers in ((4, 0, 0), (0, 4, 0), (0, 0, 4))}
    spread = SecondMomentAxes(np.eye(3), np.ones(3), (0, 1, 2), 0.0)
    frames, revolution_axes, tilt, rule = _candidates(moments_of(known), spread, np.eye(3)[None])
    assert revolution_axes == () and rule == FrameRule(4, 2, (4, 4, 0), sign) and len(frames) == 24
    assert np.abs(np.sort(np.abs(frames), axis=1) - [[0], [0], [1]]).max() < 1e-9
    assert 0.0 < tilt < 0.1 * 3e-3 / size


def test_a_body_that_is_the_same_in_all_directions_has_none():
    spread = SecondMomentAxes(AXES, np.ones(3), (0, 1, 2), 0.0, 3e-7)
    frames, revolution_axes, tilt, rule = _candidates(moments_of({}), spread, np.eye(3)[None])
    assert (frames == AXES[None]).all() and revolution_axes == (0, 1, 2) and tilt == 0.0
    assert rule == FrameRule(0, 2, None, 1.0)
