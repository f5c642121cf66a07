# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object shows, or takes its density from: what changes it though Blender reports no change of it."""

from __future__ import annotations

from collections.abc import Iterator

from bpy.types import ID, Object


def shown_by(obj: Object) -> Iterator[ID]:
    """Find what an object shows as instances, whose shape and place matter.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Yields
    ------
    bpy.types.ID
        Objects and collections. Of collections Blender reports what happens to their members.
    """
    kind = obj.instance_type
    if kind == "COLLECTION":
        if obj.instance_collection is not None:
            yield obj.instance_collection
    elif kind != "NONE":
        yield from obj.children_recursive
    for system in obj.particle_systems:
        settings = system.settings
        if settings.instance_object is not None:
            yield settings.instance_object
        if settings.instance_collection is not None:
            yield settings.instance_collection


def density_source(obj: Object) -> Object | None:
    """Return the Volume object that the density comes from, of which the shape matters; its place is a setting.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.

    Returns
    -------
    bpy.types.Object or None
    """
    settings = obj.body_moments
    return settings.density_volume if settings.density_from == "VOLUME" else None
