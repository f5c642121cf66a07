# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies: a collection, or an empty with its children, as one body, with the tree of its
members.

The sub-panel shows the active empty if it has children, else the active object's collection; the
active collection has a panel among the collection's properties too.
"""

from __future__ import annotations

import re
from itertools import islice

from bpy.types import (
    Collection,
    Context,
    Object,
    Panel,
    PropertyGroup,
    UILayout,
    UIList,
    bpy_prop_collection,
)

from ..blender.session.tracking.staleness import stale_reason
from ..blender.settings import assembly, chosen, given
from ..blender.write import properties, translations
from ..core import inertia, verdict
from . import density, places, remedies, rows, texts

MEMBER_ICONS = {
    "COLLECTION": "OUTLINER_COLLECTION",
    "INSTANCE": "OUTLINER_OB_GROUP_INSTANCE",
    "EMPTY": "EMPTY_AXIS",
    "OBJECT": "OBJECT_DATA",
    "POINT": "EMPTY_SINGLE_ARROW",
}
LINES = 8  # height of the tree, before it scrolls
# Masses of turned copies differ by the rounding of float32 coordinates, about 1e-7; chosen, with a
# margin of 100.
EQUAL_RTOL = 1e-5


class BODY_MOMENTS_UL_assembly(UIList):
    """The members of an assembly with their masses and shares."""

    def draw_item(
        self, context, layout, data, row, _icon, _active_data, _active_property, index
    ) -> None:
        line = layout.row(align=True)
        # 0.001: every line begins with a separator of some width, also those of depth 0
        line.separator(factor=0.001 + 1.5 * row.depth)
        tree = assembly.settings_of(data.id_data).rows
        if index + 1 < len(tree) and tree[index + 1].depth > row.depth:
            icon = "DISCLOSURE_TRI_DOWN" if row.is_open else "DISCLOSURE_TRI_RIGHT"
            line.prop(row, "is_open", text="", icon=icon, emboss=False)
        else:
            line.label(text="", icon="BLANK1")
        name = line.row(align=True)
        name.active = row.is_counted
        copies = _count_equal(tree, index)
        text = row.name if copies == 1 else "{:d} × {:s}".format(copies, _base_name(row.name))
        name.label(text=text, icon=MEMBER_ICONS[row.member], translate=False)
        findings = properties.findings_in(row.findings)
        words = []
        if row.mass > 0.0:
            words.append(texts.scene_units().text("mass", copies * row.mass))
            if row.is_counted and row.depth:  # the share of the whole assembly would be 100%
                words.append("{:.0f}%".format(100.0 * copies * row.share))
        numbers = rows.right(line, *words)
        numbers.active = row.is_counted
        if findings:
            worst = max(
                findings, key=lambda finding: tuple(texts.ICONS).index(verdict.severity(finding))
            )
            numbers.label(text="", icon=texts.ICONS[verdict.severity(worst)])

    def filter_items(self, _context, data, name) -> tuple[list[int], list[int]]:
        """Hide rows below a closed member, rows that do not match a search, and equal parts but for
        the first.
        """
        flags = []
        closed_depth = None  # depth of the closed member that the row may be below
        previous_row = None
        for row in getattr(data, name):
            is_hidden = closed_depth is not None and row.depth > closed_depth
            is_repeated = previous_row is not None and _are_equal(previous_row, row)
            previous_row = row
            if is_hidden or is_repeated:
                flags.append(0)
                continue
            closed_depth = None if row.is_open else row.depth
            matches = not self.filter_name or self.filter_name.lower() in row.name.lower()
            flags.append(self.bitflag_filter_item if matches else 0)
        return flags, []  # []: in the order of the rows


def _base_name(name: str) -> str:
    """Return a name without the number that Blender gives to copies."""
    return re.sub(r"\.\d{3,}$", "", name)


def _are_equal(row: PropertyGroup, other_row: PropertyGroup) -> bool:
    # Successive copies of one part are shown as one line.
    return (
        row.member == other_row.member == "OBJECT"
        and (row.depth, row.is_counted, row.findings)
        == (other_row.depth, other_row.is_counted, other_row.findings)
        and abs(row.mass - other_row.mass) <= EQUAL_RTOL * row.mass
        and _base_name(row.name) == _base_name(other_row.name)
    )


def _count_equal(tree: bpy_prop_collection, first: int) -> int:
    # equal rows from the index `first` on; not if the last one has members, which are below it
    end = first + 1
    while end < len(tree) and _are_equal(tree[end - 1], tree[end]):
        end += 1
    has_members = end < len(tree) and tree[end].depth > tree[first].depth
    return 1 if has_members else end - first


def draw_assembly(layout: UILayout, context: Context, root: assembly.Root, target: str) -> None:
    """Draw an assembly's settings, its total and its tree."""
    layout.use_property_decorate = False
    settings = assembly.settings_of(root)
    column = layout.column()
    rows.settings(column, settings, "mass_from", expand=True)
    if settings.mass_from == "MASS":
        rows.settings(column, settings, "mass")
        density.given_rows(layout, settings)
    rows.main_button(layout, "object.body_moments_measure_assembly", "PHYSICS").target = target
    stored = properties.stored(root) if properties.method_text(root) == "assembly" else None
    actions = layout.column(align=True)
    actions.enabled = stored is not None
    _actions(actions, target, isinstance(root, Collection))
    reason = None if stored is None else stale_reason(root, context.scene)
    texts.stale_state(layout, reason)
    if stored is None:
        return
    groups = [verdict.Group(finding) for finding in properties.findings(root)]
    rows.quantities(layout, [("Mass", "mass", stored.mass)])
    _tree(layout, settings)
    _numbers(layout, stored, isinstance(root, Collection))
    remedies.lines(layout, context, groups, can_accept=False)
    remedies.notes(layout, "body_moments_assembly_notes", groups)


