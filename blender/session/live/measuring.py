# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of objects that follow their edits while Live is on: shown, never stored.

Nothing is written to any data. A moving object is not measured again: its numbers are mapped to its
new place. An object that deforms during playback or posing gets volume and center at once, in a
light pass over its faces (`MovingSurface`), within the budget of a redraw. Full numbers come from a
timer, never from a handler: at once if they take no longer than the budget, else when updates and
frames have ceased. Until then the panel says that the numbers lag. B-spline patches are tracked
(core/nurbs/tracked_solid.py). Only seconds of this thread count, so that other work on a busy
machine makes no numbers lag.

The switch is kept in memory, too: a property of the object would make Blender report an edit of its
geometry.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from math import inf
from operator import itemgetter

import bpy
import numpy as np
from bpy.types import Depsgraph, Object

from ....core import bodies, measurement, mesh, numerics, nurbs, polyhedron
from ....core.verdict import MeasureError, Method, Procedure, ReadError, Source, internal_error
from ...bodies.measure_body import measure_body
from ...bodies.request import Request, measurement_of
from ...bodies.stack import Measured
from ...read import fingerprint, visibility
from ...read.mesh import mesh_points
from ...read.objects import read_patches
from ...settings.options import MeasureOptions
from ...settings.preferences import preferences
from .. import memory
from ..stored import floating
from ..tracking import handlers, updates
from .following import Followed

BUDGET = 0.01  # s per redraw, if there are no preferences
MAX_PASS = 5.0  # limit for the first pass of a redraw, in budgets
RETRY = 0.7  # factor for the remembered time of a skipped pass, so that it is tried again
IDLE = 0.25  # s without an update before measurements that take longer than the budget
POLL = 0.1  # s between two checks whether these can begin
RENDER_POLL = 0.5  # s between two checks during a render, which no measurement disturbs
FOLLOWED = {Procedure.EXACT, Procedure.CAPPED, Procedure.REORIENTED}


def update(obj: Object, depsgraph: Depsgraph) -> Followed:
    """Measure an object with Live on as it is now, and keep the outcome to be shown."""
    current = memory.followed[obj]
    start = time.thread_time()
    current.measurement = current.refusal = None
    try:
        current.measurement, current.surface = _measure(obj, current, depsgraph)
    except MeasureError as error:
        current.refusal = error.finding
    except Exception as error:
        current.refusal = internal_error.finding_of(error)
        current.tracked = None  # a half-followed body is no start for the next edit
    current.seconds = time.thread_time() - start
    current.settings = fingerprint.settings_hash(obj, depsgraph.scene)
    current.matrix = bodies.float64_matrix(obj.matrix_world)
    current.transform = fingerprint.transform_key(obj)
    current.first_order = None
    current.is_pending = False
    current.number = memory.state.updates
    handlers.count_change(obj)
    return current


def start(obj: Object, depsgraph: Depsgraph) -> Followed:
    """Turn Live on for an object, and return it with its first measurement."""
    memory.followed[obj] = Followed(shows_others=next(updates.shown_by(obj), None) is not None)
    return update(obj, depsgraph)


def stop(obj: Object) -> None:
    """Turn Live off for an object."""
    memory.followed.forget(obj)
    handlers.count_change(obj)


def _measure(
    obj: Object, current: Followed, depsgraph: Depsgraph
) -> tuple[measurement.Measurement, MovingSurface | None]:
    """Return a measurement without comparisons, and the faces that a light pass can follow, if any.

    The patches of a surface object are tracked in `current.tracked`.
    """
    plain = MeasureOptions(compare=False)
    request = Request.resolve(obj, depsgraph, plain)
    options = request.settings
    can_track = options.kind == "solid" and options.overlap == "signed" and request.density is None
    reading = read_patches(obj, depsgraph) if can_track and obj.type == "SURFACE" else None
    if reading is None or reading.all_singular:
        measured = measure_body(obj, depsgraph, plain)
        return measured.measurement, MovingSurface.from_measured(measured)
    (part,) = reading.parts
    splines = part.splines
    assert splines is not None
    matrix = part.matrices[0] * options.unit  # the last row is not used
    # Flat faces exist only while a file is measured.
    patches = [
        patch.transform(matrix) for patch in splines.patches if isinstance(patch, nurbs.Patch)
    ]
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        patches = [patch.reverse_orientation() for patch in patches]
    # The spectral norm bounds how much the map enlarges the error of stored coordinates.
    stored_error = splines.stored * float(np.linalg.norm(matrix[:3, :3], 2))
    if current.tracked is None:
        current.tracked = nurbs.TrackedSolid(patches, stored_error)
    else:
        current.tracked.update(patches, stored_error)
    measure = current.tracked.measure
    measured_body = measurement.Body(
        measure.volume,
        measure.area,
        measure.health,
        Method(Procedure(measure.method), Source.NURBS),
        (*splines.findings, *measure.findings),
        estimated=True,
    )
    return measurement_of(reading, measured_body, request), None


# ---------------------------------------------------------------- Timing


def _budget() -> float:
    """Return the budget of a redraw in seconds."""
    settings = preferences()
    return BUDGET if settings is None else settings.live_budget / 1e3


