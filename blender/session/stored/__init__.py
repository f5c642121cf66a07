# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of an open file: stored on objects or cached, one module per kind of result."""

from typing import TYPE_CHECKING

from ....core.lazy import lazy_names

if TYPE_CHECKING:
    from . import assembly as assembly
    from . import balance_groups as balance_groups
    from . import density as density
    from . import faults as faults
    from . import listing as listing
    from . import moments as moments
    from . import outcome as outcome
    from . import reference as reference
    from . import results as results
    from . import rig as rig
    from . import stability as stability
    from . import sums as sums
    from . import threshold as threshold
    from . import walls as walls

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    assembly="assembly",
    balance_groups="balance_groups",
    compute_moments="moments_to_order",
    density="density",
    faults="faults",
    listing="listing",
    moments="moments",
    outcome="outcome",
    reference="reference",
    results="results",
    rig="rig",
    sections="sections",
    stability="stability",
    sums="sums",
    symmetry="symmetry",
    threshold="threshold",
    walls="walls",
)
