# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of size and of negligible differences, on both sides."""

import numpy as np
import pytest
from body_moments.core import Surface, measure_solid, numerics, polyhedron_moments, verdict, wall
from body_moments.core.nurbs import Curve, Patch, length_moments, measure_patches, measure_sheet

from tests.core.bodies import box
from tests.core.findings import refused


def measured(part):
    return measure_solid(Surface.from_triangles(*part))


@pytest.mark.parametrize(
    "size, fault",
    [(9.9e49, ""), (1.01e50, verdict.TOO_LARGE), (1.01e-60, ""), (9.9e-61, verdict.TOO_SMALL)],
)
def test_body_size_is_limited_only_by_finite_moments(size, fault):
    rod = box((0, 0, 0), (size, 0.01 * size, 0.01 * size))
    if fault:
        with refused("object_size", fault=fault):
            measured(rod)
    else:
        assert measured(rod).volume.total > 0.0


@pytest.mark.parametrize("size", [1e-62, 1e-120, 1e-200, 1e-310])
def test_bodies_too_small_for_a_volume_are_refused(size):
    points, triangles = (
        size * np.eye(4, 3, -1),
        np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
    )
    surface, line = Surface(points, triangles), numerics.clamped_space(2)
    patch = Patch((line, line), size * np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]]))
    for measure in (
        lambda: measure_solid(surface),
        lambda: polyhedron_moments(surface),
        lambda: polyhedron_moments([surface], 5, about=(0, 0, 0)),
        lambda: wall.offset_solid(surface),
        lambda: measure_patches([patch]),
        lambda: measure_sheet([patch], 0.0, 0.1 * size),
        lambda: length_moments([Curve(line, points[:2])]),
    ):
        with refused("object_size"):
            measure()
