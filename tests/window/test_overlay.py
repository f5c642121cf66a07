# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay's pixels in the window: the disc is at the projected center, says the verdict,
follows a move in the same redraw, and is gone when it is switched off or the add-on is disabled.

The tests run in the order of the file and go on from one another.
"""

import numpy as np
import pytest

from tests.window.harness import PACKAGE

SETTINGS = "bpy.context.scene.body_moments.overlay"
EXACT, OUT_OF_DATE = (0.15, 0.85, 0.60), (0.68, 0.72, 0.76)
FROM_SRGB = 0.06  # Rounding and the display change colors by as much.


def center_color(window, name="overlay"):
    """(3,) the color on the screen where the cube's center is."""
    window.point_at_view()
    window.get("True")
    path = window.picture(name, "png")
    return window.ask(
        "from bpy_extras.view3d_utils import location_3d_to_region_2d as project\n"
        "cube, region = bpy.data.objects['Cube'], regions['WINDOW']\n"
        "place = project(region, area.spaces.active.region_3d, cube.matrix_world.translation)\n"
        f"image = bpy.data.images.load({str(path)!r})\n"
        "x, y = round(region.x + place.x), round(region.y + place.y)\n"
        "start = 4 * (y * image.size[0] + x)\n"
        "result = list(image.pixels[start:start + 3])\n"
        "bpy.data.images.remove(image)"
    )


def white_pixels_of_disc(window, name):
    """Count the white pixels around the cube's center."""
    window.point_at_view()
    window.get("True")
    screen = window.pixels(name)
    x, y = window.ask(
        "from bpy_extras.view3d_utils import location_3d_to_region_2d as project\nregion = "
        "regions['WINDOW']\n"
        "center = bpy.data.objects['Cube'].matrix_world.translation\n"
        "place = project(region, area.spaces.active.region_3d, center)\n"
        "result = [round(region.x + place.x), round(region.y + place.y)]"
    )
    row = len(screen) - 1 - y
    return int((screen[row - 8 : row + 9, x - 8 : x + 9] > 240).all(axis=2).sum())


def is_near(color, truth):
    return bool(np.abs(np.subtract(color, truth)).max() <= FROM_SRGB)


def test_nothing_is_drawn_before_the_first_measure(window):
    window.ask("bpy.ops.view3d.view_selected()")
    assert not is_near(center_color(window, "overlay-before"), EXACT)


@pytest.mark.parametrize("light", [False, True], ids=["dark", "light"])
def test_the_disc_is_at_the_projected_center_on_every_background(window, light):
    window.ask(
        "bpy.ops.object.body_moments_measure()\n"
        "gradients = bpy.context.preferences.themes[0].view_3d.space.gradients\n"
        f"gradients.high_gradient = gradients.gradient = ({0.95 if light else 0.02},) * 3"
    )
    assert is_near(center_color(window, f"overlay-{'light' if light else 'dark'}"), EXACT)


def test_front_objects_show_through_the_white_quadrants(window):
    assert white_pixels_of_disc(window, "overlay-hidden") == 0


def test_the_disc_follows_a_move(window):
    window.type("g", "x", "1", "Return")
    window.wait("bpy.data.objects['Cube'].location.x == 2.0")
    assert is_near(center_color(window, "overlay-moved"), EXACT)


def test_the_verdict_is_out_of_date_after_a_change_of_settings(window):
    window.ask("bpy.data.objects['Cube'].body_moments.kind = 'SHELL'")
    assert is_near(center_color(window, "overlay-stale"), OUT_OF_DATE)
    window.ask("bpy.data.objects['Cube'].body_moments.kind = 'SOLID'")
    assert is_near(center_color(window), EXACT)


@pytest.mark.parametrize("switch", [SETTINGS + ".show", "area.spaces.active.overlay.show_overlays"])
def test_it_is_switched_off(window, switch):
    window.ask("bpy.ops.object.body_moments_measure()")
    window.ask(f"{switch} = False")
    assert not is_near(center_color(window), EXACT)
    window.ask(f"{switch} = True")


LEFT = f"""
import sys
types = bpy.types
kinds = (types.Panel, types.Menu, types.Operator, types.PropertyGroup, types.UIList)
names = (getattr(bpy.types, name) for name in dir(bpy.types))
menus = [getattr(getattr(cls, "draw", None), "_draw_funcs", None) or () for cls in names]
lists = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)]
lists = [*menus, *(one for one in lists if isinstance(one, list))]
functions = [entry for entries in lists for entry in entries]
left = [str(entry) for entry in functions if str(entry.__module__).startswith({PACKAGE!r})]
left += [str(cls) for kind in kinds for cls in kind.__subclasses__()
         if cls.__module__.startswith({PACKAGE!r}) and getattr(cls, "is_registered", False)]
owners = (bpy.types.Object, bpy.types.Scene, bpy.types.Collection, bpy.types.Material,
          bpy.types.PoseBone, bpy.types.WindowManager)
left += [name for owner in owners for name in dir(owner) if "body_moments" in name]
ours = [module for name, module in sys.modules.items() if name.startswith({PACKAGE!r})]
members = [member for module in ours for member in vars(module).values()
           if type(member) is type(lambda: 0)]
left += [str(member) for member in members if bpy.app.timers.is_registered(member)]
keys = bpy.context.window_manager.keyconfigs
left += [item.idname for keymap in keys.user.keymaps for item in keymap.keymap_items
         if "body_moments" in item.idname]
drawing = sys.modules.get("{PACKAGE}.panels.overlay.draw")
left += [] if drawing is None or not drawing._handles else ["draw handler"]
result = left
"""


def test_nothing_is_drawn_or_handled_when_the_add_on_is_disabled(window):
    window.ask(
        "bpy.ops.object.body_moments_live()\nbpy.ops.object.body_moments_stability()\n"
        "bpy.ops.object.body_moments_compute_moments('EXEC_DEFAULT', True)"
    )
    assert len(window.ask(LEFT)) > 100
    window.ask(f"bpy.ops.preferences.addon_disable(module={PACKAGE!r})")
    assert not is_near(center_color(window, "overlay-disabled"), EXACT)
    assert window.ask(LEFT) == []
