# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings in a panel: beside their labels, or below them in a narrow region."""

from __future__ import annotations

import bpy
from bpy.types import PropertyGroup, UILayout

from ..blender.write.translations import localized
from . import rows

VALUE_SHARE = 0.6  # share of a row, beside the label
BUTTON_MARGIN = "m"  # a letter as wide as what a button has around its text


def setting(layout: UILayout, data: PropertyGroup, name: str, text: str = "", expand: bool = False) -> None:
    """Draw a setting with its label, by default its own, in a column.

    `expand` puts choices side by side if there is room for their names.
    """
    definition = data.bl_rna.properties[name]
    options = {"text": text} if text else {}
    narrow = rows.is_narrow(bpy.context)
    if narrow and definition.type != "BOOLEAN":
        rows.title(layout, text or definition.name)
        options = {"text": ""}
    row = layout.row()
    row.use_property_split = not narrow
    if expand:
        names = [localized(item.name) for item in definition.enum_items]
        expand = rows.fits(1.0 if narrow else VALUE_SHARE, *(one + BUTTON_MARGIN for one in names))
    row.prop(data, name, expand=expand, **options)
