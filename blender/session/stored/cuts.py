# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of liquids in vessels, and cut and fill of surfaces: computed on request, and remembered
until the object, its place or the unit changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial

import bmesh
import bpy
import numpy as np
from bpy.types import Context, Mesh, Object, Scene
from mathutils import Vector

from ....core import bodies, cuts, numerics, verdict
from ... import read, scale
from ...bodies.cuts import cut_fill_against, world_surface
from ...bodies.measure_body import THREADS, measure_body
from ...bodies.mesh import mesh_body
from ...scene.rigid_world import down
from ...settings.options import object_settings
from .. import memory
from ..findings import NO_SUCH_NAME
from ..tracking import staleness
from ..tracking.stamps import Kind

MAX_TILTED_TRIANGLES = 20_000  # the spill tilt of larger vessels is not computed


@dataclass(eq=False)
class Level:
    """A liquid in a vessel, in meters and the world.

    height: of its surface, against gravity from the world's origin. density: kg/m³. tilt: at which
    it spills, rad; None if not computed.
    """

    hollow: cuts.Hollow
    height: float
    liquid: cuts.PartBelow
    density: float
    tilt: float | None

    @property
    def volume(self) -> float:
        return float(self.liquid.volume[0])

    @cached_property
    def surface_moments(self) -> tuple[float, float, float]:
        """The area of the free surface, m², and its least and largest second moment about its
        centroid, m⁴; zeros if there is none.
        """
        surface = self.hollow.free_surface(self.liquid, self.height)
        if surface is None:
            return 0.0, 0.0, 0.0
        # The smallest eigenvalue is that across the surface, zero.
        _, low, high = np.linalg.eigvalsh(surface.about_center().second()).tolist()
        return surface.total, low, high

    @cached_property
    def table(self) -> numerics.Array:
        """(33, 2) heights over the bottom, m, and volumes, m³, up to the spill height."""
        heights = np.linspace(self.hollow.bottom, self.hollow.spill, cuts.TABLE_ROWS)
        return np.stack([heights - self.hollow.bottom, self.hollow.below(heights).volume], axis=1)

    @cached_property
    def triangles(self) -> numerics.Array:
        """(k, 3, 3) corners of the surface's triangles, in m in the world; none if it is empty."""
        if not self.surface_moments[0]:
            return np.empty((0, 3, 3))
        edited = self.cut()
        places = [[vertex.co for vertex in face.verts] for face in edited.faces]
        edited.free()
        return np.array(places, np.float64).reshape(-1, 3, 3) + self.liquid.face.center[0]

    def cut(self) -> bmesh.types.BMesh:
        """Return the surface as triangles about its centroid, in m, as a BMesh that the caller has
        to free.
        """
        hollow = self.hollow
        origin = self.liquid.face.center[0]
        # A plane through the rim's edges alone cuts no face. So a vessel that is full to the rim is
        # raised by a millionth of its size: over 10 times the rounding of float32 coordinates.
        step = 1e-6 * float(np.ptp(hollow.points, axis=0).max())
        raised = max(self.height - max(hollow.spill - step, hollow.bottom), 0.0) * hollow.up
        edited = bmesh.new()
        vertices = [edited.verts.new(point) for point in hollow.points - origin + raised]
        # A mesh may have a face twice, but a BMesh may not. The order of corners has no effect.
        for triangle in np.unique(np.sort(hollow.triangles, axis=1), axis=0).tolist():
            edited.faces.new([vertices[i] for i in triangle])
        everything = [*edited.verts, *edited.edges, *edited.faces]
        up = Vector(hollow.up)
        bisection = bmesh.ops.bisect_plane(edited, geom=everything, plane_co=(0, 0, 0), plane_no=up)
        edges = [item for item in bisection["geom_cut"] if isinstance(item, bmesh.types.BMEdge)]
        # Deleting the vessel's faces leaves the section's edges, which are filled.
        surface_vertices = {vertex for edge in edges for vertex in edge.verts}
        bmesh.ops.delete(edited, geom=[*edited.faces], context="FACES_ONLY")
        edges = [edge for edge in edges if edge.is_valid]
        bmesh.ops.triangle_fill(edited, use_beauty=True, edges=edges, normal=up)
        stray_vertices = [
            vertex
            for vertex in edited.verts
            if vertex not in surface_vertices or not vertex.link_faces
        ]
        bmesh.ops.delete(edited, geom=stray_vertices, context="VERTS")
        return edited


@dataclass(frozen=True, eq=False)
class KnownCutFill:
    """Cut and fill of a surface, and findings about them."""

    cut_fill: cuts.CutFill
    findings: tuple[verdict.Finding, ...]


