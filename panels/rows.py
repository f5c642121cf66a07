# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of a narrow panel: settings, values that can be copied, and buttons."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees
from typing import Any

from bpy.types import PropertyGroup, UILayout

from ..blender import write
from ..blender.session.selected import is_mixed
from ..core import inertia, measurement, verdict
from . import texts

# share of a row for its label, for one of up to 3 letters, and for one of 1 letter
LABEL_SHARE = 0.36
SHORT_LABEL_SHARE = 0.3
INDEX_LABEL_SHARE = 0.12

VERDICTS = {  # icon and word; the form says it, not the color alone
    verdict.Verdict.EXACT: ("CHECKMARK", "Exact"),
    verdict.Verdict.REPAIRED: ("MODIFIER", "Repaired"),
    verdict.Verdict.DOUBTFUL: ("ERROR", "Doubtful"),
    verdict.Verdict.OUT_OF_DATE: ("FILE_REFRESH", "Out of Date"),
    verdict.Verdict.INCOMPLETE: ("ERROR", "Incomplete"),
    None: ("RADIOBUT_OFF", "Not Measured"),
}
AXIS_LABELS = ("X", "Y", "Z")
PRINCIPAL_LABELS = ("1", "2", "3")
TENSOR_LABELS = tuple("I" + name for name in inertia.ENTRIES)
VALUE_SHARE = 0.6  # share of a row that a setting takes beside its label
WIDEST_COSINE = "−0.0000"  # rows of directions have one form, whatever their signs
BUTTON_MARGIN = "m"  # a letter as wide as the space around a button's text
Cell = tuple[str, str, str, str]  # label, text, copied value, its unit
LABELS = {  # labels of settings, in place of their names
    "mass": "Mass (kg)",
    "shown_mass": "Total Mass (kg)",
    "density": "Density (kg/m³)",
    "linear_density": "Density (kg/m)",
    "value_density": "Value 1 (kg/m³)",
    "transfer_table": "Table",
    "given_center": "Center",
    "print_line_width": "Line Width (mm)",
    "print_layer_height": "Layer (mm)",
    "pocket_radius": "Pocket (mm)",
    "pocket_density": "Ballast (kg/m³)",
    "spool_mass": "Spool (kg)",
}


def settings(layout: UILayout, data: PropertyGroup, *names: str, expand: bool = False) -> None:
    """Draw settings in a column, each with its label beside it, or above it in a narrow region.

    `expand` puts choices side by side if there is room for their names. A setting that differs
    among the selected objects is a button "Mixed", which opens its choices or its field.
    """
    for name in names:
        _setting(layout, data, name, expand)


def _setting(layout: UILayout, data: PropertyGroup, name: str, expand: bool) -> None:
    definition = data.bl_rna.properties[name]
    text = LABELS.get(name, "")
    if is_mixed(data, name):
        row = labeled_row(layout, text or definition.name, definition.translation_context)
        if definition.type == "ENUM":
            row.prop_menu_enum(data, name, text="Mixed")
        else:
            row.context_string_set("body_moments_setting", name)
            row.popover("OBJECT_PT_body_moments_mixed", text="Mixed")
        return
    options = {"text": text} if text else {}
    narrow = texts.is_narrow()
    if narrow and definition.type != "BOOLEAN":
        texts.title(layout, text or definition.name)
        options = {"text": ""}
    row = layout.row()
    row.use_property_split = not narrow
    if expand:
        names = [write.translations.localized(item.name) for item in definition.enum_items]
        expand = texts.fits(
            1.0 if narrow else VALUE_SHARE, *(choice + BUTTON_MARGIN for choice in names)
        )
    row.prop(data, name, expand=expand, **options)


def labeled_row(column: UILayout, label: str, context: str = "*") -> UILayout:
    """Return a row beside a label, as Blender aligns properties, or below it in a narrow panel."""
    if texts.is_narrow():
        texts.title(column, label)
        return column.row(align=True)
    split = column.row(align=True).split(factor=1.0 - VALUE_SHARE, align=True)
    end = split.row()
    end.alignment = "RIGHT"
    end.label(text=label, text_ctxt=context)
    return split.row(align=True)


