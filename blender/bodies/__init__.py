# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of objects: a reading becomes a body, then a measurement; one module for each kind of
body.
"""

from typing import TYPE_CHECKING

from ...core.lazy import lazy_names

if TYPE_CHECKING:
    from . import measure_body as measure_body
    from . import rig as rig

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    Assembly="assembly.measure",
    FlatShape="flat.flat_shape",
    MeasuredSection="flat.region",
    Results="assembly.measure",
    Shape="shape.object_shape",
    THREADS="measure_body",
    assemble="assembly.measure",
    comparable_shape_of="flat.flat_shape",
    distance_from="flat.flat_shape",
    flat_transform="fourier",
    measure_assembly="assembly.measure",
    measure_many="measure_object",
    measure_members="assembly.measure",
    measure_rig="rig",
    measured_in_turn="measure_object",
    object_transform="fourier",
    overlap_caveats="overlaps",
    register_surfaces="shape.surface_distance",
    rig="rig",
    section_of="flat.region",
)
