# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Center of Mass to a character: an empty that follows its pose, and plays without the add-on.

A bone's part moves with the bone, and so does its center: an empty for each, parented to the bone. Copy Location
constraints, each with the share of its part in the mass of those so far, then put one more empty at their weighted
mean.
"""

from __future__ import annotations

import bpy
import numpy as np
from bpy.types import Context, Object, Operator
from mathutils import Matrix, Vector

from ...blender.bodies.rig import BonePart, Rig, measure_rig
from ...blender.read.rig import require_armature
from ...blender.read.tracking import tracking_paused
from ...blender.scene.made_collections import MadeCollection
from ...blender.write import reports
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import MeasureError, finding
from .. import selection
from ..findings import RIG_CENTER_ADDED
from ..modal import redraw
from .measure import poll_armature

CENTER_OF = "center_of_mass_of"  # ID property of what is made: the armature object


class OBJECT_OT_body_moments_rig_center(Operator):
    """Add an empty that stays at the center of mass of the posed character."""

    bl_idname = "object.body_moments_rig_center"
    bl_label = "Add Center of Mass"
    bl_description = (
        "Add an empty that stays at the center of mass of the character in every pose, by constraints to the centers "
        "of the bones' parts. One added before is replaced"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return poll_armature(cls, context)

    def execute(self, context: Context) -> set[str]:
        try:
            rig = measure_rig(context, require_armature(context.object))
            with tracking_paused():
                _add_center(context, rig)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        selection.report(self, finding(RIG_CENTER_ADDED, armature=rig.armature.name))
        redraw(context)
        return {"FINISHED"}


def _add_center(context: Context, rig: Rig) -> None:
    armature = rig.armature
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    made = MadeCollection(context, armature, CENTER_OF, "Center of Mass")
    center = bpy.data.objects.new("{:s} Center of Mass".format(armature.name), None)
    center.empty_display_type, center.show_in_front = "SPHERE", True
    center.empty_display_size = 0.1 * float(rig.measurement.mass_properties.radii_of_gyration.max()) / unit
    made.link(center)
    mass = 0.0
    for part in rig.parts:
        if part.mass.total <= 0.0:
            continue
        mass += part.mass.total
        constraint = center.constraints.new("COPY_LOCATION")
        constraint.name = part.name
        constraint.target = _follower(context, made, armature, part, unit)
        constraint.influence = part.mass.total / mass
    context.view_layer.update()


def _follower(context: Context, made: MadeCollection, armature: Object, part: BonePart, unit: float) -> Object:
    """Add an empty that is parented to a bone, at the center of its part."""
    bone = armature.data.bones[part.name]
    empty = bpy.data.objects.new("{:s} {:s} Center".format(armature.name, part.name), None)
    empty.empty_display_size = 0.1 * bone.length
    made.link(empty)
    rest = np.array(armature.matrix_world @ bone.matrix_local, np.float64)
    local = np.linalg.solve(rest, np.append(part.mass.center / unit, 1.0))[:3]
    empty.parent, empty.parent_type, empty.parent_bone = armature, "BONE", bone.name
    empty.matrix_parent_inverse = Matrix.Identity(4)
    empty.location = Vector(local) - Vector((0.0, bone.length, 0.0))  # children of a bone start at its tail
    empty.hide_set(True)
    return empty


CLASSES = (OBJECT_OT_body_moments_rig_center,)
