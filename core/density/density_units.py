# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pure data: units in which densities are shown and entered."""

from __future__ import annotations

POUND = 0.45359237  # kg
FOOT = 0.3048  # m
DENSITY_UNITS = {  # name of a setting → kg/m³, unit
    "KG_M3": (1.0, "kg/m³"),
    "G_CM3": (1e3, "g/cm³"),
    "LB_IN3": (POUND / (FOOT / 12.0) ** 3, "lb/in³"),
    "LB_FT3": (POUND / FOOT**3, "lb/ft³"),
}
SYSTEM_UNITS = {"METRIC": "KG_M3", "IMPERIAL": "LB_FT3", "NONE": "KG_M3"}  # The customary units of tables, not kg/mm³.


def density_unit(chosen: str, system: str) -> str:
    """Return one of `DENSITY_UNITS`: the chosen one, or for "AUTO" that of a unit system (`SYSTEM_UNITS`)."""
    return SYSTEM_UNITS[system] if chosen == "AUTO" else chosen
