# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects as planes and surfaces that others are compared with, in meters and the world."""

from __future__ import annotations

import numpy as np
from bpy.types import Depsgraph, Object

from ...core import cuts, flat, mesh, verdict
from ...core.numerics import Array
from ..read import objects, visibility


def world_surface(obj: Object, depsgraph: Depsgraph, unit: float) -> mesh.Surface:
    """Return the faces that an object shows, before any repair, in meters along the world's axes.
    unit: meters per Blender unit.
    """
    reading = objects.read_object(obj, depsgraph, edges=False)
    return reading.join().transform(unit * np.eye(3), np.zeros(3))


def cut_fill_against(
    other: Object, surface: mesh.Surface, depsgraph: Depsgraph, unit: float
) -> cuts.CutFill:
    """Return cut and fill of a surface against an object: its plane if it is flat or shows no
    faces (its X and Y axes), else its surface.
    """
    if not visibility.measurable(other):
        matrix = np.array(other.matrix_world, np.float64)
        normal = np.cross(matrix[:3, 0], matrix[:3, 1])
        return _against_plane(surface, normal, unit * matrix[:3, 3])
    shown = world_surface(other, depsgraph, unit)
    faces = shown.all_triangles()[0]
    try:
        coordinate_error = float(shown.coordinate_error.max())
        plane = flat.fit_plane(shown.points, faces, np.eye(3), np.zeros(3), coordinate_error)
    except verdict.MeasureError:  # the surface is not flat
        return cuts.cut_fill_between(
            surface.points, surface.all_triangles()[0], shown.points, faces
        )
    return _against_plane(surface, plane.axes[:, 2], plane.origin)


def _against_plane(surface: mesh.Surface, normal: Array, point: Array) -> cuts.CutFill:
    """Return cut and fill against the plane through a (3,) point, or raise MeasureError if it is
    upright. The normal may have any length and point down; its upper side counts as up.
    """
    length = float(np.linalg.norm(normal))
    if not length > 0.0 or abs(normal[2]) < cuts.MIN_RIM_SPREAD * length:
        raise verdict.MeasureError(cuts.CUT_FILL_UNAVAILABLE, fault=cuts.PLANE_UPRIGHT)
    normal = normal if normal[2] >= 0.0 else -normal
    triangles = surface.all_triangles()[0]
    offset = float(normal @ point)  # the plane is normal · x = offset
    return cuts.cut_fill(surface.points, triangles, normal, offset, surface.coordinate_error)
