# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/mesh`."""

from ..verdict import error

HULL_WITHOUT_EXTENT = error(
    "hull_without_extent", "All points are on one line: nothing can stand on it."
)
