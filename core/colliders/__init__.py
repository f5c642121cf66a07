# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colliders of a body, and their effect on mass, center and inertia."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    Effect="effects",
    Wanted="fits",
    correct_masses="effects",
    correct_vertices="corners",
    distances="distance",
    effect="effects",
    make_colliders="fits",
    uniform_masses="effects",
)
