# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of a body's shape, wherever it lies: its symmetry, its copies, and moving one onto
another.
"""

from __future__ import annotations

from bpy.types import Context, Object, UILayout

from ..blender import read, session, settings, write
from ..blender.session.tracking import staleness, stamps
from ..core.verdict import SIMILARITY, truncate
from . import places, rows, texts

MAX_SHOWN = 12  # elements of a symmetry, and similar shapes
KINDS = {"AXIS": "{:d}-Fold Axis", "PLANE": "Mirror Plane", "ROUND": "Axis of Revolution"}
ICONS = {
    "copy": "CHECKMARK",
    "scaled_copy": "FULLSCREEN_ENTER",
    "mirror": "MOD_MIRROR",
    "scaled_mirror": "MOD_MIRROR",
    "copy_or_mirror": "QUESTION",
    "scaled_copy_or_mirror": "QUESTION",
    "similar": "RADIOBUT_OFF",
    "different": "X",
}


class ShapePanel:
    """Symmetry and similar shapes"""

    bl_label = "Shape"

    def draw(self, context: Context) -> None:
        layout = self.layout
        column = layout.column(align=True)
        rows.button(column, "object.body_moments_find_symmetry", "MOD_MIRROR", short="Symmetry")
        rows.button(column, "object.body_moments_match_pose", "SNAP_ON")
        row = column.row(align=True)
        rows.button(row, "object.body_moments_find_similar", "VIEWZOOM", short="Similar")
        if settings.preferences.shows_advanced():
            row.operator("object.body_moments_find_in_library", text="", icon="FILEBROWSER")
        rows.button(column, "object.body_moments_link_copies", "LINKED")
        _symmetry(layout, context, session.selected.subject(context))
        _similar(layout, context)


def _symmetry(layout: UILayout, context: Context, obj: Object | None) -> None:
    if obj is None or not obj.is_property_set("body_moments_symmetry"):
        return
    stored = obj.body_moments_symmetry
    column = layout.column(align=True)
    texts.filled(column, "Symmetry {:s}", stored.group, icon="CHECKMARK")
    texts.stale_state(column, staleness.stale_reason(obj, context.scene, stamps.Kind.SYMMETRY))
    if stored.compatible != stored.group:
        text = "Moments to order 6 alone allow {group}"
        texts.remark(column, text, icon="BLANK1", group=stored.compatible)
    text = "The surface matches its images within {share:.2g} of the radius of gyration"
    if stored.of_display_mesh:
        text = "The display mesh matches its images within {share:.2g} of the radius of gyration"
    texts.remark(column, text, icon="BLANK1", share=stored.tolerance)
    if not stored.elements:
        return
    body = rows.fold(layout, "body_moments_symmetry", "Axes and Mirror Planes")
    if body is None:
        return
    column = body.column(align=True)
    column.label(text="Directions and normals along the object's axes")
    listed_elements, further_count = truncate(stored.elements, MAX_SHOWN)
    for element in listed_elements:
        texts.filled(column, KINDS[element.kind], element.order)
        rows.direction(column, "", element.direction)
    if further_count:
        texts.filled(column, "And {:d} more", further_count)


def _similar(layout: UILayout, context: Context) -> None:
    search = context.scene.body_moments_search
    if not search.wanted:
        return
    header, body = layout.panel("body_moments_similar")
    texts.filled(header, "Similar to {:s}", search.wanted)
    if body is None:
        return
    column = body.column(align=True)
    if search.looked_at:
        column.label(text=search.looked_at, icon="FILE", translate=False)
    if not search.found:
        texts.remark(column, "Nothing to compare with")
    else:
        rows.right(column).label(text="Similarity, Distance")
    for shape in search.found[:MAX_SHOWN]:
        row = column.row(align=True)
        icon = ICONS.get(shape.verdict, "QUESTION")
        if search.looked_at:
            row.label(text=shape.name, icon=icon, translate=False)
        else:
            button = row.operator(
                "object.body_moments_select_found", text=shape.name, icon=icon, translate=False
            )
            button.name = shape.name
        words = write.translations.localized(SIMILARITY.get(shape.verdict, shape.verdict))
        size = " ×{:.4g}".format(shape.scale) if shape.verdict.startswith("scaled") else ""
        rows.right(row, "{:s}{:s}, {:.2g}".format(words, size, shape.distance))


CLASSES = places.in_both_places(
    ShapePanel, "shape", shown_for=read.visibility.measurable, for_any=True
)
