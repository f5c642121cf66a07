# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface to hold points against: which of its own points it is compared by."""

from types import SimpleNamespace

import numpy as np
from body_moments.core.mesh.surface import Surface
from body_moments.operators.bodies import shape as shapes
from body_moments.operators.bodies.shape import SurfaceDistance

from tests.close import close

CENTER = np.array([3.0, -2.0, 5.0])


def skin_of(*surfaces, center=CENTER, size=1.0):
    return SurfaceDistance(SimpleNamespace(center=center, size=size, pieces=lambda: iter(surfaces)))


def test_a_surface_is_compared_by_its_farthest_points_evenly_picked_ones_and_middles_of_faces(monkeypatch):
    """With 20 samples: 10 of 28 vertices that faces use, 10 of 28 faces, from the first to the last, and 2 that are far
    from the center."""
    monkeypatch.setattr(shapes, "SURFACE_SAMPLES", 20)
    rng = np.random.default_rng(4)
    used = [vertex for vertex in range(30) if vertex not in (0, 13)]  # of 30, which two no face has
    points = CENTER + rng.normal(size=(30, 3)) * np.linspace(0.5, 2.0, 30)[:, None]
    points[13] += 100.0
    corners = [(k, k + 1, k + 2) for k in range(26)] + [(0, 5, 9), (1, 6, 10)]
    triangles = np.array(used)[np.array(corners)]
    found = skin_of(Surface(points, triangles=triangles)).points
    distances = [np.linalg.norm(points[vertex] - CENTER) for vertex in used]
    farthest = sorted(range(28), key=distances.__getitem__)[-2:]
    expected = [points[used[k]] for k in farthest] + [points[used[k]] for k in range(0, 28, 3)]
    expected += [(points[a] + points[b] + points[c]) / 3.0 for a, b, c in triangles[::3]]
    assert close(found, np.array(expected), 1e-14)


def test_of_a_small_surface_all_points_and_middles_are_compared(monkeypatch):
    monkeypatch.setattr(shapes, "SURFACE_SAMPLES", 20)
    points = CENTER + np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0)])
    triangles = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    found = skin_of(Surface(points[:3], triangles=triangles[:1]), Surface(points, triangles=triangles[1:])).points
    corners = np.concatenate([points[:3], points])
    expected = np.concatenate([points[2:], corners, points[triangles].mean(axis=1)])
    assert close(found, expected, 1e-14)
