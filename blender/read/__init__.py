# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender in: evaluated objects as arrays, with their places and a finding for each decision."""

from typing import TYPE_CHECKING

from ...core.lazy import lazy_names

if TYPE_CHECKING:
    from . import assembly as assembly
    from . import rig as rig
    from . import robots as robots
    from . import shapes as shapes
    from . import total_caveats as total_caveats

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    assembly="assembly",
    reference="reference",
    rig="rig",
    robots="robots",
    shapes="shapes",
    total_caveats="total_caveats",
    vdb="grids.vdb",
)
