# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translation: what is shown is looked up before it is filled, and what is stored is English.

The bpy module has no languages of its own, so a dictionary stands for Blender's look-up here; tests/window has the real
one.
"""

import json
import string
from types import SimpleNamespace

import bpy
import pytest
from body_moments.blender.write import translations
from body_moments.core.verdict import messages

from tests.blender.objects import add, mesh_body
from tests.panels.drawing import labels, shown


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
