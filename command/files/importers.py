# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Importers of files that Blender's importers do not read, or not as they are.

Blender has none for .3mf and IGES; that of .obj leaves out ``surf``.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...blender import bodies, scene
from ...blender.settings.prints import set_print
from ...core import cad, files, polyhedron, streams, verdict
from ...core.mesh import Surface
from ...core.solid import UNCHECKED, measure_solid
from ...core.verdict import FileError, Finding, finding
from ..findings import FILE_HIDES, PRINT_SETTINGS
from .references import Opened

# Numbers of vertices with a meaning of their own; Blender makes attributes of all others.
_KNOWN = {*("x", "y", "z", "nx", "ny", "nz", "s", "t"), *("red", "green", "blue", "alpha")}
_MOVED = 1e-6  # by float32, relative to the body's size
_SHEAR = 1e-6  # relative to the largest entry of a matrix; larger than the rounding of float32
_OBJ_MESH = re.compile(rb"[ \t]*(?:f|l|curv)[ \t]")  # the elements that Blender's importer reads


def import_mesh(path: str) -> None:
    """Add the mesh of an .stl or .ply file to the scene. Raises FileError.

    If float32 would move points noticeably, the object stands at the center of their box.
    """
    mesh = streams.KINDS[Path(path).suffix.lower()](Path(path)).mesh()
    center = np.zeros(3)
    if len(mesh.points):
        low, high = streams.box_of_blocks([mesh.points], "vertex")
        with np.errstate(over="ignore"):
            moved = np.abs(mesh.points.astype(np.float32) - mesh.points).max()
        if moved > _MOVED * (high - low).max():
            center = polyhedron.box_center(low, high, np.dtype(np.float32))
            mesh = replace(mesh, points=mesh.points - center)
    obj = bpy.data.objects.new(mesh.name, blender_mesh(mesh))
    obj.location = center
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()


def blender_mesh(found: streams.FileMesh) -> bpy.types.Mesh:
    """Return a file's mesh as data of Blender. FileError if a coordinate is too large for it."""
    with np.errstate(over="ignore"):
        points = found.points.astype(np.float32)
    streams.box_of_blocks([points], "vertex")
    mesh = bpy.data.meshes.new(found.name)
    mesh.vertices.add(len(points))
    if len(points):  # Attributes are set several times faster than properties.
        mesh.attributes["position"].data.foreach_set("vector", points.ravel())
    mesh.edges.add(len(found.edges))
    mesh.edges.foreach_set("vertices", found.edges.astype(np.int32).ravel())
    mesh.loops.add(len(found.corners))
    if len(found.corners):
        mesh.attributes[".corner_vert"].data.foreach_set("value", found.corners.astype(np.int32))
    mesh.polygons.add(len(found.sides))
    mesh.polygons.foreach_set("loop_start", (np.cumsum(found.sides) - found.sides).astype(np.int32))
    for name, values in found.values.items():
        if name not in _KNOWN:
            mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values)
    mesh.update(calc_edges=True)
    return mesh


def import_3mf(path: str) -> Opened:
    """Add the file's objects to the scene, and set its unit to the file's. Raises FileError."""
    placed, unit = streams.read_3mf(path, files.file_limits())
    hidden: dict[str, Finding] = {}
    bpy.context.scene.unit_settings.scale_length = unit
    meshes: dict[tuple[str, str], bpy.types.Mesh] = {}
    errors: list[Finding] = []
    notes: dict[str, tuple[Finding, ...]] = {}
    for one, negative in _without_negative_parts(placed, errors):
        if one.key not in meshes:
            meshes[one.key] = _mesh(one)
        obj = bpy.data.objects.new(one.name, meshes[one.key])
        bpy.context.scene.collection.objects.link(obj)
        found = dict(one.print_settings or ())
        if found:
            obj.body_moments.kind = "PRINTED"
        if "density" in found:
            obj.body_moments.density = found.pop("density")
        set_print(obj.body_moments, found)
        unread = [finding(UNCHECKED, subject=PRINT_SETTINGS)] * (one.print_settings is None)
        cut = [finding(streams.NEGATIVE_PARTS_CUT, names=negative)] if negative else []
        notes[obj.name] = (*unread, *cut)
        if one.hidden:
            hidden[obj.name] = finding(FILE_HIDES, cause=one.hidden)
        obj.matrix_basis = Matrix(one.matrix)
        if (
            np.abs(np.array(obj.matrix_basis) - one.matrix).max()
            > _SHEAR * np.abs(one.matrix).max()
        ):
            obj.matrix_basis = Matrix()  # an object's own channels hold no shear
            obj.data = _mesh(
                replace(one, points=one.points @ one.matrix[:3, :3].T + one.matrix[:3, 3])
            )
    bpy.context.view_layer.update()
    return Opened(tuple(errors), by_object=notes, hidden=hidden)


