# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Remedies name controls that exist: labels and choices of ours, and Blender's own, as this Blender draws them."""

import ast
import re
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from body_moments.operators.write.messages import MESSAGES

from tests.blender.objects import add, mesh_body

pytestmark = pytest.mark.usefixtures("scene")
ROOT = Path(__file__).resolve().parent.parent.parent.parent
TEXTS = [(code, text) for code, entry in MESSAGES.items() for text in (entry.text, entry.plural) if text]
# Menus and tabs that a path may start from; the menu File > Import has our own entry.
MENUS = {
    "Mesh": "VIEW3D_MT_edit_mesh",
    "Face": "VIEW3D_MT_edit_mesh_faces",
    "Segments": "VIEW3D_MT_edit_curve_segments",
    "Object": "VIEW3D_MT_object",
    "File": "TOPBAR_MT_file",
}
PANELS = {
    "Object Properties": ("OBJECT_PT_instancing", "OBJECT_PT_transform"),
    "Object Data Properties": ("DATA_PT_shape_curve",),
}
# Controls of Blender outside menus: name → where its data has the name
PROPERTIES = {
    "Endpoint": ("Spline", "use_endpoint_u"),
    "Bézier": ("Spline", "use_bezier_u"),
    "Order": ("Spline", "order_u"),
    "Offset": ("Curve", "offset"),
    "Extrude": ("Curve", "extrude"),
    "Bevel Depth": ("Curve", "bevel_depth"),
}
OPERATORS = {"Toggle Cyclic": "curve.cyclic_toggle", "Convert Attribute": "geometry.attribute_convert"}
PANEL_NAMES = {
    "Active Spline": "VIEW3D_PT_active_spline",
    "Dyntopo": "VIEW3D_PT_sculpt_dyntopo",
    "Simplify": "RENDER_PT_simplify",
}
PANEL_TEXTS = {"Show Instancer": "OBJECT_PT_instancing", "Resolution Preview": "DATA_PT_shape_curve"}
NODES = {"Grid to Mesh": "GeometryNodeGridToMesh"}
# What is written with a capital and is no control
NOUNS = (
    *(
        "BODY_MOMENTS_LIMITS",  # a variable of the environment
        "Blender",
        "Boolean",
        "CT",
        "MB",
        "PLY",
        "Zhang",
        "Chen",
        "FILE",
        "Fourier",
        "NAME",
        "NUMBER",
        "NIfTI",
        "NRRD",
        "NURBS",
        "NaN",
        "Python",
    ),
    *("ASCII", "IGES", "NumPy", "OUT", "STL", "NRRD0001", "NRRD0005"),
    *("URDF", "SDF", "MJCF", "MuJoCo", "USD", "PhysicsMassAPI", "XML"),
)


class Recorder:
    """A layout that keeps what is drawn into it: (kind, arguments, options)."""

    def __init__(self, calls):
        object.__setattr__(self, "calls", calls)

    def __setattr__(self, name, value):
        pass

    def __getattr__(self, name):
        def draw(*arguments, **options):
            self.calls.append((name, arguments, options))
            return Recorder(self.calls)

        return draw


def drawn(idname, context=None):
    calls, cls = [], getattr(bpy.types, idname)
    cls.draw(SimpleNamespace(layout=Recorder(calls), bl_label=cls.bl_label), context or bpy.context)
    return calls


def entries(idname):
    """What a menu offers: text → the menu that it opens, or the names of its choices, or None."""
    found = {}
    for kind, arguments, options in drawn(idname):
        if kind == "menu":
            menu = getattr(bpy.types, arguments[0], None)  # None: one that a Blender with a window has
            found[options.get("text") or getattr(menu, "bl_label", "")] = arguments[0]
        elif kind in {"operator", "operator_enum", "operator_menu_enum"}:
            category, name = arguments[0].split(".")
            operator = getattr(getattr(bpy.ops, category), name).get_rna_type()
            choices = None
            if kind != "operator":
                prop = options["property"] if "property" in options else arguments[1]
                choices = {item.name: None for item in operator.properties[prop].enum_items}
            found |= choices if kind == "operator_enum" else {options.get("text") or operator.name: choices}
    return {text.removesuffix("..."): target for text, target in found.items()}


def exists(path):
    """Whether there is such a way through Blender's menus, or from a tab of its properties to a panel."""
    first, *rest = path.split(" > ")
    if first in PANELS:
        return len(rest) == 1 and rest[0] in [getattr(bpy.types, name).bl_label for name in PANELS[first]]
    if path == "File > Import > Scan of Densities":
        texts = [node.value for node in constants(ROOT / "operators/actions/imports/import_scan.py")]
        return "Import" in entries("TOPBAR_MT_file") and any(text.startswith("Scan of Densities") for text in texts)
    target = MENUS[first]
    assert getattr(bpy.types, target).bl_label == first
    for name in rest:
        choices = entries(target) if isinstance(target, str) else target
        if not choices or name not in choices:
            return False
        target = choices[name]
    return True


def constants(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]


def data_of(cls):
    """What describes the properties of a class: an operator's own are known to `bpy.ops` only."""
    if not issubclass(cls, bpy.types.Operator):
        return cls.bl_rna
    category, name = cls.bl_idname.split(".")
    return getattr(getattr(bpy.ops, category), name).get_rna_type()


