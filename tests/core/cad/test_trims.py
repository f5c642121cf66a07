# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loops that bound a region of a plane."""

import numpy as np
import pytest
from body_moments.core.cad.trimmed import flat_region
from body_moments.core.nurbs import reverse_curves
from body_moments.core.verdict import MeasureError

from tests.core.polygons import polygon


def test_directed_loops_may_touch_but_not_cross():
    up = np.array([0.0, 0.0, 1.0])
    square = polygon((0, 0), (2, 0), (2, 2), (0, 2))
    corner = polygon((2, 2), (3, 2), (3, 3), (2, 3))
    assert flat_region([square, corner], up).area_moments(0, np.zeros(3)).total == 5.0
    twisted = polygon((0, 0), (3, 3), (3, 0), (1, 4))  # lobes of different signs
    overlapping = polygon((1, 1), (3, 1), (3, 3), (1, 3))
    cornered = polygon((0, 0), (2, 2), (3, 3), (3, 0), (1, 4))  # the same, a corner on an edge
    sides = np.linspace([(0, 0), (3, 3), (3, 0), (1, 4)], [(3, 3), (3, 0), (1, 4), (0, 0)], 31)
    fine = polygon(*np.moveaxis(sides[:-1], 1, 0).reshape(-1, 2))  # the same, in short curves
    crossing = [[loop] for loop in (twisted, cornered, fine)]
    for loops in (*crossing, *([reverse_curves(one)] for (one,) in crossing)):
        with pytest.raises(MeasureError):
            flat_region(loops, up)
    with pytest.raises(MeasureError):
        flat_region([square, overlapping], up)
