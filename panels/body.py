# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, in the order of CAD's mass property dialogs: verdict, material, mass, center,
principal axes, tensor.

It is in the 3D Viewport's sidebar, and the same in the object's properties, where it stays open
beside other settings.
"""

from __future__ import annotations

from bpy.types import Context, Panel

from ..operators.read.visibility import GEOMETRY_TYPES
from ..operators.session import results
from ..operators.write.units import Units
from . import rows
from .buttons import actions, analysis
from .density import settings_rows
from .numbers import more, numbers
from .totals import totals
from .verdict import method_and_findings, verdict


class BodyPanel:
    """What both places show."""

    bl_label = "Body Moments"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.object is not None

    def draw(self, context: Context) -> None:
        obj, scene = context.object, context.scene
        layout = self.layout
        layout.use_property_decorate = False
        units = Units.of(scene.unit_settings)
        shown = results.of_object(obj, scene)
        verdict(layout, context, obj, measured=shown is not None)
        if obj.type in GEOMETRY_TYPES or obj.instance_collection is not None:
            settings_rows(layout, context, obj)
        row = layout.row(align=True)
        row.scale_y = 1.4
        row.operator("object.body_moments_measure", icon="PHYSICS")
        row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")
        if len(context.selected_objects) > 1:
            layout.operator("object.body_moments_copy_settings", icon="PASTEDOWN")
        if shown is not None:
            _, findings = method_and_findings(obj)
            rows.warnings(layout, context, "body_moments_warnings", findings)
            numbers(layout, context, units, shown)
            more(layout, obj, units, shown)
            rows.notes(layout, context, "body_moments_notes", findings)
            row = layout.row(align=True)
            row.operator("object.body_moments_copy_report", icon="COPYDOWN")
            row.operator("object.body_moments_clear", icon="TRASH")
        actions(layout, obj)
        analysis(layout)
        totals(layout, context, units)


class VIEW3D_PT_body_moments(BodyPanel, Panel):
    """Mass properties in the sidebar"""

    bl_idname = "VIEW3D_PT_body_moments"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Moments"


class OBJECT_PT_body_moments(BodyPanel, Panel):
    """Mass properties in the object's properties"""

    bl_idname = "OBJECT_PT_body_moments"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}


CLASSES = (VIEW3D_PT_body_moments, OBJECT_PT_body_moments)
