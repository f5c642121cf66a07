# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The entries in Blender's menus: where users look, only where they can run, and gone with the add-on."""

from types import SimpleNamespace

import bpy
import pytest

from tests.blender.objects import add, mesh_body
from tests.blender.panels.test_panel import Layout

pytestmark = pytest.mark.usefixtures("scene")

PLACES = {
    "VIEW3D_MT_object": "object.body_moments_origin_to_center",
    "VIEW3D_MT_object_context_menu": "object.body_moments_measure",
    "VIEW3D_MT_transform_object": "object.body_moments_align_to_world",
    "VIEW3D_MT_snap": "view3d.body_moments_cursor_to_center",
    "VIEW3D_MT_snap_pie": "view3d.body_moments_cursor_to_center",
    "VIEW3D_MT_object_rigid_body": "object.body_moments_set_rigid_body_mass",
    "VIEW3D_MT_empty_add": "object.body_moments_add_empty",
    "PHYSICS_PT_rigid_body": "object.body_moments_set_rigid_body_mass",
}


def drawn_in(name):
    """The operators that we add to a menu."""
    from body_moments.panels import menus

    layout = Layout()
    for place, draw in menus.ADDED:
        if place == name:
            draw(SimpleNamespace(layout=layout), bpy.context)
    return [entry[1] for entry in layout.record if entry[0] == "operator"]


@pytest.mark.parametrize(("menu", "operator"), PLACES.items())
def test_every_menu_has_its_entry(menu, operator):
    from body_moments.panels import menus

    obj = add(mesh_body())
    bpy.ops.rigidbody.object_add()
    assert obj.rigid_body is not None
    assert operator in drawn_in(menu)
    draws = getattr(bpy.types, menu).draw._draw_funcs
    assert [draw for _, draw in menus.ADDED if draw in draws]


def test_menus_that_edit_mode_shares_have_no_entry_there():
    add(mesh_body())
    bpy.ops.object.mode_set(mode="EDIT")
    for menu in ("VIEW3D_MT_snap", "VIEW3D_MT_empty_add", "VIEW3D_MT_transform_object"):
        assert drawn_in(menu) == []


def test_the_menu_of_all_names_operators_that_exist_each_once():
    from body_moments.panels.menus import VIEW3D_MT_body_moments

    layout = Layout()
    VIEW3D_MT_body_moments.draw(SimpleNamespace(layout=layout), bpy.context)
    named = [entry[1] for entry in layout.record]
    assert len(named) == len({*named}) > 12


def test_nothing_stays_in_the_menus_without_the_add_on():
    from body_moments.panels import menus

    menus.unregister()
    try:
        for name, draw in menus.ADDED:
            assert draw not in getattr(bpy.types, name).draw._draw_funcs
    finally:
        menus.register()
