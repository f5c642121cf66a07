# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The first clear harmonic about an axis fixes the other axes."""

import numpy as np
import pytest
from body_moments.core.inertia.third_moment_frames import SecondMomentAxes
from body_moments.core.moments import Moments, monomial_index
from body_moments.core.shape.canonical_frame import _candidates


def moments_of(known):
    """Moments of total one; {powers: value} along the coordinate axes, the others are zero."""
    raw = np.zeros(84)
    raw[0] = 1.0
    for powers, value in known.items():
        raw[monomial_index(*powers)] = value
    return Moments(raw, np.zeros(3))


@pytest.mark.parametrize("size", [0.5, 3e-3])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_weakly_cubic_body_has_the_axes_of_a_cube(size, sign):
    """E[(u·x)⁴] is extreme along six axes, and the other way along eight diagonals."""
    known = {powers: sign * size for powers in ((4, 0, 0), (0, 4, 0), (0, 0, 4))}
    spread = SecondMomentAxes(np.eye(3), np.ones(3), (0, 1, 2), 0.0)
    frames, revolution_axes, tilt = _candidates(moments_of(known), spread, np.eye(3)[None])
    assert revolution_axes == () and len(frames) == 24
    assert np.abs(np.sort(np.abs(frames), axis=1) - [[0], [0], [1]]).max() < 1e-9
    assert 0.0 < tilt < 0.1 * 3e-3 / size
