# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tests' comparison has no tolerance but the one that it is given."""

import numpy as np
import pytest

from tests.close import close


@pytest.mark.parametrize("size", [1e-300, 1e-18, 1.0, 1e18])
def test_only_the_relative_tolerance_counts(size):
    truth = size * np.array([1.0, -2.0])
    assert close(truth * (1 + 0.9e-9), truth, rel=1e-9)
    assert not close(truth * [1.0, 1 + 1.1e-9], truth, rel=1e-9)


def test_zero_and_nan_are_close_to_nothing_else():
    assert close([0.0, 1.0], [0.0, 1.0], rel=0.0)
    assert not close(1e-300, 0.0, rel=0.5) and not close(0.0, 1e-300, rel=0.5)
    for value in (np.nan, np.inf):
        assert not close(value, value, rel=1.0) and not close(1.0, value, rel=1.0) and not close(value, 1.0, rel=1.0)


def test_shapes_are_equal_or_the_truth_is_one_number():
    assert close([2.0, 2.0], 2.0, rel=0.0)
    assert not close(2.0, [2.0, 2.0], rel=0.0) and not close([[1.0, 2.0]], [1.0, 2.0], rel=0.0)
