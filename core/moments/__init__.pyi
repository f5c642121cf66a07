# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .affine_maps import absolute_moments as absolute_moments
from .affine_maps import affine_matrices as affine_matrices
from .affine_maps import are_similarities as are_similarities
from .affine_maps import are_singular as are_singular
from .affine_maps import distinct_linear_parts as distinct_linear_parts
from .affine_maps import multiply_by_linear_form as multiply_by_linear_form
from .affine_maps import placed_boxes as placed_boxes
from .affine_maps import similarity_groups as similarity_groups
from .affine_maps import to_trailing_axis as to_trailing_axis
from .affine_maps import transform_by_horner as transform_by_horner
from .complex_form import Invariant as Invariant
from .complex_form import complex_moments as complex_moments
from .complex_form import flusser_invariants as flusser_invariants
from .complex_form import hu_invariants as hu_invariants
from .complex_form import normalize as normalize
from .exponents import KNOWN_ORDER as KNOWN_ORDER
from .exponents import check_exponents as check_exponents
from .exponents import count_of_degree as count_of_degree
from .exponents import factorial_ratios as factorial_ratios
from .exponents import monomial_count as monomial_count
from .exponents import monomial_index as monomial_index
from .exponents import monomial_values as monomial_values
from .exponents import monomials as monomials
from .exponents import order_from_count as order_from_count
from .exponents import product_indices as product_indices
from .exponents import quotient_indices as quotient_indices
from .exponents import tensor_index as tensor_index
from .images import MAPS_PER_BLOCK as MAPS_PER_BLOCK
from .images import invert_through_point as invert_through_point
from .images import sum_of_images as sum_of_images
from .raw import FLOAT32_HALF_ULP as FLOAT32_HALF_ULP
from .raw import PAIRWISE_SUM_ROUNDINGS as PAIRWISE_SUM_ROUNDINGS
from .raw import SECOND_MOMENT_INDEX as SECOND_MOMENT_INDEX
from .raw import THIRD_MOMENT_INDEX as THIRD_MOMENT_INDEX
from .raw import Measure as Measure
from .raw import Moments as Moments
from .raw import U as U
from .raw import image as image
from .raw import measure_scale_factors as measure_scale_factors
from .raw import stack_moments as stack_moments
from .raw import sum_moments as sum_moments
from .raw import unchecked_moments as unchecked_moments
from .solid_harmonics import Multiplets as Multiplets
from .solid_harmonics import along_first as along_first
from .solid_harmonics import couple as couple
from .solid_harmonics import harmonic_moments as harmonic_moments
from .solid_harmonics import with_negative_orders as with_negative_orders

__all__ = [
    "Measure",
    "Moments",
    "monomials",
]

def __getattr__(name: str) -> Any: ...
