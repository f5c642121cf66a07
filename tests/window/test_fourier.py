# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform goes on while the window lives: it shows how far it is, and Esc ends it."""

import numpy as np

BODY = """
bpy.ops.mesh.primitive_torus_add(major_segments=160, minor_segments=64)
bpy.context.object.name = "Ring"
"""
START = "bpy.ops.object.body_moments_fourier_run('INVOKE_DEFAULT', filepath={!r}, count=64)"
IMAGES = "[list(image.size) for image in bpy.data.images if image.get('body_fourier')]"


def test_esc_ends_it_and_leaves_nothing(window, tmp_path):
    path = tmp_path / "ring.npz"
    window.ask(BODY)
    window.ask(START.format(str(path)))
    window.point_at_view()
    window.key("Escape")
    window.wait("not [op for op in window.modal_operators if 'FOURIER' in op.bl_idname.upper()]")
    assert window.get(IMAGES) == [] and list(tmp_path.iterdir()) == []


def test_transform_writes_a_file_and_shows_slices(window, tmp_path):
    path = tmp_path / "ring.npz"
    window.ask("[a for a in window.screen.areas if a.type == 'PROPERTIES'][0].type = 'IMAGE_EDITOR'")
    window.ask(START.format(str(path)))
    window.wait("not [op for op in window.modal_operators if 'FOURIER' in op.bl_idname.upper()]", limit=480.0)
    assert window.get(IMAGES) == [[3 * 64 + 4, 64]]
    shown = "[a for a in window.screen.areas if a.type == 'IMAGE_EDITOR'][0].spaces.active.image.name"
    assert window.get(shown) == "Fourier Transform of Ring"
    window.redraw()
    window.picture("fourier")
    with np.load(path) as found:
        assert found["q"].shape == (64**3, 3) and found["F"].shape == (64**3,)
    window.point_at_view()
    window.key("ctrl+z")
    window.wait("not " + IMAGES)
