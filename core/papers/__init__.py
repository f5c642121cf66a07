# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas as the papers print them, one module a paper: the tests compare the fast methods with these."""

from . import (
    durso_2005,
    sheynin_tuzikov_2001,
    soldea_elber_rivlin_2002_phi,
    soldea_elber_rivlin_2002_theorem_4_2,
    zhang_chen_2001,
)

__all__ = [
    "durso_2005",
    "sheynin_tuzikov_2001",
    "soldea_elber_rivlin_2002_phi",
    "soldea_elber_rivlin_2002_theorem_4_2",
    "zhang_chen_2001",
]
