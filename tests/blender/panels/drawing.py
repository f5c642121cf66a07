# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout that writes down all that is drawn into it, and a context with a region of a known width.

A text is in quotation marks, with a star where Blender does not translate it; operators have short names. What is drawn
must exist: functions, options, icons and attributes of layouts, properties, operators with their properties, menus.
"""

from contextlib import ExitStack, contextmanager
from types import SimpleNamespace
from unittest.mock import patch

import bpy
from body_moments.core.verdict.finding import finding

from tests.blender.conftest import six_digits

LAYOUT = bpy.types.UILayout.bl_rna
ICONS = LAYOUT.functions["label"].parameters["icon"].enum_items
LAYOUTS = {"row", "column", "split", "box", "grid_flow", "menu_pie", "column_flow"}
SHORT = {("align", True): "aligned", ("translate", False): "*", ("expand", True): "expanded"}
LINE = 220  # letters
LETTER = 0.55  # of the size of the font


class Layout:
    """What was drawn is `parts`, layouts and words. closed: names of panels in the panel that are closed. record: the
    labels, settings, operators and pointers of all layouts in it, in their order.
    """

    def __init__(self, words="", closed=(), record=None):
        self.__dict__.update(words=words, parts=[], closed=closed, record=[] if record is None else record)

    def write(self, *words):
        self.parts.append(" ".join(filter(None, words)))

    def inner(self, *words):
        made = type(self)(" ".join(filter(None, words)), self.closed, self.record)
        self.parts.append(made)
        return made

    def lines(self):
        """What was drawn, indented as it is nested where a line is too short for it."""
        inner = [[part] if isinstance(part, str) else part.lines() for part in self.parts]
        line = "{:s} ({:s})".format(self.words, "; ".join(lines[0] for lines in inner)) if inner else self.words
        if all(len(lines) == 1 for lines in inner) and len(six_digits(line)) <= LINE:
            return [line]
        return [self.words, *("    " + line for lines in inner for line in lines)]

    def text(self):
        return "\n".join(line for part in self.parts for line in ([part] if isinstance(part, str) else part.lines()))

    def __setattr__(self, name, value):
        assert not LAYOUT.properties[name].is_readonly
        self.write(".{:s} = {!r}".format(name, value))

    def __getattr__(self, name):
        def draw(**options):
            return self.inner(name, named(name, options))

        assert name in LAYOUTS and name in LAYOUT.functions
        return draw

    def panel(self, idname, default_closed=False):
        made = self.inner("panel", idname, "closed at first" if default_closed else "")
        return made.inner("header"), None if idname in self.closed else made.inner("body")

    def separator(self, **options):
        self.write("separator", named("separator", options))

    def label(self, **options):
        self.record.append(("label", options.get("text", ""), options.get("translate", True)))
        self.write("label", named("label", options))

    def prop(self, data, prop, **options):
        assert prop in data.bl_rna.properties
        self.record.append(("prop", prop))
        self.write("prop", kind(data), prop, named("prop", options))

    def prop_enum(self, data, prop, value, **options):
        assert value in data.bl_rna.properties[prop].enum_items
        self.write("prop_enum", kind(data), prop, value, named("prop_enum", options))

    def prop_search(self, data, prop, owner, collection, **options):
        assert prop in data.bl_rna.properties and collection in owner.bl_rna.properties
        self.write("prop_search", kind(data), prop, collection, named("prop_search", options))

    def operator(self, idname, **options):
        category, name = idname.split(".")
        known = getattr(getattr(bpy.ops, category), name).get_rna_type().properties
        properties = SimpleNamespace()
        self.record.append(("operator", idname, properties))
        return Properties(
            known, properties, self.inner(idname.replace("body_moments_", ""), named("operator", options))
        )

    def operator_menu_enum(self, idname, prop, **options):
        category, name = idname.split(".")
        assert prop in getattr(getattr(bpy.ops, category), name).get_rna_type().properties
        self.write("operator_menu_enum", idname, prop, named("operator_menu_enum", options))

    def menu(self, idname, **options):
        assert hasattr(bpy.types, idname)
        self.write("menu", idname, named("menu", options))

    def popover(self, idname, **options):
        assert hasattr(bpy.types, idname)
        self.write("popover", idname, named("popover", options))

    def context_pointer_set(self, name, data):
        self.write("context_pointer_set", name, data.name)

    def template_list(self, name, idname, data, listed, active_data, active, **options):
        cls = getattr(bpy.types, name)
        assert active in active_data.bl_rna.properties
        inner = self.inner("template_list", name, idname, listed, active, named("template_list", options))
        for index, item in enumerate(getattr(data, listed)):
            cls.draw_item(None, bpy.context, inner, data, item, 0, active_data, active, index)


class Properties:
    """Those of an operator's button."""

    def __init__(self, known, given, layout):
        self.__dict__.update(known=known, given=given, layout=layout)

    def __setattr__(self, name, value):
        assert name in self.known
        setattr(self.given, name, value)
        self.layout.write("{:s} = {!r}".format(name, value))


