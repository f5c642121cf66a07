# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities in the units that a scene can choose, and bounds rounded upward."""

import itertools
from math import inf

import pytest
from body_moments.blender.write.units import Units, rounded_up


@pytest.mark.parametrize(
    ("density", "system"),
    itertools.product(("AUTO", "KG_M3", "G_CM3", "LB_IN3"), ("METRIC", "IMPERIAL")),
)
def test_densities_have_units_of_their_own(density, system):
    name = {
        "KG_M3": "kg/m³",
        "G_CM3": "g/cm³",
        "LB_IN3": "lb/in³",
        "AUTO": {"METRIC": "kg/m³"}.get(system, "lb/ft³"),
    }
    factor = {"kg/m³": 1.0, "g/cm³": 1000.0, "lb/in³": 27679.9047, "lb/ft³": 16.0184634}[
        name[density]
    ]
    text = Units(system, "ADAPTIVE", "ADAPTIVE", 1.0, density, 5).text("density", 7874.0)
    assert text.endswith(" " + name[density])
    shown = float(text.rpartition(" ")[0].replace("\u2009", ""))
    assert abs(shown / (7874.0 / factor) - 1.0) < 1e-4


def test_bounds_are_rounded_upward():
    for bound, shown in (
        (0.0, 0.0),
        (1.2, 1.2),
        (1.2000001, 1.3),
        (9.91e-7, 1e-6),
        (1.01962, 1.1),
        (inf, inf),
    ):
        assert rounded_up(bound) == shown
