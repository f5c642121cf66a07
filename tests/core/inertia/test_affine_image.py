# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The image of mass properties is that of the moments, and its axes turn along."""

import numpy as np
import pytest
from body_moments.core.inertia import HALF_TURN_SIGNS, MassProperties, affine_image
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments

from tests.close import close
from tests.core.bodies import rotation

POINTS = np.array([[0.0, 0.0, 0.0], [2.0, 0.1, 0.0], [0.2, 1.0, 0.1], [0.3, 0.2, 0.5]])
TRIANGLES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


@pytest.mark.parametrize("scale", [1.0, 1e-9, 1e6])
@pytest.mark.parametrize("mirrored", [False, True])
def test_affine_image_matches_mapped_moments(scale, mirrored):
    moments = polyhedron_moments(Surface.from_triangles(POINTS, TRIANGLES))[0]
    body = MassProperties.from_moments(moments, 7.0)
    linear = scale * np.array([[1.3, 0.2, 0.0], [-0.4, 0.9, 0.3], [0.1, 0.0, 2.0]])
    if mirrored:
        linear[0] *= -1.0
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, (5.0, -1.0, 2.0)
    truth = MassProperties.from_moments(moments.transform(matrix), 7.0)
    image = affine_image(body, linear, truth.center, truth.mass, truth.principal.axes)
    size = truth.principal.moments.max()
    assert np.abs(image.inertia - truth.inertia).max() <= 1e-12 * size
    assert close(image.principal.moments, truth.principal.moments, 1e-11)
    assert close((image.principal.axes * truth.principal.axes).sum(axis=0), 1.0, 1e-10)
    assert close(np.linalg.det(image.principal.axes), 1.0, 1e-12)
    for seed in range(20):  # the nearest frame along these axes, also to a left-handed one
        preferred = rotation(seed) * (-1.0) ** seed
        frames = truth.principal.axes * HALF_TURN_SIGNS[:, None]
        nearest = max(frames, key=lambda frame: (frame * preferred).sum())
        found = affine_image(body, linear, truth.center, truth.mass, preferred).principal.axes
        assert np.abs(found - nearest).max() <= 1e-9
