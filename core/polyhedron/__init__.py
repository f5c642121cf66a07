# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of what triangles and quads bound: to third order, to any order, in n dimensions."""

from .integration import MAX_ORDER, polyhedron_moments

__all__ = ["MAX_ORDER", "polyhedron_moments"]
