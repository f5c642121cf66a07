# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Armatures and their meshes: meshes of posed armatures, and edits of measured characters.

A skinned mesh is evaluated anew whenever its armature moves, but the rest pose is measured: an edit
is a new shape of a mesh without an update of its armature.
"""

from __future__ import annotations

from collections.abc import Iterable

import bpy
from bpy.types import Object, ViewLayer

from ... import read, settings, write
from .. import memory
from . import handlers, staleness


def stands_for_meshes(obj: Object) -> bool:
    """Return whether an original object is an armature in Pose Mode, whose meshes count in its
    place.
    """
    return obj.type == "ARMATURE" and obj.mode == "POSE"


def deformed_meshes(armature: Object) -> tuple[Object, ...]:
    """Return the meshes of the window's view layer that an original armature deforms, in the
    layer's order.
    """
    return _deformed_meshes(armature, bpy.context.view_layer)


@memory.until_change
def _deformed_meshes(armature: Object, layer: ViewLayer) -> tuple[Object, ...]:
    return tuple(
        obj for obj in layer.objects if obj.type == "MESH" and read.rig.is_skin_of(obj, armature)
    )


def subjects(objects: Iterable[Object]) -> list[Object]:
    """Return original objects, each once, with the deformed meshes in place of posed armatures.

    Colliders, and objects without a shape or results, are left out, unless nothing else is among
    the objects.
    """
    by_object: dict[Object, None] = {}
    candidates = list(objects)
    for obj in [obj for obj in candidates if _counts(obj)] or candidates:
        by_object.update(dict.fromkeys(deformed_meshes(obj) if stands_for_meshes(obj) else (obj,)))
    return list(by_object)


def _counts(obj: Object) -> bool:
    """Return whether an object can be measured or shows results, as assemblies and armatures do; no
    collider does.
    """
    may_be_measured = read.visibility.has_shape(obj) or stands_for_meshes(obj)
    return settings.given.COLLIDER not in obj and (may_be_measured or "body_mass" in obj)


def watch(armature: Object, objects: Iterable[Object]) -> None:
    """Begin to note edits of the meshes among `objects` that an armature deforms, in the name of
    the armature.
    """
    for obj in read.rig.skinned_objects(armature, objects):
        memory.watched[obj.session_uid] = armature


def watch_all() -> None:
    """Watch the meshes of all measured characters of a file."""
    memory.watched.clear()
    for obj in bpy.data.objects:
        if obj.type == "ARMATURE" and "body_mass" in obj:
            watch(obj, bpy.data.objects)


def redraw_weights(updates: handlers.Updates) -> None:
    """Redraw sidebars with the weight of a character after a frame change: Blender does not redraw
    them during playback.
    """
    for window in bpy.context.window_manager.windows if updates.frame_changed else ():
        obj = window.view_layer.objects.active
        if obj is not None and obj.type == "ARMATURE" and obj.body_moments_weight.show:
            for area in window.screen.areas:
                for region in area.regions if area.type == "VIEW_3D" else ():
                    if region.type == "UI":
                        region.tag_redraw()


def note_updates(updates: handlers.Updates) -> None:
    """Note an edit on an armature if one of its watched meshes has a new shape and the armature has
    no update.
    """
    if read.tracking.tracking_paused.depth or not memory.watched:
        return
    # A new pose evaluates the meshes with their armature; an edit evaluates a mesh alone.
    touched = {*updates.reshaped, *updates.moved, *updates.others}
    for uid in memory.watched.keys() & updates.reshaped:
        armature = memory.watched[uid]
        if armature.session_uid not in touched:
            staleness.set_edited(armature, write.properties.fingerprint(armature), True)
