# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender set to German shows the panel in German, and stores English."""

import json

import pytest

PACKAGE = "bl_ext.user_default.body_moments"
LOOK_UP = f"__import__('sys').modules['{PACKAGE}.blender.write.translations'].localized"
OPEN_BOX = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
mesh = bpy.data.meshes.new("Mass")
bpy.ops.mesh.primitive_cube_add()
cube = bpy.context.object
faces = [tuple(face.vertices) for face in cube.data.polygons]
mesh.from_pydata([tuple(vertex.co) for vertex in cube.data.vertices], [], faces[1:])
cube.data = mesh
cube.name = "Mass"
"""

# Prints a text in each language, and how many files of translations were opened before.
SWITCH = """
import addon_utils, bpy, json, sys
opened = []
sys.addaudithook(lambda event, arguments: event == "open" and str(arguments[0]).endswith(".po") and opened.append(1))
def show(step):
    print(json.dumps([step, bpy.app.translations.pgettext_iface("Capped", "Body Moments"), len(opened)]))
addon_utils.disable("{package}")
addon_utils.enable("{package}")
show(bpy.context.preferences.view.language)
for locale in ("fr_FR", "de_DE", "en_US", "de_DE"):
    bpy.context.preferences.view.language = locale
    show(locale)
addon_utils.disable("{package}")
show("disabled")
addon_utils.enable("{package}")
show("enabled")
"""


@pytest.fixture(scope="module")
def german(window):
    window.ask(
        "view = bpy.context.preferences.view\nview.language = 'de_DE'\n"
        "view.use_translate_interface = view.use_translate_reports = view.use_translate_tooltips = True"
    )
    yield window
    window.ask("bpy.context.preferences.view.language = 'en_US'")


def test_panel_is_german_and_stored_text_english(german):
    german.ask(OPEN_BOX)
    german.open_tab("Moments")
    german.press("object.body_moments_measure")
    german.wait("'body_mass' in bpy.context.object")
    german.point_at_view()
    german.redraw()
    german.picture("german")
    assert german.get(f"{LOOK_UP}('Capped')") == "Mit Deckeln"
    assert german.get("bpy.app.translations.pgettext_iface('Select Defects', 'Operator')") == "Fehlerstellen auswählen"
    assert german.get("bpy.context.object['body_method']") == "capped"
    assert german.get("bpy.context.object['body_warnings']").startswith("Holes capped: 1")
    assert "Traceback" not in german.output()


def test_language_change_reads_a_file_and_disabling_leaves_english(run_blender, tmp_path):
    script = tmp_path / "languages.py"
    script.write_text(SWITCH.format(package=PACKAGE), encoding="utf-8")
    done = run_blender("--background", "--python-exit-code", "1", "--python", script)
    shown = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("[")]
    assert shown == [
        ["en_US", "Capped", 0],
        ["fr_FR", "Capped", 0],
        ["de_DE", "Mit Deckeln", 1],
        ["en_US", "Capped", 1],
        ["de_DE", "Mit Deckeln", 2],
        ["disabled", "Capped", 2],
        ["enabled", "Mit Deckeln", 3],
    ]
