# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of NURBS objects that follow an edit while Live is on: shown, never stored.

What Blender has evaluated anew is noted, in memory, of objects with Live on, and a timer measures them once
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
from . import handlers
from .cache import SessionCache

MAX_WAIT = 2.0  # s between two measurements of a body that takes long


@dataclass(frozen=True, eq=False)
class LiveResult:
    """What an object's numbers are now. measurement: None where there are none; refusal: then why. seconds: what it
    took. settings: the digest of those that it was measured with."""

    measurement: Measurement | None
    refusal: Finding | None
    seconds: float
    settings: str


@dataclass(eq=False)
class _Followed:
    """An object with Live on. tracked: its body, where that is followed rather than measured each time. is_pending:
    whether it was evaluated anew since it was measured."""

    result: LiveResult | None = None
    tracked: TrackedSolid | None = None
    is_pending: bool = False


_followed: SessionCache[_Followed] = SessionCache()


def is_live(obj: Object) -> bool:
    """Whether the object's numbers are to follow its edits."""
    return obj in _followed


def is_pending(obj: Object) -> bool:
    """Whether an object with Live on is going to be measured: Blender has evaluated it anew."""
    followed = _followed.get(obj)
    return followed is not None and followed.is_pending


def current_numbers(obj: Object) -> LiveResult | None:
    """The numbers of an object with Live on, None before they were first measured."""
    followed = _followed.get(obj)
    return None if followed is None else followed.result


def is_stale(obj: Object, scene: Scene) -> bool:
    """Whether settings were changed since the live numbers were measured: Blender does not report every such change."""
    now = current_numbers(obj)
    return now is not None and now.settings != settings_hash(obj, scene)


def update(obj: Object, depsgraph: Depsgraph) -> LiveResult:
    """Measure an object with Live on as it is now, and keep the outcome to be shown."""
    followed, start = _followed.get(obj), time.perf_counter()
    measurement, refusal = None, None
    try:
        measurement = _measure(obj, followed, depsgraph)
    except MeasureError as error:
        refusal = error.finding
    except Exception as error:
        refusal = internal_error.finding_of(error)
        followed.tracked = None  # what is half followed is no start for the next edit
    followed.result = LiveResult(measurement, refusal, time.perf_counter() - start, settings_hash(obj, depsgraph.scene))
    return followed.result


def start(obj: Object, depsgraph: Depsgraph) -> LiveResult:
    """Let the object's numbers follow its edits; the first of them."""
    _followed[obj] = _Followed()
    return update(obj, depsgraph)


def stop(obj: Object) -> None:
    """Let the object's numbers follow its edits no more."""
    _followed.forget(obj)


def _measure(obj: Object, followed: _Followed, depsgraph: Depsgraph) -> Measurement:
    plain = MeasureOptions(compare=False)
    request = Request.of(obj, depsgraph, plain)
    options, unit = request.options, request.unit
    can_track = options.kind == "solid" and options.overlap == "signed" and request.density is None
    reading = read_patches(obj, depsgraph) if can_track else None
    if reading is None or reading.all_singular:
        return measure_object(obj, depsgraph, plain)
    (part,) = reading.parts
    matrix = part.matrices[0].copy()
    matrix[:3] *= unit
    patches = [patch.transform(matrix) for patch in part.splines.patches]
    if np.linalg.det(matrix) < 0.0:
        patches = [patch.reverse_orientation() for patch in patches]
    stored = part.splines.stored * float(np.linalg.norm(matrix[:3, :3], 2))
    if followed.tracked is None:
        followed.tracked = TrackedSolid(patches, stored)
    else:
        followed.tracked.update(patches, stored)
    measure = followed.tracked.measure
    measured_body = Body(
        measure.volume,
        measure.area,
        measure.health,
        Method(Verdict(measure.method), Source.NURBS),
        (*part.splines.findings, *measure.findings),
        estimated=True,
    )
    return measurement_of(reading, measured_body, request)


def _note_updates(updates: handlers.Updates) -> None:
    for uid in (*updates.reshaped, *updates.moved) if len(_followed) else ():
        if (followed := _followed.by_uid(uid)) is not None:
            followed.is_pending = True
    pending = [followed for followed in _followed if followed.is_pending]
    if pending and not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        slowest = max(followed.result.seconds if followed.result else 0.0 for followed in pending)
        bpy.app.timers.register(_tick, first_interval=min(2.0 * slowest, MAX_WAIT))


def _tick() -> float | None:
    if bpy.app.is_job_running("RENDER"):
        return 0.5
    layer = bpy.context.view_layer
    depsgraph = bpy.context.evaluated_depsgraph_get()  # may evaluate, and so note more
    due = [obj for obj in layer.objects if is_pending(obj)]
    for followed in _followed:
        followed.is_pending = False
    for obj in due:
        update(obj, depsgraph)
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "PROPERTIES"}:
                area.tag_redraw()
    return None


def register() -> None:
    """Follow what Blender evaluates anew."""
    handlers.on_update.append(_note_updates)


def unregister() -> None:
    """Follow it no more."""
    handlers.on_update.remove(_note_updates)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
