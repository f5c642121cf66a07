# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sculpt Balance: move chosen vertices least so that the center of mass comes over a point, "make it stand".

Which vertices: the selected ones in Edit Mode, those of a vertex group in Object Mode, as willingly as their weights
say. The change is made on the mesh itself and measured again, the way the object is always measured; where faces that
are not flat were cut anew by it, it is found again for the new cut. What does not come there is put back.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import bmesh
import bpy
import numpy as np
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, StringProperty
from bpy.types import Context, Object, Operator
from numpy.typing import NDArray

from ....core.measurement import Measurement
from ....core.mesh.surface import Surface
from ....core.moments.moments import Measure
from ....core.numerics.float32 import decimal
from ....core.statics.balance import Balanced, balance
from ...bodies.measure_object import measure_object
from ...read import Part, read_object
from ...read.quiet import paused
from ...scene.transforms import FLOAT32, Refused
from ...write.units import Units
from .. import selection
from . import base as snapping

ATTEMPTS = 6  # at a cut of faces that suits the shape that it leads to
THERE = 1e-6  # of the body's size: what float32 coordinates leave of a center


class OBJECT_OT_body_moments_sculpt_balance(Operator):
    """Move vertices as little as possible so that the center of mass comes over a point"""

    bl_idname = "object.body_moments_sculpt_balance"
    bl_label = "Sculpt Balance"
    bl_description = (
        "Make it stand: move the selected vertices (in Object Mode those of a vertex group) as "
        "little as possible so that the center of mass comes over a point"
    )
    bl_options = {"REGISTER", "UNDO"}

    target: EnumProperty(
        name="Over",
        description="Where the center of mass shall come",
        items=(
            ("CURSOR", "3D Cursor", "The 3D cursor"),
            ("POINT", "Point", "A point in the world, given below"),
        ),
        default="CURSOR",
    )
    point: FloatVectorProperty(
        name="Point",
        description="The point in the world that the center of mass shall come over",
        subtype="TRANSLATION",
    )
    axes: EnumProperty(
        name="Match",
        description="In which directions the center of mass shall come to the point",
        items=(
            (
                "ALONG_GRAVITY",
                "Over It",
                "Onto the line through the point along gravity, at whatever height",
            ),
            ("ALL", "On It", "Onto the point itself"),
        ),
        default="ALONG_GRAVITY",
    )
    limit: FloatProperty(
        name="Largest Move",
        description="How far each vertex may move; 0 for as far as the mesh is large",
        default=0.0,
        min=0.0,
        unit="LENGTH",
        precision=4,
    )
    group: StringProperty(
        name="Vertex Group",
        description=(
            "In Object Mode, the vertices that may move, as willingly as they weigh; the active "
            "group where none is named"
        ),
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = context.active_object
        if obj is None or obj.type != "MESH":
            cls.poll_message_set("Make a mesh the active object")
            return False
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            cls.poll_message_set("Switch to Edit Mode and select the vertices that may move")
            return False
        if context.mode == "OBJECT" and not obj.vertex_groups:
            cls.poll_message_set("Select the vertices that may move in Edit Mode, or give the object a vertex group")
            return False
        return True

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "target")
        if self.target == "POINT":
            layout.prop(self, "point")
        layout.prop(self, "axes")
        layout.prop(self, "limit")
        if context.mode == "OBJECT":
            layout.prop_search(self, "group", context.active_object, "vertex_groups")

    def execute(self, context: Context) -> set[str]:
        obj = context.active_object
        unit = decimal(context.scene.unit_settings.scale_length)
        target = context.scene.cursor.location if self.target == "CURSOR" else self.point
        wanted = _Wanted(
            np.array(target, np.float64) * unit,
            np.eye(3) if self.axes == "ALL" else _across(context.scene),
            self.limit * unit,
        )
        try:
            mesh = _EditedMesh(obj) if obj.mode == "EDIT" else _GroupedMesh(obj, self.group)
            with paused():  # what is tried and put back is no edit
                told, notes = _balance(context, obj, mesh, wanted, unit)
            obj.data.update_tag()  # for others that show the mesh it is one
        except snapping.REFUSALS as error:
            reason = str(getattr(error, "reason", error))
            return selection.summarise(self, 0, 1, "", [(obj.name, reason)])
        snapping.refresh(context, [obj])
        return selection.summarise(self, 1, 1, told, notes=notes)


