# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform of solids, surfaces and polygons, in closed form and on large grids."""

from .grid import GridTransform
from .instances import BodyTransform
from .polygon import polygon_transform
from .spectrum import Spectrum
from .transform import solid_transform, surface_transform
from .wave_vectors import FrequencyGrid

__all__ = [
    "BodyTransform",
    "FrequencyGrid",
    "GridTransform",
    "Spectrum",
    "polygon_transform",
    "solid_transform",
    "surface_transform",
]
