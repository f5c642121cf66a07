# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of B-spline surfaces as objects of the open scene: IGES, and .obj files with ``surf``.

Blender has no importer for IGES, and its importer of .obj files silently leaves out ``surf``.
"""

from __future__ import annotations

import re

import bpy

from ...blender.scene.surface_objects import show_bodies
from ...core.cad.findings import FACES_NOT_READ
from ...core.cad.obj import has_surfaces
from ...core.cad.surface_file import read_surfaces
from ...core.cad.surfaces import SurfaceFile
from ...core.scans.limits import scan_limits
from ...core.verdict.finding import FileError, Finding, finding
from .references import Opened

_MESH = re.compile(rb"[ \t]*(?:f|l|curv)[ \t]")  # the elements that Blender's importer reads


def import_iges(path: str) -> Opened:
    """Add the surfaces of a file to the scene, in meters. Raises FileError and OSError."""
    return _added(read_surfaces(path, scan_limits(), for_blender=False))


def import_obj(path: str) -> Opened:
    """Add the objects of a file to the scene: faces by Blender's importer, surfaces by ours.

    Raises FileError and OSError.
    """
    if not has_surfaces(path):
        bpy.ops.wm.obj_import(filepath=path)
        return Opened()
    with open(path, "rb") as file:
        has_faces = any(_MESH.match(line) for line in file)
    try:
        opened = _added(read_surfaces(path, scan_limits(), for_blender=False))
    except FileError as error:
        if not has_faces:
            raise
        opened = Opened((error.finding,))
    if has_faces:
        bpy.ops.wm.obj_import(filepath=path)
    return opened


def _added(file: SurfaceFile) -> Opened:
    unit = 1.0 if file.unit is None else file.unit
    made = show_bodies(file.bodies, bpy.context.scene.collection, unit)
    bpy.context.view_layer.update()
    unread = (finding(FACES_NOT_READ, count=file.unread),) if file.unread else ()
    by_object: dict[str, tuple[Finding, ...]] = {obj.name: unread for obj in made}
    return Opened(file.refused, file.notes, by_object)
