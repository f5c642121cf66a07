# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Data to draw measured objects: the current place of their mass, and the trust in it.

A viewport is drawn at every movement of the mouse, so the answer is kept until Blender reports a change, and mapped to
the object's place until Blender reports a change of the object itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Object, PoseBone, Scene
from numpy.typing import NDArray

from ....core.numerics.float32 import shortest_decimal
from ....core.numerics.rotations import rotation_matrix
from ...settings.preferences import default_density
from ...write import properties
from ..live import live
from ..tracking import handlers, posed, staleness, updates
from ..tracking.cache import SessionCache
from . import results
from .trust import BY_OTHERS, Trust, trust, trust_of


@dataclass(frozen=True, eq=False)
class ShownBody:
    """A measured object as it is drawn: world axes, lengths in Blender units.

    center: (3,) center of mass. mass: in kg.
    axes: (3, 3) principal axes as columns, of the least moment first. gyration: (3,) radii of gyration about them.
    """

    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    mass: float
    verdict: Trust


@dataclass(frozen=True, eq=False)
class _Own:
    """An object's stored numbers, in its own frame, lengths in Blender units, and the key of their state."""

    key: tuple
    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    mass: float
    verdict: Trust


_shown: SessionCache[tuple[tuple, ShownBody | None]] = SessionCache()  # and after which change of which scene
_last: SessionCache[tuple[tuple, ShownBody | None]] = (
    SessionCache()
)  # and what it was found for, and after which update
_own: SessionCache[_Own] = SessionCache()


def shown_body(obj: Object, scene: Scene = None) -> ShownBody | None:
    """Return an original object's body as it is drawn: its live numbers if Live is on, else the stored ones.

    None if it has no numbers. scene: the scene of the drawing, by default the context's.
    """
    scene = scene or bpy.context.scene
    key = (handlers.generation(), scene.session_uid)
    cached = _shown.get(obj)
    if cached is None or cached[0] != key:
        cached = _shown[obj] = (key, _shown_now(obj, scene))
    return cached[1]


def changes_alone(obj: Object) -> bool:
    """Return whether an object's drawn body is independent of all moves of others that leave its geometry."""
    return obj.type == "MESH" and not (
        live.is_live(obj)
        or obj.body_moments.density_from in BY_OTHERS
        or obj.is_instancer
        or any(modifier.type == "NODES" for modifier in obj.modifiers)
    )


def _shown_now(obj: Object, scene: Scene) -> ShownBody | None:
    if live.is_live(obj) or obj.body_moments.density_from in BY_OTHERS:
        return _computed(obj, scene)
    if posed.stands_for_meshes(obj):
        return _computed(obj, scene) if results.are_meshes_measured(obj, scene) else _posed_rig(obj, scene)
    if "body_mass" not in obj:
        return None
    if obj.type == "ARMATURE":
        return _posed_rig(obj, scene)
    key = (
        updates.last_change_but_moves(obj),
        obj.get("body_fingerprint"),
        scene.session_uid,
        scene.unit_settings.scale_length,
        default_density(scene),
    )
    place, last = (key, updates.last_change(obj)), _last.get(obj)
    if last is None or last[0] != place:
        last = _last[obj] = (place, _mapped(obj, scene, key))
    return last[1]


def _mapped(obj: Object, scene: Scene, key: tuple) -> ShownBody | None:
    """Return the body kept for `key`, mapped to the object's current place."""
    own = _own.get(obj)
    if own is None or own.key != key or not staleness.has_transform_of_results(obj):
        return _computed(obj, scene, key)
    location, turn, _ = obj.matrix_world.decompose()
    rotation = rotation_matrix(turn)
    return ShownBody(rotation @ own.center + location, rotation @ own.axes, own.gyration, own.mass, own.verdict)


def _computed(obj: Object, scene: Scene, key: tuple | None = None) -> ShownBody | None:
    """Compute the drawn body, and keep it for `key` if that is given."""
    stored = results.in_world(obj, scene)
    if stored is None or not stored.body.mass > 0.0:
        return None
    body, unit = stored.body, shortest_decimal(scene.unit_settings.scale_length)
    shown = ShownBody(
        body.center / unit, body.principal.axes, body.radii_of_gyration / unit, body.mass, trust(obj, scene)
    )
    if key is not None and staleness.has_transform_of_results(obj):
        location, turn, _ = obj.matrix_world.decompose()
        to_own = rotation_matrix(turn).T
        center = to_own @ (shown.center - location)
        _own[obj] = _Own(key, center, to_own @ shown.axes, shown.gyration, shown.mass, shown.verdict)
    return shown


def _posed_rig(armature: Object, scene: Scene) -> ShownBody | None:
    """Return a character as the current places of its bones' parts; its own stored numbers are of the rest pose."""
    parts = [part for bone in armature.pose.bones if (part := shown_bone(bone, scene)) is not None]
    if not parts:
        return None
    masses, centers = np.array([part.mass for part in parts]), np.array([part.center for part in parts])
    axes = np.array([part.axes for part in parts])
    center = masses @ centers / masses.sum()
    arms = centers - center
    inertia = np.einsum("n,nij,nj,nkj->ik", masses, axes, np.array([part.gyration**2 for part in parts]), axes)
    second = np.einsum("n,ni,nk->ik", masses, arms, arms)
    moments, frame = np.linalg.eigh((inertia + np.trace(second) * np.eye(3) - second) / masses.sum())
    frame[:, 2] *= np.sign(np.linalg.det(frame))
    return ShownBody(center, frame, np.sqrt(np.maximum(moments, 0.0)), float(masses.sum()), trust(armature, scene))


def shown_bone(bone: PoseBone, scene: Scene) -> ShownBody | None:
    """Return the drawn body of a pose bone's part, in the bone's current place; None if it has no numbers.

    bone: of an original armature object.
    """
    numbers = properties.numbers(bone)
    if numbers is None:
        return None
    body, armature = properties.from_numbers(numbers).body, bone.id_data
    location, turn, _ = (armature.matrix_world @ bone.matrix).decompose()
    rotation, unit = rotation_matrix(turn), shortest_decimal(scene.unit_settings.scale_length)
    is_stale = staleness.stale_reason(armature, scene) is not None
    return ShownBody(
        rotation @ (body.center / unit) + location,
        rotation @ body.principal.axes,
        body.radii_of_gyration / unit,
        body.mass,
        Trust.OUT_OF_DATE if is_stale else trust_of(properties.method(bone), properties.findings(armature)),
    )
