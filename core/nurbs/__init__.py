# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of B-spline curves, and of bodies bounded by patches (Soldea, Elber and Rivlin, sections
2 and 3).
"""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