def _without_negative_parts(
    placed: list[streams.Placed], errors: list[Finding]
) -> Iterator[tuple[streams.Placed, list[str]]]:
    """Yield the meshes with negative parts cut away, and the names of these; a mesh that cannot be
    cut is left out, with an error.
    """
    for number, one in enumerate(placed):
        if one.is_negative:
            yield replace(one, hidden=one.hidden or "it is cut away from the other parts"), []
            continue
        cutters = [
            part
            for part in placed
            if part.is_negative and part.item == one.item and not part.hidden
        ]
        if one.hidden or not cutters:
            yield one, []
            continue
        names = [cutter.name for cutter in cutters]
        inverse = np.linalg.inv(one.matrix)
        surfaces = [_closed_surface(part, inverse @ part.matrix) for part in (one, *cutters)]
        closed = [surface for surface in surfaces if surface is not None]
        left = (
            bodies.union.subtract(closed[0], closed[1:]) if len(closed) == len(surfaces) else None
        )
        if left is not None and left.triangle_count:
            triangles = left.all_triangles()[0].astype(np.int64)
            yield replace(one, key=(number,), points=left.points, triangles=triangles), names
            continue
        cause = "they cover all of it"
        if left is None:
            cause = "the surfaces are not closed, or Blender's Boolean fails with them"
        errors.append(
            finding(streams.NEGATIVE_PARTS_UNFIT, names=names, object=one.name, cause=cause)
        )


def _closed_surface(part: streams.Placed, matrix: NDArray) -> Surface | None:
    """Return a part in its place with faces outward, or None if it is not closed."""
    surface = Surface.from_triangles(part.points, part.triangles)
    solid = measure_solid(surface.transform(matrix[:3, :3], matrix[:3, 3]))
    is_closed = solid.method in (verdict.Procedure.EXACT, verdict.Procedure.REORIENTED)
    return solid.repaired_surface if is_closed else None


def _mesh(one: streams.Placed) -> bpy.types.Mesh:
    return blender_mesh(
        streams.FileMesh(
            one.name, one.points, one.triangles.ravel(), np.full(len(one.triangles), 3)
        )
    )


def import_cad(path: str) -> Opened:
    """Add the surfaces of a file to the scene, in meters. Raises FileError and OSError."""
    file = cad.read_surfaces(path, files.file_limits(), for_blender=False)
    unit = 1.0 if file.unit is None else file.unit
    made = scene.imports.show_bodies(file.bodies, bpy.context.scene.collection, unit)
    bpy.context.view_layer.update()
    unread = (finding(cad.FACES_NOT_READ, count=file.unread),) if file.unread else ()
    by_object: dict[str, tuple[Finding, ...]] = {obj.name: unread for obj in made}
    return Opened(file.refused, file.notes, by_object)


def import_obj(path: str) -> Opened:
    """Add the objects of a file to the scene: faces by Blender's importer, surfaces by ours.

    Raises FileError and OSError.
    """
    opened = Opened()
    has_faces = True
    if cad.has_surfaces(path):
        with open(path, "rb") as file:
            has_faces = any(_OBJ_MESH.match(line) for line in file)
        try:
            opened = import_cad(path)
        except FileError as error:
            if not has_faces:
                raise
            opened = Opened((error.finding,))
    if has_faces:
        bpy.ops.wm.obj_import(filepath=path)
    return opened
