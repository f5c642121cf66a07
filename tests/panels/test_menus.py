# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's menus, and its entries in Blender's menus, which come and go with it."""

from types import SimpleNamespace

import bpy
import pytest
from body_moments.blender.registration import classes_of, register_modules, unregister_modules
from body_moments.panels import menus

from tests.blender.objects import add, mesh_body
from tests.panels.drawing import Layout

pytestmark = pytest.mark.usefixtures("scene")


def test_entries_are_in_the_menus_as_long_as_the_add_on_is():
    assert all(draw in menu.draw._draw_funcs for menu, draw in menus.MENUS)
    unregister_modules("body_moments.panels", ["menus"])
    try:
        assert not any(draw in menu.draw._draw_funcs for menu, draw in menus.MENUS)
    finally:
        register_modules("body_moments.panels", ["menus"])


def drawn(menu):
    layout = Layout()
    menu.draw(SimpleNamespace(layout=layout, GROUPS=menu.GROUPS), bpy.context)
    return [entry[:2] for entry in layout.record if entry[0] in ("operator", "menu")]


def test_no_operator_stands_in_two_menus():
    entries = [
        entry for menu in classes_of(menus) for entry in drawn(menu) if entry[0] == "operator"
    ]
    assert len(entries) == len(set(entries)) > 20


@pytest.mark.parametrize("what", ["REPORT", "TABLE", "REFERENCE", "SECTION", "MOMENTS", "urdf"])
def test_copy_without_numbers_is_refused(what):
    add(mesh_body(), "Body").select_set(False)
    bpy.context.view_layer.objects.active = None
    with pytest.raises(RuntimeError, match="first|Select objects"):
        bpy.ops.object.body_moments_copy(what=what)


def test_help_without_manual_shows_first_page():
    assert bpy.ops.wm.body_moments_manual() == {"FINISHED"}
    assert "Body Moments" in bpy.data.texts["Body Moments Manual"].as_string()
