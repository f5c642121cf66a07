# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual: the pages in the zip, the website, or else the README in Blender's text editor."""

from pathlib import Path

import bpy
from bpy.types import Context, Operator

from ..blender.settings.preferences import address, manual_folder

TEXT = "Body Moments Manual"
FIRST_PAGE = "README.md"  # in every zip, beside the add-on's code


class WM_OT_body_moments_manual(Operator):
    """Open the manual"""

    bl_label = "Body Moments Manual"
    bl_options = {"REGISTER"}

    def execute(self, context: Context) -> set[str]:
        if url := address("index.html"):
            bpy.ops.wm.url_open(url=url)
            return {"FINISHED"}
        path: Path = manual_folder().with_name(FIRST_PAGE)
        text = bpy.data.texts.get(TEXT) or bpy.data.texts.new(TEXT)
        text.from_string(path.read_text(encoding="utf-8"))
        if context.window is not None and not bpy.app.background:
            bpy.ops.wm.window_new()
            area = context.window_manager.windows[-1].screen.areas[0]
            area.type = "TEXT_EDITOR"
            area.spaces.active.text = text
            area.spaces.active.show_word_wrap = True
        return {"FINISHED"}
