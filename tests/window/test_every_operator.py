# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator pressed once by mouse, what the panel shows compared with what is stored, and refusals read.

The tests run in the order of the file and go on from one another, as a person does.
"""

import ast
import re

import pytest

MENU = "VIEW3D_MT_body_moments"
PART = "bpy.data.objects['Part']"
PACKAGE = "bl_ext.user_default.body_moments"
# A box of 60 around one of 40, of which one face is flipped; the scene's unit is a meter.
NESTED = """
import bmesh
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.ops.mesh.primitive_cube_add(size=60.0, location=(20.0, -10.0, 30.0))
part = bpy.context.object
part.name = "Part"
built = bmesh.new()
built.from_mesh(part.data)
bmesh.ops.create_cube(built, size=40.0)
built.faces.ensure_lookup_table()
bmesh.ops.reverse_faces(built, faces=[built.faces[0]])
built.to_mesh(part.data)
built.free()
bpy.context.scene.body_moments.units_answered = False
bpy.context.scene.unit_settings.scale_length = 1.0
"""
BRICK = """
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
bpy.ops.mesh.primitive_cube_add(size=2.0, location=(1.0, 2.0, 3.0))
part = bpy.context.object
part.name, part.scale = "Part", (1.0, 2.0, 3.0)
part.data.transform(__import__("mathutils").Matrix.Translation((0.5, 0.0, 0.0)))
bpy.context.scene.body_moments.units_answered = True
"""


def click_material(window, name):
    """Two clicks: the menu of materials, which is above the Measure button, and its entry; returns their count."""
    x, y, width, height = window.region("UI")
    left, measure = window.place("object.body_moments_measure")
    window.click(x + (width - 28) * 0.6, measure + 30)
    for down in range(0, 400, 9):
        for way in (-down, down):
            command = window._command_at(x + (width - 28) * 0.6, measure + 30 + way)
            if (
                command
                and command.startswith("bpy.ops.object.body_moments_set_material")
                and repr(name)[1:-1] in command
            ):
                window._xdotool("click", 1)
                window.wait(f"{PART}.body_moments.material == {name!r}")
                return 2
    window.picture("no-material")
    raise LookupError(name)


def rows(window):
    """Value and unit of every row with a copy button."""
    shown = []
    for command in window.commands():
        if "body_moments_copy_value" in command:
            call = ast.parse(command.removeprefix("bpy.ops.object."), mode="eval").body
            shown.append(tuple(keyword.value.value for keyword in call.keywords))
    return shown


def number_of_clicks(window, unit):
    """From opening the sidebar to mass and center of a print part in PLA."""
    window.ask(NESTED.replace("scale_length = 1.0", f"scale_length = {unit!r}"))
    window.open_tab("Moments")
    count = click_material(window, "PLA")
    window.press("object.body_moments_measure")
    window.wait(f"'body_mass' in {PART}")
    return count + 1


def test_a_print_part_takes_three_clicks_in_millimeters(window):
    assert number_of_clicks(window, 0.001) == 3
    mass = window.get(f"{PART}['body_mass']")
    assert mass == pytest.approx(1240.0 * (0.06**3 + 0.04**3), rel=1e-6)
    window.picture("operators-three-clicks")


def test_print_part_with_another_unit_takes_four_clicks(window):
    clicks = number_of_clicks(window, 1.0)
    window.press("scene.body_moments_set_millimeters")
    window.wait("bpy.context.scene.unit_settings.length_unit == 'MILLIMETERS'")
    assert clicks + 1 == 4
    assert window.get(f"{PART}['body_mass']") == pytest.approx(1240.0 * (0.06**3 + 0.04**3), rel=1e-6)
    center = window.get(f"list({PART}.location)")
    assert center == [20.0, -10.0, 30.0]


def test_the_rows_of_the_panel_are_the_stored_numbers(window):
    window.point_at_view()
    window.redraw()
    shown = rows(window)
    stored = window.get(f"[{PART}[key] for key in ('body_mass', 'body_volume', 'body_area', 'body_density')]")
    values = [(float(text), unit) for text, unit in shown if re.fullmatch(r"[-0-9.e]+", text)]
    for value, unit in zip(stored, ("kg", "m³", "m²", "kg/m³"), strict=True):
        assert (value, unit) in values
    center = [float(text) for text, unit in shown if unit == "m" and not text.startswith("[")]
    assert center == pytest.approx([0.02, -0.01, 0.03], rel=1e-6)
    heading = next(ast.literal_eval(text) for text, unit in shown if text.startswith("["))
    assert heading == center


def test_each_remedy_works_as_labeled(window):
    window.press("object.body_moments_recalculate_outside")
    window.wait(f"'flipped_faces' not in {PART}['body_findings']")
    window.press("object.body_moments_accept")
    window.wait(f"not {PART}['body_warnings']")
    window.point_at_view()
    window.key("ctrl+z")
    window.wait(f"{PART}['body_warnings']")
    window.press("object.body_moments_count_as_union")
    window.wait(f"{PART}['body_method'] == 'union'")
    assert window.get(f"{PART}['body_volume']") == pytest.approx(0.06**3, rel=1e-6)
    window.picture("operators-remedies")


def test_the_other_answer_to_the_question_is_kept(window):
    window.ask(NESTED)
    window.press("object.body_moments_measure")
    window.press("scene.body_moments_keep_units")
    window.wait("bpy.context.scene.body_moments.units_answered")
    assert window.get("bpy.context.scene.unit_settings.scale_length") == 1.0


def test_a_refusal_is_read_in_the_panel_and_dismissed(window):
    window.ask(BRICK + "part.modifiers.new('Cast', 'CAST')")
    place = window.get(f"list({PART}.location)")
    window.choose(MENU, "object.body_moments_origin_to_center")
    refused = f"__import__('sys').modules['{PACKAGE}.blender.session.stored.outcome'].last()"
    window.wait(f"{refused} is not None")
    assert "“Cast”" in window.get(f"str({refused}.findings[0])")
    assert window.get(f"list({PART}.location)") == place
    window.redraw()
    window.picture("operators-refusal")
    window.press("wm.body_moments_dismiss")
    window.wait(f"{refused} is None")


# Each by its entry in Object > Body Moments: what is there before, and what must have happened.
PRESSED = {
    "object.body_moments_measure": ("", f"{PART}['body_volume'] == 48.0"),
    "object.body_moments_select_faults": (
        f"import bmesh\nb = bmesh.new()\nb.from_mesh({PART}.data)\nb.faces.ensure_lookup_table()\n"
        f"bmesh.ops.reverse_faces(b, faces=[b.faces[2]])\nb.to_mesh({PART}.data)\nb.free()",
        "bpy.context.mode == 'EDIT_MESH'",
    ),
    "object.body_moments_copy_report": (
        "bpy.ops.object.body_moments_measure()",
        "'Part' in bpy.context.window_manager.clipboard",
    ),
    "object.body_moments_clear": ("bpy.ops.object.body_moments_measure()", f"'body_mass' not in {PART}"),
    "object.body_moments_origin_to_center": ("", f"abs({PART}.location.x - 1.5) < 1e-5"),
    "object.body_moments_axes_to_principal": ("", f"max(abs(s - 1.0) for s in {PART}.scale) < 1e-5"),
    "object.body_moments_align_to_world": (
        f"{PART}.rotation_euler = (0.3, 0.2, 0.1)",
        f"max(abs(round(e) - e) for row in {PART}.matrix_world.to_3x3().normalized() for e in row) < 1e-4",
    ),
    "object.body_moments_add_empty": ("", "any(obj.type == 'EMPTY' for obj in bpy.data.objects)"),
    "view3d.body_moments_cursor_to_center": (
        "bpy.context.scene.cursor.location = (0, 0, 0)",
        "abs(bpy.context.scene.cursor.location.x - 1.5) < 1e-5",
    ),
    "object.body_moments_create_orientation": (
        "",
        "bpy.context.scene.transform_orientation_slots[0].type not in ('GLOBAL', 'LOCAL')",
    ),
    "object.body_moments_set_rigid_body_mass": (
        "bpy.ops.rigidbody.object_add()",
        f"abs({PART}.rigid_body.mass - 48000.0) < 1.0",
    ),
    "object.body_moments_add_nodes": ("", "'Center of Mass' in bpy.data.node_groups"),
    "object.body_moments_measure_section": (
        "bpy.ops.object.mode_set(mode='EDIT')\nbpy.ops.mesh.select_mode(type='FACE')\n"
        "bpy.ops.mesh.select_all(action='DESELECT')\n"
        f"import bmesh\nb = bmesh.from_edit_mesh({PART}.data)\nb.faces.ensure_lookup_table()\n"
        f"b.faces[0].select_set(True)\nbmesh.update_edit_mesh({PART}.data)",
        f"'body_section' in {PART}",
    ),
    "object.body_moments_compute_moments": (
        "",
        f"__import__('sys').modules['{PACKAGE}.blender.session.stored.moments'].computed_moments({PART}) is not None",
    ),
    "object.body_moments_find_symmetry": ("", f"{PART}.body_moments_symmetry.group == 'D2h'"),
    "object.body_moments_find_similar": (
        "bpy.ops.object.duplicate()\nbpy.context.object.name = 'Twin'\nbpy.context.object.location.x += 9.0\n"
        f"bpy.context.view_layer.objects.active = {PART}\n{PART}.select_set(True)",
        "len(bpy.context.scene.body_moments_search.found) == 1",
    ),
    "object.body_moments_match_pose": (
        "bpy.ops.object.duplicate()\ntwin = bpy.context.object\ntwin.name = 'Twin'\ntwin.location.x += 9.0\n"
        f"{PART}.select_set(True)\nbpy.context.view_layer.objects.active = {PART}",
        f"(bpy.data.objects['Twin'].location - {PART}.location).length < 1e-4",
    ),
    "object.body_moments_copy_settings": (
        f"bpy.ops.object.duplicate()\nbpy.context.object.name = 'Twin'\n{PART}.body_moments.density = 5.0\n"
        f"{PART}.select_set(True)\nbpy.context.view_layer.objects.active = {PART}",
        "bpy.data.objects['Twin'].body_moments.density == 5.0",
    ),
}


@pytest.mark.parametrize("operator", PRESSED)
def test_an_operator_is_chosen_from_the_menu_and_does_its_work(window, operator):
    before, after = PRESSED[operator]
    window.ask("if bpy.context.mode != 'OBJECT':\n    bpy.ops.object.mode_set(mode='OBJECT')\n" + BRICK + before)
    window.choose(MENU, operator)
    window.wait(after, limit=60.0)
    if window.get("bpy.context.mode != 'OBJECT'"):
        window.ask("bpy.ops.object.mode_set(mode='OBJECT')")


def test_nothing_went_wrong_while_the_panels_were_drawn(window):
    assert "Traceback" not in window.output()
