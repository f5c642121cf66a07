# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .body_distances import distances as distances
from .body_distances import hull_of as hull_of
from .effects import correct_masses as correct_masses
from .effects import correct_vertices as correct_vertices
from .effects import effect as effect
from .effects import uniform_masses as uniform_masses
from .fits import Wanted as Wanted
from .fits import make_colliders as make_colliders

__all__ = []

def __getattr__(name: str) -> Any: ...
