# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra add, scale and take phases with their bounds, which are as large as they are said to be."""

import numpy as np
import pytest
from body_moments.core.fourier.polygon import RegionTransform, polygon_transform
from body_moments.core.fourier.spectrum import Spectrum
from body_moments.core.fourier.transform import solid_transform, surface_transform
from body_moments.core.moments.moments import U

from tests.close import close
from tests.core import bodies

RNG = np.random.default_rng(1)
Q = RNG.normal(size=(12, 3))


def spectrum(method="exact"):
    values = RNG.normal(size=12) + 1j * RNG.normal(size=12)
    return Spectrum(Q, values, RNG.uniform(0.1, 1.0, 12), RNG.uniform(0.1, 1.0), method)


def test_bodies_add_with_their_bounds_and_are_as_exact_as_the_least_exact():
    for methods, together in ((("exact", "exact"), "exact"), (("exact", "approximate"), "approximate")):
        for one, other in (map(spectrum, methods), map(spectrum, methods[::-1])):
            both = one + other
            assert both.q is Q and (both.values == one.values + other.values).all() and both.method == together
            assert (both.error == one.error + other.error).all()
            assert both.input_error == one.input_error + other.input_error
    twice = spectrum("approximate") + spectrum("approximate")
    assert twice.method == "approximate"


def test_thicknesses_and_copies_are_factors_of_values_and_bounds():
    one, waves = spectrum("approximate"), RNG.normal(size=12) + 1j * RNG.normal(size=12)
    sheet, copies = one.scale(2.5), one.multiply_by_phases(waves, 7)
    assert (sheet.values == one.values * 2.5).all() and (sheet.error == one.error * 2.5).all()
    assert sheet.input_error == one.input_error * 2.5 and sheet.method == copies.method == "approximate"
    assert (copies.values == one.values * waves).all() and copies.input_error == 7 * one.input_error
    assert close(copies.error - 7 * one.error, 15 * 7 * U * np.abs(one.values), rel=1.0)
    assert (copies.error > 7 * one.error).all()


@pytest.mark.parametrize("scale", [2.0**-9, 1.0, 2.0**9])
def test_bounds_are_those_of_the_faces_and_of_the_values(scale):
    """64 u of the area, by the power of two above the reach for a solid, and 8 u of each value."""
    part = bodies.box((0, 0, 0), (3 * scale, 2 * scale, scale))  # reaches 1.87 from its center
    area, q = 22.0 * scale**2, Q / scale
    for transform, size in ((solid_transform, 2.0 * scale), (surface_transform, 1.0)):
        found = transform(bodies.surface(part), q)
        rest = found.error - 8.0 * U * np.abs(found.values)
        assert (rest >= 64.0 * U * area * size * (1 - 1e-3)).all() and (rest <= 65.0 * U * area * size).all()
    loop = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]) * scale  # reaches 1.80
    found = polygon_transform([loop], q[:, :2])
    rest = found.error - 8.0 * U * np.abs(found.values)
    assert close(rest, np.full(12, 64.0 * U * 10.0 * scale * 2.0 * scale), rel=1e-3) and found.input_error == 0.0


def test_a_region_s_bounds_are_what_its_moved_edges_sweep():
    points, edges = (
        np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]),
        np.array([[0, 1], [1, 2], [2, 3], [3, 0]]),
    )
    exact, off = (RegionTransform(points, edges, Q[:, :2], *given) for given in ((), (1e-3, 1e-2)))
    for transform in (exact, off):
        list(transform.steps())
    one, other = exact.result(), off.result()
    swept = [np.sqrt(2.0) * step * (10.0 + 3.0 * step * 4) for step in (1e-3, 1e-2)]
    assert close(other.error - one.error, np.full(12, swept[0]), rel=1e-9) and close(
        other.input_error, swept[1], rel=1e-14
    )
