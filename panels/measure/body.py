# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The main panel: the object's name and a verdict, warnings and their remedies, mass, volume and center.

The rest is in sub-panels, in the order of CAD's mass property dialogs (`places.ORDER`).
"""

from __future__ import annotations

from bpy.types import Context

from ...blender.session.displayed import displayed
from ...blender.session.live import following
from ...blender.session.tracking import posed
from ...blender.write.units import Units
from .. import rows
from ..density.density import material_row
from ..overlay.popover import header_switch
from ..places import in_both_places
from . import remedies
from .numbers import numbers
from .verdict import verdict


class BodyPanel:
    """Mass properties"""

    bl_label = "Body Moments"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.object is not None

    def draw_header_preset(self, context: Context) -> None:
        header_switch(self.layout, context)

    def draw(self, context: Context) -> None:
        obj, scene = context.object, context.scene
        layout = self.layout
        layout.use_property_decorate = False
        shown = displayed(obj, scene)
        verdict(layout, context, obj, shown)
        findings = shown.findings if shown is not None else ()
        remedies.last_action(layout, context)
        remedies.warnings(layout, context, "body_moments_warnings", findings)
        material_row(layout, context, obj)
        narrow = rows.is_narrow(context)
        buttons = layout.column(align=True) if narrow else layout.row(align=True)
        buttons.scale_y = 1.4
        rows.button(buttons, context, "object.body_moments_measure", "PHYSICS")
        row = buttons.row(align=True)
        followed = any(following.is_live(subject) for subject in posed.subjects([obj]))
        rows.button(row, context, "object.body_moments_live", "REC", depress=followed)
        row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")
        if shown is not None:
            remedies.unit_question(layout, context, shown.world)
            numbers(layout, context, Units.from_settings(scene.unit_settings), shown)
            row = layout.column(align=True) if narrow else layout.row(align=True)
            rows.button(row, context, "object.body_moments_copy_report", "COPYDOWN")
            rows.button(row, context, "object.body_moments_clear", "TRASH")
            remedies.notes(layout, context, "body_moments_notes", findings)


CLASSES = VIEW3D_PT_body_moments, OBJECT_PT_body_moments = in_both_places(BodyPanel)
