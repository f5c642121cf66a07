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
# Chosen, a shift of points by float32 relative to the body's size: the rounding of float32, 6e-8,
# exceeds it if the origin is more than about 16 sizes away.
_MOVED = 1e-6
# Chosen, relative to the largest entry of a matrix: larger than the rounding of float32.
_SHEAR = 1e-6
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
            largest_shift = np.abs(mesh.points.astype(np.float32) - mesh.points).max()
        if largest_shift > _MOVED * (high - low).max():
            center = polyhedron.box_center(low, high, np.dtype(np.float32))
            mesh = replace(mesh, points=mesh.points - center)
    obj = bpy.data.objects.new(mesh.name, blender_mesh(mesh))
    obj.location = center
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()


def blender_mesh(file_mesh: streams.FileMesh) -> bpy.types.Mesh:
    """Return a file's mesh as data of Blender. FileError if a coordinate is too large for it."""
    with np.errstate(over="ignore"):
        points = file_mesh.points.astype(np.float32)
    streams.box_of_blocks([points], "vertex")
    mesh = bpy.data.meshes.new(file_mesh.name)
    mesh.vertices.add(len(points))
    if len(points):  # Attributes are set several times faster than properties.
        mesh.attributes["position"].data.foreach_set("vector", points.ravel())
    mesh.edges.add(len(file_mesh.edges))
    mesh.edges.foreach_set("vertices", file_mesh.edges.astype(np.int32).ravel())
    mesh.loops.add(len(file_mesh.corners))
    if len(file_mesh.corners):
        mesh.attributes[".corner_vert"].data.foreach_set(
            "value", file_mesh.corners.astype(np.int32)
        )
    mesh.polygons.add(len(file_mesh.sides))
    mesh.polygons.foreach_set(
        "loop_start", (np.cumsum(file_mesh.sides) - file_mesh.sides).astype(np.int32)
    )
    for name, values in file_mesh.values.items():
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
    for part, negative_names in _without_negative_parts(placed, errors):
        if part.key not in meshes:
            meshes[part.key] = _mesh(part)
        obj = bpy.data.objects.new(part.name, meshes[part.key])
        bpy.context.scene.collection.objects.link(obj)
        print_settings = dict(part.print_settings or ())
        if print_settings:
            obj.body_moments.kind = "PRINTED"
        if "density" in print_settings:
            obj.body_moments.density = print_settings.pop("density")
        set_print(obj.body_moments, print_settings)
        unread = [finding(UNCHECKED, subject=PRINT_SETTINGS)] * (part.print_settings is None)
        cut = [finding(streams.NEGATIVE_PARTS_CUT, names=negative_names)] if negative_names else []
        notes[obj.name] = (*unread, *cut)
        if part.hidden:
            hidden[obj.name] = finding(FILE_HIDES, cause=part.hidden)
        obj.matrix_basis = Matrix(part.matrix)
        if (
            np.abs(np.array(obj.matrix_basis) - part.matrix).max()
            > _SHEAR * np.abs(part.matrix).max()
        ):
            obj.matrix_basis = Matrix()  # The channels of an object hold no shear, its mesh does.
            obj.data = _mesh(
                replace(part, points=part.points @ part.matrix[:3, :3].T + part.matrix[:3, 3])
            )
    bpy.context.view_layer.update()
    return Opened(tuple(errors), by_object=notes, hidden=hidden)


def _without_negative_parts(
    placed: list[streams.Placed], errors: list[Finding]
) -> Iterator[tuple[streams.Placed, list[str]]]:
    """Yield the meshes with negative parts cut away, each with the names of its negative parts. A
    mesh that cannot be cut is left out, and an error is added to `errors`.

    Negative parts themselves are yielded as hidden. A cut mesh has a key of its own.
    """
    for number, solid_part in enumerate(placed):
        if solid_part.is_negative:
            yield (
                replace(
                    solid_part, hidden=solid_part.hidden or "it is cut away from the other parts"
                ),
                [],
            )
            continue
        cutters = [
            part
            for part in placed
            if part.is_negative and part.item == solid_part.item and not part.hidden
        ]
        if solid_part.hidden or not cutters:
            yield solid_part, []
            continue
        names = [cutter.name for cutter in cutters]
        inverse = np.linalg.inv(solid_part.matrix)
        surfaces = [_closed_surface(part, inverse @ part.matrix) for part in (solid_part, *cutters)]
        closed = [surface for surface in surfaces if surface is not None]
        left = (
            bodies.union.subtract(closed[0], closed[1:]) if len(closed) == len(surfaces) else None
        )
        if left is not None and left.triangle_count:
            triangles = left.all_triangles()[0].astype(np.int64)
            yield replace(solid_part, key=(number,), points=left.points, triangles=triangles), names
            continue
        cause = "they cover all of it"
        if left is None:
            cause = "the surfaces are not closed, or Blender's Boolean fails with them"
        errors.append(
            finding(streams.NEGATIVE_PARTS_UNFIT, names=names, object=solid_part.name, cause=cause)
        )


def _closed_surface(part: streams.Placed, matrix: NDArray) -> Surface | None:
    """Return a part in its place with faces outward, or None if it is not closed."""
    surface = Surface.from_triangles(part.points, part.triangles)
    solid = measure_solid(surface.transform(matrix[:3, :3], matrix[:3, 3]))
    is_closed = solid.method in (verdict.Procedure.EXACT, verdict.Procedure.REORIENTED)
    return solid.repaired_surface if is_closed else None


def _mesh(part: streams.Placed) -> bpy.types.Mesh:
    return blender_mesh(
        streams.FileMesh(
            part.name, part.points, part.triangles.ravel(), np.full(len(part.triangles), 3)
        )
    )


def import_cad(path: str) -> Opened:
    """Add the surfaces of a file to the scene, in meters. Raises FileError and OSError."""
    file = cad.read_surfaces(path, files.file_limits(), for_blender=False)
    unit = 1.0 if file.unit is None else file.unit
    objects = scene.imports.show_bodies(file.bodies, bpy.context.scene.collection, unit)
    bpy.context.view_layer.update()
    unread = (finding(cad.FACES_NOT_READ, count=file.unread),) if file.unread else ()
    by_object: dict[str, tuple[Finding, ...]] = {obj.name: unread for obj in objects}
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
