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
    "{count} of {total} faces has no density of a material and takes the object's {density:.7g} "
    "kg/m³. Materials without density: {materials:word}.",
    "{count} of {total} faces have no density of a material and take the object's {density:.7g} "
    "kg/m³. Materials without density: {materials:word}.",
)
DENSITY_FROM_POLYNOMIAL = note(
    "density_from_polynomial", "polynomial {polynomial}, in {frame:word} coordinates"
)
