# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/fourier`."""

from ..verdict import error

FOURIER_OF_OPEN_SURFACE = error(
    "fourier_of_open_surface",
    "The surface is open and bounds no body. Close it, set Kind to Shell, or set Domain to "
    "Surface.",
)
WAVE_VECTORS_SHAPE = error(
    "wave_vectors_shape",
    "Wave vectors must be rows of {dimension} real numbers; the array has shape {shape:size} and "
    "type {type}.",
)
WAVE_VECTORS_RANGE = error(
    "wave_vectors_range", "Some wave vectors are not finite, or exceed 1e100 rad/m."
)
FREQUENCIES_INVALID = error("frequencies_invalid", "A grid of frequencies needs {need:word}.")
