# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--thumbnails: a small picture of each body, in its record."""

from __future__ import annotations

import bpy

from ...core.measurement import Measurement
from ...core.numerics.float32 import shortest_decimal
from ..read.links import link_surface
from ..write.thumbnail import thumbnail


def thumbnail_of(obj: bpy.types.Object, measurement: Measurement, unit: float | None) -> str | None:
    """The picture of a measured object, None of what shows no faces. unit: meters per unit, else the scene's."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    unit = unit or shortest_decimal(depsgraph.scene.unit_settings.scale_length)
    surface = link_surface(obj, depsgraph, measurement, unit)
    if surface is None:
        return None
    triangles = surface.all_triangles()[0]
    properties = measurement.in_object_frame()
    if not len(triangles):
        return None
    return thumbnail(surface.points, triangles, properties.center, properties.principal.axes)
