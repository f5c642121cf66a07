# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

from .balancing import balance as balance
from .findings import BALANCE_NO_EFFECT as BALANCE_NO_EFFECT
from .findings import BALANCE_SHORT as BALANCE_SHORT
from .findings import NO_STABLE_POSE as NO_STABLE_POSE
from .gradient import area_gradient as area_gradient
from .gradient import volume_gradient as volume_gradient
from .infill import ballast_margins as ballast_margins
from .infill import infill_range as infill_range
from .infill import largest_margin as largest_margin
from .infill import least_ballast as least_ballast
from .mixes import Mixes as Mixes
from .mixes import fit_mixes as fit_mixes
from .mixes import sample_count as sample_count
from .support import CONTACT_RTOL as CONTACT_RTOL
from .support import RestingPoses as RestingPoses
from .support import Support as Support
from .support import find_contacts as find_contacts
from .support import find_support as find_support
from .support import ground_axes as ground_axes
from .support import resting_poses as resting_poses
from .support import support_of_contacts as support_of_contacts

__all__ = [
    "area_gradient",
    "balance",
    "find_support",
    "resting_poses",
    "volume_gradient",
]

def __getattr__(name: str) -> Any: ...
