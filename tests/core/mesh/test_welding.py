# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Welding of near points and of faces on the same vertices."""

import numpy as np
import pytest
from body_moments.core.mesh.welding import (
    vertex_tolerance,
)

from tests.close import close


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_move_a_thousandth_of_a_triangle_at_most(dtype):
    """Each triangle is as large as its longest side: 5, 13.3 and 0.5."""
    points = np.array([[0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 5, 12], [0, 4, 0.5], [0.25, 4, 0.25], [9, 9, 9]], dtype)
    triangles = np.array([[0, 1, 2], [0, 3, 1], [2, 5, 4]])
    found = vertex_tolerance(points, triangles, np.array([6, 3, 0, 4, 2, 1]), 0.01)
    sides = [np.sqrt(178.0), 5.0, 0.5, 0.5, 5.0]
    assert close(found, [0.01, *np.minimum(0.01, 1e-3 * np.array(sides))], 1e-7)
    assert close(vertex_tolerance(points, triangles, np.array([3, 1]), 1.0), [1e-3 * 178.0**0.5, 5e-3], 1e-7)
