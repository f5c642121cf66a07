# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The entries in Blender's menus are gone with the add-on; what they are, test_drawn.py keeps."""

from types import SimpleNamespace

import bpy
import pytest

from tests.blender.panels.drawing import Layout

pytestmark = pytest.mark.usefixtures("scene")


def test_entries_are_in_the_menus_as_long_as_the_add_on_is():
    from body_moments.panels import menus

    assert all(draw in getattr(bpy.types, name).draw._draw_funcs for name, draw in menus.ADDED)
    menus.unregister()
    try:
        for name, draw in menus.ADDED:
            assert draw not in getattr(bpy.types, name).draw._draw_funcs
    finally:
        menus.register()


def test_the_manual_is_in_the_help_menu_and_in_online_manual_where_it_lies_beside_the_code(tmp_path, monkeypatch):
    from body_moments.panels import manual

    monkeypatch.setattr(manual, "folder", lambda: tmp_path)
    manual.register()
    try:
        assert manual._help_entry in bpy.types.TOPBAR_MT_help.draw._draw_funcs
        assert (tmp_path.as_uri() + "/", manual.PAGES) in list(bpy.utils.manual_map())
        layout = Layout()
        manual._help_entry(SimpleNamespace(layout=layout), bpy.context)
        ((_, name, values),) = layout.record
        assert name == "wm.url_open" and values.url == (tmp_path / "index.html").as_uri()
        assert layout.text().startswith("separator\n") and "'HELP'" in layout.text()
    finally:
        manual.unregister()
    assert manual._help_entry not in bpy.types.TOPBAR_MT_help.draw._draw_funcs
    assert (tmp_path.as_uri() + "/", manual.PAGES) not in list(bpy.utils.manual_map())
    manual.unregister()  # without a manual there is nothing to take away
    monkeypatch.setattr(manual, "folder", lambda: tmp_path / "missing")
    manual.register()
    assert manual._help_entry not in bpy.types.TOPBAR_MT_help.draw._draw_funcs
