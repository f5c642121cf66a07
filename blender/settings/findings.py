# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/settings`."""

from ...core.verdict.finding import error, note, warning

DENSITY_SOURCE_MISSING = error(
    "density_source_missing",
    "Density From is {source:word}, but none is chosen. Choose one below, or change Density From.",
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
VALUES_SCALED = note("values_scaled", "A value of 1 stands for {density:.6g} kg/m³ (spline order {order}).")
VALUES_BY_TABLE = note("values_by_table", "Values become densities by the transfer table (spline order {order}).")
BACKGROUND_EMPTY = warning("background_empty", "Voxels with the background value {value:.6g} count as empty.")
VALUES_NEGATIVE = error(
    "values_negative",
    "Negative densities, down to {density:.6g} kg/m³. Convert the samples, set Values to Table, or Measure As to Solid "
    "for a level set.",
)
POSITIONS_DAMAGED = error(
    "positions_damaged",
    "The positions of the samples of “{grid}” are not rows of ascending numbers, or fewer than its samples. Import the "
    "scan again.",
)
POSITIONS_ONLY_AS_DENSITY = error(
    "positions_only_as_density",
    "The samples of the grid “{grid}” do not stand evenly, and can be measured as a density only. Set Measure As "
    "to Density, or import or measure the scan without positions.",
)
