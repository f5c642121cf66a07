# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/density`."""

from ..verdict import error, note, warning

POLYNOMIAL_EMPTY = "is empty. Type one, such as 1000 + 20*z"
POLYNOMIAL_TOO_LONG = "is longer than 4096 characters or nested too deeply. Shorten it"
POLYNOMIAL_BEYOND_NUMBERS = (
    "has values outside the range of numbers at the object. Use smaller coefficients, or move "
    "the object nearer to the origin"
)
POLYNOMIAL_UNUSABLE = error("polynomial_unusable", "The polynomial {fault:word}.")
POLYNOMIAL_UNREADABLE = "cannot be read. Write products with *, as in 20*z"
POLYNOMIAL_OUT_OF_RANGE = "is outside the range of numbers"
POLYNOMIAL_NOT_ALLOWED = (
    "is not allowed in a polynomial. Use numbers, x, y, z, +, -, *, division by a number, whole "
    "powers with **, and parentheses"
)
POLYNOMIAL_PART = error("polynomial_part", "“{part}” {fault:word}.")
POLYNOMIAL_DEGREE = error(
    "polynomial_degree", "The degree of “{part}” must be a whole number from 0 to {limit}."
)
GRID_TRANSFORM_SINGULAR = error(
    "grid_transform_singular", "The transform of the grid is singular or not finite. Set its scale."
)
DENSITY_NON_FINITE = error(
    "density_non_finite",
    "The densities are not finite, or too large to be summed. Remove such values.",
)
TRANSFER_TABLE_SYNTAX = error(
    "transfer_table_syntax",
    "“{part}” is not a pair of the transfer table: a value and a density in kg/m³, with commas "
    "between pairs.",
)
TRANSFER_TABLE_NUMBERS = error(
    "transfer_table_numbers",
    "The transfer table needs at least two pairs, with ascending values and finite densities that "
    "are not negative.",
)
VALUES_SCALED = note(
    "values_scaled", "A value of 1 stands for {density:.6g} kg/m³ (spline order {order})."
)
VALUES_BY_TABLE = note(
    "values_by_table", "Values become densities by the transfer table (spline order {order})."
)
BACKGROUND_EMPTY = warning(
    "background_empty", "Voxels with the background value {value:.6g} count as empty."
)
VALUES_NEGATIVE = error(
    "values_negative",
    "Negative densities, down to {density:.6g} kg/m³. Convert the samples, set Values to Table, or "
    "Measure As to Solid "
    "for a level set.",
)
POSITIONS_DAMAGED = error(
    "positions_damaged",
    "The positions of the samples of “{grid}” are not rows of ascending numbers, or fewer than its "
    "samples. Import the "
    "scan again.",
)
POSITIONS_ONLY_AS_DENSITY = error(
    "positions_only_as_density",
    "The samples of the grid “{grid}” do not stand evenly, and can be measured as a density only. "
    "Set Measure As "
    "to Density, or import or measure the scan without positions.",
)
LABELS_UNFIT = error(
    "labels_unfit",
    "The samples are no labels: {cause:word}. Use --threshold or --density-scale instead of "
    "--label.",
)
