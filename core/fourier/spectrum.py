# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Fourier transform at some wave vectors.

Spectra of several bodies add up, as moments do; copies of a body multiply its spectrum by phase factors.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..moments.moments import U

EXACT, APPROXIMATE = "exact", "approximate"


@dataclass(frozen=True, eq=False)
class Spectrum:
    """∫ exp(-i q·x) at wave vectors q, (M, 3) or (M, 2) of a polygon, in rad per unit of length; spectra of bodies add.

    `values`: (M,), unit³ of a body, unit² of a surface or a polygon.
    `error`: (M,) of the values: for an "exact" spectrum a bound of the rounding, for an "approximate" one an estimate.
    `input_error`: a bound of the change that storing coordinates as float32 may have made, for any q.
    `method`: "exact" or "approximate".
    """

    q: NDArray[np.float64]
    values: NDArray[np.complex128]
    error: NDArray[np.float64]
    input_error: float = 0.0
    method: str = EXACT

    def __add__(self, other: Spectrum) -> Spectrum:
        """Add the spectrum of another body, at the same wave vectors."""
        method = EXACT if self.method == other.method == EXACT else APPROXIMATE
        return Spectrum(
            self.q, self.values + other.values, self.error + other.error, self.input_error + other.input_error, method
        )

    def scale(self, factor: float) -> Spectrum:
        """Multiply by a positive factor, such as the thickness of a sheet."""
        return replace(
            self, values=self.values * factor, error=self.error * factor, input_error=self.input_error * factor
        )

    def multiply_by_phases(self, waves: NDArray[np.complex128], count: int) -> Spectrum:
        """Return the spectrum of `count` copies together, from the (M,) sums of exp(-i q·t) over their places."""
        rounding = (8.0 + count) * count * U * np.abs(self.values)
        return replace(
            self, values=self.values * waves, error=count * self.error + rounding, input_error=count * self.input_error
        )
