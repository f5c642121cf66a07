# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of what a body's shape tells, wherever it lies: its symmetry, its copies, and laying one on another."""

from __future__ import annotations

from bpy.types import Context, Object, Panel, UILayout

from ..operators.session import staleness
from . import rows

SHOWN = 12  # elements of a symmetry, and similar shapes
KINDS = {"AXIS": "{:d}-Fold", "PLANE": "Mirror", "ROUND": "Round"}
ICONS = {
    "copy": "CHECKMARK",
    "scaled copy": "FULLSCREEN_ENTER",
    "mirror image": "MOD_MIRROR",
    "scaled mirror": "MOD_MIRROR",
    "copy or mirror": "QUESTION",
    "scaled copy or mirror": "QUESTION",
    "similar": "RADIOBUT_OFF",
    "different": "X",
}


class ShapePanel:
    """What both places show."""

    bl_label = "Shape"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_decorate = False
        layout.operator("object.body_moments_find_symmetry", icon="MOD_MIRROR")
        _symmetry(layout, context, context.object)
        column = layout.column(align=True)
        column.operator("object.body_moments_match_pose", icon="SNAP_ON")
        row = column.row(align=True)
        row.operator("object.body_moments_find_similar", icon="VIEWZOOM")
        row.operator("object.body_moments_find_in_library", text="", icon="FILEBROWSER")
        _found(layout, context)


def _symmetry(layout: UILayout, context: Context, obj: Object) -> None:
    if not obj.is_property_set("body_moments_symmetry"):
        return
    kept = obj.body_moments_symmetry
    column = layout.column(align=True)
    column.label(text="Symmetry {:s}".format(kept.group), icon="CHECKMARK")
    rows.outdated(column, staleness.symmetry_reason(obj))
    if kept.compatible != kept.group:
        text = "Moments to order 6 alone would allow {:s}".format(kept.compatible)
        rows.sentence(column, context, text, icon="BLANK1")
    rows.sentence(
        column,
        context,
        "The {:s} lies on its images within {:.2g} of the radius of gyration".format(
            "display mesh" if kept.of_display_mesh else "surface", kept.tolerance
        ),
        icon="BLANK1",
    )
    if not kept.elements:
        return
    header, body = layout.panel("body_moments_symmetry", default_closed=True)
    header.label(text="Axes and Mirror Planes")
    if body is None:
        return
    column = body.column(align=True)
    column.label(text="Directions and normals, object axes")
    for element in kept.elements[:SHOWN]:
        column.label(text=KINDS[element.kind].format(element.order))
        rows.direction(column, "", element.direction)
    if len(kept.elements) > SHOWN:
        column.label(text="and {:d} more".format(len(kept.elements) - SHOWN))


def _found(layout: UILayout, context: Context) -> None:
    search = context.scene.body_moments_search
    if not search.wanted:
        return
    header, body = layout.panel("body_moments_similar", default_closed=False)
    header.label(text="Similar to {:s}".format(search.wanted))
    if body is None:
        return
    column = body.column(align=True)
    if search.looked_at:
        column.label(text=search.looked_at, icon="FILE")
    if not search.found:
        column.label(text="Nothing to compare with", icon="INFO")
    else:
        row = column.row()
        row.alignment = "RIGHT"
        row.label(text="Verdict, Distance")
    for one in search.found[:SHOWN]:
        row = column.row(align=True)
        if search.looked_at:
            row.label(text=one.name, icon=ICONS[one.verdict])
        else:
            row.operator("object.body_moments_select_found", text=one.name, icon=ICONS[one.verdict]).name = one.name
        cell = row.row(align=True)
        cell.alignment = "RIGHT"
        size = " ×{:.4g}".format(one.scale) if one.verdict.startswith("scaled") else ""
        cell.label(text="{:s}{:s}, {:.2g}".format(one.verdict.title(), size, one.distance))


class VIEW3D_PT_body_moments_shape(ShapePanel, Panel):
    """Symmetry and similar shapes in the sidebar"""

    bl_idname = "VIEW3D_PT_body_moments_shape"
    bl_parent_id = "VIEW3D_PT_body_moments"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Moments"


class OBJECT_PT_body_moments_shape(ShapePanel, Panel):
    """Symmetry and similar shapes in the object's properties"""

    bl_idname = "OBJECT_PT_body_moments_shape"
    bl_parent_id = "OBJECT_PT_body_moments"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"


CLASSES = (VIEW3D_PT_body_moments_shape, OBJECT_PT_body_moments_shape)
