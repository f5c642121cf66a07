# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of a measured wall and the threshold of a measured grid as sliders.

Walls are kept in memory as polynomials in the thickness, grids with their values; a change of the
setting stores the numbers of the new body. If geometry or transform have changed since, the stored
numbers stay and are out of date. While a threshold moves, its numbers come from every second or
third value of a large grid and are out of date; a moment later the exact ones follow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import bpy
from bpy.types import Context, Object, PropertyGroup, Scene

from ....core import bodies, numerics, verdict
from ....core.density import GridOptions
from ....core.measurement import Body
from ... import scale, write
from ...bodies.request import Request, measurement_of
from ...bodies.stack import Measured
from ...settings import hooks
from ...settings.density import grid_key
from ...settings.options import MeasureOptions
from .. import memory
from ..tracking import staleness, stamps
from . import density

DELAY = 0.3  # s after the last change of a threshold
COARSE = "coarse"  # equals no key of settings, so that results with it are out of date

Source = TypeVar("Source", bodies.Walls, bodies.ThresholdGrid)


@dataclass(frozen=True, eq=False)
class _Kept(Generic[Source]):
    """The walls or the grid of an object's measurement, and the parts of the stamps that were
    stored with it since.

    geometries: the digests at every stored threshold, because undo may restore each. unit: meters
    per Blender unit.
    """

    reading: bodies.Reading
    source: Source
    geometries: set[str]
    transform: str
    unit: float


SliderWalls = _Kept[bodies.Walls]
SliderGrid = _Kept[bodies.ThresholdGrid]


def remember(obj: Object, measured: Measured, scene: Scene) -> None:
    """Remember the wall or the grid of an object's measurement, if it has one, and follow its
    setting from now on.
    """
    stamp = stamps.Stamp.parse(measured.measurement.fingerprint)
    reading = measured.reading
    body = measured.body
    unit = scale.meters_per_unit(scene)
    if isinstance(body, bodies.WallBody) and body.walls is not None:
        memory.walls[obj] = _Kept(
            replace(reading, parts=[]),
            body.walls.drop_arrays(),
            {stamp.geometry},
            stamp.transform,
            unit,
        )
        if on_wall_setting not in hooks.on_wall_change:
            hooks.on_wall_change.append(on_wall_setting)
    elif isinstance(body, bodies.ThresholdGridBody):
        memory.grids[obj] = _Kept(reading, body.grid, {stamp.geometry}, stamp.transform, unit)
        if on_threshold not in hooks.on_threshold_change:
            hooks.on_threshold_change.append(on_threshold)


def max_thickness(obj: Object) -> float | None:
    """Return the thickness in m from which the object's wall folds over, or None if it is unknown
    or unlimited.
    """
    cached = _current(memory.walls, obj)
    if cached is None or obj.body_moments.wall == "THIN":
        return None
    limit = _walls_on_side(cached, obj).max_thickness
    return limit if limit < float("inf") else None


def is_too_thick(obj: Object) -> bool:
    """Return whether the current thickness is known to be too large."""
    limit = max_thickness(obj)
    cached = memory.walls.get(obj)
    if limit is None or cached is None:
        return False
    return not numerics.shortest_decimal(obj.body_moments.thickness) * cached.unit < limit


def on_wall_setting(settings: PropertyGroup, context: Context) -> None:
    """Store the numbers of a changed wall or thickness, if they follow it: no density that varies,
    and neither the geometry nor the transform has changed.
    """
    obj = settings.id_data
    scene = context.scene
    cached = _current(memory.walls, obj, scene)
    is_walled = settings.kind == "SHELL" and settings.wall != "THIN"
    varies = settings.mass_from == "DENSITY" and settings.density_from != "VALUE"
    if cached is None or not is_walled or varies:
        return

    def body(request: Request) -> Body:
        return _walls_on_side(cached, obj).body(request.settings.thickness, check_overlap=False)

    if _store(obj, scene, cached, body):
        staleness.mark_object(obj)


