# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""When the members of an assembly are the same bodies after their objects got other origins and axes."""

import numpy as np
from body_moments.operators.session import assembly


def test_members_are_the_same_to_rounding_and_no_further():
    rtol = assembly.SAME_RTOL
    for mass, center, size in ((3.0, (1.0, -2.0, 0.5), 0.25), (1e-9, (0.0, 0.0, 0.0), 4.0)):
        before = mass, np.array(center), size
        reach = max(size, np.abs(center).max())
        for factor, is_same in ((0.9, True), (1.2, False), (-0.9, True), (-1.2, False)):
            step = factor * rtol
            assert assembly._is_same(before, (mass * (1.0 + step), before[1], size)) == is_same
            assert assembly._is_same(before, (mass, before[1], size * (1.0 + step))) == is_same
            for axis in np.eye(3):
                assert assembly._is_same(before, (mass, before[1] + step * reach * axis, size)) == is_same
