# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of moments by every vertex, and the least change of shape that moves the center."""

from .balance import BalanceResult, balance
from .gradient import Gradient, area_gradient, volume_gradient

__all__ = [
    "BalanceResult",
    "Gradient",
    "area_gradient",
    "balance",
    "volume_gradient",
]
