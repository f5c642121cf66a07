# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance: chosen vertices of a mesh are moved as little as brings its center of mass over a
point.

Without chosen vertices the body leans: each vertex moves in proportion to its height, so that no
face turns over. The change is made on the mesh itself, and the object is measured again in the
usual way. If faces that are not flat are then cut into other triangles, the change is solved again
for these. Of a body that counts as a union, the changes are solved for its shells, and aimed until
the center of the union is there. A change that misses the point is undone.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bmesh
import numpy as np
from bpy.types import Context, Object

from ...core.bodies import Part
from ...core.measurement import Measurement
from ...core.moments import Measure
from ...core.numerics import Array, NDArray
from ...core.statics import BALANCE_NO_EFFECT, BALANCE_SHORT, balance
from ...core.verdict import (
    LINKED_OBJECT,
    EditRefusedError,
    MeasureError,
    Method,
    Procedure,
    Severity,
    of_severity,
)
from ..bodies.measure_object import measure_object
from ..read.findings import SCALE_ZERO_AXIS
from ..read.mesh import vertex_points
from ..read.objects import read_object
from ..read.tracking import tracking_paused
from ..scale import meters_per_unit
from .findings import (
    BALANCE_IMPOSSIBLE,
    BALANCE_SETTINGS,
    OTHER_SHAPES,
    SHAPE_NOT_OF_MESH,
)
from .rigid_world import down
from .transforms import FLOAT32

MAX_ATTEMPTS = 6  # at a change that keeps the triangles that it was solved for
MAX_UNION_ATTEMPTS = 25  # the changes are solved for the shells, whose center moves otherwise
REACHED_RTOL = 1e-6  # rounding of a center in float32, relative to the body's size
ROUNDING = 1e-7  # relative to the body's size; a coordinate below is reported as 0


@dataclass(frozen=True)
class Balanced:
    """The number of moved vertices, the longest move in m, and (3,) the center of mass before and
    after, in m.
    """

    count: int
    distance: float
    start: list[float]
    end: list[float]


class _Vertices:
    """The vertices of a mesh that may move.

    start: (n, 3) points of the mesh. movable: (k,) indices. weights: (k,), how freely each moves.
    leans: whether the whole body leans.
    """

    start: NDArray[np.float32]
    is_changed = leans = False

    def choose(self, weights: Array) -> None:
        """Let the vertices with (n,) weights above 0 move; EditRefusedError if there are none."""
        self.movable = np.flatnonzero(weights > 0.0)
        self.weights = weights[self.movable]
        if not len(self.movable):
            raise EditRefusedError(
                BALANCE_IMPOSSIBLE,
                cause=(
                    "no vertices may move. Select some in Edit Mode, or choose a vertex "
                    "group that has some"
                ),
            )


class _EditedMesh(_Vertices):
    """The selected vertices in Edit Mode; a BMesh gives and takes its vertices one by one only."""

    def __init__(self, obj: Object):
        self.mesh = obj.data
        vertices = bmesh.from_edit_mesh(obj.data).verts
        self.start = np.array([vertex.co[:] for vertex in vertices], np.float32).reshape(-1, 3)
        self.choose(np.array([vertex.select for vertex in vertices], np.float64))

    def set_points(self, points: NDArray[np.float32]) -> None:
        """Move the movable vertices to their rows of (n, 3) points."""
        self.is_changed = True
        mesh = bmesh.from_edit_mesh(self.mesh)
        mesh.verts.ensure_lookup_table()
        for index in self.movable.tolist():
            mesh.verts[index].co = points[index].tolist()
        mesh.normal_update()
        bmesh.update_edit_mesh(self.mesh)


class _StoredMesh(_Vertices):
    """The vertices of one of the vertex groups of an object in Object Mode; without groups, all of
    them, which lean.
    """

    def __init__(self, obj: Object, name: str):
        self.mesh = obj.data
        self.start = vertex_points(obj.data)
        self.leans = not (name or obj.vertex_groups)
        group = obj.vertex_groups.get(name) if name else obj.vertex_groups.active
        weights = np.full(len(self.start), float(self.leans))
        if group is not None:
            for vertex in self.mesh.vertices:  # Blender gives weights one by one only
                for entry in vertex.groups:
                    if entry.group == group.index:
                        weights[vertex.index] = entry.weight
        self.choose(weights)

    def set_points(self, points: NDArray[np.float32]) -> None:
        """Move all vertices to (n, 3) points."""
        self.is_changed = True
        self.mesh.attributes["position"].data.foreach_set(
            "vector", np.ascontiguousarray(points).ravel()
        )
        self.mesh.vertices[0].co = self.mesh.vertices[
            0
        ].co  # makes Blender update normals and bounding box


