# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of a measured wall as a slider: what was measured last is kept in memory as polynomials in the
thickness, and a change of the setting stores their values at once.

Only where nothing else has changed since: geometry and transform must be those of the stored numbers. Otherwise the
numbers stay, and are reported as out of date.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, replace

from bpy.types import Context, Object, PropertyGroup

from ...core.numerics.float32 import decimal
from ...core.verdict.finding import MeasureError
from ..bodies.measure_object import Measured
from ..bodies.measurement import as_measurement
from ..bodies.wall import Walls
from ..read import Reading
from ..settings import hooks
from ..settings.options import MeasureOptions, resolved
from ..write import properties
from . import staleness

KEPT = 64  # objects

_kept: OrderedDict[int, _Kept] = OrderedDict()  # by session uid, the last one measured last


@dataclass(frozen=True)
class _Kept:
    """What was measured of one object, and the fingerprint that it was given."""

    reading: Reading
    walls: Walls
    geometry: str
    matrix: str
    unit: float


def keep(obj: Object, measured: Measured, unit: float) -> None:
    """Remember the walls that an object was measured with, if any. unit: metres per Blender unit."""
    if measured.walls is None:
        return
    _, geometry, matrix, _ = measured.measurement.fingerprint.split(":")
    reading = replace(measured.reading, parts=[])
    _kept[obj.session_uid] = _Kept(reading, measured.walls.without_surfaces(), geometry, matrix, unit)
    _kept.move_to_end(obj.session_uid)
    while len(_kept) > KEPT:
        _kept.popitem(last=False)


def largest(obj: Object) -> float | None:
    """From which thickness in m the object's wall folds over, where that is known and there is such a thickness."""
    kept = _current(obj)
    if kept is None or obj.body_moments.wall == "THIN":
        return None
    limit = _on_side(kept, obj).largest
    return limit if limit < float("inf") else None


def folds(obj: Object) -> bool:
    """Whether the thickness that is set is known to be too large."""
    limit = largest(obj)
    return limit is not None and not decimal(obj.body_moments.thickness) * _kept[obj.session_uid].unit < limit


def changed(settings: PropertyGroup, context: Context) -> None:
    """What a change of the wall or its thickness does to the stored numbers."""
    obj = settings.id_data
    kept = _current(obj)
    scene = context.scene
    if (
        kept is None
        or settings.kind != "SHELL"
        or settings.wall == "THIN"
        or scene is None
        or decimal(scene.unit_settings.scale_length) != kept.unit
        or staleness.is_edited(obj)
        or settings.mass_from == "DENSITY"
        and settings.density_from != "VALUE"
        or not obj.is_editable
        or obj.override_library is not None
    ):
        return
    options = resolved(MeasureOptions(), obj, kept.unit)
    try:
        body = _on_side(kept, obj).body(options.thickness, looked=False)
        measurement = as_measurement(obj, kept.reading, body, options, kept.unit)
    except MeasureError:  # the panel shows how thick it may be
        return
    properties.store(obj, measurement)
    staleness.mark_retold(obj)


def _on_side(kept: _Kept, obj: Object) -> Walls:
    return replace(kept.walls, side=obj.body_moments.wall.lower())


def _current(obj: Object) -> _Kept | None:
    """What is kept of an object, where its stored numbers are of the same geometry and transform."""
    kept = _kept.get(obj.session_uid)
    parts = str(obj.get("body_fingerprint", "")).split(":")
    return kept if kept is not None and parts[1:3] == [kept.geometry, kept.matrix] else None


def register() -> None:
    hooks.on_wall_change.append(changed)


def unregister() -> None:
    hooks.on_wall_change.remove(changed)
    _kept.clear()
