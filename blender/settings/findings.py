# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/settings`."""

from ...core.verdict.finding import error, note, warning

DENSITY_VOLUME_MISSING = error(
    "density_volume_missing", "No Volume object is chosen for the density. Choose one in Volume."
)
DENSITY_ATTRIBUTE_MISSING = error(
    "density_attribute_missing", "No vertex attribute is named for the density. Set Attribute."
)
OBJECT_DENSITY_USED = warning(
    "object_density_used",
    "{count} of {total} faces has no material with a density and takes the object's {density:.7g} kg/m³.",
    "{count} of {total} faces have no material with a density and take the object's {density:.7g} kg/m³.",
)
OBJECT_DENSITY_USED_FOR_MATERIALS = warning(
    "object_density_used_for_materials",
    "{count} of {total} faces takes the object's {density:.7g} kg/m³, as these materials have no density: {materials}.",
    "{count} of {total} faces take the object's {density:.7g} kg/m³, as these materials have no density: {materials}.",
)
DENSITY_FROM_POLYNOMIAL = note("density_from_polynomial", "polynomial {polynomial}, in {frame:word} coordinates")
DENSITY_FROM_COEFFICIENTS = note(
    "density_from_coefficients",
    "polynomial with the coefficients {polynomial} of 1, x, y, z, …, in {frame:word} coordinates",
)
VALUES_SCALED = note("values_scaled", "A value of 1 stands for {density:.6g} kg/m³.")
VALUES_BY_TABLE = note("values_by_table", "Values become densities by the transfer table.")
VALUES_SCALED_SPLINE = note(
    "values_scaled_spline",
    "A value of 1 stands for {density:.6g} kg/m³; the values are spline coefficients of order {order}, which "
    "smooth them.",
)
VALUES_BY_TABLE_SPLINE = note(
    "values_by_table_spline",
    "Values become densities by the transfer table; they are spline coefficients of order {order}, which smooth them.",
)
BACKGROUND_EMPTY = warning("background_empty", "Voxels with the background value {value:.6g} count as empty.")
VALUES_NON_FINITE_FOR_TABLE = error(
    "values_non_finite_for_table", "Some values are not finite and have no density in the transfer table. Remove them."
)
VALUES_NEGATIVE = error(
    "values_negative",
    "Negative densities, down to {density:.6g} kg/m³. Convert the samples, set Values to Table, or Measure As to Solid "
    "for a level set.",
)
POSITIONS_OF_OTHER_SAMPLES = error(
    "positions_of_other_samples",
    "The grid “{grid}” has samples beyond its {count} positions along {axis}. Import the scan again.",
)
POSITIONS_DAMAGED = error(
    "positions_damaged",
    "The positions of the samples of “{grid}” are not rows of ascending numbers. Import the scan again.",
)
POSITIONS_ONLY_AS_DENSITY = error(
    "positions_only_as_density",
    "The samples of the grid “{grid}” do not stand evenly, and can be measured as a density only. Set Measure As "
    "to Density, or import the scan without positions.",
)
