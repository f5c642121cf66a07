# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The convex hull of an object's surface: its possible contacts with the ground."""

from __future__ import annotations

import numpy as np
from bpy.types import Depsgraph, Object
from numpy.typing import NDArray

from ....core.mesh.hulls import ConvexHull, convex_hull
from ....core.mesh.surface import Surface
from ....core.verdict.finding import EditRefusedError
from ...read.findings import SCALE_ZERO_AXIS
from ...read.objects import read_object

HULL_RTOL = 1e-6  # relative to the extent: points that are outside by less are left out
NOISE = 4.0  # half ulps of float32 coordinates by which flat faces may be uneven
MAX_CORNERS = 10000  # per hull: finely divided round bodies have more


def object_hull(obj: Object, depsgraph: Depsgraph) -> ConvexHull:
    """Return the convex hull of an object with its instances, in its own coordinates, or raise MeasureError."""
    reading = read_object(obj, depsgraph, edges=False)
    if reading.is_singular:
        raise EditRefusedError(SCALE_ZERO_AXIS)
    to_local = np.linalg.inv(reading.matrix)
    points, noise = [], 0.0
    for part in reading.parts:
        corners = _corners(part.surface) if len(part.matrices) > 1 else _used_points(part.surface)
        for matrix in to_local @ part.matrices:
            points.append(corners @ matrix[:3, :3].T + matrix[:3, 3])
            noise = max(noise, float((np.abs(matrix[:3, :3]) @ part.surface.coordinate_error).max()))
    joined = np.concatenate(points)
    extent = float(np.ptp(joined, axis=0).max())
    return convex_hull(joined, max(HULL_RTOL, NOISE * noise / (extent or np.inf)), MAX_CORNERS)


def _used_points(surface: Surface) -> NDArray[np.float64]:
    """Return the points that are corners of faces."""
    used = np.zeros(len(surface.points), bool)
    used[surface.triangles] = True
    used[surface.quads] = True
    return surface.points[used].astype(np.float64)


def _corners(surface: Surface) -> NDArray[np.float64]:
    return convex_hull(_used_points(surface), HULL_RTOL, MAX_CORNERS).points