def note_updates(events: handlers.Updates) -> None:
    """Follow updated objects at once, as far as the budget allows, and schedule their
    measurement.
    """
    memory.state.last_event = time.monotonic()
    changed = {
        uid: current
        for uid in events.reshaped
        if (current := memory.followed.by_uid(uid)) is not None
    }
    active = events.depsgraph.view_layer.objects.active
    if (
        active is not None
        and active.mode == "SCULPT"
        and active in memory.followed
        and active.session_uid in events.others
    ):
        # Strokes change the mesh without evaluating its geometry.
        changed[active.session_uid] = memory.followed[active]
    for current in changed.values():
        current.is_pending = True
    is_followed_moved = any(memory.followed.by_uid(uid) is not None for uid in events.moved)
    if changed and not bpy.app.is_job_running("RENDER"):
        _follow_at_once(events, set(changed))
    has_other_events = events.collections or events.moved or events.reshaped
    # Carried objects and instances change a followed object without an update of it.
    depends_on_others = len(memory.afloat) or any(
        current.shows_others for current in memory.followed
    )
    is_due = changed or is_followed_moved or has_other_events and depends_on_others
    if is_due and not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick)


def _follow_at_once(events: handlers.Updates, changed: set[int]) -> None:
    """Follow one object, and as many others as the budget of a redraw allows, quickest passes
    first.
    """
    budget = _budget()
    is_first = True
    objects = [obj for obj in events.depsgraph.view_layer.objects if obj.session_uid in changed]
    for obj in sorted(objects, key=lambda obj: memory.followed[obj].pass_seconds):
        current = memory.followed[obj]
        start = time.thread_time()
        allowed = MAX_PASS * _budget() if is_first else budget
        if current.surface is None or current.pass_seconds > allowed:
            current.first_order = None
            current.pass_seconds *= RETRY  # a busy moment is not for ever
            continue
        current.first_order = current.surface.follow(obj, events.depsgraph)
        current.pass_seconds = time.thread_time() - start
        budget -= current.pass_seconds
        is_first = False


def _tick() -> float | None:
    """Measure the due objects that are quick enough, all if updates have ceased; return the seconds
    until Blender's timer shall call again, None if nothing waits.
    """
    if not len(memory.followed):  # Live was turned off, or the add-on disabled
        return None
    if bpy.app.is_job_running("RENDER"):
        return RENDER_POLL
    layer = bpy.context.view_layer
    depsgraph = bpy.context.evaluated_depsgraph_get()  # may evaluate, and so note more
    due = [obj for obj in layer.objects if obj in memory.followed and _is_due(obj)]
    is_playing = any(
        window.screen.is_animation_playing for window in bpy.context.window_manager.windows
    )
    budget = _budget()
    idle = time.monotonic() - memory.state.last_event >= IDLE and not is_playing
    waiting = False
    for seconds, obj in sorted(
        ((memory.followed[obj].seconds, obj) for obj in due), key=itemgetter(0)
    ):
        if (seconds <= budget or idle) and not _is_stroking(obj):
            if obj.mode == "SCULPT":  # evaluates the strokes
                obj.update_tag(refresh={"DATA"})
                layer.update()
            update(obj, depsgraph)
            budget -= seconds
        else:
            waiting = True
    waiting |= floating.follow(depsgraph, inf if idle else budget)
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "PROPERTIES"}:
                area.tag_redraw()
    return POLL if waiting else None


def _is_stroking(obj: Object) -> bool:
    windows = bpy.context.window_manager.windows if obj.mode == "SCULPT" else ()
    return any(
        running.bl_idname.startswith("SCULPT_OT_")
        for window in windows
        for running in window.modal_operators
    )


def _is_due(obj: Object) -> bool:
    """Return whether an object has to be measured again: more than its place has changed."""
    current = memory.followed[obj]
    if not current.is_pending:
        is_edited = updates.last_edit(obj).number > current.number
        current.is_pending = is_edited or not fingerprint.has_transform(obj, current.transform)
    return current.is_pending


@dataclass(frozen=True, eq=False)
class MovingSurface:
    """A body whose points move while its faces stay the same.

    surface: its faces, in the object's own coordinates.
    corners: (c,) vertices of all corners of the mesh that was read.
    """

    surface: mesh.Surface
    corners: numerics.Integers

    @classmethod
    def from_measured(cls, measured: Measured) -> MovingSurface | None:
        """Return the faces of a measured body, or None unless it is one exact or repaired mesh in
        its own place.
        """
        reading = measured.reading
        body = measured.body
        method = measured.measurement.method
        if (
            not isinstance(reading, bodies.Reading)
            or not isinstance(body, bodies.MeshBody)
            or measured.measurement.kind != "solid"
            or body.mass is not None
            or method.source != Source.POLYGONS
            or method.procedure not in FOLLOWED
            or len(reading.parts) != 1
            or len(body.solids) != 1
        ):
            return None
        (part,) = reading.parts
        ((solid, _matrices),) = body.solids
        read = part.surface
        surface = solid.repaired_surface
        if (
            part.source_object_name not in ("", reading.name)
            or len(part.matrices) != 1
            or not np.array_equal(part.matrices[0], reading.matrix)
            or read.corner_vertices is None
            or not np.array_equal(surface.points, read.points)
        ):
            return None
        return cls(surface, read.corner_vertices)

    def follow(self, obj: Object, depsgraph: Depsgraph) -> tuple[float, numerics.Array] | None:
        """Return the object's current volume and (3,) center, in its own coordinates; None if it
        shows other faces.
        """
        if (
            obj.type != "MESH"
            or obj.mode not in {"OBJECT", "POSE", "WEIGHT_PAINT"}
            or obj.data.is_editmode
        ):
            return None
        try:
            geometry = visibility.evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
        except ReadError:
            return None
        points = None if geometry.mesh is None else mesh_points(geometry.mesh, self.corners)
        if points is None or len(points) != len(self.surface.points):
            return None
        volume, center = polyhedron.volume_and_center(
            mesh.Surface(points, self.surface.triangles, quads=self.surface.quads)
        )
        return (volume, center) if volume > 0.0 and np.isfinite(center).all() else None
