# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout that records what panels draw, and what is read from the record.

What is drawn must exist: functions, options, icons and attributes of layouts, properties, operators
with their properties, menus.
"""

from importlib import import_module
from types import SimpleNamespace

import bpy
from body_moments import panels
from body_moments.blender.registration import classes_of
from body_moments.core.verdict import finding, sentences
from body_moments.panels import body, places

LAYOUT = bpy.types.UILayout.bl_rna
ICONS = LAYOUT.functions["label"].parameters["icon"].enum_items
LAYOUTS = {"row", "column", "split", "box", "grid_flow", "menu_pie", "column_flow"}


class Layout:
    """A layout that records what is drawn into it and into its inner layouts.

    record: labels, settings, operators, menus and pointers, in their order. closed: names of panels
    that are closed.
    """

    def __init__(self, closed=(), record=None):
        self.__dict__.update(closed=closed, record=[] if record is None else record)

    def inner(self):
        return type(self)(self.closed, self.record)

    def __setattr__(self, name, value):
        assert not LAYOUT.properties[name].is_readonly
        self.record.append((name, value))

    def __getattr__(self, name):
        def draw(**options):
            check(name, options)
            return self.inner()

        assert name in LAYOUTS and name in LAYOUT.functions
        return draw

    def panel(self, idname, default_closed=False):
        return self.inner(), None if idname in self.closed else self.inner()

    def progress(self, **options):
        check("progress", options)
        self.record.append(("label", options["text"], False))

    def separator(self, **options):
        check("separator", options)

    def label(self, **options):
        check("label", options)
        self.record.append(("label", options.get("text", ""), options.get("translate", True)))

    def prop(self, data, prop, **options):
        check("prop", options)
        assert prop in data.bl_rna.properties
        self.record.append(("prop", prop))

    def prop_enum(self, data, prop, value, **options):
        check("prop_enum", options)
        assert value in data.bl_rna.properties[prop].enum_items
        self.record.append(("prop", prop))

    def prop_search(self, data, prop, owner, collection, **options):
        check("prop_search", options)
        assert prop in data.bl_rna.properties and collection in owner.bl_rna.properties
        self.record.append(("prop", prop))

    def operator(self, idname, **options):
        check("operator", options)
        category, name = idname.split(".")
        known = getattr(getattr(bpy.ops, category), name).get_rna_type().properties
        properties = SimpleNamespace()
        self.record.append(("operator", idname, properties))
        return Properties(known, properties)

    def operator_menu_enum(self, idname, prop, **options):
        check("operator_menu_enum", options)
        category, name = idname.split(".")
        known = getattr(getattr(bpy.ops, category), name).get_rna_type().properties
        assert prop in known
        self.record.append(("menu", idname))
        return Properties(known, SimpleNamespace())

    def operator_enum(self, idname, prop, **options):
        check("operator_enum", options)
        self.operator_menu_enum(idname, prop)

    def menu(self, idname, **options):
        check("menu", options)
        assert hasattr(bpy.types, idname)
        self.record.append(("menu", idname))

    def popover(self, idname, **options):
        check("popover", options)
        self.label(text=options["text"])
        assert hasattr(bpy.types, idname)
        self.record.append(("menu", idname))

    def context_pointer_set(self, name, data):
        pass

    def context_string_set(self, name, value):
        self.record.append(("prop", value))

    def prop_menu_enum(self, data, prop, **options):
        check("prop_menu_enum", options)
        self.prop(data, prop)
        self.label(text=options["text"])

    def template_list(self, name, idname, data, listed, active_data, active, **options):
        check("template_list", options)
        cls, inner = getattr(bpy.types, name), self.inner()
        assert active in active_data.bl_rna.properties
        for index, item in enumerate(getattr(data, listed)):
            cls.draw_item(None, bpy.context, inner, data, item, 0, active_data, active, index)


class Properties:
    """Properties of an operator's button."""

    def __init__(self, known, given):
        self.__dict__.update(known=known, given=given)

    def __setattr__(self, name, value):
        assert name in self.known
        setattr(self.given, name, value)


def check(function, options):
    """Assert that Blender's function of layouts has these options, and the icon among them."""
    known = LAYOUT.functions[function].parameters
    assert {*options} <= {*known.keys()}, (function, options)
    assert options.get("icon", "NONE") in ICONS


def shown(closed=(), without=()):
    """The record of the main panel and its sub-panels in Blender's own context, in their order, all
    open.

    without: names of sub-panels.
    """
    layout = Layout(closed=closed)
    body.VIEW3D_PT_body_moments.draw(SimpleNamespace(layout=layout), bpy.context)
    for name in places.ORDER:
        panel = getattr(bpy.types, "_".join(filter(None, ("VIEW3D_PT_body_moments", name))))
        if name not in without and (not hasattr(panel, "poll") or panel.poll(bpy.context)):
            layout.label(text=panel.bl_label)
            panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout.record


def every_panel():
    """The labels of all panels, of both places, that Blender's own context shows."""
    layout = Layout()
    for module in panels.MODULES:
        for cls in classes_of(import_module("body_moments.panels." + module)):
            # else Blender's
            is_ours = issubclass(cls, bpy.types.Panel) and not hasattr(cls, "preset_add_operator")
            if is_ours and (not hasattr(cls, "poll") or cls.poll(bpy.context)):
                cls.draw(SimpleNamespace(layout=layout), bpy.context)
    return labels(layout.record)


def labels(record):
    return [entry[1] for entry in record if entry[0] == "label"]


def shows(record, code, **values):
    """Whether the sentence of a finding is drawn, in however many lines."""
    return str(finding(code, **values)) in " ".join(labels(record))


def copied(record, unit):
    return [
        entry[2].value
        for entry in record
        if entry[0] == "operator" and entry[1].endswith("copy_value") and entry[2].unit == unit
    ]


def findings_of(obj, severity=None):
    """The codes that are stored, all or of one severity."""
    from body_moments.blender.write import properties

    found = properties.findings(obj)
    return [
        one.code for one in (found if severity is None else sentences.of_severity(found, severity))
    ]
