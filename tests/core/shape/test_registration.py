# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration of a body onto another one by rotations and reflections."""

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, region_moments
from body_moments.core.shape import disc_zernike, match_flat
from body_moments.core.shape import registration as matching

from tests.core import shapes
from tests.core.recursion import moments


@pytest.mark.parametrize("is_flat", [False, True])
@pytest.mark.parametrize("size", [0.5, 7.0])
@pytest.mark.parametrize(
    "left, share, is_mirror_image",
    [(1.01, 0.19, True), (1.01, 0.21, False), (0.99, 0.19, False), (1.5, 0.0, True)],
)
def test_shape_fitting_only_a_reflection_is_a_mirror_image(
    is_flat, size, left, share, is_mirror_image
):
    left = left * 1e-3 * size

    def residual(way, few):
        return np.array([left if np.linalg.det(way) > 0.0 else share * left, 0.0])

    if is_flat:
        points = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 1.0]])
        zernike = disc_zernike(region_moments(points, directed_edges([range(3)]), 8), 3.0)
        found = match_flat(zernike, zernike, (np.eye(3), np.eye(3)), residual, size)
    else:
        body = moments(shapes.WEDGE, 6).about_center()
        found = matching.match(body, body, residual, size)
    assert found.is_mirror_image is is_mirror_image
    assert (found.max_distance, found.mean_distance) == (left, left / 2.0)
