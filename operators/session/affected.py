# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which other objects show, or take their density from, what Blender has evaluated anew."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import bpy
from bpy.types import Collection, Object


def volume_filled_objects(updated: Iterable[Object]) -> Iterator[Object]:
    """Find the objects with stored numbers whose density comes from the voxels of updated objects.

    Parameters
    ----------
    updated : iterable of bpy.types.Object
        Original objects with new geometry.

    Yields
    ------
    bpy.types.Object
        Each once.
    """
    sources = {obj for obj in updated if obj.type == "VOLUME"}
    if not sources:
        return
    for obj in bpy.data.objects:
        if "body_fingerprint" in obj:
            settings = obj.body_moments
            if settings.density_from == "VOLUME" and settings.density_volume in sources:
                yield obj


def instancing_objects(updated: Iterable[Object], collections: set[Collection]) -> Iterator[Object]:
    """Find the objects that show updated ones as instances, which Blender reports of collections only.

    Parameters
    ----------
    updated : iterable of bpy.types.Object
        Original objects with new geometry or transform.
    collections : set of bpy.types.Collection
        Original collections of which something is new.

    Yields
    ------
    bpy.types.Object
        Some perhaps more than once.
    """
    updated = set(updated)
    above: set[Object] = set()
    for obj in updated:
        while (obj := obj.parent) is not None and obj not in above:
            above.add(obj)
            if obj.instance_type in {"VERTS", "FACES"}:
                yield obj
    emitted = {
        settings
        for settings in bpy.data.particles
        if settings.instance_object in updated or settings.instance_collection in collections
    }
    for obj in bpy.data.objects if collections or emitted else ():
        if (
            obj.instance_type == "COLLECTION"
            and obj.instance_collection in collections
            or emitted
            and any(system.settings in emitted for system in obj.particle_systems)
        ):
            yield obj
