# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts of meshes that importers misread."""

from tests.core.findings import refused

NO_NUMBERS = [
    "1.0x0",
    "1.0D0",
    "l.0",
    "1,0",
    "--1",
    "+-1",
    "1e",
    "1e+",
    "e1",
    ".",
    "+",
    "1.0.0",
    "0x1",
    "0x1p3",
    "1_0",
]

NUMBERS = [
    "+1",
    ".5",
    "5.",
    "1E-3",
    "-0",
    "1e+000",
    "1.e05",
    "-.5e-3",
    "0001",
    "1" * 35,
    "0." + "3" * 70,
    "1e-999",
]

NO_WHOLES = ["1.0", "1e0", "x", "1_0", "٣", "--1", "1/1", "0x1", ""]


def misread(line, expected, text):
    return refused("line_misread", line=line, text=text, expected=expected)
