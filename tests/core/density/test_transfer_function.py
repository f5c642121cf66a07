# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of densities for sample values, and the units of displayed densities."""

import numpy as np
import pytest
from body_moments.core.density.grid_values import parse_table
from body_moments.core.density.materials import CT_DENSITIES, DENSITY_UNITS, density_unit

from tests.close import close
from tests.core.findings import refused


def test_pairs_are_parted_by_commas_semicolons_and_lines():
    for text in ("-5 0, 0.5 1e3,7 2", " -5 0; 0.5 1000;; 7 2 ", "-5 0\n0.5 1000\n\n7\t2,"):
        values, densities = parse_table(text)
        assert values.tolist() == [-5.0, 0.5, 7.0] and densities.tolist() == [0.0, 1000.0, 2.0]
    values, densities = parse_table(CT_DENSITIES)
    assert np.interp([-2000, -1000, 14, 1600, 4000], values, densities).tolist() == [
        1.21,
        1.21,
        1030,
        1964.2,
        2800,
    ]


@pytest.mark.parametrize(
    "text, code, values",
    [
        ("0 1, 2", "transfer_table_syntax", {"part": "2"}),
        ("0 1; 1 2 3", "transfer_table_syntax", {"part": "1 2 3"}),
        ("0 1, one 2 ", "transfer_table_syntax", {"part": "one 2"}),
        ("", "transfer_table_numbers", {}),
        ("0 1", "transfer_table_numbers", {}),
        ("0 1, 1 -0.001", "transfer_table_numbers", {}),
        ("0 1, 1 nan", "transfer_table_numbers", {}),
        ("0 1, inf 1", "transfer_table_numbers", {}),
        ("0 1, 0 2", "transfer_table_numbers", {}),
        ("0 1, 2 2, 1 3", "transfer_table_numbers", {}),
    ],
)
def test_malformed_table_is_refused(text, code, values):
    with refused(code, **values):
        parse_table(text)


def test_units_have_their_sizes_and_follow_the_scene():
    # NIST SP 811
    sizes = {
        "KG_M3": 1.0,
        "G_CM3": 1000.0,
        "LB_IN3": 27679.904710203125,
        "LB_FT3": 16.01846337396014,
    }
    assert DENSITY_UNITS.keys() == sizes.keys()
    assert all(close(DENSITY_UNITS[name][0], size, 1e-14) for name, size in sizes.items())
    shown = {"METRIC": "KG_M3", "IMPERIAL": "LB_FT3", "NONE": "KG_M3"}
    assert all(density_unit("AUTO", system) == unit for system, unit in shown.items())
    assert density_unit("G_CM3", "IMPERIAL") == "G_CM3"
