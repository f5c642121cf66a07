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
from ...core.mesh import Surface
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
        first = self.mesh.vertices[0]
        first.co = first.co  # makes Blender update normals and bounding box


@tracking_paused()  # a trial that is undone is not an edit
def balance_mesh(
    context: Context, obj: Object, group: str, point: Sequence[float], align: str, longest: float
) -> Balanced:
    """Move vertices so that the center of mass comes over a point, or raise MeasureError and leave
    them in place.
    """
    mesh = _EditedMesh(obj) if obj.mode == "EDIT" else _StoredMesh(obj, group)
    _require_balanceable(obj)
    balancing = _Balancing(context, obj, mesh, np.array(point, np.float64), align, longest)
    try:
        return balancing.run()
    except BaseException:
        if mesh.is_changed:
            mesh.set_points(mesh.start)
            context.view_layer.update()
        raise


class _Balancing:
    """The attempts to move one object's center of mass over a target; lengths in m, world axes.

    across: (k, 3) directions along which the center has to meet the target. linear, offset: the map
    from the mesh's coordinates. start: the surface before the change. limit: of a vertex' move.
    """

    def __init__(
        self,
        context: Context,
        obj: Object,
        mesh: _EditedMesh | _StoredMesh,
        point: Array,
        align: str,
        longest: float,
    ):
        self.context = context
        self.obj = obj
        self.mesh = mesh
        unit = meters_per_unit(context.scene)
        self.up = -down(context.scene)
        self.across = np.eye(3) if align == "ALL" else np.linalg.svd(self.up[None])[2][1:]
        self.target = point * unit
        part = _read_surface(context, obj, mesh)
        self.before = _measure(context, obj)
        self.linear = part.matrices[0, :3, :3] * unit
        self.offset = part.matrices[0, :3, 3] * unit
        self.start = part.surface.transform(self.linear, self.offset)
        self.size = float(np.linalg.norm(np.ptp(self.start.points, axis=0)))
        self.tolerance = REACHED_RTOL * self.size + 4.0 * FLOAT32 * np.abs(self.start.points).max()
        self.limit = longest * unit or self.size

    def run(self) -> Balanced:
        """Change the mesh until its center is over the target, or raise MeasureError."""
        mesh = self.mesh
        is_union = self.before.method == Method(Procedure.UNION)
        surface = self.start
        moves = np.zeros_like(self.start.points)
        center = self.before.mass_properties.center
        aim = self.target.copy()
        effect = np.eye(3)  # of a change of the aim on the center
        step = np.zeros(3)
        for attempt in range(MAX_UNION_ATTEMPTS if is_union else MAX_ATTEMPTS):
            if mesh.leans:
                shift = self.across.T @ (self.across @ (self.target - center))
                first_center = self.before.mass_properties.center
                moves += _lean(self.start.points, first_center, shift, self.up)
                self._require_short(moves, center)
            else:
                moves = self._solved_moves(surface, aim)
            points = self._set_moves(moves)
            previous_center = center
            center = _measure(self.context, self.obj).mass_properties.center
            missing = self.across @ (self.target - center)
            if np.abs(missing).max() <= self.tolerance:
                self.obj.data.update_tag()  # for other objects with the mesh it is an edit
                return self._balanced(points, center)
            if is_union and not mesh.leans:  # Broyden's method
                if attempt:
                    error = center - previous_center - effect @ step
                    effect += np.outer(error, step) / (step @ step)
                step = np.linalg.solve(effect, self.across.T @ missing)
                aim = aim + step
            else:  # the faces may be cut into other triangles now
                part = _read_surface(self.context, self.obj, None)
                surface = replace(
                    part.surface.transform(self.linear, self.offset), points=self.start.points
                )
        raise EditRefusedError(
            BALANCE_IMPOSSIBLE,
            cause="the triangulation changes with every move. Use Face > Triangulate Faces",
        )

    def _require_short(self, moves: NDArray, center: Array) -> None:
        """Raise MeasureError if a vertex would move by more than the limit."""
        longest = float(np.linalg.norm(moves, axis=1).max())
        if longest > self.limit:
            distance = float(np.linalg.norm(self.across @ (self.target - center)))
            short = distance * (1.0 - self.limit / longest)
            raise MeasureError(BALANCE_SHORT, distance=short, limit=self.limit)

    def _solved_moves(self, surface: Surface, aim: Array) -> Array:
        """Return the smallest (n, 3) moves that bring the center of a surface over the aim."""
        balanced = balance(
            surface,
            self.mesh.movable,
            aim,
            across=self.across,
            weights=self.mesh.weights,
            limit=self.limit,
            shell=self.before.kind == "shell",
        )
        return balanced.points - self.start.points

    def _set_moves(self, moves: NDArray) -> NDArray[np.float32]:
        """Move the vertices of the mesh and return their (n, 3) points."""
        movable = self.mesh.movable
        points = self.mesh.start.copy()  # vertices that are not movable stay to the bit
        points[movable] = (
            self.mesh.start[movable].astype(np.float64)
            + np.linalg.solve(self.linear, moves[movable].T).T
        )
        self.mesh.set_points(points)
        return points

    def _balanced(self, points: NDArray[np.float32], center: Array) -> Balanced:
        """Return the numbers of a change that reached the target."""
        movable = self.mesh.movable
        moved = (points[movable].astype(np.float64) - self.mesh.start[movable]) @ self.linear.T
        start, end = (
            np.where(np.abs(place) < ROUNDING * self.size, 0.0, place).tolist()
            for place in (self.before.mass_properties.center, center)
        )
        return Balanced(
            int(np.count_nonzero(moved.any(axis=1))),
            float(np.linalg.norm(moved, axis=1).max()),
            start,
            end,
        )


def _lean(points: NDArray, center: NDArray, shift: NDArray, up: NDArray) -> Array:
    """Return (n, 3) moves in proportion to the height above the lowest of the points, by `shift` at
    the center.

    Raise MeasureError if the center is, or would come to be, no higher than the lowest point.
    """
    lowest = (points @ up).min()
    heights = points @ up - lowest
    rise = center @ up - lowest
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