def on_threshold(settings: PropertyGroup, context: Context) -> None:
    """Store the numbers of a changed threshold from a coarse grid, and the exact ones after a
    moment.
    """
    obj = settings.id_data
    scene = context.scene
    cached = _current_grid(obj, scene)
    if cached is None:
        return
    coarse = cached.source.coarse()
    # A small grid is its own coarse one, so that its numbers are exact.
    if _store_threshold(obj, scene, cached, coarse, preview=True) and coarse is cached.source:
        staleness.mark_object(obj)
    if (obj, scene) not in memory.due_numbers:
        memory.due_numbers.append((obj, scene))
    if bpy.app.background:
        _finish()
        return
    if bpy.app.timers.is_registered(_finish):
        bpy.app.timers.unregister(_finish)
    bpy.app.timers.register(_finish, first_interval=DELAY)


def _current(
    cache: memory.SessionCache[_Kept[Source]], obj: Object, scene: Scene | None = None
) -> _Kept[Source] | None:
    """Return an object's cached walls or grid, if its stored numbers belong to the same geometry
    and transform.

    scene: if given, it must also have the same unit scale, and the object no edits since.
    """
    cached = cache.get(obj)
    stamp = stamps.stamp_of(obj)
    if (
        cached is None
        or stamp is None
        or stamp.geometry not in cached.geometries
        or stamp.transform != cached.transform
    ):
        return None
    if scene is not None and scale.meters_per_unit(scene) != cached.unit:
        return None
    return None if scene is not None and staleness.is_edited(obj) else cached


def _current_grid(obj: Object, scene: Scene | None) -> _Kept[bodies.ThresholdGrid] | None:
    """Return `_current` of an object's grid, None if it has no threshold now."""
    cached = None if scene is None else _current(memory.grids, obj, scene)
    return cached if cached is not None and obj.body_moments.grid_as == "THRESHOLD" else None


def _walls_on_side(cached: _Kept[bodies.Walls], obj: Object) -> bodies.Walls:
    """Return the cached walls, on the side that the object's settings say now."""
    return replace(cached.source, side=obj.body_moments.wall.lower())


def _store(obj: Object, scene: Scene, cached: _Kept, body: Callable[[Request], Body]) -> bool:
    """Write the numbers of a body to the object; return False if there are none; the panel and
    Measure then say why.
    """
    request = Request.resolve(obj, given=MeasureOptions(unit_scale=cached.unit))
    try:
        measurement = measurement_of(cached.reading, body(request), request)
    except verdict.MeasureError:
        return False
    write.properties.store(obj, density.noted(obj, measurement, scene))
    cached.geometries.add(stamps.Stamp.parse(measurement.fingerprint).geometry)
    return True


def _store_threshold(
    obj: Object,
    scene: Scene,
    cached: _Kept[bodies.ThresholdGrid],
    grid: bodies.ThresholdGrid,
    preview: bool,
) -> bool:
    """Write the numbers of the current threshold to the object; return False if there are none.

    grid: the source, or its coarse one, whose numbers are out of date by their stamp. preview: as
    in `bodies.threshold_grid_body`.
    """
    options = GridOptions.from_settings(obj.body_moments)

    def body(_request: Request) -> Body:
        key = grid_key(obj) if grid is cached.source else COARSE
        return replace(bodies.threshold_grid_body(grid, options, preview), density_key=key)

    return _store(obj, scene, cached, body)


def _finish() -> None:
    """Store the exact numbers of the pending objects.

    Return None, so that Blender's timer calls this only once.
    """
    while memory.due_numbers:
        obj, scene = memory.due_numbers.pop()
        try:
            cached = _current_grid(obj, scene)
        except ReferenceError:  # removed meanwhile
            continue
        if cached is not None and _store_threshold(
            obj, scene, cached, cached.source, preview=False
        ):
            staleness.mark_object(obj)
