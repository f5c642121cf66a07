# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .findings import NO_SECTION_AREA as NO_SECTION_AREA
from .findings import SECTION_NOT_FLAT as SECTION_NOT_FLAT
from .polygon import directed_edges as directed_edges
from .polygon import find_defects as find_defects
from .polygon import orient_loops as orient_loops
from .polygon import plane_positions as plane_positions
from .polygon import region_moments as region_moments
from .section import fit_plane as fit_plane
from .section import foot as foot
from .section import measure_section as measure_section
from .section import project as project
from .section import projection_rounding as projection_rounding
from .section import region as region
from .section_properties import Plane as Plane
from .section_properties import Section as Section

__all__ = [
    "Section",
    "directed_edges",
    "fit_plane",
    "measure_section",
    "region_moments",
]

def __getattr__(name: str) -> Any: ...
