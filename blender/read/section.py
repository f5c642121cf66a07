# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs of a plane section: selected faces, an object's faces, or the outlines of 2-D curves
and text.

Blender fills outlines that touch, coincide or cross wrongly, without a warning, so edges of a copy
without fill are read. Only a text on a curve is read by its fill.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

from ...core.bodies import DRAWN_AS_POLYGONS, Reading
from ...core.flat import NO_SECTION_AREA
from ...core.mesh import Surface, triangle_areas
from ...core.numerics import Array, Index, Mask, NDArray, polar_rotation
from ...core.nurbs import Curve
from ...core.verdict import Finding, ReadError, finding
from .curves import read_curves, text_curves
from .decisions import render_findings
from .findings import (
    EXTRUDED,
    FILL_MODIFIED,
    FLAT_UNSUITABLE,
    MODIFIERS_LEFT_OUT,
    NOT_FILLED,
    SECTION_FILL,
    SECTION_SPLINES_OPEN,
    WRONG_TYPE,
)
from .mesh import from_edit_mesh, mesh_surface, read_array
from .objects import locate, read_object, require_finite
from .visibility import SECTION_TYPES

ZERO_SCALE = 1e-17  # a scale that `decompose()` takes for zero


@dataclass
class SectionReading:
    """Faces or outlines as arrays, in the world, Blender units.

    description: of the object or part, in words. points: (n, 3). triangles: (m, 3), facing as
    drawn, and faces: (m,) the face of each; of outlines, the triangles are fans that give the
    plane, and loops has the points of each closed outline in order. facing: (3,) front of the
    plane, None if the triangles decide. error: largest effect of float32 storage on a point.
    drawn_area: the area that Blender fills, of outlines in a plane. rotation, location: the object
    frame; if a zero scale leaves `decompose()` without a rotation, the remaining right-angled axes.
    """

    name: str
    description: str
    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    faces: NDArray[np.integer]
    error: float
    rotation: Array
    location: Array
    loops: Sequence[NDArray[np.integer]] | None = None
    facing: Array | None = None
    drawn_area: float | None = None
    findings: list[Finding] = field(default_factory=list)


def read_section(
    obj, depsgraph, *, selected: bool = True, resolution: int | None = None
) -> SectionReading:
    """Read an object's faces (in Edit Mode only the `selected` ones) or its outlines, or raise
    ReadError.
    """
    obj = obj.original
    if obj.type not in SECTION_TYPES:
        raise ReadError(FLAT_UNSUITABLE, fault=WRONG_TYPE, subject=obj.name)
    if selected and obj.type == "MESH" and obj.data.is_editmode:
        return _selected_faces(obj, depsgraph)
    if obj.type in {"CURVE", "FONT"} and not any(
        modifier.show_viewport for modifier in obj.modifiers
    ):
        return _outlines(obj, depsgraph, resolution)
    reading = read_object(obj, depsgraph, edges=False)
    findings = list(reading.findings)
    if obj.type in {"CURVE", "FONT"}:
        findings.append(finding(SECTION_FILL, treatment=FILL_MODIFIED))
    surface = reading.join()
    triangles, faces = surface.all_triangles()
    return _section("All Faces", surface, triangles, faces, reading, findings=findings)


def read_outline_curves(obj, depsgraph) -> tuple[list[Curve], Array]:
    """Return the outlines of a flat curve or text without modifiers in its own coordinates, and its
    `matrix_world`.
    """
    obj = obj.original
    curves = text_curves(obj, depsgraph) if obj.type == "FONT" else read_curves(obj, depsgraph)[0]
    return curves, locate(obj, depsgraph).matrix


def _section(
    description: str,
    surface: Surface,
    triangles: NDArray,
    faces: NDArray,
    place: Reading,
    **more: Any,
) -> SectionReading:
    """Return the reading of (m, 3) triangles of a surface, and the (m,) face of each; more: further
    fields.
    """
    shortest = np.sqrt((place.matrix[:, :3] ** 2).sum(axis=0)).min()
    axes = polar_rotation(place.matrix[None])[0][0] if shortest < ZERO_SCALE else place.rotation
    error = float(np.linalg.norm(surface.coordinate_error))
    return SectionReading(
        place.name,
        description,
        surface.points,
        triangles,
        faces,
        error,
        axes,
        place.location,
        **more,
    )


def _selected_faces(obj, depsgraph) -> SectionReading:
    def read_copy(copy: bpy.types.Mesh) -> tuple[Mask, Surface]:
        is_selected = read_array(copy.polygons, "select", (len(copy.polygons),), bool)
        return is_selected, mesh_surface(copy, edges=False)

    is_selected, surface = from_edit_mesh(obj.data, read_copy)
    if not is_selected.any():
        raise ReadError(
            NO_SECTION_AREA,
            fault="no face is selected. Select the faces of the section",
            subject=obj.name,
        )
    place = locate(obj, depsgraph)
    surface = surface.transform(place.matrix[:3, :3], place.matrix[:3, 3])
    triangles, faces = surface.all_triangles()
    is_of_section = is_selected[faces]
    require_finite(obj, surface.points)  # all points bound the effect of float32 on any
    acting = [modifier.name for modifier in obj.modifiers if modifier.show_viewport]
    findings = [finding(MODIFIERS_LEFT_OUT, modifiers=acting)] if acting else []
    count = int(np.count_nonzero(is_selected))
    description = "1 Selected Face" if count == 1 else f"{count} Selected Faces"
    return _section(
        description,
        surface,
        triangles[is_of_section],
        faces[is_of_section],
        place,
        findings=findings,
    )


