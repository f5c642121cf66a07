# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Letters in the window: their area moments in the panel, their transform's picture, found again and told apart."""

from tests.window.test_subpanels import OPEN, shown

LETTERS = """
import math
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
for name, place, turn, scale in (
    ("Mirrored", (3, 0, 0), 0.3, (-1, 1, 1)),
    ("Large", (-3, 0, 0), 2.0, (3, 3, 3)),
    ("Copy", (1.5, 0, 0), 1.0, (1, 1, 1)),
    ("Letter", (0, 0, 0), 0.0, (1, 1, 1)),
):
    bpy.ops.object.text_add(location=place, rotation=(0, 0, turn))
    letter = bpy.context.object
    letter.name, letter.data.body, letter.scale = name, "R", scale
settings = bpy.context.scene.body_moments
settings.moments_of, settings.moments_about, settings.moments_order = "FLAT", "CENTER", 6
"""
IMAGES = "[list(image.size) for image in bpy.data.images if image.get('body_fourier')]"
FOUND = "{row.name: row.verdict for row in bpy.context.scene.body_moments_search.found}"


def test_the_panel_shows_area_moments_and_invariants_of_a_letter(window):
    window.ask(LETTERS)
    window.ask(OPEN)
    window.open_tab("Moments")
    window.ask("bpy.ops.object.body_moments_compute_moments('EXEC_DEFAULT', True)")
    shown(window, "flat-moments", 25)
    window.ask("bpy.context.scene.body_moments.moments_about = 'INVARIANT'")
    shown(window, "flat-invariants")


def test_letters_are_found_again_and_mirrored_ones_told_apart(window):
    window.ask("bpy.ops.object.body_moments_find_similar('INVOKE_DEFAULT')")
    window.wait("not [op for op in window.modal_operators if 'SIMILAR' in op.bl_idname.upper()]", limit=480.0)
    assert window.get(FOUND) == {"Copy": "copy", "Mirrored": "mirror", "Large": "scaled_copy"}
    shown(window, "flat-similar", 60)


def test_its_transform_is_shown_as_one_picture(window, tmp_path):
    path = str(tmp_path / "letter.npz")
    window.ask("[a for a in window.screen.areas if a.type == 'PROPERTIES'][0].type = 'IMAGE_EDITOR'")
    window.ask(f"bpy.ops.object.body_moments_fourier_run('INVOKE_DEFAULT', filepath={path!r}, of='FLAT', count=128)")
    window.wait("not [op for op in window.modal_operators if 'FOURIER' in op.bl_idname.upper()]", limit=480.0)
    assert window.get(IMAGES) == [[128, 128]]
    shown(window, "flat-fourier")
