# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects in a list and their order, cached until Blender reports a change."""

from __future__ import annotations

from enum import StrEnum

from bpy.types import Object, Scene, ViewLayer

from ...write.units import Units
from ..displayed import Displayed, Trust, all_drawn
from ..tracking import handlers
from ..tracking.cache import SessionCache, current_value

Listing = tuple[list[bool], list[int]]  # for each object its visibility in the list, and its line
RANKS = {verdict: rank for rank, verdict in enumerate(Trust)}


class SortBy(StrEnum):
    """Sort key of the lines."""

    NAME = "NAME"
    MASS = "MASS"  # the heaviest first
    VERDICT = "VERDICT"  # the least trustworthy first


_masses: SessionCache[tuple[tuple, dict[int, str]]] = SessionCache()  # by scene: the last query, and its answer
_listings: SessionCache[tuple[tuple, Listing]] = SessionCache()  # by scene: the last query, and its answer


def listing(scene: Scene, view_layer: ViewLayer, name: str, sort_by: SortBy, warnings_first: bool) -> Listing:
    """Return two lists over a view layer's objects: whether each is listed, and its line, warnings first on request."""
    key = (handlers.generation(), view_layer.name, name, sort_by, warnings_first)
    return current_value(
        _listings, scene, key, lambda: _listing(scene, view_layer, name.lower(), sort_by, warnings_first)
    )


def listed_masses(scene: Scene, view_layer: ViewLayer) -> dict[int, str]:
    """Return texts of the masses of a view layer's measured objects by session uid, with common unit and decimals."""
    units = Units.from_settings(scene.unit_settings)

    def list_masses() -> dict[int, str]:
        objects = list(view_layer.objects)
        masses = {obj: body.world.mass for obj, body in zip(objects, all_drawn(objects, scene)) if body is not None}
        return dict(zip([obj.session_uid for obj in masses], units.texts("mass", list(masses.values()))))

    return current_value(_masses, scene, (handlers.generation(), view_layer.name, units), list_masses)


def _listing(scene: Scene, view_layer: ViewLayer, name: str, sort_by: SortBy, warnings_first: bool) -> Listing:
    objects = list(view_layer.objects)
    all_bodies = zip(objects, all_drawn(objects, scene))
    bodies = [body if name in obj.name.lower() else None for obj, body in all_bodies]
    order = sorted(range(len(objects)), key=lambda i: _rank(objects[i], bodies[i], sort_by, warnings_first))
    lines = [0] * len(objects)
    for line, i in enumerate(order):
        lines[i] = line
    return [body is not None for body in bodies], lines


def _rank(obj: Object, body: Displayed | None, sort_by: SortBy, warnings_first: bool) -> tuple:
    if body is None:
        return (True,)
    by = {SortBy.MASS: -body.world.mass, SortBy.VERDICT: -RANKS[body.trust]}
    is_first = warnings_first and body.trust in (Trust.OUT_OF_DATE, Trust.DOUBTFUL)
    return (False, not is_first, by.get(sort_by, 0.0), obj.name.lower(), obj.name)
