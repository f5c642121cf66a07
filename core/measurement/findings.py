# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/measurement`."""

from ..verdict import error, finding, note, warning

NO_VOLUME = error(
    "no_volume",
    "The faces enclose no volume. Set Kind to Shell, close the mesh, or use Measure Section for a "
    "flat shape.",
)
ZERO_QUANTITY = error("zero_quantity", "The {quantity:word} is zero. Set it.")
WALL_UNSUPPORTED = error(
    "wall_unsupported",
    "{quantity:word} is not available for walls of real thickness. Set Wall to Thin.",
)
LARGE_BOUND = warning(
    "large_bound",
    "The error bound of the {quantity:word} is {share:percent} of its {whole:word}. Do not rely on "
    "it, or move "
    "vertices nearer to the object's origin.",
)
DENSITY_FROM = note("density_from", "{source:word}")
# Sources of a density that is the same everywhere.
DENSITY_FROM_VALUE = finding(DENSITY_FROM, source="one value")
DENSITY_FROM_MASS = finding(DENSITY_FROM, source="given mass")
UNIFORM_DENSITIES = DENSITY_FROM_VALUE, DENSITY_FROM_MASS