def group(
    layout: UILayout,
    label: str,
    labels: Sequence[str],
    quantity: str,
    si: Sequence[float] | None,
    size: float = 0.0,
) -> UILayout:
    """Draw a heading, and a row for each value below it, blank if it is unknown; return their
    column.
    """
    column = layout.column(align=True)
    heading(column, label, quantity, si)
    if si is None:
        table(column, [(name, "–", "", "") for name in labels])
    else:
        values(column, labels, quantity, si, size)
    return column


def quantities(layout: UILayout, entries: Sequence[tuple[str, str, float | None]]) -> None:
    """Draw a row for each (label, quantity, SI value or None), each in the unit that suits it."""
    table(layout, [quantity_cell(*entry) for entry in entries])


def quantity_cell(label: str, quantity: str, si: float | None) -> Cell:
    """Return the cells of a row for an SI value, in the unit that suits it, or for an unknown
    one.
    """
    if si is None:
        return label, "–", "", ""
    return (
        label,
        texts.scene_units().text(quantity, si),
        repr(float(si)),
        write.units.SI_UNITS[quantity],
    )


def angle_cell(label: str, angle: float) -> Cell:
    """Return the cells of a row for an angle in radians, shown in degrees."""
    text = "{:.2f}°".format(round(degrees(angle), 2) + 0.0).replace("-", "−")  # + 0.0: no −0
    return label, text, repr(degrees(angle)), "°"


def values(
    layout: UILayout, labels: Sequence[str], quantity: str, si: Sequence[float], size: float = 0.0
) -> None:
    """Draw a row for each value, all in the same unit. size: as for `Units.texts`."""
    value_texts = texts.scene_units().texts(quantity, si, size)
    table(
        layout,
        [
            (label, text, repr(float(number)), write.units.SI_UNITS[quantity])
            for label, text, number in zip(labels, value_texts, si)
        ],
    )


def center(layout: UILayout, label: str, numbers: inertia.PlainBody | None) -> None:
    """Draw the center of mass; a coordinate that is mere rounding, relative to the body's size, is
    shown as 0.
    """
    place = None if numbers is None else numbers.center
    size = 0.0 if numbers is None else max(numbers.gyration)
    group(layout, label, AXIS_LABELS, "length", place, size)


def error_bounds(
    layout: UILayout,
    sources: Sequence[tuple[str, Mapping[str, Any]]],
    entries: Sequence[tuple[str, str, str, float]],
) -> None:
    """Draw the error bounds by source, with a row for each entry below the source.

    sources: headings, and bounds in SI units by name. entries: label, quantity, name of the bound,
    and the SI value that the bound is about, whose unit it takes.
    """
    bound = texts.scene_units().bound
    for source, errors in sources:
        column = layout.column(align=True)
        column.label(text=source)
        table(
            column,
            [
                (
                    label,
                    bound(quantity, errors[name], size),
                    repr(errors[name]),
                    write.units.SI_UNITS[quantity],
                )
                for label, quantity, name, size in entries
            ],
        )


def heading(layout: UILayout, label: str, quantity: str, si: Sequence[float] | None) -> None:
    """Draw a heading with a button that copies all values below it, if they are known."""
    row = layout.row(align=True)
    texts.title(row, label)
    if si is not None:
        _copy(row, repr(measurement.plain(si)), write.units.SI_UNITS.get(quantity, ""))


