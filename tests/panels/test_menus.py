# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's menus come and go with the add-on."""

import bpy
import pytest

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
