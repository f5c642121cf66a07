# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether bodies stand and how they rest; derivatives by every vertex, and the least change of shape that moves the
center.
"""

from .balancing import BalanceResult, balance
from .gradient import Gradient, area_gradient, volume_gradient
from .resting import RestingPoses, resting_poses
from .support import Support, find_support

__all__ = [
    "BalanceResult",
    "Gradient",
    "RestingPoses",
    "Support",
    "area_gradient",
    "balance",
    "find_support",
    "resting_poses",
    "volume_gradient",
]
