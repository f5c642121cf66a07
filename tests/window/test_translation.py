# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender set to German shows the panel in German, and stores English."""

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


def test_other_languages_and_a_disabled_add_on_leave_english(german):
    german.ask("bpy.context.preferences.view.language = 'fr_FR'")
    assert german.get(f"{LOOK_UP}('Capped')") == "Capped"
    german.ask("bpy.context.preferences.view.language = 'de_DE'")
    german.ask(f"import addon_utils\naddon_utils.disable('{PACKAGE}')")
    look_up = "bpy.app.translations.pgettext_iface('Capped', 'Body Moments')"
    assert german.get(look_up) == "Capped"
    german.ask(f"import addon_utils\naddon_utils.enable('{PACKAGE}')")
    assert german.get(look_up) == "Mit Deckeln"
