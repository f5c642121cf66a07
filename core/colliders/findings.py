# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/colliders`."""

from ..verdict import error

COLLIDERS_FLAT = error(
    "colliders_flat",
    "The colliders are flat: they enclose no volume, and so have no mass. Choose Sphere or Capsule "
    "for Shape, or thicken the object.",
)