@dataclass(frozen=True)
class _Wanted:
    """point: (3,) in m, across: (r, 3) along which directions, limit: of a move in m, 0 for the size of the body."""

    point: NDArray[np.float64]
    across: NDArray[np.float64]
    limit: float


def _across(scene: bpy.types.Scene) -> NDArray[np.float64]:
    """(2, 3) the two directions across gravity, or across Z where there is none."""
    down = np.array(scene.gravity, np.float64) if scene.use_gravity else np.zeros(3)
    if not down.any():
        down = np.array((0.0, 0.0, -1.0))
    down /= np.linalg.norm(down)
    side = np.cross(down, np.eye(3)[np.argmin(np.abs(down))])
    side /= np.linalg.norm(side)
    return np.array([side, np.cross(down, side)])


class _EditedMesh:
    """The mesh of an object in Edit Mode; a BMesh gives and takes its vertices one by one only."""

    def __init__(self, obj: Object):
        self.obj, self.changed = obj, False
        vertices = self._vertices()
        self.start = np.array([vertex.co[:] for vertex in vertices], np.float32).reshape(-1, 3)
        selected = np.fromiter((vertex.select and not vertex.hide for vertex in vertices), bool, len(vertices))
        self.movable = np.flatnonzero(selected)
        self.willing = np.ones(len(self.movable))
        if not len(self.movable):
            raise Refused("no vertex is selected; select those that may move")

    def _vertices(self) -> bmesh.types.BMVertSeq:
        return bmesh.from_edit_mesh(self.obj.data).verts

    def put(self, points: NDArray[np.float32]) -> None:
        """(n, 3) where the vertices go."""
        self.changed = True
        vertices = self._vertices()
        vertices.ensure_lookup_table()
        for index in self.movable.tolist():
            vertices[index].co = points[index].tolist()
        mesh = bmesh.from_edit_mesh(self.obj.data)
        mesh.normal_update()
        bmesh.update_edit_mesh(self.obj.data, loop_triangles=True, destructive=False)


class _GroupedMesh:
    """The mesh of an object in Object Mode, and a vertex group of it."""

    def __init__(self, obj: Object, name: str):
        group = obj.vertex_groups.get(name) if name else obj.vertex_groups.active
        if group is None:
            raise Refused("it has no vertex group {:s}; name one that holds the vertices that may move".format(name))
        self.mesh, self.changed = obj.data, False
        weights = np.zeros(len(self.mesh.vertices))
        for vertex in self.mesh.vertices:  # Blender gives weights one by one only
            for entry in vertex.groups:
                if entry.group == group.index:
                    weights[vertex.index] = entry.weight
        self.movable = np.flatnonzero(weights > 0.0)
        self.willing = weights[self.movable]
        if not len(self.movable):
            raise Refused(
                "no vertex has a weight in its vertex group {:s}; assign those that may move".format(group.name)
            )
        self.start = np.empty(3 * len(weights), np.float32)
        self.mesh.attributes["position"].data.foreach_get("vector", self.start)
        self.start = self.start.reshape(-1, 3)

    def put(self, points: NDArray[np.float32]) -> None:
        """(n, 3) where the vertices go."""
        self.changed = True
        self.mesh.attributes["position"].data.foreach_set("vector", np.ascontiguousarray(points).ravel())
        self.mesh.update()


