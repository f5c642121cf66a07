# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The threshold of a measured grid as a slider.

The values of the grid are kept in memory, and a change of the setting stores the numbers of the new body at once.

While the slider moves they come from every second or third value of a large grid, by an unchecked rule, and are out of
date; a moment after the last change the exact ones take their place. This needs the geometry and transform of the
stored numbers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
from bpy.types import Context, Object, PropertyGroup, Scene

from ....core.bodies.threshold import ThresholdGrid, ThresholdGridBody, threshold_grid_body
from ....core.density.grid_options import GridOptions
from ....core.numerics.float32 import shortest_decimal
from ....core.verdict.finding import MeasureError
from ...bodies.measure_object import Measured
from ...bodies.measurement import measurement_of
from ...bodies.request import Request
from ...read.grids.volume import VolumeReading
from ...settings import hooks
from ...settings.density import grid_key
from ...write import properties
from ..tracking import staleness, stamps
from ..tracking.cache import SessionCache
from . import density

MAX_CACHED_OBJECTS = 2  # a grid may have gigabytes
DELAY = 0.3  # s after the last change of the slider
COARSE = "coarse"  # equals no key of settings, so that results with it are out of date


@dataclass(frozen=True, eq=False)
class _CachedGrid:
    """One object's grid, and the parts of the stamps stored with it since.

    geometries: the digests at every stored threshold, as undo may go back to any of them.
    """

    reading: VolumeReading
    grid: ThresholdGrid
    geometries: set[str]
    transform: str
    unit: float


_cache: SessionCache[_CachedGrid] = SessionCache(MAX_CACHED_OBJECTS)
_pending: list[tuple[Object, Scene]] = []  # objects whose exact numbers are due


def cache_grid(obj: Object, measured: Measured, unit: float) -> None:
    """Remember the grid that an object was measured with; `unit` is in meters per Blender unit."""
    stamp, reading, body = stamps.Stamp.parse(measured.measurement.fingerprint), measured.reading, measured.body
    assert isinstance(reading, VolumeReading) and isinstance(body, ThresholdGridBody)
    _cache[obj] = _CachedGrid(reading, body.grid, {stamp.geometry}, stamp.transform, unit)
    if on_threshold not in hooks.on_threshold_change:
        hooks.on_threshold_change.append(on_threshold)


def on_threshold(settings: PropertyGroup, context: Context) -> None:
    """Store the numbers of a changed threshold."""
    obj, scene = settings.id_data, context.scene
    cached = _current(obj, scene)
    if cached is None:
        return
    coarse = cached.grid.coarse()
    if _store(obj, scene, cached, coarse, preview=True) and coarse is cached.grid:
        staleness.mark_object(obj)
    if (obj, scene) not in _pending:
        _pending.append((obj, scene))
    if bpy.app.background:
        _finish()
        return
    if bpy.app.timers.is_registered(_finish):
        bpy.app.timers.unregister(_finish)
    bpy.app.timers.register(_finish, first_interval=DELAY)


def _current(obj: Object, scene: Scene | None) -> _CachedGrid | None:
    """Return the kept grid of an object, if its stored numbers are of the same geometry and transform."""
    cached, stamp = _cache.get(obj), stamps.of_results(obj)
    if cached is None or stamp is None or scene is None:
        return None
    same = stamp.geometry in cached.geometries and stamp.transform == cached.transform
    unit = shortest_decimal(scene.unit_settings.scale_length)
    if not same or unit != cached.unit or staleness.is_edited(obj):
        return None
    return cached if obj.body_moments.grid_as == "THRESHOLD" else None


def _store(obj: Object, scene: Scene, cached: _CachedGrid, grid: ThresholdGrid, preview: bool) -> bool:
    """Write the numbers of the current threshold to the object; return False if there are none."""
    options = GridOptions.from_settings(obj.body_moments)
    request = Request.resolve(obj, unit=cached.unit)
    try:
        body = threshold_grid_body(grid, options, preview)
        key = grid_key(obj) if grid is cached.grid else COARSE
        measurement = measurement_of(cached.reading, replace(body, density_key=key), request)
    except MeasureError:  # the panel says that the numbers are out of date, and Measure why there are none
        return False
    properties.store(obj, density.noted(obj, measurement, scene))
    cached.geometries.add(stamps.Stamp.parse(measurement.fingerprint).geometry)
    return True


def _finish() -> None:
    """Store the exact numbers of the pending objects; as a timer's function, return None to be called only once."""
    while _pending:
        obj, scene = _pending.pop()
        try:
            cached = _current(obj, scene)
        except ReferenceError:  # removed meanwhile
            continue
        if cached is not None and _store(obj, scene, cached, cached.grid, preview=False):
            staleness.mark_object(obj)