def _vessel(
    obj: Object, context: Context
) -> tuple[numerics.Array, numerics.Integers, numerics.Array]:
    """Return points (m, world) and triangles of a vessel, and the direction against gravity."""
    depsgraph = context.evaluated_depsgraph_get()
    settings = object_settings(obj, context.scene)
    if settings.kind == "shell" and settings.wall != "thin":
        surface = bodies.vessel_surface(measure_body(obj, depsgraph).body)
    else:
        reading = read.objects.read_object(obj, depsgraph, edges=False)
        body = partial(
            mesh_body, reading, scale.meters_per_unit(context.scene), shell=False, threads=THREADS
        )
        # Overlapping components are united if the settings say so, as a union takes longer.
        try:
            surface = bodies.vessel_surface(body(union=False))
        except verdict.MeasureError:
            if settings.overlap != "union":
                raise
            surface = bodies.vessel_surface(body(union=True))
    return surface.points.astype(np.float64), surface.all_triangles()[0], -down(context.scene)


def fill_vessel(context: Context, obj: Object, by: str, amount: float, density: float) -> Level:
    """Compute and remember the level of a liquid; MeasureError if the vessel does not hold it.

    amount: height (m), volume (m³) or mass (kg), as `by` says: LEVEL, VOLUME, MASS.
    """
    points, triangles, up = _vessel(obj, context)
    hollow = cuts.find_hollow(points, triangles, up)
    height = amount
    if by != "LEVEL":
        height = hollow.level_of(amount / (density if by == "MASS" else 1.0))
    liquid = hollow.contents(height)
    tilt = None
    if len(triangles) <= MAX_TILTED_TRIANGLES:
        tilt, _direction = cuts.spill_tilt(points, triangles, float(liquid.volume[0]), up)
    level = Level(hollow, min(height, hollow.spill), liquid, density, tilt)
    memory.levels[obj] = level
    staleness.carry(obj, Kind.LEVEL, context.evaluated_depsgraph_get())
    return level


def measure_cut_fill(
    context: Context, obj: Object, against: str, height: float, reference_name: str
) -> KnownCutFill:
    """Compute and remember cut and fill of an open surface. against: "RIM", the plane through its
    rim; "OBJECT", the surface of the object with the reference's name; else the height, m.
    """
    depsgraph = context.evaluated_depsgraph_get()
    unit = scale.meters_per_unit(context.scene)
    surface = world_surface(obj, depsgraph, unit)
    if against == "OBJECT":
        reference = context.scene.objects.get(reference_name)
        if reference is None:
            raise verdict.QueryError(NO_SUCH_NAME, kind="object", name=reference_name)
        cut_fill = cut_fill_against(reference, surface, depsgraph, unit)
    else:
        cut_fill = cuts.surface_cut_fill(surface, None if against == "RIM" else height)
    known_cut_fill = KnownCutFill(cut_fill, cuts.partly_compared(cut_fill))
    memory.cut_fills[obj] = known_cut_fill
    staleness.carry(obj, Kind.CUT_FILL, context.evaluated_depsgraph_get())
    return known_cut_fill


def level_of(obj: Object, scene: Scene) -> Level | None:
    """Return the remembered level; None if there is none or it is out of date."""
    return None if staleness.stale_reason(obj, scene, Kind.LEVEL) else memory.levels.get(obj)


def add_surface(context: Context, obj: Object, level: Level) -> Object:
    """Add a mesh object of the liquid's surface, with its level in the object's name."""
    unit = scale.meters_per_unit(context.scene)
    edited = level.cut()
    bmesh.ops.scale(edited, vec=Vector((1, 1, 1)) / unit, verts=edited.verts)
    return _add_mesh(context, obj.name + " Level", edited, level.liquid.face.center[0] / unit)


def add_table(context: Context, obj: Object, level: Level) -> Object:
    """Add a mesh curve of the level table: volumes along X, heights along Z, both 0 to 1 of the
    full vessel.
    """
    edited = bmesh.new()
    vertices = [
        edited.verts.new((volume, 0.0, height))
        for height, volume in (level.table / level.table.max(axis=0)).tolist()
    ]
    for start, stop in zip(vertices, vertices[1:]):
        edited.edges.new((start, stop))
    return _add_mesh(
        context, obj.name + " Level Table", edited, np.array(obj.matrix_world.translation)
    )


def _add_mesh(
    context: Context, name: str, edited: bmesh.types.BMesh, place: numerics.Array
) -> Object:
    """Add a mesh object at a place, in Blender units, and free the BMesh."""
    mesh: Mesh = bpy.data.meshes.new(name)
    edited.to_mesh(mesh)
    edited.free()
    added = bpy.data.objects.new(name, mesh)
    added.location = place
    context.collection.objects.link(added)
    return added
