# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/moments`."""

from ..verdict import error

NORMALIZATION_UNDEFINED = error(
    "normalization_undefined",
    "The moments cannot be normalized: the volume or area is zero. Set About to Center.",
)
