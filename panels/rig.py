# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones: the part of the active bone among the bone's properties, and the sub-panel of a whole character."""

from __future__ import annotations

from bpy.types import Context, Panel, PoseBone, UILayout

from ..blender.session.tracking.staleness import stale_reason
from ..blender.write import properties
from ..blender.write.units import Units
from . import rows
from .places import in_both_places

LISTED = 60  # bones that the sub-panel lists


class BonesPanel:
    """The parts of a character's bones"""

    bl_label = "Bones"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.object is not None and context.object.type == "ARMATURE"

    def draw(self, context: Context) -> None:
        layout, armature = self.layout, context.object
        layout.use_property_decorate = False
        button = layout.row()
        button.scale_y = 1.4
        button.operator("object.body_moments_measure_bones", icon="BONE_DATA")
        if properties.stored(armature) is None:
            return
        rows.stale_row(layout, context, stale_reason(armature, context.scene))
        units = Units.from_settings(context.scene.unit_settings)
        stored = [(bone, properties.stored(bone)) for bone in armature.pose.bones]
        measured = [(bone, numbers.mass) for bone, numbers in stored if numbers is not None]
        total = sum(mass for _, mass in measured)
        column = layout.column(align=True)
        for bone, mass in measured[:LISTED]:
            row = column.row(align=True)
            row.label(text=bone.name, icon="BONE_DATA", translate=False)
            cell = row.row(align=True)
            cell.alignment = "RIGHT"
            cell.label(text=units.text("mass", mass), translate=False)
            cell.label(text="{:.1f}%".format(100.0 * mass / total), translate=False)
        if len(measured) > LISTED:
            rows.filled(layout, "And {:d} more", len(measured) - LISTED)
        column = layout.column(align=True)
        rows.button(column, context, "object.body_moments_physics_rig", "RIGID_BODY")
        rows.button(column, context, "object.body_moments_rig_center", "EMPTY_AXIS")
        rows.button(column, context, "object.body_moments_clear_bones", "TRASH")


class BONE_PT_body_moments(Panel):
    """The part of the active bone, in rest pose and the bone's rest frame"""

    bl_idname = "BONE_PT_body_moments"
    bl_label = "Body Moments"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "bone"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return _pose_bone(context) is not None

    def draw(self, context: Context) -> None:
        bone, layout = _pose_bone(context), self.layout
        layout.use_property_decorate = False
        settings = bone.body_moments
        column = layout.column()
        rows.setting(column, settings, "mass_from")
        if settings.mass_from == "DENSITY":
            rows.setting(column, settings, "density", text="Density (kg/m³)")
        elif settings.mass_from == "MASS":
            rows.setting(column, settings, "mass", text="Mass (kg)")
        rows.button(layout, context, "object.body_moments_measure_bones", "BONE_DATA")
        rows.stale_row(layout, context, stale_reason(bone.id_data, context.scene))
        _numbers(layout, context, bone)


def _pose_bone(context: Context) -> PoseBone | None:
    obj = context.object
    if obj is None or obj.type != "ARMATURE" or obj.pose is None or obj.data.bones.active is None:
        return None
    return obj.pose.bones.get(obj.data.bones.active.name)


def _numbers(layout: UILayout, context: Context, bone: PoseBone) -> None:
    stored, units = properties.stored(bone), Units.from_settings(context.scene.unit_settings)
    if stored is None:
        return
    column = layout.column(align=True)
    rows.quantities(column, units, [("Mass", "mass", stored.mass), ("Volume", "volume", stored.volume)])
    rows.center(layout, units, "Center of Mass (Rest Frame)", stored)
    rows.group(layout, units, "Principal Moments", rows.PRINCIPAL_LABELS, "inertia", stored.moments)
    rows.group(layout, units, "Inertia, Ixy = −∫xy dm", rows.TENSOR_LABELS, "inertia", stored.inertia)


CLASSES = (*in_both_places(BonesPanel, "bones"), BONE_PT_body_moments)
