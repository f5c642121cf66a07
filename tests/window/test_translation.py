# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Languages of a real Blender: translations are read when one is chosen, and are gone with the
add-on.
"""

import json

PACKAGE = "bl_ext.user_default.body_moments"
# Prints a text in each language, and how many files of translations were opened before.
SWITCH = """
import addon_utils, bpy, json, sys
opened = []
def hook(event, arguments):
    if event == "open" and str(arguments[0]).endswith(".po"):
        opened.append(1)
sys.addaudithook(hook)
def show(step):
    word = bpy.app.translations.pgettext_iface("Capped", "Body Moments")
    print(json.dumps([step, word, len(opened)]))
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
