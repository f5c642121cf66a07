# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences go into the scene when it is first used: elsewhere, with other preferences, the file
gives the same.
"""

import json

import pytest

CHOSEN = {
    "frame": "OBJECT",
    "density_unit": "G_CM3",
    "digits": 5,
    "digit_grouping": "COMMA",
    "default_material": "CUSTOM",
    "default_density": 1234.5,
}
MEASURED = f"""\
import bpy, sys
chosen = bpy.context.preferences.addons["bl_ext.user_default.body_moments"].preferences
for name, value in {CHOSEN!r}.items():
    setattr(chosen, name, value)
chosen.show_overlay = False
settings = bpy.context.scene.body_moments
assert not settings.has_defaults and settings.default_material == "NONE"
assert bpy.ops.object.body_moments_measure() == {{"FINISHED"}}
cube = bpy.data.objects["Cube"]
assert abs(cube["body_mass"] / (8.0 * 1234.5) - 1.0) < 1e-12, cube["body_mass"]
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1])
"""
# The next scene's preferences are others: what the file has is not touched by them.
ELSEWHERE = """\
import bpy, json
chosen = bpy.context.preferences.addons["bl_ext.user_default.body_moments"].preferences
chosen.default_material = "Copper"
# not those of the first run
assert chosen.frame == "WORLD" and chosen.digits == 4 and chosen.show_overlay
bpy.ops.object.body_moments_measure()
settings, cube = bpy.context.scene.body_moments, bpy.data.objects["Cube"]
names = "frame density_unit digits digit_grouping default_material default_density".split()
seen = {name: getattr(settings, name) for name in names}
print("SEEN", json.dumps([seen, settings.overlay.show, cube["body_mass"]]))
"""


@pytest.fixture(scope="module")
def saved(run_blender, cube_file, tmp_path_factory):
    """The file that was measured where the preferences were those above.

    They were not saved as preferences.
    """
    folder = tmp_path_factory.mktemp("preferences")
    script, file = folder / "measured.py", folder / "measured.blend"
    script.write_text(MEASURED, encoding="utf-8")
    run_blender(
        "--background", cube_file, "--python-exit-code", "1", "--python", script, "--", file
    )
    return file


def test_batch_gives_the_mass_that_was_seen(run_blender, saved, tmp_path):
    output = tmp_path / "out.json"
    run_blender("--background", "--command", "body_moments", "measure", "--output", output, saved)
    (cube,) = json.loads(output.read_text(encoding="utf-8"))["objects"]
    assert cube["density"] == 1234.5 and abs(cube["mass"] / (8.0 * 1234.5) - 1.0) < 1e-12


def test_another_users_preferences_change_nothing(run_blender, saved, tmp_path):
    script = tmp_path / "elsewhere.py"
    script.write_text(ELSEWHERE, encoding="utf-8")
    done = run_blender("--background", saved, "--python-exit-code", "1", "--python", script)
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("SEEN ")]
    seen, is_shown, mass = json.loads(line.removeprefix("SEEN "))
    assert seen == CHOSEN and not is_shown
    assert abs(mass / (8.0 * 1234.5) - 1.0) < 1e-12
