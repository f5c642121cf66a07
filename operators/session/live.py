# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of NURBS objects that follow an edit while Live is on: shown, never stored.

A handler notes, in memory, which objects with Live on Blender has evaluated anew, and a timer measures them once
Blender is idle: nothing is written to any data, and nothing is measured while Blender evaluates, renders or draws. What
takes long is measured less often. A body is tracked (core/nurbs/tracked_solid.py) as long as its patches and what was
decided about them stay; Measure stores the numbers, with the bounds of their errors. Which objects have Live on is kept
in memory too: a property of the object would make Blender report an edit of its geometry when it is switched.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy.types import Depsgraph, Object, Scene

from ...core.measurement import Measurement
from ...core.nurbs.tracked_solid import TrackedSolid
from ...core.verdict import internal_error
from ...core.verdict.finding import Finding, MeasureError
from ...core.verdict.method import Method, Source, Verdict
from ..bodies.body import Body
from ..bodies.measure_object import measure_object
from ..bodies.measurement import measurement_of
from ..bodies.request import Request
from ..read import read_patches
from ..read.fingerprint import settings_hash
from ..settings.options import MeasureOptions

MAX_WAIT = 2.0  # s between two measurements of a body that takes long


@dataclass(frozen=True, eq=False)
class LiveResult:
    """What an object's numbers are now. measurement: None where there are none; refusal: then why. seconds: what it
    took. settings: the digest of those that it was measured with."""

    measurement: Measurement | None
    refusal: Finding | None
    seconds: float
    settings: str


# by session uid; none of it outlives the file
_live: set[int] = set()
_pending: set[int] = set()
_results: dict[int, LiveResult] = {}
_tracked: dict[int, TrackedSolid] = {}


def is_live(obj: Object) -> bool:
    """Whether the object's numbers are to follow its edits."""
    return obj.session_uid in _live


def current_numbers(obj: Object) -> LiveResult | None:
    """The numbers of an object with Live on, None before they were first measured."""
    return _results.get(obj.session_uid) if is_live(obj) else None


def is_stale(obj: Object, scene: Scene) -> bool:
    """Whether settings were changed since the live numbers were measured: Blender does not report every such change."""
    now = current_numbers(obj)
    return now is not None and now.settings != settings_hash(obj, scene)


def update(obj: Object, depsgraph: Depsgraph) -> LiveResult:
    """Measure an object as it is now, and keep the outcome to be shown."""
    start = time.perf_counter()
    measurement, refusal = None, None
    try:
        measurement = _measure(obj, depsgraph)
    except MeasureError as error:
        refusal = error.finding
    except Exception as error:
        refusal = internal_error.finding_of(error)
        _tracked.pop(obj.session_uid, None)  # what is half followed is no start for the next edit
    result = _results[obj.session_uid] = LiveResult(
        measurement, refusal, time.perf_counter() - start, settings_hash(obj, depsgraph.scene)
    )
    return result


def start(obj: Object, depsgraph: Depsgraph) -> LiveResult:
    """Let the object's numbers follow its edits; the first of them."""
    _live.add(obj.session_uid)
    return update(obj, depsgraph)


def stop(obj: Object) -> None:
    """Let the object's numbers follow its edits no more."""
    _forget(obj.session_uid)


def _measure(obj: Object, depsgraph: Depsgraph) -> Measurement:
    plain = MeasureOptions(compare=False)
    request = Request.of(obj, depsgraph, plain)
    options, unit = request.options, request.unit
    followed = options.kind == "solid" and options.overlap == "signed" and request.density is None
    reading = read_patches(obj, depsgraph) if followed else None
    if reading is None or reading.all_singular:
        return measure_object(obj, depsgraph, plain)
    (part,) = reading.parts
    matrix = part.matrices[0].copy()
    matrix[:3] *= unit
    patches = [patch.transform(matrix) for patch in part.splines.patches]
    if np.linalg.det(matrix) < 0.0:
        patches = [patch.reverse_orientation() for patch in patches]
    stored = part.splines.stored * float(np.linalg.norm(matrix[:3, :3], 2))
    body = _tracked.get(obj.session_uid)
    if body is None:
        body = _tracked[obj.session_uid] = TrackedSolid(patches, stored)
    else:
        body.update(patches, stored)
    measure = body.measure
    measured_body = Body(
        measure.volume,
        measure.area,
        measure.health,
        Method(Verdict(measure.method), Source.NURBS),
        (*part.splines.findings, *measure.findings),
        estimated=True,
    )
    return measurement_of(reading, measured_body, request)


@persistent
def _on_depsgraph_update(_scene: Scene, depsgraph: Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.mode != "VIEWPORT":
        return
    for update in depsgraph.updates:
        if isinstance(update.id, Object) and (update.is_updated_geometry or update.is_updated_transform):
            obj = update.id.original
            if is_live(obj):
                _pending.add(obj.session_uid)
    if _pending and not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        slowest = max((_results[uid].seconds for uid in _pending if uid in _results), default=0.0)
        bpy.app.timers.register(_tick, first_interval=min(2.0 * slowest, MAX_WAIT))


def _tick() -> float | None:
    if bpy.app.is_job_running("RENDER"):
        return 0.5
    layer = bpy.context.view_layer
    depsgraph = bpy.context.evaluated_depsgraph_get()  # may evaluate, and so note more
    due = [obj for obj in layer.objects if obj.session_uid in _pending]
    _pending.clear()
    for obj in due:
        update(obj, depsgraph)
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "PROPERTIES"}:
                area.tag_redraw()
    return None


def _forget(uid: int) -> None:
    for cache in (_live, _pending):
        cache.discard(uid)
    for cache in (_results, _tracked):
        cache.pop(uid, None)


@persistent
def _on_load(*_args) -> None:
    for cache in (_live, _pending, _results, _tracked):
        cache.clear()


HANDLERS = (
    ("depsgraph_update_post", _on_depsgraph_update),
    ("frame_change_post", _on_depsgraph_update),
    ("load_post", _on_load),
)


def register() -> None:
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister() -> None:
    for name, function in reversed(HANDLERS):
        getattr(bpy.app.handlers, name).remove(function)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    _on_load()
