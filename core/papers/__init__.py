# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas as the papers print them, one module a paper: the tests compare the fast methods with
these.
"""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    durso_2005="durso_2005",
    sheynin_tuzikov_2001="sheynin_tuzikov_2001",
    soldea_elber_rivlin_2002_phi="soldea_elber_rivlin_2002_phi",
    soldea_elber_rivlin_2002_theorem_4_2="soldea_elber_rivlin_2002_theorem_4_2",
    zhang_chen_2001="zhang_chen_2001",
)
