# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/settings`."""

from ...core.verdict import error, note, warning

DENSITY_SOURCE_MISSING = error(
    "density_source_missing",
    "Density From is {source:word}, but none is chosen. Choose one below, or change Density From.",
)
OBJECT_DENSITY_USED = warning(
    "object_density_used",
    "{count} of {total} faces has no material with a density and takes the object's {density:.7g} "
    "kg/m³.",
    "{count} of {total} faces have no material with a density and take the object's {density:.7g} "
    "kg/m³.",
)
OBJECT_DENSITY_USED_FOR_MATERIALS = warning(
    "object_density_used_for_materials",
    "{count} of {total} faces takes the object's {density:.7g} kg/m³, as these materials have no "
    "density: {materials}.",
    "{count} of {total} faces take the object's {density:.7g} kg/m³, as these materials have no "
    "density: {materials}.",
)
DENSITY_FROM_POLYNOMIAL = note(
    "density_from_polynomial", "polynomial {polynomial}, in {frame:word} coordinates"
)