def _balance(
    context: Context, obj: Object, mesh: _EditedMesh | _GroupedMesh, wanted: _Wanted, unit: float
) -> tuple[str, list[str]]:
    """Carry it out, or leave all as it was. Returns what to report."""
    _check(obj)
    part = _read(context, obj, mesh)
    before = _measured(context, obj)
    linear, offset = part.matrices[0, :3, :3] * unit, part.matrices[0, :3, 3] * unit
    start = part.surface.mapped(linear, offset)
    size = float(np.linalg.norm(np.ptp(start.points, axis=0)))
    tolerance = THERE * size + 4.0 * FLOAT32 * np.abs(np.concatenate([start.points, [wanted.point]])).max()
    with _put_back(context, mesh):
        surface = start
        for _ in range(ATTEMPTS):
            found = balance(
                surface,
                mesh.movable,
                wanted.point,
                across=wanted.across,
                willing=mesh.willing,
                limit=wanted.limit or size,
                shell=before.kind == "shell",
            )
            points = _moved(mesh, found, start, linear)
            mesh.put(points)
            context.view_layer.update()
            after = _measured(context, obj)
            off = np.abs(wanted.across @ (wanted.point - after.mass_properties.center)).max()
            if off <= tolerance:
                break
            surface = replace(_read(context, obj, None).surface.mapped(linear, offset), points=start.points)
        else:
            raise Refused("its faces are cut differently with every change; triangulate the mesh itself first")
    units = Units.of(context.scene.unit_settings)
    moves = (points[mesh.movable].astype(np.float64) - mesh.start[mesh.movable]) @ linear.T
    number, largest = int(np.count_nonzero(moves.any(axis=1))), float(np.linalg.norm(moves, axis=1).max())
    told = "Moved {:s} by at most {:s}: the center of mass went from {:s} to {:s}".format(
        "1 vertex" if number == 1 else "{:d} vertices".format(number),
        units.text("length", largest),
        *(
            "({:s})".format(", ".join(units.texts("length", one.mass_properties.center, size)))
            for one in (before, after)
        ),
    )
    notes = []
    if obj.data.users - obj.data.use_fake_user > 1:
        notes.append("Other objects use its mesh and have changed with it")
    if any(
        other.type == "MESH" and other.data.is_editmode and other.data != obj.data
        for other in context.view_layer.objects
    ):
        notes.append("Only {:s} was balanced; the others in Edit Mode are as they were".format(obj.name))
    return told, notes


@contextmanager
def _put_back(context: Context, mesh: _EditedMesh | _GroupedMesh) -> Iterator[None]:
    """Put the vertices back where something fails in here."""
    try:
        yield
    except BaseException:
        if mesh.changed:
            mesh.put(mesh.start)
            context.view_layer.update()
        raise


def _check(obj: Object) -> None:
    """Refused where the mesh cannot be changed, or its change is not the object's."""
    if not obj.data.is_editable:
        raise Refused("its mesh is linked from another file; make it local first")
    if obj.data.shape_keys is not None:
        raise Refused("it has shape keys, which hold shapes of their own; apply or remove them first")
    if obj.body_moments.kind == "SHELL" and obj.body_moments.wall != "THIN":
        raise Refused("it is a shell of real thickness; set Wall to Thin for balancing, which is good for thin ones")


def _measured(context: Context, obj: Object) -> Measurement:
    """The object as it is always measured; Refused where its center cannot be differentiated by its vertices."""
    found = measure_object(obj, context.evaluated_depsgraph_get())
    if found.mass_moments[0].of == Measure.MASS:
        raise Refused("its density is not the same everywhere; balance it with one density")
    if found.kind == "solid" and (found.method != "exact" or found.health.welded):
        raise Refused(
            "it is not closed with all faces outward as it stands; merge it by distance, close it and "
            "recalculate its normals first, or measure it as a shell"
        )
    return found


def _read(context: Context, obj: Object, mesh: _EditedMesh | _GroupedMesh | None) -> Part:
    """The surface as it is measured; Refused where its vertices are not those of the mesh."""
    reading = read_object(obj, context.evaluated_depsgraph_get(), edges=False)
    part = reading.parts[0]
    if reading.singular:
        raise Refused("a zero scale flattens it; set its scale first")
    if reading.places > 1:
        raise Refused("it shows instances, whose vertices are not its own; make them real first")
    if mesh is not None and not (
        part.surface.points.shape == mesh.start.shape and np.array_equal(part.surface.points, mesh.start)
    ):
        shown = [modifier.name for modifier in obj.modifiers if modifier.show_viewport]
        raise Refused(
            "what is measured is not the mesh itself but what {:s} make of it; apply or hide them first".format(
                ", ".join(shown) or "its animation, constraints or instances"
            )
        )
    return part


def _moved(mesh: _EditedMesh | _GroupedMesh, found: Balanced, start: Surface, linear: NDArray) -> NDArray[np.float32]:
    """(n, 3) the mesh's own coordinates: those that do not move to the bit."""
    points = mesh.start.copy()
    moves = found.points[mesh.movable] - start.points[mesh.movable]
    local = mesh.start[mesh.movable].astype(np.float64) + np.linalg.solve(linear, moves.T).T
    points[mesh.movable] = local.astype(np.float32)
    return points


CLASSES = (OBJECT_OT_body_moments_sculpt_balance,)