@tracking_paused()  # a trial that is undone is not an edit
def balance_mesh(
    context: Context, obj: Object, group: str, point: Sequence[float], align: str, longest: float
) -> Balanced:
    """Move vertices so that the center of mass comes over a point, or raise MeasureError and leave
    them in place.
    """
    mesh = _EditedMesh(obj) if obj.mode == "EDIT" else _StoredMesh(obj, group)
    up = -down(context.scene)
    unit = meters_per_unit(context.scene)
    across = np.eye(3) if align == "ALL" else np.linalg.svd(up[None])[2][1:]
    target = np.array(point, np.float64) * unit
    _require_balanceable(obj)
    part = _read_surface(context, obj, mesh)
    before = _measure(context, obj)
    linear = part.matrices[0, :3, :3] * unit
    offset = part.matrices[0, :3, 3] * unit
    start = part.surface.transform(linear, offset)
    size = float(np.linalg.norm(np.ptp(start.points, axis=0)))
    tolerance = REACHED_RTOL * size + 4.0 * FLOAT32 * np.abs(start.points).max()
    limit = longest * unit or size
    shell = before.kind == "shell"
    movable = mesh.movable
    weights = mesh.weights
    try:
        surface = start
        moves = np.zeros_like(start.points)
        center = before.mass_properties.center
        is_union = before.method == Method(Procedure.UNION)
        aim = target.copy()
        effect = np.eye(3)  # of a change of the aim on the center
        step = np.zeros(3)
        for attempt in range(MAX_UNION_ATTEMPTS if is_union else MAX_ATTEMPTS):
            if mesh.leans:
                moves += _lean(
                    start.points,
                    before.mass_properties.center,
                    across.T @ (across @ (target - center)),
                    up,
                )
                far = float(np.linalg.norm(moves, axis=1).max())
                if far > limit:
                    short = float(np.linalg.norm(across @ (target - center))) * (1.0 - limit / far)
                    raise MeasureError(BALANCE_SHORT, distance=short, limit=limit)
            else:
                found = balance(
                    surface,
                    movable,
                    aim,
                    across=across,
                    weights=weights,
                    limit=limit,
                    shell=shell,
                )
                moves = found.points - start.points
            points = mesh.start.copy()  # vertices that are not movable stay to the bit
            points[movable] = (
                mesh.start[movable].astype(np.float64) + np.linalg.solve(linear, moves[movable].T).T
            )
            mesh.set_points(points)
            after = _measure(context, obj)
            last = center
            center = after.mass_properties.center
            if np.abs(across @ (target - center)).max() <= tolerance:
                break
            if is_union and not mesh.leans:  # Broyden's method
                if attempt:
                    effect += np.outer(center - last - effect @ step, step) / (step @ step)
                step = np.linalg.solve(effect, across.T @ (across @ (target - center)))
                aim = aim + step
            else:
                surface = replace(
                    _read_surface(context, obj, None).surface.transform(linear, offset),
                    points=start.points,
                )
        else:
            raise EditRefusedError(
                BALANCE_IMPOSSIBLE,
                cause="the triangulation changes with every move. Use Face > Triangulate Faces",
            )
    except BaseException:
        if mesh.is_changed:
            mesh.set_points(mesh.start)
            context.view_layer.update()
        raise
    obj.data.update_tag()  # for other objects with the mesh it is an edit
    moved = (points[movable].astype(np.float64) - mesh.start[movable]) @ linear.T
    number = int(np.count_nonzero(moved.any(axis=1)))
    largest = float(np.linalg.norm(moved, axis=1).max())
    centers = [
        np.where(np.abs(center) < ROUNDING * size, 0.0, center).tolist()
        for center in (before.mass_properties.center, after.mass_properties.center)
    ]
    return Balanced(number, largest, centers[0], centers[1])


def _lean(points: NDArray, center: NDArray, shift: NDArray, up: NDArray) -> Array:
    """Return (n, 3) moves in proportion to the height above the lowest of the points, by `shift` at
    the center.

    Raise MeasureError if the center is, or would come to be, no higher than the lowest point.
    """
    heights = points @ up - (points @ up).min()
    rise = center @ up - (points @ up).min()
    if min(rise, rise + shift @ up) <= REACHED_RTOL * np.linalg.norm(np.ptp(points, axis=0)):
        raise MeasureError(BALANCE_NO_EFFECT)
    return np.multiply.outer(heights / rise, shift)


def _require_balanceable(obj: Object) -> None:
    """Raise EditRefusedError if the mesh is linked or has shape keys, or the object is a shell with
    a real wall.
    """
    if not obj.data.is_editable:
        raise EditRefusedError(LINKED_OBJECT)
    if obj.data.shape_keys is not None:
        raise EditRefusedError(SHAPE_NOT_OF_MESH, makers=OTHER_SHAPES)
    if obj.body_moments.kind == "SHELL" and obj.body_moments.wall != "THIN":
        raise EditRefusedError(BALANCE_IMPOSSIBLE, cause=BALANCE_SETTINGS)


def _measure(context: Context, obj: Object) -> Measurement:
    """Measure the object in the usual way; EditRefusedError if its center cannot be differentiated
    by its vertices.
    """
    measurement = measure_object(obj, context.evaluated_depsgraph_get())
    if measurement.mass_moments[0].measure == Measure.MASS:
        raise EditRefusedError(BALANCE_IMPOSSIBLE, cause=BALANCE_SETTINGS)
    is_union = measurement.method == Method(Procedure.UNION)
    is_clean = measurement.method == Method(Procedure.EXACT) or (
        is_union and not of_severity(measurement.findings, Severity.WARNING)
    )
    if measurement.kind == "solid" and (not is_clean or measurement.health.welded):
        raise EditRefusedError(
            BALANCE_IMPOSSIBLE,
            cause=(
                "the mesh is not closed with all faces outward. Merge by distance, fill "
                "holes and recalculate normals, or set Kind to Shell"
            ),
        )
    return measurement


def _read_surface(context: Context, obj: Object, mesh: _Vertices | None) -> Part:
    """Return the measured surface; raise EditRefusedError if its vertices are not those of
    `mesh`.
    """
    reading = read_object(obj, context.evaluated_depsgraph_get(), edges=False)
    part = reading.parts[0]
    if reading.all_singular:
        raise EditRefusedError(SCALE_ZERO_AXIS)
    if reading.instance_count > 1:
        raise EditRefusedError(SHAPE_NOT_OF_MESH, makers=OTHER_SHAPES)
    if mesh is not None and not np.array_equal(part.surface.points, mesh.start):
        shown = [modifier.name for modifier in obj.modifiers if modifier.show_viewport]
        raise EditRefusedError(SHAPE_NOT_OF_MESH, makers=shown or OTHER_SHAPES)
    return part
