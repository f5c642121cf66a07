# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Area moments of polygons with holes, and the section properties that engineers know."""

from .polygon import area_moments, directed_edges, find_defects, orient_loops
from .regions import region_moments
from .section import Plane, Section, fit_plane, measure_section

__all__ = [
    "Plane",
    "Section",
    "area_moments",
    "directed_edges",
    "find_defects",
    "fit_plane",
    "measure_section",
    "orient_loops",
    "region_moments",
]
