# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, in the order of CAD's mass property dialogs: verdict, material, mass, center,
principal axes, tensor.

It is in the 3D Viewport's sidebar, and the same in the object's properties, where it stays open
beside other settings.
"""

from __future__ import annotations

import numpy as np
from bpy.types import Context, Object, Panel, UILayout

from ..operators import live, results, staleness, wall_slider
from ..operators.counted import LISTED
from ..operators.read.visibility import GEOMETRY_TYPES
from ..operators.selection import listed
from ..operators.units import SI_UNITS, Units
from ..operators.write import properties
from . import grid, materials, rows

# method: (headline, icon, explanation)
VERDICTS = {
    "exact": ("Exact, Closed Surface", "CHECKMARK", ""),
    "grid exact": ("Exact, from a Grid", "VOLUME_DATA", ""),
    "union": ("United Shells", "INFO", "By Blender's exact boolean, to 7 digits"),
    "shell": ("Shell", "MOD_SOLIDIFY", "The mass is in the surface"),
    "wire": ("Wire", "CURVE_DATA", "The mass is along the curve"),
    "reoriented": ("Reoriented", "INFO", "Closed after flipped faces were turned"),
    "capped": ("Capped", "ERROR", "The surface is open; its holes were capped"),
    "open": ("Open", "CANCEL", "Not closed: the numbers depend on the reference point"),
}
AXES = ("X", "Y", "Z")
NUMBERS = ("1", "2", "3")
EQUAL = 1e-6  # moments closer than this, relatively, are shown as equal
BOUNDS = (("Rounding, at Most", None), ("Coordinates Stored as Float32, at Most", "input"))
ESTIMATED = "Quadrature and Rounding, Estimated"
BOUNDED = {
    "volume": ("Volume", "volume"),
    "area": ("Area", "area"),
    "center_of_mass": ("Center", "length"),
    "inertia": ("Inertia", "inertia"),
}


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
        found = results.of_object(obj, scene)
        _verdict(layout, context, obj, measured=found is not None)
        if obj.type in GEOMETRY_TYPES or obj.instance_collection is not None:
            _material(layout, context, obj)
        row = layout.row(align=True)
        row.scale_y = 1.4
        row.operator("object.body_moments_measure", icon="PHYSICS")
        row.operator("object.body_moments_select_faults", text="", icon="ZOOM_SELECTED")
        if len(context.selected_objects) > 1:
            layout.operator("object.body_moments_copy_settings", icon="PASTEDOWN")
        if found is not None:
            _numbers(layout, context, units, found)
            _more(layout, obj, units, found)
            rows.warnings(layout, context, "body_moments_warnings", _method_and_warnings(obj)[1])
            row = layout.row(align=True)
            row.operator("object.body_moments_copy_report", icon="COPYDOWN")
            row.operator("object.body_moments_clear", icon="TRASH")
        _actions(layout, obj)
        _analysis(layout)
        _totals(layout, context, units)


def _method_and_warnings(obj: Object) -> tuple[str, list[str]]:
    """Of the numbers that are shown: live or stored."""
    now = live.shown(obj)
    if now is not None and now.measurement is not None:
        return now.measurement.method, list(now.measurement.warnings)
    return properties.method_and_warnings(obj)


def _verdict(layout: UILayout, context: Context, obj: Object, measured: bool) -> None:
    column = layout.column(align=True)
    refusal = results.refusal(obj)
    if refusal or not measured:
        text = "Not Measured Again" if measured else "Not Measured"
        column.label(text=text, icon="CANCEL" if refusal else "RADIOBUT_OFF")
    if refusal:
        rows.sentence(column, context, refusal, icon="BLANK1")
    if not measured:
        return
    method, _ = _method_and_warnings(obj)
    *before, last = method.split() or [""]
    headline, icon, explanation = VERDICTS.get(method) or VERDICTS.get(last, (method.title(), "INFO", ""))
    before = [] if method in VERDICTS else [word[:1].upper() + word[1:] for word in before]
    column.label(text=" ".join([*before, headline]), icon=icon)
    if last == "shell" and obj.body_moments.wall != "THIN":
        explanation = "The mass is in walls of real thickness"
    if explanation:
        rows.sentence(column, context, explanation, icon="BLANK1")
    now = live.shown(obj)
    if now is not None and now.measurement is not None:
        if live.is_outdated(obj, context.scene):
            row = column.row()
            row.alert = True
            row.label(text="Out of Date: Settings Changed", icon="FILE_REFRESH")
            return
        column.label(text="Live, in {:.0f} ms: Measure Stores It".format(1e3 * now.seconds), icon="REC")
        return
    if now is not None:
        rows.sentence(column, context, now.reason, icon="ERROR")
    rows.outdated(column, staleness.reason(obj, context.scene))


def _material(layout: UILayout, context: Context, obj: Object) -> None:
    settings = obj.body_moments
    if obj.override_library is not None:
        rows.sentence(layout, context, "A library override: the file keeps none of these settings, nor results; make "
                                       "it local first", icon="ERROR")
    if obj.type == "VOLUME" and grid.settings_rows(layout, context, obj):
        return
    column = layout.column()
    column.use_property_split = True
    if obj.type == "VOLUME":
        column.row().prop(settings, "mass_from", text="Given", expand=True)
        if settings.mass_from == "MASS":
            column.prop(settings, "mass", text="Mass kg")
        else:
            _one_density(column, settings, "Material")
        return
    row = _labelled(column, "Kind")
    row.use_property_split = False
    for kind in ("SOLID", "SHELL", "WIRE") if obj.type == "CURVE" or settings.kind == "WIRE" else ("SOLID", "SHELL"):
        row.prop_enum(settings, "kind", kind)
    if obj.type == "SURFACE":
        column.operator("object.body_moments_live", icon="REC", depress=live.is_live(obj))
    if settings.kind == "SHELL":
        column.prop(settings, "wall")
        column.prop(settings, "thickness")
        _largest(column, context, obj)
    elif settings.kind == "SOLID":
        column.prop(settings, "overlap")
    column.row().prop(settings, "mass_from", text="Given", expand=True)
    if settings.mass_from == "DENSITY" and settings.kind == "WIRE":
        column.prop(settings, "linear_density", text="Density kg/m")
        return
    if settings.mass_from == "MASS":
        column.prop(settings, "mass", text="Mass kg")
        return
    column.prop(settings, "density_from", text="From")
    if settings.density_from == "POLYNOMIAL":
        column.prop(settings, "density_polynomial", text="kg/m³")
        column.row().prop(settings, "density_frame", text="x, y, z in m", expand=True)
    elif settings.density_from == "ATTRIBUTE":
        if obj.type == "MESH":
            column.prop_search(settings, "density_attribute", obj.data, "attributes", results_are_suggestions=True)
        else:
            column.prop(settings, "density_attribute")
    elif settings.density_from == "VOLUME":
        column.prop(settings, "density_volume")
    elif settings.density_from == "MATERIALS":
        _materials(layout, obj)
    else:
        _one_density(column, settings, "Material")


def _largest(layout: UILayout, context: Context, obj: Object) -> None:
    """How thick the wall may be, once that is known."""
    limit = wall_slider.largest(obj)
    if limit is None:
        return
    units = Units.of(context.scene.unit_settings)
    row = layout.row()
    row.alert = wall_slider.folds(obj)
    text = "Folds Over from {:s}" if row.alert else "Good up to {:s}"
    row.label(text=text.format(units.text("length", limit)), icon="ERROR" if row.alert else "INFO")


def _materials(layout: UILayout, obj: Object) -> None:
    settings = obj.body_moments
    column = layout.column(align=True)
    column.label(text="Densities, kg/m³")
    shown = {slot.material: None for slot in obj.material_slots if slot.material}
    for material in shown:
        materials.density_row(column, material, material.name)
    if not shown:
        column.label(text="It has no material slots", icon="INFO")
    column = layout.column()
    column.use_property_split = True
    _one_density(column, settings, "Without One")


def _labelled(column: UILayout, label: str) -> UILayout:
    """A row beside a label, as Blender puts properties there."""
    split = column.row(align=True).split(factor=0.4, align=True)
    heading = split.row()
    heading.alignment = "RIGHT"
    heading.label(text=label)
    return split.row(align=True)


def _one_density(column: UILayout, settings, heading: str) -> None:
    """The object's own density, with the table and the user's presets."""
    row = _labelled(column, heading)
    row.menu("OBJECT_MT_body_moments_materials", text=settings.material or "Custom")
    row.popover("OBJECT_PT_body_moments_presets", text="", icon="PRESET")
    column.prop(settings, "density", text="Density kg/m³")


def _numbers(layout: UILayout, context: Context, units: Units, found: properties.Stored) -> None:
    scene, source = context.scene, properties.density_from(context.object)
    column = layout.column(align=True)
    rows.value(column, units, "Mass", "mass", found.body.mass)
    length = properties.optional(context.object, "body_length")
    if length is None:
        rows.value(column, units, "Density", "density", found.density)
        if source:
            rows.sentence(column, context, "The mean, from {:s}".format(source), icon="BLANK1")
        rows.value(column, units, "Volume", "volume", found.volume)
        if found.area:  # a grid of densities has no surface
            rows.value(column, units, "Area", "area", found.area)
    else:
        rows.value(column, units, "Length", "length", length)
    layout.row().prop(scene.body_moments, "frame", expand=True)
    column = layout.column(align=True)
    rows.heading(column, "Center of Mass", "length", found.body.center)
    rows.values(column, units, AXES, "length", found.body.center, found.body.radii_of_gyration.max())
    column = layout.column(align=True)
    rows.heading(column, "Principal Moments", "inertia", found.body.principal.moments)
    rows.values(column, units, NUMBERS, "inertia", found.body.principal.moments)
    column = layout.column(align=True)
    rows.heading(column, "Principal Axes", "", found.body.principal.axes.T)
    for label, axis in zip(NUMBERS, found.body.principal.axes.T):
        rows.direction(column, label, axis)
    free = _free_axes(found.body.principal.moments)
    if free:
        column.label(text=free, icon="INFO")


def _free_axes(moments: np.ndarray) -> str:
    """What equal moments leave to choose."""
    first, second = (np.diff(moments) <= EQUAL * moments[2]).tolist()
    if first and second:
        return "All axes have equal moments"
    return "Axes 1 and 2 have equal moments" if first else "Axes 2 and 3 have equal moments" if second else ""


def _more(layout: UILayout, obj: Object, units: Units, found: properties.Stored) -> None:
    header, body = layout.panel("body_moments_gyration", default_closed=True)
    header.label(text="Radii of Gyration")
    if body is not None:
        rows.values(body.column(align=True), units, NUMBERS, "length", found.body.radii_of_gyration)
    header, body = layout.panel("body_moments_tensor", default_closed=True)
    header.label(text="Inertia Tensor")
    if body is not None:
        column = body.column(align=True)
        column.label(text="At the center of mass, Ixy = −∫xy dm")
        entries = properties.tensor_entries(found.body.inertia)
        rows.values(column, units, ["I" + name for name in properties.ENTRIES], "inertia", entries)
    if live.shown(obj) is not None:
        return
    display = properties.optional(obj, "body_display_volume")
    if display is not None:
        header, body = layout.panel("body_moments_display_mesh", default_closed=True)
        header.label(text="Display Mesh Instead")
        if body is not None:
            column = body.column(align=True)
            rows.value(column, units, "Volume", "volume", display)
            rows.value(column, units, "Difference", "volume", display - found.volume)
            column.label(text="{:+.3g} % of the volume".format(100.0 * (display / found.volume - 1.0)))
    header, body = layout.panel("body_moments_bounds", default_closed=True)
    header.label(text="Error Bounds")
    if body is not None:
        _bounds(body, obj, units, found)


def _bounds(layout: UILayout, obj: Object, units: Units, found: properties.Stored) -> None:
    sizes = {
        "volume": found.volume,
        "area": found.area,
        "center_of_mass": np.abs(found.body.center).max(),
        "inertia": found.body.principal.moments.max(),
    }
    for heading, bound in BOUNDS:
        column = layout.column(align=True)
        column.label(text=ESTIMATED if bound is None and properties.is_estimated(obj) else heading)
        values = found.error_bound if bound is None else found.error_bound[bound]
        for name, (label, quantity) in BOUNDED.items():
            if name in ("volume", "area") and not sizes[name]:
                continue  # a wire has neither, a grid of densities no surface
            rows.texts(column, label, units.bound(quantity, values[name], sizes[name]), repr(values[name]),
                       SI_UNITS[quantity])


def _actions(layout: UILayout, obj: Object) -> None:
    header, body = layout.panel("body_moments_snap", default_closed=False)
    header.label(text="Snap")
    if body is None:
        return
    column = body.column(align=True)
    column.operator("object.body_moments_origin_to_center", icon="OBJECT_ORIGIN")
    column.operator("object.body_moments_axes_to_principal", icon="EMPTY_AXIS")
    column.operator("object.body_moments_align_to_world", icon="ORIENTATION_GLOBAL")
    column = body.column(align=True)
    column.operator("object.body_moments_add_empty", text="Add Empty", icon="OUTLINER_OB_EMPTY")
    column.operator("view3d.body_moments_cursor_to_center", icon="PIVOT_CURSOR")
    column.operator(
        "object.body_moments_create_orientation",
        text="Transform Orientation",
        icon="ORIENTATION_LOCAL",
    )
    text = "Set Rigid Body Mass" if obj.rigid_body else "Add Rigid Body with Mass"
    column.operator("object.body_moments_set_rigid_body_mass", text=text, icon="RIGID_BODY").add = not obj.rigid_body
    body.operator("object.body_moments_sculpt_balance", icon="SCULPTMODE_HLT")


def _analysis(layout: UILayout) -> None:
    header, body = layout.panel("body_moments_analysis", default_closed=True)
    header.label(text="Analysis")
    if body is not None:
        body.operator("object.body_moments_fourier", text="Fourier Transform…", icon="MOD_WAVE")


def _totals(layout: UILayout, context: Context, units: Units) -> None:
    header, body = layout.panel("body_moments_totals", default_closed=True)
    header.label(text="Total of Selection")
    if body is None:
        return
    total = results.total(context)
    column = body.column(align=True)
    if not total.count:
        column.label(text="No selected object is measured", icon="INFO")
        return
    column.label(
        text="1 object" if total.count == 1 else "{:d} objects".format(total.count), icon="GROUP"
    )
    for names, text in ((total.missing, "Not measured: {:s}"), (total.outdated, "Out of date: {:s}")):
        if names:
            row = column.row()
            row.alert = True
            rows.sentence(row, context, text.format(", ".join(listed(names, LISTED))), icon="ERROR")
    for one in total.doubts:
        rows.sentence(column, context, one, icon="ERROR")
    column = body.column(align=True)
    if total.body is not None:
        rows.value(column, units, "Mass", "mass", total.body.mass)
    if total.volume:
        rows.value(column, units, "Volume", "volume", total.volume)
    if total.area:
        rows.value(column, units, "Area", "area", total.area)
    if total.body is None:
        return
    column = body.column(align=True)
    rows.heading(column, "Center of Mass (World)", "length", total.body.center)
    rows.values(column, units, AXES, "length", total.body.center, total.body.radii_of_gyration.max())
    column = body.column(align=True)
    moments = total.body.principal.moments
    rows.heading(column, "Principal Moments", "inertia", moments)
    rows.values(column, units, NUMBERS, "inertia", moments)


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
