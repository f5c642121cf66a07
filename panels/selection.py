# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of the selection: the measured objects as a list, and the selected ones as one
body.
"""

from __future__ import annotations

from bpy.props import BoolProperty, EnumProperty
from bpy.types import Context, UIList

from ..blender.session.displayed import SortBy, Verdict, drawn, listed_masses, listing
from . import places, rows, texts

LINES = 5  # height of the list, before it scrolls


class BODY_MOMENTS_UL_measured(UIList):
    """The measured objects of the view layer with mass and verdict."""

    sort_by: EnumProperty(
        name="Sort By",
        items=(
            (SortBy.NAME, "Name", "By name"),
            (SortBy.MASS, "Mass", "The heaviest first"),
            (SortBy.VERDICT, "Verdict", "The least trustworthy first"),
        ),
        default=SortBy.NAME,
    )
    warnings_first: BoolProperty(
        name="Warnings First", description="List what is out of date or doubtful before all others"
    )

    def draw_item(
        self, context, layout, _data, obj, _icon, _active_data, _active_property, _index
    ) -> None:
        body = drawn(obj, context.scene)
        if body is None:
            layout.label(text=obj.name, translate=False)
            return
        row = layout.row(align=True)
        row.alert = body.verdict == Verdict.OUT_OF_DATE
        row.active = obj.select_get()
        row.label(text=obj.name, icon=rows.VERDICTS[body.verdict][0], translate=False)
        if not texts.is_narrow():
            masses = listed_masses(context.scene, context.view_layer, texts.scene_units())
            rows.right(row, masses[obj.session_uid])

    def draw_filter(self, _context, layout) -> None:
        row = layout.row(align=True)
        row.prop(self, "filter_name", text="", icon="VIEWZOOM")
        row.prop(self, "warnings_first", text="", icon="ERROR")
        row.prop(self, "use_filter_sort_reverse", text="", icon="SORT_DESC")
        layout.row(align=True).prop(self, "sort_by", expand=True)

    def filter_items(self, context, _data, _name) -> tuple[list[int], list[int]]:
        listed, lines = listing(
            context.scene,
            context.view_layer,
            self.filter_name,
            SortBy(self.sort_by),
            self.warnings_first,
        )
        return [self.bitflag_filter_item if is_listed else 0 for is_listed in listed], lines


class SelectionPanel:
    """The selected objects as one body"""

    bl_label = "Selection"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return bool(context.view_layer.objects)

    def draw(self, context: Context) -> None:
        layout = self.layout
        rows.button(layout, "object.body_moments_copy_settings", "PASTEDOWN", short="Copy Settings")
        layout.template_list(
            BODY_MOMENTS_UL_measured.__name__,
            "",
            context.view_layer,
            "objects",
            context.scene,
            "body_moments_listed",
            rows=LINES,
        )
        column = layout.column(align=True)
        rows.button(
            column, "object.body_moments_copy", "COPYDOWN", text="Copy Table"
        ).what = "TABLE"
        rows.button(column, "object.body_moments_save_numbers", "FILE_TICK", short="Save")


CLASSES = places.in_both_places(SelectionPanel, "selection")
