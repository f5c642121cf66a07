# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums of displayed bodies: of a selection, of the meshes that an armature deforms, of a character's posed bones."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from bpy.types import Object, Scene
from numpy.typing import NDArray

from ....core.inertia.mass_properties import MassProperties, combine
from ....core.numerics.float32 import shortest_decimal
from ....core.numerics.rotations import rotation_matrix
from ...read.rig import skinned_objects
from ...write import properties
from ...write.properties import StoredProperties
from ..displayed import Displayed, Trust, displayed, drawn_bone
from ..tracking import armatures


def of_meshes(armature: Object, scene: Scene) -> Displayed | None:
    """Return the sum of the meshes that an armature deforms and that have numbers; None if they have no mass."""
    parts = [shown for mesh in armatures.deformed_meshes(armature) if (shown := displayed(mesh, scene)) is not None]
    return _of_parts(armature, scene, parts)


def of_bones(armature: Object, scene: Scene) -> Displayed | None:
    """Return the sum of a character's parts in its current pose; its own stored numbers are of the rest pose."""
    parts = [shown for bone in armature.pose.bones if (shown := drawn_bone(bone, scene)) is not None]
    return _of_parts(armature, scene, parts)


def members(obj: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the members of an assembly or character: its descendants, and the `objects` that it deforms."""
    return [*obj.children_recursive, *skinned_objects(obj, objects)]


def add(parts: Sequence[StoredProperties]) -> StoredProperties | None:
    """Return bodies as one, in their common frame, by the parallel-axis theorem; None if they have no mass."""
    body = _combine([part.body for part in parts])
    if body is None:
        return None
    volume, area = sum([part.volume for part in parts]), sum([part.area for part in parts])
    bound = _bound_of_sum(parts, body.center, [part.error_bound for part in parts])
    bound["input"] = _bound_of_sum(parts, body.center, [part.error_bound["input"] for part in parts])
    return StoredProperties.of_body(body, body.mass / volume if volume else 0.0, volume, area, bound)


def _of_parts(armature: Object, scene: Scene, parts: Sequence[Displayed]) -> Displayed | None:
    world = add([part.world for part in parts]) if parts else None
    if world is None:
        return None
    location, turn, _ = armature.matrix_world.decompose()
    unit = shortest_decimal(scene.unit_settings.scale_length)
    body = world.body.in_frame(rotation_matrix(turn), np.array(location, np.float64) * unit)
    own = StoredProperties.of_body(body, world.density, world.volume, world.area, world.error_bound)
    worst = max(parts, key=lambda part: tuple(Trust).index(part.trust))
    return Displayed(own, world, unit, worst.method, worst.findings, worst.trust, is_posed=True)


def _combine(bodies: Sequence[MassProperties]) -> MassProperties | None:
    """Return bodies as one, summed in whole arrays; None if they have no mass."""
    masses = np.array([body.mass for body in bodies])
    if not masses.sum() > 0.0:  # the stored values were changed
        return None
    centers = np.array([body.center for body in bodies])
    about = masses @ centers / masses.sum()
    arms = centers - about
    inertia = np.array([body.inertia for body in bodies])
    second = np.trace(inertia, axis1=1, axis2=2).sum() / 2.0 * np.eye(3) - inertia.sum(axis=0)
    second += np.einsum("i,ij,ik->jk", masses, arms, arms)
    inertia = np.trace(second) * np.eye(3) - second
    whole = replace(bodies[0], mass=float(masses.sum()), center=about, inertia=inertia)
    return combine([(whole.as_moments(), 1.0)])


def _bound_of_sum(
    parts: Sequence[StoredProperties], center: NDArray, bounds: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """Return the bound of a sum of bodies, from the bound of each."""
    volume, area, center_error, inertia = np.array(
        [[bound[name] for name in properties.BOUND_KEYS] for bound in bounds], np.float64
    ).T
    mass = np.array([part.mass for part in parts])
    arm = np.linalg.norm([np.subtract(part.center, center) for part in parts], axis=1)
    sizes = np.array([(part.volume, part.area) for part in parts]).T  # a shell without thickness has its mass by area
    share = np.where(sizes[0] > 0.0, volume, area) / np.maximum(np.where(sizes[0] > 0.0, *sizes), np.finfo(float).tiny)
    own = mass * (1.0 + share)
    center_of_sum = float((own * center_error + share * mass * arm).sum() / mass.sum())
    reach = arm + center_error + center_of_sum
    inertia_of_sum = inertia + own * (reach * reach - arm * arm) + share * mass * arm * arm
    values = volume.sum(), area.sum(), center_of_sum, inertia_of_sum.sum()
    return dict(zip(properties.BOUND_KEYS, map(float, values)))