def _outlines(obj, depsgraph, resolution: int | None) -> SectionReading:
    """Read the outlines of a flat curve or text; a text on a curve by its fill."""
    curve = obj.data
    is_spatial = obj.type == "CURVE" and curve.dimensions != "2D"
    has_bevel = curve.bevel_depth or (curve.bevel_mode == "OBJECT" and curve.bevel_object)
    if is_spatial or curve.extrude or curve.offset or has_bevel:
        raise ReadError(FLAT_UNSUITABLE, fault=EXTRUDED, subject=obj.name)
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    local, loops, open_splines = _spline_outlines(obj, resolution)
    if not loops:
        raise ReadError(
            NO_SECTION_AREA,
            fault=(
                "there is no closed outline. Close the splines with Toggle Cyclic, or type a text"
            ),
            subject=obj.name,
        )
    place = locate(obj, depsgraph)
    linear = place.matrix[:3, :3]
    facing = np.cross(linear[:, 0], linear[:, 1]) * np.sign(np.linalg.det(linear) or 1.0)
    filled = _drawn_fill(obj, depsgraph)
    drawn_area = None
    if obj.type == "FONT" and obj.data.follow_curve is not None:
        # Only the evaluated text follows its curve, and only its fill is there to be read.
        if filled is None:
            raise ReadError(
                NO_SECTION_AREA,
                fault=(
                    "the text follows a curve and is not filled. Fill it, or use Object "
                    "> Convert > Mesh"
                ),
                subject=obj.name,
            )
        surface = filled.transform(linear, place.matrix[:3, 3])
        loops = None
        triangles, faces = surface.all_triangles()
    else:
        surface = Surface(local).transform(linear, place.matrix[:3, 3])
        # triangles between the first point of a loop and each of its other edges
        fans = [
            np.stack([np.full(len(loop) - 2, loop[0]), loop[1:-1], loop[2:]], axis=1)
            for loop in loops
        ]
        triangles = np.concatenate(fans)
        faces = np.arange(len(triangles))
        if filled is not None:
            areas = triangle_areas(filled.points.astype(np.float64), filled.all_triangles()[0])
            drawn_area = float(areas.sum() * np.sqrt(facing @ facing))
    require_finite(obj, surface.points)
    return _section(
        "Text" if obj.type == "FONT" else "Curve",
        surface,
        triangles,
        faces,
        place,
        loops=loops,
        facing=facing,
        drawn_area=drawn_area,
        findings=list(_outline_findings(obj, depsgraph.scene, open_splines)),
    )


def _drawn_fill(obj, depsgraph) -> Surface | None:
    """Return the faces with which Blender fills outlines, in the object's coordinates, or None."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    filled = mesh_surface(mesh, edges=False) if mesh is not None and len(mesh.polygons) else None
    evaluated.to_mesh_clear()
    return filled


def _outline_findings(obj, scene, open_splines: int) -> Iterator[Finding]:
    if open_splines:
        yield finding(SECTION_SPLINES_OPEN, count=open_splines)
    if obj.data.fill_mode == "NONE":
        yield finding(SECTION_FILL, treatment=NOT_FILLED)
    is_polygonal = obj.type != "FONT" and all(spline.type == "POLY" for spline in obj.data.splines)
    if not is_polygonal:
        yield finding(DRAWN_AS_POLYGONS)
    yield from render_findings(obj, scene, exact=is_polygonal)


def _spline_outlines(obj, resolution: int | None) -> tuple[NDArray[np.float32], list[Index], int]:
    """Return (n, 3) spline points, the indices of each closed spline's points, and the number of
    open splines.
    """
    data = obj.data.copy()
    data.dimensions = "2D"
    data.fill_mode = "NONE"
    if resolution is not None:
        for curved in (data, *data.splines):
            curved.resolution_u = resolution
    copy = bpy.data.objects.new("Body Moments Reading", data)
    try:
        mesh = copy.to_mesh()
        if mesh is None:
            return np.empty((0, 3), np.float32), [], 0
        points = read_array(mesh.vertices, "co", (len(mesh.vertices), 3), np.float32)
        edges = read_array(mesh.edges, "vertices", (len(mesh.edges), 2), np.int32)
        copy.to_mesh_clear()
    finally:
        bpy.data.curves.remove(data)  # and the object with it
    # Each spline is a row of points; the edge that closes it leads back from its last one to its
    # first.
    closing = edges[edges[:, 1] < edges[:, 0]].tolist()  # (last, first) points of closed splines
    loops = [np.arange(first, last + 1) for last, first in closing if last - first >= 2]
    is_closed = np.zeros(len(points), bool)
    for last, first in closing:
        is_closed[first : last + 1] = True
    # An open spline has one point more than edges.
    steps = edges[edges[:, 1] == edges[:, 0] + 1]
    open_points = int(np.count_nonzero(~is_closed))
    open_edges = int(np.count_nonzero(~is_closed[steps[:, 0]]))
    return points, loops, open_points - open_edges
