# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""First steps of a person: open the tab, press Measure, look, change their mind.

The tests run in the order of the file and go on from one another, as the person does.
"""

import pytest

CUBE = "bpy.data.objects['Cube']"
PLACE = f"list({CUBE}.location)"
PACKAGE = "bl_ext.user_default.body_moments"
STALE = (
    f"sys.modules['{PACKAGE}.blender.session.tracking.staleness']"
    f".stale_reason({CUBE}, bpy.context.scene)"
)


def test_the_sidebar_has_the_tab(window):
    window.open_tab("Moments")
    window.picture("1-tab")


def test_measure_button_measures_the_selection(window):
    assert window.get(f"'body_volume' in {CUBE}") is False
    window.press("object.body_moments_measure")
    window.wait(f"'body_volume' in {CUBE}")
    window.picture("2-measured")
    assert window.get(f"{CUBE}['body_volume']") == pytest.approx(8.0, rel=1e-12)
    assert window.get(f"{CUBE}['body_mass']") == pytest.approx(8000.0, rel=1e-12)
    assert window.get(f"{CUBE}['body_method']") == "exact"
    assert window.get(f"list({CUBE}['body_center_of_mass'])") == pytest.approx([0.0] * 3, abs=1e-12)


def test_fresh_numbers_are_not_called_out_of_date(window):
    window.point_at_view()
    window.redraw()
    assert window.ask(f"import sys\nresult = {STALE}") is None


def test_undo_takes_the_numbers_away_and_redo_brings_them_back(window):
    window.undo()
    window.wait(f"'body_volume' not in {CUBE}")
    window.picture("3-undone")
    window.key("ctrl+shift+z")
    window.wait(f"'body_volume' in {CUBE}")


def test_the_report_is_copied(window):
    window.ask("bpy.ops.object.body_moments_copy(what='REPORT')")
    window.wait("'Cube' in bpy.context.window_manager.clipboard")
    assert "8000" in window.get("bpy.context.window_manager.clipboard")


def test_moving_the_object_keeps_its_numbers_up_to_date(window):
    window.point_at_view()
    window.type("g", "x", "1", "Return")
    window.wait(f"{PLACE} == [2.0, 2.0, 3.0]")
    window.picture("4-moved")
    assert window.ask(f"import sys\nresult = {STALE}") is None


def test_origin_moves_to_the_center_of_mass_and_body_stays(window):
    corners = f"sorted(list({CUBE}.matrix_world @ v.co) for v in {CUBE}.data.vertices)"
    window.ask(
        "from mathutils import Matrix\n"
        f"{CUBE}.data.transform(Matrix.Translation((0.5, 0.25, 0.0)))\n"
        f"{CUBE}.data.update()"
    )
    before = window.get(corners)
    window.choose("VIEW3D_MT_body_moments", "object.body_moments_origin_to_center")
    window.wait(f"{PLACE} == [2.5, 2.25, 3.0]")
    window.picture("5-origin")
    for corner, moved in zip(window.get(corners), before, strict=True):
        assert corner == pytest.approx(moved, abs=1e-6)
    window.undo()
    window.wait(f"{PLACE} == [2.0, 2.0, 3.0]")


SUZANNE = """
bpy.ops.mesh.primitive_monkey_add()
bpy.context.object.modifiers.new("Subdivision", "SUBSURF").render_levels = 3
"""
PARTS = """
for number in range(30):
    bpy.ops.mesh.primitive_cube_add(location=(4.0 * number, 0.0, 0.0))
    obj = bpy.context.object
    if number < 20:
        built = bmesh.new()
        built.from_mesh(obj.data)
        built.faces.ensure_lookup_table()
        built.faces[0].normal_flip()
        built.faces.remove(built.faces[3])
        built.to_mesh(obj.data)
"""


@pytest.mark.parametrize(
    "scene", ["bpy.ops.mesh.primitive_cube_add(location=(1.0, 2.0, 3.0))", SUZANNE, PARTS]
)
def test_mass_volume_and_center_are_above_350_pixels(window, scene):
    window.ask("import bmesh\nfor obj in bpy.data.objects:\n    obj.hide_set(True)\n" + scene)
    window.ask("bpy.ops.object.select_all(action='SELECT')")
    window.ask("bpy.ops.object.body_moments_measure('EXEC_DEFAULT', True)")
    window.point_at_view()
    window.redraw()
    x, bottom, width, height = window.region("UI")
    found = {}
    for down in range(24, 350, 6):
        command = window._command_at(x + (width - 28) * 0.95, bottom + height - down)
        if command and "copy_value" in command:
            found.setdefault(command, down)
    window.picture("answer")
    units = [command.rpartition("unit=")[2].strip("()'\"") for command in found]
    assert units[:3] == ["kg", "m³", "m"]  # mass, volume, and the copy of the whole center
    assert units.count("m") >= 2 and max(found.values()) < 350


def test_nothing_went_wrong_while_the_panel_was_drawn(window):
    assert "Error" not in window.output()
