# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The faults of measured meshes, for the overlay: cached until the geometry changes or the file is
closed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bpy.types import Object

from ....core import bodies, numerics, verdict
from ...bodies.stack import Measured
from .. import memory, tracking

# names of the defective elements: (k, 2) pairs of vertices, and (k,) indices of faces
PAIRS = "boundary_edges", "non_manifold_edges", "inconsistent_edges"
FACES = verdict.FLIPPED_FACES, "duplicate_faces", "degenerate_faces"
MAX_DRAWN = 20000  # edges, and triangles, of an object


@dataclass(frozen=True, eq=False)
class Faults:
    """Faulty edges and faces in an object's own coordinates.

    edges: (k, 2, 3), boundary, non-manifold and inconsistent. triangles: (l, 3, 3), of flipped,
    duplicate and zero-area faces. change: number of the last update of the geometry.
    """

    edges: numerics.Array
    triangles: numerics.Array
    change: int


forget = memory.faults.forget


def remember(obj: Object, measured: Measured) -> None:
    """Cache the faults of a freshly measured object, or drop them if it has none."""
    forget(obj)
    if measured.is_faultless:
        return
    reading = measured.reading
    if not isinstance(reading, bodies.Reading) or len(reading.parts) != 1 or reading.is_singular:
        return  # with several surfaces, the faulty one is unknown
    (part,) = reading.parts
    surface = part.surface
    elements = measured.measurement.health.defective_elements
    to_object = np.linalg.inv(reading.matrix) @ part.matrices[0]
    pairs, faces = (
        np.concatenate([getattr(elements, name) for name in names]) for names in (PAIRS, FACES)
    )
    if not len(pairs) and not len(faces):
        return
    points = surface.points.astype(np.float64) @ to_object[:3, :3].T + to_object[:3, 3]
    triangles = surface.triangles[:0]
    if len(faces):
        all_triangles, face_of_triangle = surface.all_triangles()
        triangles = all_triangles[np.isin(face_of_triangle, faces)][:MAX_DRAWN]
    memory.faults[obj] = Faults(
        points[pairs[:MAX_DRAWN]], points[triangles], tracking.updates.last_change_of_geometry(obj)
    )


def of_object(obj: Object) -> Faults | None:
    """Return the faults of an object, None if there are none or its geometry has changed."""
    faults = memory.faults.get(obj)
    if faults is None or faults.change != tracking.updates.last_change_of_geometry(obj):
        return None
    return faults
