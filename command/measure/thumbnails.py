# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--thumbnails: a small picture of each body, in its record."""

from __future__ import annotations

import bpy
import numpy as np

from ...blender.read.objects import read_object
from ...blender.write.thumbnail import thumbnail
from ...core.measurement.measurement import Measurement
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import MeasureError


def thumbnail_of(obj: bpy.types.Object, measurement: Measurement, unit: float | None) -> str | None:
    """Return the picture of a measured object, or None if it shows no faces.

    unit: meters per unit, else the scene's.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    unit = unit or shortest_decimal(depsgraph.scene.unit_settings.scale_length)
    try:
        surface = read_object(obj, depsgraph, edges=False).join()
    except MeasureError:  # such as a grid of densities
        return None
    triangles = surface.all_triangles()[0]
    if not len(triangles):
        return None
    properties = measurement.mass_properties
    return thumbnail(surface.points.astype(np.float64) * unit, triangles, properties.center, properties.principal.axes)
