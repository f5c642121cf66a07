# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Raw moments about a point, their sums, affine images and error bounds; the monomials that index them."""

from .complex_form import complex_moments
from .exponents import monomial_count, monomial_index, monomials
from .images import sum_of_images
from .moments import Measure, Moments, sum_moments
from .normalized import normalize

__all__ = [
    "Measure",
    "Moments",
    "complex_moments",
    "monomial_count",
    "monomial_index",
    "monomials",
    "normalize",
    "sum_moments",
    "sum_of_images",
]
