# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in every unit that a scene can be set to, kept as text."""

import itertools
from math import inf, nan

import pytest
from body_moments.operators.write import messages
from body_moments.operators.write.units import GROUPS, LENGTHS, MASSES, SI_UNITS, Units, column, number, rounded_up

VALUES = (0.0, 3e-19, 1.25e-7, 0.000999999, 0.0123456789, 0.99999951, 1.0, 12345.6789, -98765.4321, 6.02214e9, 2.5e12)


@pytest.mark.parametrize("system", ["NONE", *LENGTHS])
def test_every_unit(kept, system):
    lines = []
    lengths, masses = (["ADAPTIVE", *table.get(system, ())] for table in (LENGTHS, MASSES))
    for length, mass in itertools.product(lengths, masses):
        if "ADAPTIVE" in (length, mass) or masses.index(mass) == lengths.index(length):
            units = Units(system, length, mass, 0.5)
            lines.append("=== {:s}, {:s}".format(length, mass))
            for quantity in SI_UNITS:
                lines.append("{:s}: {:s}".format(quantity, " | ".join(units.text(quantity, value) for value in VALUES)))
                lines.append("    {:s}".format(" | ".join(units.texts(quantity, (0.25, -3e-9, 1e-14, inf, nan), 2.0))))
                lines.append(
                    "    {:s}".format(" | ".join(units.bound(quantity, 1.2345e-9, -value) for value in VALUES))
                )
    kept("units_{:s}.txt".format(system.lower()), "\n".join(lines))


def test_numbers(kept):
    lines = []
    for digits, grouping in itertools.product((2, 6, 15), GROUPS):
        lines.append("=== {:d} digits, {:s}".format(digits, grouping))
        lines += [
            repr(number(value, digits, grouping)) for value in (*VALUES, 1e-5, 1.1e-4, 9999.0, 10000.0, 1e10, inf, nan)
        ]
        lines.append(repr(column((1234567.0, -0.04, 100.0), digits, grouping)))
        lines.append(repr(column((20.0, 300.0), digits, grouping)))
        lines.append(repr(column((2e-7, 3.5e-8, 0.0), digits, grouping)))
    kept("numbers.txt", "\n".join(lines))


@pytest.mark.parametrize(
    ("density", "system"), itertools.product(("AUTO", "KG_M3", "G_CM3", "LB_IN3"), ("METRIC", "IMPERIAL"))
)
def test_densities_have_units_of_their_own(density, system):
    name = {"KG_M3": "kg/m³", "G_CM3": "g/cm³", "LB_IN3": "lb/in³", "AUTO": {"METRIC": "kg/m³"}.get(system, "lb/ft³")}
    factor = {"kg/m³": 1.0, "g/cm³": 1000.0, "lb/in³": 27679.9047, "lb/ft³": 16.0184634}[name[density]]
    text = Units(system, "ADAPTIVE", "ADAPTIVE", 1.0, density, 5).text("density", 7874.0)
    assert text.endswith(" " + name[density])
    shown = float(text.rpartition(" ")[0].replace("\u2009", ""))
    assert abs(shown / (7874.0 / factor) - 1.0) < 1e-4


def test_bounds_are_rounded_upward():
    for bound, shown in ((0.0, 0.0), (1.2, 1.2), (1.2000001, 1.3), (9.91e-7, 1e-6), (1.01962, 1.1), (inf, inf)):
        assert rounded_up(bound) == shown


def test_places_at_zero_have_no_sign():
    assert messages._Formatter(str, None).format_field([-0.0, 0.0, -1.5], "point") == "(0 m, 0 m, -1.5 m)"
