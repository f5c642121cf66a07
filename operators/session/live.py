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
from ...core.numerics.float32 import decimal
from ...core.nurbs.tracked_solid import FollowedBody
from ...core.verdict import internal_error
from ..bodies.body import Body
from ..bodies.measure_object import measure_object
from ..bodies.measurement import as_measurement
from ..read import Unreadable, read_patches
from ..read.fingerprint import settings_hash
from ..settings.density import density_field
from ..settings.options import MeasureOptions, resolved

LONGEST_WAIT = 2.0  # s between two measurements of a body that takes long


@dataclass(frozen=True, eq=False)
class Live:
    """What an object's numbers are now. measurement: None where there are none, for the reason given. seconds: what
    it took. settings: the digest of those that it was measured with."""

    measurement: Measurement | None
    reason: str
    seconds: float
    settings: str


# by session uid; none of it outlives the file
_live: set[int] = set()
_due: set[int] = set()
_shown: dict[int, Live] = {}
_followed: dict[int, FollowedBody] = {}


def is_live(obj: Object) -> bool:
    """Whether the object's numbers are to follow its edits."""
    return obj.session_uid in _live


def shown(obj: Object) -> Live | None:
    """The numbers of an object with Live on, None before they were first measured."""
    return _shown.get(obj.session_uid) if is_live(obj) else None


def is_outdated(obj: Object, scene: Scene) -> bool:
    """Whether settings were changed since the live numbers were measured: Blender does not report every such change."""
    now = shown(obj)
    return now is not None and now.settings != settings_hash(obj, scene)


def follow(obj: Object, depsgraph: Depsgraph) -> Live:
    """Measure an object as it is now, and keep the outcome to be shown."""
    start = time.perf_counter()
    measurement, reason = None, ""
    try:
        measurement = _measured(obj, depsgraph)
    except (Unreadable, ValueError) as error:
        reason = str(getattr(error, "reason", error))
    except Exception as error:
        reason = internal_error.reason(error)
        _followed.pop(obj.session_uid, None)  # what is half followed is no start for the next edit
    found = _shown[obj.session_uid] = Live(
        measurement, reason, time.perf_counter() - start, settings_hash(obj, depsgraph.scene)
    )
    return found


def start(obj: Object, depsgraph: Depsgraph) -> Live:
    """Let the object's numbers follow its edits; the first of them."""
    _live.add(obj.session_uid)
    return follow(obj, depsgraph)


def stop(obj: Object) -> None:
    """Let the object's numbers follow its edits no more."""
    _forget(obj.session_uid)


def _measured(obj: Object, depsgraph: Depsgraph) -> Measurement:
    unit = decimal(depsgraph.scene.unit_settings.scale_length)
    plain = MeasureOptions(compare=False)
    options = resolved(plain, obj, unit)
    followed = options.kind == "solid" and options.overlap == "signed" and density_field(obj.body_moments) is None
    reading = read_patches(obj, depsgraph) if followed else None
    if reading is None or reading.singular:
        return measure_object(obj, depsgraph, plain)
    (part,) = reading.parts
    matrix = part.matrices[0].copy()
    matrix[:3] *= unit
    patches = [patch.mapped(matrix) for patch in part.splines.patches]
    if np.linalg.det(matrix) < 0.0:
        patches = [patch.turned() for patch in patches]
    stored = part.splines.stored * float(np.linalg.norm(matrix[:3, :3], 2))
    body = _followed.get(obj.session_uid)
    if body is None:
        body = _followed[obj.session_uid] = FollowedBody(patches, stored)
    else:
        body.follow(patches, stored)
    measure = body.measure
    found = Body(
        measure.volume,
        measure.area,
        measure.health,
        "NURBS " + measure.method,
        (*part.splines.notes, *measure.warnings),
        refined=lambda: measure.volume,
        estimated=True,
    )
    return as_measurement(obj, reading, found, options, unit)


@persistent
def _note(_scene: Scene, depsgraph: Depsgraph | None = None) -> None:
    if depsgraph is None or depsgraph.mode != "VIEWPORT":
        return
    for update in depsgraph.updates:
        if isinstance(update.id, Object) and (update.is_updated_geometry or update.is_updated_transform):
            obj = update.id.original
            if is_live(obj):
                _due.add(obj.session_uid)
    if _due and not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        slowest = max((_shown[uid].seconds for uid in _due if uid in _shown), default=0.0)
        bpy.app.timers.register(_tick, first_interval=min(2.0 * slowest, LONGEST_WAIT))


def _tick() -> float | None:
    if bpy.app.is_job_running("RENDER"):
        return 0.5
    layer = bpy.context.view_layer
    depsgraph = bpy.context.evaluated_depsgraph_get()  # may evaluate, and so note more
    due = [obj for obj in layer.objects if obj.session_uid in _due]
    _due.clear()
    for obj in due:
        follow(obj, depsgraph)
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "PROPERTIES"}:
                area.tag_redraw()
    return None


def _forget(uid: int) -> None:
    for kept in (_live, _due):
        kept.discard(uid)
    for kept in (_shown, _followed):
        kept.pop(uid, None)


@persistent
def _load(*_args) -> None:
    for kept in (_live, _due, _shown, _followed):
        kept.clear()


HANDLERS = (("depsgraph_update_post", _note), ("frame_change_post", _note), ("load_post", _load))


def register() -> None:
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister() -> None:
    for name, function in reversed(HANDLERS):
        getattr(bpy.app.handlers, name).remove(function)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    _load()
