# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import FOURIER_OF_OPEN_SURFACE as FOURIER_OF_OPEN_SURFACE
from .instances import FOURIER_RTOL as FOURIER_RTOL
from .instances import BodyTransform as BodyTransform
from .polygon import RegionTransform as RegionTransform
from .polygon import polygon_transform as polygon_transform
from .transform import solid_transform as solid_transform
from .transform import surface_transform as surface_transform
from .wave_vectors import APPROXIMATE as APPROXIMATE
from .wave_vectors import FrequencyGrid as FrequencyGrid
from .wave_vectors import Spectrum as Spectrum

__all__ = [
    "FrequencyGrid",
    "polygon_transform",
    "solid_transform",
    "surface_transform",
]

def __getattr__(name: str) -> Any: ...
