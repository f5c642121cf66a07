# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of a measured body whose points may move: its current volume and center in one light pass.

It serves deformations during playback or posing: the measured faces, with their flips and caps, get the points that
Blender shows. There is no such pass if the faces of the mesh have changed, or vertices had to be welded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bpy.types import Depsgraph, Object
from numpy.typing import NDArray

from ....core.bodies.mesh_body import MeshBody
from ....core.bodies.reading import Reading
from ....core.mesh.surface import Surface
from ....core.polyhedron.integration import volume_and_center
from ....core.verdict.finding import ReadError
from ....core.verdict.method import Source, Verdict
from ...bodies.measure_object import Measured
from ...read.mesh import mesh_points
from ...read.visibility import evaluated_geometry

FOLLOWED = {Verdict.EXACT, Verdict.CAPPED, Verdict.REORIENTED}


@dataclass(frozen=True, eq=False)
class MovingSurface:
    """A body whose points move while its faces stay the same.

    surface: its faces, in the object's own coordinates.
    corners: (c,) vertices of all corners of the mesh that was read.
    """

    surface: Surface
    corners: NDArray[np.integer]

    @classmethod
    def from_measured(cls, measured: Measured) -> MovingSurface | None:
        """Return the faces of a measured body, or None unless it is one exact or repaired mesh in its own place."""
        reading, body, method = measured.reading, measured.body, measured.measurement.method
        if (
            not isinstance(reading, Reading)
            or not isinstance(body, MeshBody)
            or measured.measurement.kind != "solid"
            or body.mass is not None
            or method.source != Source.POLYGONS
            or method.verdict not in FOLLOWED
            or len(reading.parts) != 1
            or len(body.solids) != 1
        ):
            return None
        (part,), ((solid, _matrices),) = reading.parts, body.solids
        read, surface = part.surface, solid.repaired_surface
        if (
            part.source_object_name not in ("", reading.name)
            or len(part.matrices) != 1
            or not np.array_equal(part.matrices[0], reading.matrix)
            or read.corner_vertices is None
            or not np.array_equal(surface.points, read.points)
        ):
            return None
        return cls(surface, read.corner_vertices)

    def follow(self, obj: Object, depsgraph: Depsgraph) -> tuple[float, NDArray[np.float64]] | None:
        """Return the object's current volume and (3,) center, in its own coordinates; None if it shows other faces."""
        if obj.type != "MESH" or obj.mode not in {"OBJECT", "POSE", "WEIGHT_PAINT"} or obj.data.is_editmode:
            return None
        try:
            geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
        except ReadError:
            return None
        points = None if geometry.mesh is None else mesh_points(geometry.mesh, self.corners)
        if points is None or len(points) != len(self.surface.points):
            return None
        volume, center = volume_and_center(Surface(points, self.surface.triangles, quads=self.surface.quads))
        return (volume, center) if volume > 0.0 and np.isfinite(center).all() else None
