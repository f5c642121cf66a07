# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of small bodies in a stack, compared with single bodies and rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import extend_small_moments, polyhedron_moments, small_moments

from tests.close import close
from tests.core import bodies, exact, shapes

PARTS = [shapes.TETRAHEDRON, shapes.L_PRISM, shapes.prism(7), bodies.sphere(1), shapes.SHEARED]
PLACES = [(1.0, 0.0), (1e-5, 3e-5), (1.0, 1e4), (3e3, -7e5)]


def stacked(size, offset):
    parts = [
        ((points * size + offset).astype(np.float32).astype(float), faces)
        for points, faces in PARTS
    ]
    starts = np.cumsum([0] + [len(points) for points, _ in parts])
    triangles = np.concatenate([faces + start for (_, faces), start in zip(parts, starts)])
    counts = np.array([len(faces) for _, faces in parts])
    low, high = (
        np.array([function(points, axis=0) for points, _ in parts]) for function in (np.min, np.max)
    )
    center = low / 2.0 + high / 2.0
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * 2.0**-53)
    return parts, np.concatenate([points for points, _ in parts]), triangles, counts, center, reach


@pytest.mark.parametrize(("size", "offset"), PLACES)
def test_stacked_moments_match_single_bodies(size, offset):
    parts, points, triangles, counts, center, reach = stacked(size, offset)
    volume, area = small_moments(
        points, triangles, counts, center, reach, np.zeros((5, 3)), area=True, area_moments=True
    )
    for i, (own, faces) in enumerate(parts):
        alone = polyhedron_moments(Surface(own, faces), area_order=3)
        for stack, one in zip((volume, area), alone):
            assert close(stack.about[i], one.about, 1e-14)
            assert (np.abs(stack.raw[i] - one.raw) <= one.rounding_error).all()
            assert close(stack.rounding_error[i], one.rounding_error, 1e-9)
            assert close(stack.input_error[i], one.input_error, 1e-9)


@pytest.mark.parametrize(("size", "offset"), PLACES)
def test_higher_orders_are_exact_within_their_bounds(size, offset):
    parts, points, triangles, counts, center, reach = stacked(size, offset)
    volume, _ = small_moments(
        points, triangles, counts, center, reach, np.zeros((5, 3)), area=True, area_moments=False
    )
    sixth = extend_small_moments(volume, 6, points, triangles, counts, reach)
    for i, (own, faces) in enumerate(parts):
        alone = polyhedron_moments(Surface(own, faces), 6, about=center[i])[0]
        off = np.abs(sixth.raw[i] - alone.raw)
        assert (off <= sixth.rounding_error[i] + alone.rounding_error).all()
        assert (
            sixth.rounding_error[i, 20:] <= 100.0 * alone.rounding_error[20:]
        ).all()  # and they say something
    right = exact.volume_moments(*parts[1], center[1], 6)
    assert all(
        [
            abs(Fraction(float(x)) - y) <= e
            for x, y, e in zip(sixth.raw[1], right, sixth.rounding_error[1])
        ]
    )