def named(function, options):
    known = LAYOUT.functions[function].parameters
    assert {*options} <= {*known.keys()}, (function, options)
    assert options.get("icon", "NONE") in ICONS
    return " ".join(
        SHORT.get(item) or ("{1!r}" if item[0] == "text" else "{0:s}={1!r}").format(*item)
        for item in sorted(options.items())
    )


def kind(data):
    return type(data).__name__.removeprefix("BodyMoments")


class Context:
    """Blender's context, with a region of a width, None where there is none, and other things in place of its own."""

    def __init__(self, width=300, scale=1.0, **others):
        style = SimpleNamespace(widget=SimpleNamespace(points=11.0))
        preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=scale), ui_styles=[style])
        region = None if width is None else SimpleNamespace(width=width)
        self.__dict__ |= {"region": region, "preferences": preferences} | others

    def __getattr__(self, name):
        return getattr(bpy.context, name)


@contextmanager
def region(context):
    """Let panels draw there, in a font whose letters are all of one width."""
    from body_moments.panels import density, rows, settings

    sizes = {}  # of each font
    blf = SimpleNamespace(size=sizes.__setitem__)
    blf.dimensions = lambda font, text: (LETTER * sizes[font] * len(text), sizes[font])
    stand_in = SimpleNamespace(context=context)
    rows._wrapped.cache_clear()
    with ExitStack() as patches:
        for module in (rows, settings, density):
            patches.enter_context(patch.object(module, "bpy", stand_in))
        patches.enter_context(patch.object(rows, "blf", blf))
        yield
    rows._wrapped.cache_clear()


def drawn(*names, context=None, closed=()):
    """What the sidebar's panels show, those of their names after the common beginning, and which are not there."""
    context = context or Context()
    layout = Layout(closed=closed)
    for name in names:
        cls = getattr(bpy.types, name) if "_PT_" in name else sidebar_panel(name)
        inner = layout.inner(cls.__name__)
        if hasattr(cls, "poll") and not cls.poll(context):
            inner.write("not there")
            continue
        with region(context):
            cls.draw(SimpleNamespace(layout=inner), context)
    return layout.text()


def sidebar_panel(name):
    return getattr(bpy.types, "_".join(filter(None, ("VIEW3D_PT_body_moments", name))))


def shown(closed=(), without=()):
    """The record of the main panel and its sub-panels in Blender's own context, in their order, all open.

    without: names of sub-panels.
    """
    from body_moments.panels import body, places

    layout = Layout(closed=closed)
    body.VIEW3D_PT_body_moments.draw(SimpleNamespace(layout=layout), bpy.context)
    for name in places.ORDER:
        panel = sidebar_panel(name)
        if name not in without and (not hasattr(panel, "poll") or panel.poll(bpy.context)):
            layout.label(text=panel.bl_label)
            panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout.record


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
    from body_moments.operators.write import messages, properties

    found = properties.findings(obj)
    return [one.code for one in (found if severity is None else messages.of_severity(found, severity))]
