# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances of points and surfaces from triangles, at every size."""

from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.blender.bodies.shape.surface_distance import SurfaceDistance
from body_moments.core.mesh.surface import Surface
from body_moments.core.numerics.rotations import rotation_matrix

CENTER = np.array([3.0, -2.0, 5.0])


def skin_of(*surfaces, center=CENTER, size=1.0):
    return SurfaceDistance(SimpleNamespace(center=center, size=size, pieces=lambda: iter(surfaces)))


TETRAHEDRON = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0)])
FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_surface_distance_is_that_of_nearest_face(size):
    """Points below the lowest face, turned; what single precision would take for farther is found
    exactly.
    """
    center, turn = size * CENTER, rotation_matrix([0.8, 0.1, -0.3, 0.5])
    skin = skin_of(
        Surface(center + size * TETRAHEDRON @ turn.T, triangles=FACES), center=center, size=size
    )
    heights = size * np.geomspace(1e-8, 20.0, 300)
    below = np.stack([np.full(300, 0.3 * size), np.full(300, 0.4 * size), -heights], axis=1)
    points, is_near = center + below @ turn.T, (heights > 1.1e-5 * size) & (heights < 9e-3 * size)
    found = skin.distance(points)
    assert np.array_equal(found, [skin.distance(point[None])[0] for point in points])
    assert (
        np.abs(found - heights).max() < 1e-5 * size
        and (found <= heights * (1.0 + 1e-9))[is_near].all()
    )
    for within in (1e-4 * size, 5e-3 * size, 0.05 * size, 2.0 * size):
        told = skin.distance(points, within)
        assert np.array_equal(told <= within, heights <= within)
        assert (told <= heights * (1.0 + 1e-9))[is_near & (heights > within)].all()
