# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translation: texts are looked up before they are filled, and results are stored in English.

The bpy module has no languages of its own, so that a stand-in looks up here; tests/window has the
real one.
"""

import json
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from body_moments.blender.write import translations

from tests.blender.objects import add, mesh_body
from tests.panels.drawing import labels, shown


class Languages:
    """The translations of a Blender that has languages: what add-ons registered, by locale, context
    and text.
    """

    contexts = bpy.app.translations.contexts

    def __init__(self):
        self.locale, self.registered = "en_US", {}

    def register(self, module, texts):
        assert module not in self.registered
        self.registered[module] = texts

    def unregister(self, module):
        self.registered.pop(module, None)

    def pgettext_iface(self, text, context="*"):
        texts = self.registered.get(translations.ADDON_ID, {}).get(self.locale, {})
        return texts.get((context, text), text)

    def speak(self, locale):
        """Change the language, and let Blender call its handlers."""
        self.locale = locale
        view = bpy.context.preferences.view
        view.use_translate_interface = view.use_translate_interface


@pytest.fixture
def languages(registered, monkeypatch):
    stand_in = Languages()
    monkeypatch.setattr(
        translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=stand_in))
    )
    return stand_in


@pytest.mark.usefixtures("registered")
def test_every_text_has_every_context_of_a_lookup():
    german = translations.read_translations("de_DE")
    assert (
        german["*", "Principal Axes"]
        == german["Operator", "Principal Axes"]
        == "Hauptträgheitsachsen"
    )
    contexts = {context for context, _ in german}
    for group in bpy.types.PropertyGroup.__subclasses__():
        if group.__name__.startswith("BodyMoments"):
            assert {prop.translation_context for prop in group.bl_rna.properties} <= contexts


def test_context_of_a_file_keeps_its_text_to_itself(tmp_path, monkeypatch):
    text = 'msgid "Order"\nmsgstr "Ordnung"\n\nmsgctxt "Operator"\nmsgid "Order"\nmsgstr "Ordnen"\n'
    (tmp_path / "pt_BR.po").write_text(text, encoding="utf-8")
    monkeypatch.setattr(translations, "FOLDER", tmp_path)
    texts = translations.read_translations("pt_BR")
    assert texts == {
        ("*", "Order"): "Ordnung",
        ("Operator", "Order"): "Ordnen",
        ("Body Moments", "Order"): "Ordnung",
    }
    assert not translations.read_translations("pt_PT")


def test_language_change_shows_german_and_back(languages):
    languages.speak("de_DE")
    assert translations.localized("Capped") == "Mit Deckeln"
    assert translations.localized("No such text") == "No such text"
    languages.speak("fr_FR")
    assert translations.localized("Capped") == "Capped"
    languages.speak("de_AT")
    assert translations.localized("Capped") == "Mit Deckeln"


@pytest.mark.parametrize("locale", ["", "C", "en_US", "fr_FR"])
def test_other_languages_read_no_file(languages, locale, monkeypatch):
    monkeypatch.setattr(Path, "read_text", lambda *_args, **_options: pytest.fail("a file is read"))
    languages.speak(locale)
    assert not languages.registered


@pytest.mark.usefixtures("scene")
def test_panel_is_german_and_stored_results_english(languages):
    languages.speak("de_DE")
    closed, mesh = mesh_body(), bpy.data.meshes.new("Open")
    faces = [tuple(face.vertices) for face in closed.polygons]
    mesh.from_pydata([vertex.co for vertex in closed.vertices], [], faces[1:])
    obj = add(mesh)
    obj.body_moments.material = "Copper"
    bpy.ops.object.body_moments_measure()
    text = " ".join(labels(shown()))
    assert "Mit Deckeln" in text and "Löcher geschlossen" in text
    assert "Löcher geschlossen: 1 (1 eben" in text and "Holes" not in text
    assert obj["body_method"] == "capped" and obj["body_warnings"].startswith("Holes capped: 1")
    assert json.loads(obj["body_findings"])[0]["code"] == "holes_capped"
    obj.scale.x = 3.0
    bpy.context.view_layer.update()
    assert "Veraltet: Transformation geändert" in " ".join(labels(shown()))
