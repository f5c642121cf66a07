# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored results of a character's bones."""

from __future__ import annotations

from bpy.types import Object

from ....core.verdict import internal_error
from ....core.verdict.finding import Finding
from ...bodies.rig import Rig
from ...write import properties
from ..tracking import armatures, staleness


def store(rig: Rig) -> list[tuple[str, Finding]]:
    """Store the results of all bones and the whole, or raise EditRefusedError; return bones without, and reasons."""
    armature = rig.armature
    properties.store(armature, rig.measurement)
    parts = {part.name: part for part in rig.parts}
    failures: list[tuple[str, Finding]] = []
    for bone in armature.pose.bones:
        part = parts.get(bone.name)
        if part is None or part.measurement is None:
            properties.clear(bone)
            if part is not None and part.refusal is not None:
                failures.append((bone.name, part.refusal))
            continue
        try:
            properties.store(bone, part.measurement)
        except Exception as error:
            failures.append((bone.name, internal_error.finding_of(error)))
    armatures.watch(armature, rig.objects)
    staleness.mark_object(armature)
    return failures


def clear(armature: Object) -> bool:
    """Remove the results of all bones and of the whole, or raise EditRefusedError; return whether there were any."""
    properties.require_storable(armature)
    cleared = [properties.clear(owner) for owner in (armature, *armature.pose.bones)]
    return any(cleared)