def our_controls():
    """Names of our properties and buttons: name → the choices that it has."""
    classes = [cls for cls in bpy.types.PropertyGroup.__subclasses__() if cls.__name__.startswith("BodyMoments")]
    for base in (bpy.types.Operator, bpy.types.Panel):
        classes += [cls for cls in base.__subclasses__() if "body_moments" in getattr(cls, "bl_idname", "")]
    controls = {}
    for cls in classes:
        if hasattr(cls, "bl_label"):
            controls.setdefault(cls.bl_label, set())
        for prop in data_of(cls).properties:
            choices = {item.name for item in prop.enum_items} if prop.type == "ENUM" else set()
            controls.setdefault(prop.name, set()).update(choices)
    for path in (ROOT / "panels").glob("*.py"):  # texts of buttons in place of their operators' names
        for node in constants(path):
            if node.value.istitle():
                controls.setdefault(node.value, set())
    return controls


def blenders_controls():
    """Names of Blender's own controls, modes and editors that a remedy may use, each as this Blender has it."""
    for name, (owner, prop) in PROPERTIES.items():
        assert getattr(bpy.types, owner).bl_rna.properties[prop].name.startswith(name), name
    for name, operator in OPERATORS.items():
        category, function = operator.split(".")
        assert getattr(getattr(bpy.ops, category), function).get_rna_type().name == name
    for name, panel in PANEL_NAMES.items():
        assert getattr(bpy.types, panel).bl_label == name
    obj = add(mesh_body())
    obj.instance_type = "VERTS"
    data = SimpleNamespace(object=obj, curve=bpy.data.curves.new("Curve", "CURVE"))
    for name, panel in PANEL_TEXTS.items():
        texts = [options.get(key, "") for _, _, options in drawn(panel, data) for key in ("text", "heading")]
        assert any(text.startswith(name) for text in texts), name
    for name, node in NODES.items():
        assert getattr(bpy.types, node).bl_rna.name == name
    modes = bpy.ops.object.mode_set.get_rna_type().properties["mode"].enum_items
    editors = bpy.types.Area.bl_rna.properties["type"].enum_items
    tabs = bpy.types.SpaceProperties.bl_rna.properties["context"].enum_items
    names = {item.name for items in (modes, editors) for item in items} | {item.description for item in tabs}
    names |= {item.name for item in bpy.types.Modifier.bl_rna.properties["type"].enum_items}
    return names | {*PROPERTIES, *OPERATORS, *PANEL_NAMES, *PANEL_TEXTS, *NODES}


PATH = re.compile(r"[A-Z][A-Za-z]*(?: [A-Z][a-z]+)*(?: > [A-Z][A-Za-z]*(?: (?:of )?[A-Z][a-z]+)*)+")


def paths(text):
    """Ways through menus that a message names, without the verb before them."""
    for found in PATH.findall(text):
        yield re.sub(r"^(?:Use|In|Unlock) ", "", found)


def test_every_menu_that_a_remedy_names_is_there():
    add(mesh_body())
    named = {path: code for code, text in TEXTS for path in paths(text)}
    assert len(named) > 12
    missing = {path: code for path, code in named.items() if not exists(path)}
    assert not missing
    assert not exists("Mesh > Normals > Recalculate") and not exists("Mesh > Validate")


def test_every_control_that_a_remedy_names_is_there():
    """Each capitalized name inside a sentence is a control of ours or of Blender, or a proper noun."""
    known = sorted({*our_controls(), *blenders_controls(), *NOUNS}, key=len, reverse=True)
    choices = {choice for names in our_controls().values() for choice in names}
    pattern = r"(?<!\w)(?:{})(?!\w)".format("|".join(map(re.escape, [*known, *sorted(choices, key=len, reverse=True)])))
    unknown = []
    for code, text in TEXTS:
        if code.startswith("usage_"):
            continue
        rest = PATH.sub("", re.sub(r"\{[^}]*\}|“[^”]*”|\w+\.\w+\(\)|NAME_\S+", "", text))
        rest = re.sub(r"(^|[.:;] )[A-Z](\w* |\w+$)", r"\1 ", re.sub(pattern, "", rest))
        found = re.findall(r"(?<![\w-])[A-Z][\w]+", re.sub(r"(^|[.:;(]\s*)[A-Z]\w*", "", rest))
        if found:
            unknown.append((code, *found))
    assert not unknown


def test_every_setting_that_a_remedy_asks_for_is_a_choice_of_that_control():
    controls, asked = our_controls(), 0
    for code, text in TEXTS:
        for sentence in re.split(r"(?<=\.) ", text):
            if not re.search(r"(?i)\bset ", sentence):
                continue
            for control, choice in re.findall(
                r"(?:[Ss]et |, or |or )([A-Z][\w ]*?) to ((?:[A-Z]\w*)(?: \w+)*)", sentence
            ):
                asked += 1
                choices = controls[control]
                assert any(re.match(re.escape(name) + r"(?!\w)", choice) for name in choices), (code, control, choice)
    assert asked > 60
