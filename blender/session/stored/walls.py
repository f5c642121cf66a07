# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of a measured wall as a slider.

The last measured walls are kept in memory as polynomials in the thickness, and a change of the setting stores their
values at once.

This needs the geometry and transform of the stored numbers. Otherwise the numbers stay, and are reported as out of
date.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from bpy.types import Context, Object, PropertyGroup

from ....core.bodies.reading import Reading
from ....core.bodies.wall import WallBody, Walls
from ....core.numerics.float32 import shortest_decimal
from ....core.verdict.finding import MeasureError
from ...bodies.measure_object import Measured
from ...bodies.measurement import measurement_of
from ...bodies.request import Request
from ...settings import hooks
from ...write import properties
from ..tracking import staleness, stamps
from ..tracking.cache import SessionCache
from . import density

MAX_CACHED_OBJECTS = 64  # objects


@dataclass(frozen=True)
class _CachedWalls:
    """One object's walls, and the geometry and transform in the stamp stored with them."""

    reading: Reading
    walls: Walls
    geometry: str
    transform: str
    unit: float


_cache: SessionCache[_CachedWalls] = SessionCache(MAX_CACHED_OBJECTS)


def cache_walls(obj: Object, measured: Measured, unit: float) -> None:
    """Remember the walls that an object was measured with; `unit` is in meters per Blender unit."""
    stamp = stamps.Stamp.parse(measured.measurement.fingerprint)
    reading, body = measured.reading, measured.body
    assert isinstance(reading, Reading) and isinstance(body, WallBody) and body.walls is not None
    reading = replace(reading, parts=[])
    _cache[obj] = _CachedWalls(reading, body.walls.drop_arrays(), stamp.geometry, stamp.transform, unit)
    if on_wall_setting not in hooks.on_wall_change:
        hooks.on_wall_change.append(on_wall_setting)


def max_thickness(obj: Object) -> float | None:
    """Return the thickness in m from which the object's wall folds over, or None if it is unknown or unlimited."""
    cached = _current_walls(obj)
    if cached is None or obj.body_moments.wall == "THIN":
        return None
    limit = _walls_on_side(cached, obj).max_thickness
    return limit if limit < float("inf") else None


def is_too_thick(obj: Object) -> bool:
    """Return whether the current thickness is known to be too large."""
    limit, cached = max_thickness(obj), _cache.get(obj)
    return (
        cached is not None
        and limit is not None
        and not shortest_decimal(obj.body_moments.thickness) * cached.unit < limit
    )


def on_wall_setting(settings: PropertyGroup, context: Context) -> None:
    """Store the numbers of a changed wall or thickness."""
    obj = settings.id_data
    cached = _current_walls(obj)
    scene = context.scene
    if (
        cached is None
        or settings.kind != "SHELL"
        or settings.wall == "THIN"
        or shortest_decimal(scene.unit_settings.scale_length) != cached.unit
        or staleness.is_edited(obj)
        or settings.mass_from == "DENSITY"
        and settings.density_from != "VALUE"
    ):
        return
    request = Request.resolve(obj, unit=cached.unit)
    try:
        body = _walls_on_side(cached, obj).body(request.settings.thickness, check_overlap=False)
        measurement = measurement_of(cached.reading, body, request)
    except MeasureError:  # the panel shows how thick it may be
        return
    properties.store(obj, density.noted(obj, measurement, scene))
    staleness.mark_object(obj)


def _walls_on_side(cached: _CachedWalls, obj: Object) -> Walls:
    return replace(cached.walls, side=obj.body_moments.wall.lower())


def _current_walls(obj: Object) -> _CachedWalls | None:
    """Return the kept walls of an object, if its stored numbers are of the same geometry and transform."""
    cached, stamp = _cache.get(obj), stamps.of_results(obj)
    if cached is None or stamp is None or (stamp.geometry, stamp.transform) != (cached.geometry, cached.transform):
        return None
    return cached
