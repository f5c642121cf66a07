# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spectra add, scale and take phases together with their bounds."""

import numpy as np
from body_moments.core.fourier.wave_vectors import Spectrum

RNG = np.random.default_rng(1)
Q = RNG.normal(size=(12, 3))


def spectrum(method="exact"):
    values = RNG.normal(size=12) + 1j * RNG.normal(size=12)
    return Spectrum(Q, values, RNG.uniform(0.1, 1.0, 12), RNG.uniform(0.1, 1.0), method)


def test_spectra_add_with_bounds_and_take_the_worst_exactness():
    for methods, together in (
        (("exact", "exact"), "exact"),
        (("exact", "approximate"), "approximate"),
    ):
        for one, other in (map(spectrum, methods), map(spectrum, methods[::-1])):
            both = one + other
            assert (
                both.q is Q
                and (both.values == one.values + other.values).all()
                and both.method == together
            )
            assert (both.error == one.error + other.error).all()
            assert both.input_error == one.input_error + other.input_error
    twice = spectrum("approximate") + spectrum("approximate")
    assert twice.method == "approximate"
