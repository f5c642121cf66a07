# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/measurement`."""

from ..verdict.finding import note

DENSITY_FROM_VALUE = note("density_from_value", "one value")
DENSITY_FROM_MASS = note("density_from_mass", "given mass")