def direction(layout: UILayout, label: str, vector: Sequence[float] | None) -> None:
    """Draw a unit vector, blank if it is unknown, in one row, or in three rows if the panel is too
    narrow for one.
    """
    cosines = ["–"] * 3
    exact = [""] * 3
    if vector is not None:
        cosines = [
            "{:.4f}".format(component).replace("-0.0000", "0.0000").replace("-", "−")
            for component in vector
        ]
        exact = [repr(float(component)) for component in vector]
    # In place of the first cosine, the widest one.
    if not texts.fits(1.0 - INDEX_LABEL_SHARE, WIDEST_COSINE, *cosines[1:]):
        table(
            layout,
            [
                ("{:s} {:s}".format(label, name).strip(), text, copied, "")
                for name, text, copied in zip("xyz", cosines, exact)
            ],
        )
        return
    row = layout.row(align=True)
    split = row.split(factor=INDEX_LABEL_SHARE, align=True)
    split.label(text=label)
    cells = split.grid_flow(row_major=True, columns=3, even_columns=True, align=True)
    for text in cosines:
        right(cells, text)
    _copy(row, "" if vector is None else repr(measurement.plain(vector)), "")


def table(layout: UILayout, cells: Sequence[Cell]) -> None:
    """Draw rows of label, text to the right, copy button, all in one form, in a column.

    Labels are above their texts if rows are too narrow for both, and units beside the labels if
    rows are too narrow for the texts.
    """
    if not cells:
        return
    layout = layout.column(align=True)
    labels = [write.translations.localized(label) for label, *_ in cells]
    share, rests = _form(labels, [text for _, text, *_ in cells])
    for label, (_, text, exact, unit) in zip(labels, cells):
        if share:
            row = layout.row(align=True)
            cell = row.split(factor=share, align=True)
            cell.label(text=label, translate=False)
            right(cell, text)
            _copy(row, exact, unit)
        elif rests:
            texts.headline(layout, label)
            row = layout.row(align=True)
            right(row, text)
            _copy(row, exact, unit)
        else:
            number, _, unit_name = text.rpartition(" ")
            row = layout.row(align=True)
            texts.headline(row, "{:s} {:s}".format(label, unit_name))
            _copy(row, exact, unit)
            right(layout, number)


def _form(labels: Sequence[str], value_texts: Sequence[str]) -> tuple[float, bool]:
    """Return the share of a row that labels take, 0 if they are above their texts, and whether each
    text fits into a row.

    The share depends on the lengths of the labels, and is changed only if a label or a text needs
    more room.
    """
    letters = max(map(len, labels))
    share = LABEL_SHARE
    if letters < 4:
        share = INDEX_LABEL_SHARE if letters < 2 else SHORT_LABEL_SHARE
    room = texts.find_room()
    if room is None:
        return share, True
    label = max(map(texts.length, labels))
    text = max(map(texts.length, value_texts))
    if label + text > room:
        return 0.0, text <= room
    return min(max(share, label / room), 1.0 - text / room), True


def right(layout: UILayout, *shown: str) -> UILayout:
    """Draw texts at the right end of a row, and return their layout."""
    cell = layout.row(align=True)
    cell.alignment = "RIGHT"
    for text in shown:
        cell.label(text=text, translate=False)
    return cell


def _copy(row: UILayout, exact: str, unit: str) -> None:
    if not exact:
        return
    button = row.operator("object.body_moments_copy_value", text="", icon="COPYDOWN", emboss=False)
    button.value = exact
    button.unit = unit


def fold(layout: UILayout, idname: str, label: str, closed: bool = True) -> UILayout | None:
    """Draw a part that can be folded, and return its layout, or None while it is closed. closed:
    whether at first.
    """
    header, body = layout.panel(idname, default_closed=closed)
    header.label(text=label)
    return body


def button(layout: UILayout, idname: str, icon: str, short: str = "", **options: object):
    """Draw the button of an operator; in a narrow panel without its icon, and with a short text."""
    if not texts.is_narrow():
        return layout.operator(idname, icon=icon, **options)
    return layout.operator(idname, **(options | {"text": short} if short else options))


def buttons(layout: UILayout, *entries: tuple[str, str]) -> UILayout:
    """Draw the buttons of operators with their icons, one below the other; return their column."""
    column = layout.column(align=True)
    for idname, icon in entries:
        button(column, idname, icon)
    return column


def main_button(layout: UILayout, idname: str, icon: str, **options: object):
    """Draw the higher button of the operator that a panel is for."""
    row = layout.row()
    row.scale_y = 1.4
    return row.operator(idname, icon=icon, **options)
