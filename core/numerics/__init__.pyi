# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .arguments import check_filled as check_filled
from .arguments import check_order as check_order
from .arguments import check_type as check_type
from .arguments import float_array as float_array
from .arguments import has_form as has_form
from .arguments import index_array as index_array
from .arguments import number_array as number_array
from .arguments import shape_error as shape_error
from .arguments import unit_vector as unit_vector
from .array_types import Array as Array
from .array_types import ArrayLike as ArrayLike
from .array_types import Complex as Complex
from .array_types import DTypeLike as DTypeLike
from .array_types import Floats as Floats
from .array_types import Index as Index
from .array_types import Int64 as Int64
from .array_types import Integers as Integers
from .array_types import Mask as Mask
from .array_types import NDArray as NDArray
from .arrays import IDENTITY_3 as IDENTITY_3
from .arrays import NEXT_AXIS as NEXT_AXIS
from .arrays import PREVIOUS_AXIS as PREVIOUS_AXIS
from .arrays import PerBody as PerBody
from .arrays import as_rows as as_rows
from .arrays import as_unsigned as as_unsigned
from .arrays import batches as batches
from .arrays import cross_rows as cross_rows
from .arrays import distinct_arrays as distinct_arrays
from .arrays import first_occurrence as first_occurrence
from .arrays import following_pairs as following_pairs
from .arrays import hash_uint64 as hash_uint64
from .arrays import indices_in_range as indices_in_range
from .arrays import inertia_of_second as inertia_of_second
from .arrays import lengths as lengths
from .arrays import power_table as power_table
from .arrays import run_starts as run_starts
from .arrays import second_of_inertia as second_of_inertia
from .arrays import segment_ranges as segment_ranges
from .arrays import segment_starts as segment_starts
from .arrays import sorted_distinct as sorted_distinct
from .arrays import spread_bits as spread_bits
from .arrays import sums_by_index as sums_by_index
from .arrays import unique_pairs as unique_pairs
from .bspline import SplineSpace as SplineSpace
from .bspline import clamped_space as clamped_space
from .compensated import compensated_normals as compensated_normals
from .compensated import phase_factors as phase_factors
from .compensated import two_sum as two_sum
from .float32 import shortest_decimal as shortest_decimal
from .graph import connected_components as connected_components
from .quadrature import gauss_legendre as gauss_legendre
from .quadrature import gauss_legendre_with_ends as gauss_legendre_with_ends
from .quadrature import spread_directions as spread_directions
from .quadrature import triangle_rule as triangle_rule
from .rectangles import rectangle_pairs as rectangle_pairs
from .rotations import along_x as along_x
from .rotations import polar_rotation as polar_rotation
from .rotations import quaternion as quaternion
from .rotations import rotation_about as rotation_about
from .rotations import rotation_array as rotation_array
from .rotations import rotation_matrix as rotation_matrix
from .vectors import Number as Number
from .vectors import Vector as Vector
from .vectors import cross as cross
from .vectors import dot as dot
from .vectors import subtract as subtract

__all__ = [
    "SplineSpace",
    "clamped_space",
    "quaternion",
]

def __getattr__(name: str) -> Any: ...