def _actions(column: UILayout, target: str, is_collection: bool) -> None:
    row = column.row(align=True)
    rows.button(
        row,
        "object.body_moments_export_bill",
        "EXPORT",
        text="Bill of Masses...",
        short="Masses...",
    ).target = target
    row.operator("object.body_moments_clear_assembly", text="", icon="TRASH").target = target
    rows.button(
        column, "view3d.body_moments_cursor_to_assembly", "PIVOT_CURSOR", short="Cursor"
    ).target = target
    rows.button(column, "object.body_moments_assembly_empty", "OUTLINER_OB_EMPTY").target = target
    text = "Instance Offset to Center of Mass" if is_collection else "Origin to Center of Mass"
    rows.button(
        column, "object.body_moments_assembly_origin", "OBJECT_ORIGIN", text=text
    ).target = target


def _tree(layout: UILayout, settings: PropertyGroup) -> None:
    layout.template_list(
        BODY_MOMENTS_UL_assembly.__name__,
        "",
        settings,
        "rows",
        settings,
        "active_row",
        rows=max(min(LINES, len(settings.rows)), 2),
    )
    if 0 <= settings.active_row < len(settings.rows):
        for finding in properties.findings_in(settings.rows[settings.active_row].findings):
            texts.message(layout, finding)


def _numbers(layout: UILayout, stored: inertia.PlainBody, in_world: bool) -> None:
    entries = [("Volume", "volume", stored.volume), ("Area", "area", stored.area)]
    rows.quantities(layout, [(label, name, si) for label, name, si in entries if si])
    heading = "Center of Mass (World)" if in_world else "Center of Mass (Object)"
    rows.center(layout, heading, stored)
    rows.group(layout, "Principal Moments", rows.PRINCIPAL_LABELS, "inertia", stored.moments)


class AssemblyPanel:
    """A collection, or an empty with its children, as one body"""

    bl_label = "Assembly"

    @classmethod
    def poll(cls, context: Context) -> bool:
        root = assembly.active_assembly(context) if chosen.chosen_objects(context) else None
        if not isinstance(root, Collection):
            return root is not None
        members = (obj for obj in root.all_objects if given.has_density(obj))
        # A collection of one body is no assembly. Two are enough to know: it may have thousands.
        return properties.is_stored(root) or len([*islice(members, 2)]) > 1

    def draw(self, context: Context) -> None:
        root = assembly.active_assembly(context)
        text = (
            translations.localized("Empty: {:s}")
            if isinstance(root, Object)
            else translations.localized("Collection: {:s}")
        )
        self.layout.label(text=text.format(root.name), icon="OUTLINER_COLLECTION", translate=False)
        draw_assembly(self.layout, context, root, "OF_OBJECT")


class COLLECTION_PT_body_moments(places.AmongProperties, Panel):
    """The active collection as one body"""

    bl_context = "collection"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.collection is not None

    def draw(self, context: Context) -> None:
        draw_assembly(self.layout, context, context.collection, "COLLECTION")


CLASSES = places.in_both_places(AssemblyPanel, "assembly")
