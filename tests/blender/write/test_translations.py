# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translation: what is shown is looked up before it is filled, and what is stored is English.

The bpy module has no languages of its own, so a dictionary stands for Blender's look-up here; tests/window has the real
one.
"""

import ast
import json
import re
import string
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from body_moments.core.density.materials import BY_NAME, MATERIALS
from body_moments.operators.write import messages, translations

from tests.blender.objects import add, mesh_body
from tests.blender.panels.drawing import labels, shown

ROOT = Path(__file__).resolve().parent.parent.parent.parent


# Technical terms, and what Blender itself translates or nobody sees.
UNTRANSLATED = {
    "Presets",  # what Blender calls a menu of presets once one was removed
    *(
        "kg/m³",
        "g/cm³",
        "lb/in³",
        "Ixx, Iyy, Izz",
        "Ixy, Ixz, Iyz",
        "Polar Jp",
        "found",
        "kind",
        "fingerprint",
        "elements",
    ),
    *("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64"),
}
COMMAND_LINE = ("operators/command/", "operators/supervisor/", "operators/batch.py")
AUDIT = ("audit_", "inertial_", "mesh_", "xml_", "usda_", "usd_not_text", "description_", "usage_")


def constants(*folders, without="german"):
    """The strings in the source of some folders, without one of them."""
    paths = {path for folder in folders for path in (ROOT / folder).rglob("*.py") if without not in path.parts}
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in paths]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    return {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}


def texts_of(properties):
    """What Blender shows of properties: names, tooltips, choices. Not the table of materials: names and sources."""
    for prop in properties:
        hidden = prop.is_hidden or prop.identifier in ("rna_type", "name", "filepath", "check_existing")
        if hidden or prop.identifier.startswith(("bl_", "filter_", "hide_props")):
            continue
        yield from (prop.name, prop.description)
        if prop.type == "ENUM" and len(prop.enum_items) < len(MATERIALS):
            for item in prop.enum_items:
                yield from (item.name, item.description)


def registered():
    """Every text that Blender shows of what is registered."""
    for category in ("object", "scene", "view3d", "wm", "material", "export_scene", "import_scene"):
        for name in dir(getattr(bpy.ops, category)):
            if "body_moments" in name:
                rna = getattr(getattr(bpy.ops, category), name).get_rna_type()
                yield from (rna.name, rna.description, *texts_of(rna.properties))
    for group in (*bpy.types.PropertyGroup.__subclasses__(), *bpy.types.AddonPreferences.__subclasses__()):
        if group.__name__.startswith("BodyMoments") and group.is_registered:
            yield from texts_of(group.bl_rna.properties)
    for cls in (*bpy.types.Panel.__subclasses__(), *bpy.types.Menu.__subclasses__()):
        if "body_moments" in cls.__name__ and cls.is_registered:
            yield cls.bl_label
            yield cls.__doc__ or ""


def written():
    """Labels and templates in the source of the panels."""
    named = {"filled", "value", "quantities", "table", "text", "title", "heading", "localized", "_labeled_row"}
    for path in (ROOT / "panels").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                function = getattr(node.func, "attr", getattr(node.func, "id", ""))
                texts = [keyword.value for keyword in node.keywords if keyword.arg in ("text", "heading", "short")]
                texts += node.args if function in named else []
                inner = (part for text in texts for part in ast.walk(text))
                yield from (part.value for part in inner if isinstance(part, ast.Constant))


def words(texts):
    """Those that have a word in them."""
    return {text for text in texts if isinstance(text, str) and re.search("[A-Z][a-z]|[a-z] [a-z]", text)}


def placeholders(text):
    """Names and formats of what is filled in."""
    return sorted(field[1:4] for field in string.Formatter().parse(text) if field[1] is not None)


@pytest.mark.parametrize("locale", translations.LANGUAGES)
def test_a_translation_has_the_placeholders_of_the_english_text(locale):
    language = translations.LANGUAGES[locale]
    assert len(language.MESSAGES) >= 30
    for code, translated in language.MESSAGES.items():
        entry = messages.MESSAGES[code]
        english = [text for text in (entry.text, entry.plural) if text]
        assert len(english) == len(translated), code
        for before, after in zip(english, translated):
            assert placeholders(before) == placeholders(after), code
            assert before.endswith(".") == after.endswith("."), code
    for before, after in language.TEXTS.items():
        assert placeholders(before) == placeholders(after), before


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("locale", translations.LANGUAGES)
def test_every_text_that_is_translated_is_one_of_the_source(locale):
    language = translations.LANGUAGES[locale]
    assert not {*language.TEXTS} - constants("core", "operators", "panels") - {*registered()}


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("locale", translations.LANGUAGES)
def test_every_label_and_tooltip_is_translated(locale):
    language = translations.LANGUAGES[locale]
    missing = words((*registered(), *written())) - {*language.TEXTS} - UNTRANSLATED - {*BY_NAME}
    assert not {text for text in missing if "Source: " not in text}


@pytest.mark.parametrize("locale", translations.LANGUAGES)
def test_every_message_that_the_window_shows_is_translated(locale):
    sources = {
        path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
        for folder in ("core", "operators", "panels")
        for path in (ROOT / folder).rglob("*.py")
        if "german" not in path.parts and path.name != "messages.py"
    }
    missing = []
    for code in {*messages.MESSAGES} - {*translations.LANGUAGES[locale].MESSAGES}:
        places = [place for place, text in sources.items() if '"{}"'.format(code) in text]
        on_command_line = places and all(place.startswith(COMMAND_LINE) for place in places)
        if not on_command_line and not code.startswith(AUDIT):
            missing.append(code)
    assert not missing


def test_blender_gets_every_text_under_every_context_in_which_it_looks():
    german = translations.dictionary()["de_DE"]
    assert german["*", "Principal Axes"] == german["Operator", "Principal Axes"] == "Hauptträgheitsachsen"
    contexts = {context for context, _ in german}
    for group in bpy.types.PropertyGroup.__subclasses__():
        if group.__name__.startswith("BodyMoments"):
            assert {prop.translation_context for prop in group.bl_rna.properties} <= contexts
    assert german["*", messages.MESSAGES["t_junctions"].plural].startswith("{count} Spalte")


@pytest.fixture
def german(monkeypatch):
    """Look-ups as a German Blender answers them, by our dictionary alone."""
    texts = translations.dictionary()["de_DE"]
    look_up = SimpleNamespace(pgettext_iface=lambda text, context="*": texts.get((context, text), text))
    monkeypatch.setattr(translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=look_up)))


@pytest.mark.usefixtures("scene", "german")
def test_the_panel_speaks_german_and_what_is_stored_english():
    closed, mesh = mesh_body(), bpy.data.meshes.new("Open")
    faces = [tuple(face.vertices) for face in closed.polygons]
    mesh.from_pydata([vertex.co for vertex in closed.vertices], [], faces[1:])
    obj = add(mesh)
    obj.body_moments.material = "Copper"
    bpy.ops.object.body_moments_measure()
    text = " ".join(labels(shown()))
    assert "Mit Deckeln" in text and "Die Oberfläche ist offen; ihre Löcher wurden geschlossen" in text
    assert "Warnungen (1) Löcher geschlossen: 1 (1 eben" in text and "Holes" not in text
    assert obj["body_method"] == "capped" and obj["body_warnings"].startswith("Holes capped: 1")
    assert json.loads(obj["body_findings"])[0]["code"] == "holes_capped"
    obj.scale.x = 3.0
    bpy.context.view_layer.update()
    assert "Veraltet: Transformation geändert" in " ".join(labels(shown()))


@pytest.mark.usefixtures("scene")
def test_names_and_numbers_are_drawn_as_they_are(monkeypatch):
    """“Cube” and “Mass” are words of Blender's own: an object of that name keeps it in every language."""
    obj = add(mesh_body(), "Mass")
    bpy.ops.object.body_moments_measure()
    material = bpy.data.materials.new("Volume")
    obj.data.materials.append(material)
    obj.body_moments.density_from = "MATERIALS"
    from body_moments.panels import rows

    monkeypatch.setattr(rows, "localized", "‹{:s}›".format)
    record = shown(closed=("body_moments_tensor",))  # whose labels are letters, put together
    assert ("label", "Volume", False) in record and ("label", "‹Volume›", False) in record
    assert {entry[1] for entry in record if entry[0] == "label" and entry[2]} <= constants("panels")
