# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small bodies in a stack: their moments are those of each alone to the bit, to any order within their bounds."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import Moments, U, monomials
from body_moments.core.polyhedron import any_order_small, polyhedron_moments, third_order_small
from body_moments.core.polyhedron.any_order_small import extend_small_moments
from body_moments.core.polyhedron.third_order_small import small_moments

from tests.close import close
from tests.core import bodies, exact, shapes

PARTS = [shapes.TETRAHEDRON, shapes.L_PRISM, shapes.prism(7), bodies.sphere(1), shapes.SHEARED]
PLACES = [(1.0, 0.0), (1e-5, 3e-5), (1.0, 1e4), (3e3, -7e5)]


def stacked(size, offset):
    parts = [((points * size + offset).astype(np.float32).astype(float), faces) for points, faces in PARTS]
    starts = np.cumsum([0] + [len(points) for points, _ in parts])
    triangles = np.concatenate([faces + start for (_, faces), start in zip(parts, starts)])
    counts = np.array([len(faces) for _, faces in parts])
    low, high = (np.array([function(points, axis=0) for points, _ in parts]) for function in (np.min, np.max))
    center = low / 2.0 + high / 2.0
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * 2.0**-53)
    return parts, np.concatenate([points for points, _ in parts]), triangles, counts, center, reach


@pytest.mark.parametrize(("size", "offset"), PLACES)
def test_a_stack_is_each_body_to_the_bit(size, offset):
    parts, points, triangles, counts, center, reach = stacked(size, offset)
    volume, area, cones = small_moments(
        points, triangles, counts, center, reach, np.zeros((5, 3)), area=True, area_moments=True
    )
    for i, (own, faces) in enumerate(parts):
        alone = polyhedron_moments(Surface(own, faces), area_order=3)
        for stack, one in zip((volume, area), alone):
            for name in ("raw", "about", "rounding_error", "input_error"):
                assert np.array_equal(getattr(stack, name)[i], getattr(one, name)), name
        assert abs(cones[i, 1] - 6.0 * volume.raw[i, 0]) <= 1e-12 * cones[i, 0]


@pytest.mark.parametrize("at_a_time", [1, 5, 30, 60, 10**6])
def test_bodies_are_whole_however_many_triangles_are_taken_at_a_time(monkeypatch, at_a_time):
    monkeypatch.setattr(any_order_small, "TRIANGLES_PER_BLOCK", at_a_time)
    monkeypatch.setattr(third_order_small, "TRIANGLES_PER_BLOCK", at_a_time)
    parts, points, triangles, counts, center, reach = stacked(1.0, 0.0)
    volume, area, _ = small_moments(
        points, triangles, counts, center, reach, np.zeros((5, 3)), area=True, area_moments=True
    )
    fifth = extend_small_moments(volume, 5, points, triangles, counts, reach)
    for i, (own, faces) in enumerate(parts):
        for found, measure in ((fifth, exact.volume_moments), (area, exact.area_moments)):
            right = measure(own, faces, center[i], order=found.order)
            assert all(
                abs(Fraction(float(x)) - y) <= e for x, y, e in zip(found.raw[i], right, found.rounding_error[i])
            )


@pytest.mark.parametrize(("size", "offset"), PLACES)
def test_higher_orders_are_exact_within_their_bounds(size, offset):
    parts, points, triangles, counts, center, reach = stacked(size, offset)
    volume, _, _ = small_moments(
        points, triangles, counts, center, reach, np.zeros((5, 3)), area=True, area_moments=False
    )
    sixth = extend_small_moments(volume, 6, points, triangles, counts, reach)
    for i, (own, faces) in enumerate(parts):
        alone = polyhedron_moments(Surface(own, faces), 6, about=center[i])[0]
        off = np.abs(sixth.raw[i] - alone.raw)
        assert (off <= sixth.rounding_error[i] + alone.rounding_error).all()
        assert (sixth.rounding_error[i, 20:] <= 100.0 * alone.rounding_error[20:]).all()  # and they say something
    right = exact.volume_moments(*parts[1], center[1], 6)
    assert all([abs(Fraction(float(x)) - y) <= e for x, y, e in zip(sixth.raw[1], right, sixth.rounding_error[1])])


def test_bounds_of_higher_orders_count_their_roundings():
    """14 u a degree and 3 u a triangle of what the cones come to; and twice what the volume is off by."""
    _, points, triangles, counts, center, reach = stacked(1.0, 0.0)
    off = np.array([1e-9, 2e-12, 0.0, 3e-15, 4e-16])
    volume = Moments(np.ones((5, 20)), center, "volume", off[:, None] * np.arange(1, 21), off[:, None] + np.zeros(20))
    found = extend_small_moments(volume, 5, points, triangles, counts, reach)
    degree, ends = monomials(5).sum(axis=1), np.cumsum(counts)
    for i, (end, count) in enumerate(zip(ends, counts)):
        faces = triangles[end - count : end]
        cones = float(exact.volume_moments(points, faces, center[i], 0, absolute=True)[0])
        largest = np.prod(reach[i] ** monomials(5), axis=1)
        terms = U * (14.0 * degree + 16.0 + 3.0 * count) * 6.0 * cones / (2.0 * degree + 6.0)
        expected = (terms + 2.0 * off[i]) * largest + 8.0 * U * np.abs(found.raw[i])
        assert close(found.rounding_error[i, 20:], expected[20:], rel=1e-9)
        assert close(found.input_error[i, 20:], off[i] * largest[20:], rel=1e-12)
    assert np.array_equal(found.rounding_error[:, :20], volume.rounding_error)
    assert np.array_equal(found.input_error[:, :20], volume.input_error)
