# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared numerical tools: vectors, exact sums, rotations, quadrature, splines, graphs, segments."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
