# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from . import durso_2005 as durso_2005
from . import sheynin_tuzikov_2001 as sheynin_tuzikov_2001
from . import soldea_elber_rivlin_2002_phi as soldea_elber_rivlin_2002_phi
from . import soldea_elber_rivlin_2002_theorem_4_2 as soldea_elber_rivlin_2002_theorem_4_2
from . import zhang_chen_2001 as zhang_chen_2001

__all__ = [
    "durso_2005",
    "sheynin_tuzikov_2001",
    "soldea_elber_rivlin_2002_phi",
    "soldea_elber_rivlin_2002_theorem_4_2",
    "zhang_chen_2001",
]

def __getattr__(name: str) -> Any: ...
