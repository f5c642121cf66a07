# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator pressed once by mouse, what the panel shows compared with what is stored, and
refusals read.

The tests run in the order of the file and go on from one another, as a person does. Most buttons
are far down in sub-panels, or in menus of Blender's own: each of these is the only entry of a menu
of the test's own.
"""

import ast
import re
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.robots.formats import FORMATS

from tests.window.conftest import ROOT

MENU, OWN_MENU = "VIEW3D_MT_body_moments", "VIEW3D_MT_test_body_moments"
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
    """Two clicks: the menu of materials, which is above the Measure button, and its entry; returns
    their count.
    """
    x, y, width, height = window.region("UI")
    left, measure = window.place("object.body_moments_measure")
    window.click(x + (width - 28) * 0.6, measure + 22)
    for down in range(0, 400, 9):
        for way in (-down, down):
            command = window._command_at(x + (width - 28) * 0.6, measure + 22 + way)
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
    assert window.get(f"{PART}['body_mass']") == pytest.approx(
        1240.0 * (0.06**3 + 0.04**3), rel=1e-6
    )
    center = window.get(f"list({PART}.location)")
    assert center == [20.0, -10.0, 30.0]


def test_the_rows_of_the_panel_are_the_stored_numbers(window):
    window.point_at_view()
    window.redraw()
    shown = rows(window)
    stored = window.get(
        f"[{PART}[key] for key in ('body_mass', 'body_volume', 'body_area', 'body_density')]"
    )
    values = [(float(text), unit) for text, unit in shown if re.fullmatch(r"[-0-9.e]+", text)]
    for value, unit in zip(stored, ("kg", "m³", "m²", "kg/m³"), strict=True):
        assert (value, unit) in values
    center = [float(text) for text, unit in shown if unit == "m" and not text.startswith("[")]
    assert center == pytest.approx([0.02, -0.01, 0.03], rel=1e-6)
    heading = next(ast.literal_eval(text) for text, unit in shown if text.startswith("["))
    assert heading == center


def test_each_remedy_works_as_labeled(window):
    window.press("object.body_moments_remedy")
    window.wait(f"'flipped_faces' not in {PART}['body_findings']")
    window.press("object.body_moments_accept")
    window.wait(f"not {PART}['body_warnings']")
    window.undo()
    window.wait(f"{PART}['body_warnings']")
    window.press("object.body_moments_remedy")
    window.wait(f"{PART}['body_method'] == 'union'")
    assert window.get(f"{PART}['body_volume']") == pytest.approx(0.06**3, rel=1e-6)
    window.picture("operators-remedies")


def test_the_other_answer_to_the_question_is_kept(window):
    window.ask(NESTED)
    window.press("object.body_moments_measure")
    x, y = window.place("scene.body_moments_set_millimeters")
    window.move(x, y, *["click", 5] * 20)  # to the end, as the switch is below
    window.get("True")
    window.buttons.clear()
    x, y = window.middle("scene.body_moments_set_millimeters")
    window.click(x, y - 20)  # the switch below
    window.wait("bpy.context.scene.body_moments.units_answered")
    assert window.get("bpy.context.scene.unit_settings.scale_length") == 1.0


def test_a_refusal_is_read_in_the_panel_and_dismissed(window):
    window.ask(BRICK + "part.modifiers.new('Cast', 'CAST')")
    place = window.get(f"list({PART}.location)")
    window.choose(MENU, "object.body_moments_origin_to_center")
    refused = f"__import__('sys').modules['{PACKAGE}.blender.session.stored.outcome'].last()"
    window.wait(f"{refused} is not None")
    assert "“Cast”" in window.get(f"str({refused}.groups[0].finding)")
    assert window.get(f"list({PART}.location)") == place
    window.picture("operators-refusal")
    window.press("wm.body_moments_dismiss")
    window.wait(f"{refused} is None")


MADE = f"""
class {OWN_MENU}(bpy.types.Menu):
    bl_label = "Test"

    def draw(self, context):
        self.layout.operator_context = "INVOKE_DEFAULT"
        idname, options = bpy.app.driver_namespace["pressed"]
        button = self.layout.operator(idname)
        for name, value in options.items():
            setattr(button, name, value)

bpy.utils.register_class({OWN_MENU})
bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
"""
MEASURED = "bpy.ops.object.body_moments_measure()\n"
ASSEMBLY = "bpy.ops.object.body_moments_measure_assembly(target='COLLECTION')\n"
EDIT = "bpy.ops.object.mode_set(mode='EDIT')\nbpy.ops.mesh.select_all(action='SELECT')\n"
ONE_FACE = (
    "bpy.ops.object.mode_set(mode='EDIT')\nbpy.ops.mesh.select_mode(type='FACE')\n"
    "bpy.ops.mesh.select_all(action='DESELECT')\n"
    f"import bmesh\nb = bmesh.from_edit_mesh({PART}.data)\nb.faces.ensure_lookup_table()\n"
    f"b.faces[0].select_set(True)\nbmesh.update_edit_mesh({PART}.data)\n"
)
CLIPBOARD = "bpy.context.window_manager.clipboard"
COLLECTION = "bpy.context.collection"
RIG = """
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.subdivide(number_cuts=4)
bpy.ops.object.mode_set(mode="OBJECT")
rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
bpy.context.scene.collection.objects.link(rig)
rig.select_set(True)
bpy.context.view_layer.objects.active = rig
bpy.ops.object.mode_set(mode="EDIT")
for name, low in (("Lower", 0.0), ("Upper", 3.0)):
    bone = rig.data.edit_bones.new(name)
    bone.head, bone.tail = (1.0, 2.0, low), (1.0, 2.0, low + 3.0)
bpy.ops.object.mode_set(mode="OBJECT")
for name, below in (("Lower", True), ("Upper", False)):
    group = part.vertex_groups.new(name=name)
    group.add([v.index for v in part.data.vertices if (v.co.z < 0.0) == below], 1.0, "REPLACE")
part.modifiers.new("Armature", "ARMATURE").object = rig
bpy.context.view_layer.update()
"""
REFUSED = (
    f"__import__('sys').modules['{PACKAGE}.blender.session.stored.outcome'].last() is not None"
)
RIG_OBJECT = "bpy.data.objects['Rig']"
PRESET = str(ROOT / "tests" / "window" / "artefacts" / "preset.py")
# operator: options, what is there before, what must have happened
CLICKED = {
    "object.body_moments_copy_value": ({"value": "7.5", "unit": "kg"}, "", f"{CLIPBOARD} == '7.5'"),
    "object.body_moments_copy": ({"what": "REFERENCE"}, MEASURED, f"'Part, about' in {CLIPBOARD}"),
    "object.body_moments_store_reference": ({}, MEASURED, f"'body_reference' in {PART}"),
    "object.body_moments_axis_from_selection": (
        {},
        "bpy.ops.object.duplicate()\nbpy.context.object.location.x += 9.0\npart.select_set(True)",
        "bpy.context.scene.body_moments_reference.about == 'AXIS'",
    ),
    "object.body_moments_remedy": ({"remedy": "SHELL"}, "", f"{PART}.body_moments.kind == 'SHELL'"),
    "object.body_moments_equal_inertia": ({}, MEASURED, "len(bpy.data.objects) == 2"),
    "object.body_moments_rigid_bodies": ({}, "", f"{PART}.rigid_body is not None"),
    "object.body_moments_preset_add": (
        {"name": "Window"},
        "",
        "'Window.py' in [path.name for d in bpy.utils.preset_paths('body_moments') "
        "for path in __import__('pathlib').Path(d).iterdir()]",
    ),
    "object.body_moments_preset_apply": (
        {"filepath": PRESET},
        f"open({PRESET!r}, 'w').write('import bpy; '"
        "'bpy.context.object.body_moments.kind = \"SHELL\"')",
        f"{PART}.body_moments.kind == 'SHELL'",
    ),
    "object.body_moments_select_found": (
        {"name": "Part"},
        "bpy.ops.object.select_all(action='DESELECT')",
        "[obj.name for obj in bpy.context.selected_objects] == ['Part']",
    ),
    "object.body_moments_make_it_stand": (
        {"margin": 0.001},
        f"{PART}.body_moments.kind = 'PRINTED'",
        "bpy.context.window_manager.operators[-1].bl_idname == "
        "'OBJECT_OT_body_moments_make_it_stand'",
    ),
    "object.body_moments_sculpt_balance": (
        {},
        EDIT + "bpy.context.scene.cursor.location = (1.6, 2.0, 3.0)",
        "bpy.context.window_manager.operators[-1].bl_idname == "
        "'OBJECT_OT_body_moments_sculpt_balance'",
    ),
    "object.body_moments_select_refused": (
        {},
        "part.modifiers.new('Cast', 'CAST')\n"
        "bpy.ops.object.body_moments_origin_to_center('EXEC_DEFAULT', True)\n"
        "bpy.ops.object.select_all(action='DESELECT')",
        "[obj.name for obj in bpy.context.selected_objects] == ['Part']",
    ),
    "object.body_moments_measure_assembly": (
        {"target": "COLLECTION"},
        "",
        f"'body_mass' in {COLLECTION}",
    ),
    "object.body_moments_clear_assembly": (
        {"target": "COLLECTION"},
        ASSEMBLY,
        f"'body_mass' not in {COLLECTION}",
    ),
    "object.body_moments_assembly_empty": (
        {"target": "COLLECTION"},
        ASSEMBLY,
        "any(obj.type == 'EMPTY' for obj in bpy.data.objects)",
    ),
    "object.body_moments_assembly_origin": (
        {"target": "COLLECTION"},
        ASSEMBLY,
        f"abs({COLLECTION}.instance_offset[0] - 1.5) < 1e-5",
    ),
    "view3d.body_moments_cursor_to_assembly": (
        {"target": "COLLECTION"},
        "bpy.context.scene.cursor.location = (0, 0, 0)",
        "abs(bpy.context.scene.cursor.location.x - 1.5) < 1e-5",
    ),
    "object.body_moments_measure_bones": (
        {},
        RIG,
        f"'body_mass' in {RIG_OBJECT}.pose.bones['Upper']",
    ),
    "object.body_moments_clear_bones": (
        {},
        RIG + "bpy.ops.object.body_moments_measure_bones()",
        f"'body_mass' not in {RIG_OBJECT}.pose.bones['Upper']",
    ),
    "object.body_moments_rig_center": ({}, RIG, "'Rig Center of Mass' in bpy.data.objects"),
    "object.body_moments_physics_rig": ({}, RIG, "any(obj.rigid_body for obj in bpy.data.objects)"),
    "object.body_moments_select_faults": (
        {},
        f"import bmesh\nb = bmesh.new()\nb.from_mesh({PART}.data)\nb.faces.ensure_lookup_table()\n"
        f"bmesh.ops.reverse_faces(b, faces=[b.faces[2]])\nb.to_mesh({PART}.data)\nb.free()",
        "bpy.context.mode == 'EDIT_MESH'",
    ),
    "object.body_moments_clear": (
        {},
        "bpy.ops.object.body_moments_measure()",
        f"'body_mass' not in {PART}",
    ),
    "object.body_moments_align_to_world": (
        {},
        f"{PART}.rotation_euler = (0.3, 0.2, 0.1)",
        f"max(abs(round(e) - e) for row in {PART}.matrix_world.to_3x3().normalized()"
        " for e in row) < 1e-4",
    ),
    "view3d.body_moments_cursor_to_center": (
        {},
        "bpy.context.scene.cursor.location = (0, 0, 0)",
        "abs(bpy.context.scene.cursor.location.x - 1.5) < 1e-5",
    ),
    "object.body_moments_create_orientation": (
        {},
        "",
        "bpy.context.scene.transform_orientation_slots[0].type not in ('GLOBAL', 'LOCAL')",
    ),
    "object.body_moments_measure_section": ({}, ONE_FACE, f"'body_section' in {PART}"),
    "object.body_moments_compute_moments": (
        {},
        "",
        f"{PART} in __import__('sys').modules['{PACKAGE}.blender.session.memory'].moments",
    ),
    "object.body_moments_find_symmetry": ({}, "", f"{PART}.body_moments_symmetry.group == 'D2h'"),
    "object.body_moments_find_similar": (
        {},
        "bpy.ops.object.duplicate()\nbpy.context.object.name = "
        "'Twin'\nbpy.context.object.location.x += 9.0\n"
        f"bpy.context.view_layer.objects.active = {PART}\n{PART}.select_set(True)",
        "len(bpy.context.scene.body_moments_search.found) == 1",
    ),
    "object.body_moments_match_pose": (
        {},
        "bpy.ops.object.duplicate()\ntwin = bpy.context.object\ntwin.name = "
        "'Twin'\ntwin.location.x += 9.0\n"
        f"{PART}.select_set(True)\nbpy.context.view_layer.objects.active = {PART}",
        f"(bpy.data.objects['Twin'].location - {PART}.location).length < 1e-4",
    ),
    "object.body_moments_link_copies": (
        {},
        "bpy.ops.object.duplicate()\ntwin = bpy.context.object\ntwin.name = "
        "'Twin'\ntwin.location.x += 9.0\n"
        "twin.data.transform(__import__('mathutils').Matrix.Translation((0.3, 0, 0)))\n"
        f"{PART}.select_set(True)",
        f"bpy.data.objects['Twin'].data == {PART}.data",
    ),
    "object.body_moments_copy_settings": (
        {},
        "bpy.ops.object.duplicate()\nbpy.context.object.name = 'Twin'\n"
        f"{PART}.body_moments.density = 5.0\n"
        f"{PART}.select_set(True)\nbpy.context.view_layer.objects.active = {PART}",
        "bpy.data.objects['Twin'].body_moments.density == 5.0",
    ),
}
# operator: the ending of the file that its browser is for, what is there before, what must have
# happened
IN_BROWSER = {
    "export_scene.body_moments_urdf": ("urdf", MEASURED, "{path}.is_file()"),
    "export_scene.body_moments_sdf": ("sdf", MEASURED, "{path}.is_file()"),
    "export_scene.body_moments_mjcf": ("xml", MEASURED, "{path}.is_file()"),
    "export_scene.body_moments_usd": (
        "usda",
        MEASURED,
        f"{{path}}.is_file() or 'usd_export' not in dir(bpy.ops.wm) and {REFUSED}",
    ),
    "export_scene.body_moments_gltf": ("glb", MEASURED, "{path}.is_file()"),
    "export_scene.body_moments_osim": ("osim", MEASURED, "{path}.is_file()"),
    "object.body_moments_export_bill": ("csv", ASSEMBLY, "{path}.is_file()"),
    "object.body_moments_save_numbers": ("json", MEASURED, "{path}.is_file()"),
    "object.body_moments_fourier": ("npz", "", "{path}.is_file()"),
    "object.body_moments_import_scan": (
        "npy",
        "",
        "any(obj.type == 'VOLUME' for obj in bpy.data.objects)",
    ),
    "object.body_moments_import_surfaces": (
        "obj",
        "",
        "any(obj.type == 'SURFACE' for obj in bpy.data.objects)",
    ),
    "import_scene.body_moments_audit": ("urdf", "", "'Audit of window.urdf' in bpy.data.texts"),
    "object.body_moments_find_in_library": (
        "jsonl",
        "",
        "bpy.context.scene.body_moments_search.looked_at == 'window.jsonl'",
    ),
}
# a key chooses in their search
BY_KEYS = {
    "object.body_moments_set_material",
    "material.body_moments_set_density",
    "wm.body_moments_manual",  # opens a browser
}


@pytest.fixture(scope="module")
def prepared(window):
    window.ask(MADE)
    return window


def click(window, operator, options, before):
    window.ask(
        "if bpy.context.mode != 'OBJECT':\n    bpy.ops.object.mode_set(mode='OBJECT')\n"
        + BRICK
        + before
    )
    window.ask(f"bpy.app.driver_namespace['pressed'] = ({operator!r}, {options!r})")
    window.choose(OWN_MENU, operator)


@pytest.mark.parametrize("operator", CLICKED)
def test_a_click_does_its_work(prepared, operator):
    options, before, after = CLICKED[operator]
    click(prepared, operator, options, before)
    if operator.endswith(("preset_add", "link_copies")):  # their dialogs
        prepared.redraw()
        prepared.picture("dialog-" + operator.rpartition("_")[2])
        prepared.key("Return")
    prepared.wait(after, limit=60.0)


@pytest.mark.parametrize("operator", IN_BROWSER)
def test_a_click_opens_a_file_browser_and_return_goes_on(prepared, operator, tmp_path):
    ending, before, after = IN_BROWSER[operator]
    path = tmp_path / f"window.{ending}"
    write_input(operator, path)
    click(prepared, operator, {}, before)
    prepared.wait("area.type == 'FILE_BROWSER' and area.spaces.active.params is not None")
    prepared.ask(
        f"params = area.spaces.active.params\nparams.directory = {str(tmp_path).encode()!r}\n"
        f"params.filename = {path.name!r}"
    )
    prepared.redraw()
    prepared.move(800, 500)
    prepared.key("Return")
    prepared.wait("area.type == 'VIEW_3D'", limit=60.0)
    prepared.wait(after.format(path=f"__import__('pathlib').Path({str(path)!r})"), limit=120.0)


def write_input(operator, path: Path) -> None:
    if operator.endswith("import_scan"):
        np.save(path, np.ones((4, 4, 4), np.float32))
    elif operator.endswith("import_surfaces"):
        corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n"
        surface = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n"
        path.write_text(corners + surface, "utf-8")
    elif operator.endswith("audit"):
        inertial = (
            '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" '
            'iyz="0"/></inertial>'
        )
        path.write_text(f'<robot name="r"><link name="l">{inertial}</link></robot>', "utf-8")
    elif operator.endswith("find_in_library"):
        path.write_text("", "utf-8")


TURNED = f"{PART}.rotation_euler = (0.3, 0.2, 0.1)"
EMPTIES = "[obj.parent is not None for obj in bpy.data.objects if obj.type == 'EMPTY']"
PLACE = f"[round(value, 3) for value in {PART}.location]"
MASS = f"[{PART}.rigid_body.mass, *{PLACE}]"
# pixels from the pointer where F9 was pressed, and between settings
CHECKBOX, TITLE, ROW = (
    144,
    56,
    23,
)
# operator: which setting is clicked, what is there before, what is looked at, after the action,
# after the click
REDONE = {
    "object.body_moments_add_empty": (0, "", EMPTIES, [True], [False]),
    "object.body_moments_add_nodes": (
        0,
        "",
        "[group.name for group in bpy.data.node_groups]",
        ["Center of Mass", "Center of Mass Marker"],
        ["Center of Mass"],
    ),
    "object.body_moments_axes_to_principal": (
        0,
        TURNED,
        PLACE,
        [1.488, 2.049, 2.901],
        [1.488, 2.049, 2.901],
    ),
    "object.body_moments_set_rigid_body_mass": (
        1,
        "bpy.ops.rigidbody.object_add()",
        MASS,
        [48000.0, 1.0, 2.0, 3.0],
        [48000.0, 1.5, 2.0, 3.0],
    ),
}


@pytest.mark.parametrize("operator", REDONE)
def test_redo_panel_repeats_the_action_and_undo_takes_it_back(prepared, operator):
    window = prepared
    row, before, looked_at, acted, clicked = REDONE[operator]
    update = "\nbpy.context.view_layer.update()\nbpy.ops.ed.undo_push(message='Start')"
    window.ask(BRICK + before)
    start = window.get(looked_at)
    click(window, operator, {}, before + update)
    window.wait(f"{looked_at} == {acted!r}", limit=60.0)
    window.move(500, 500)
    window.key("F9")
    window.redraw()
    window.click(500 + CHECKBOX, 500 - TITLE - ROW * row)
    window.wait(f"{looked_at} == {clicked!r}", limit=60.0)
    window.redraw()
    window.key("Escape")
    window.undo()
    window.wait(f"{looked_at} == {start!r}", limit=60.0)


def test_every_operator_has_been_pressed():
    """By the strings that the tests of the window press, choose and click."""
    made = set()
    for folder in ("operators", "panels"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.ClassDef) and "_OT_" in node.name:
                    category, name = node.name.split("_OT_")
                    made.add(f"{category.lower()}.{name}")
    made |= {"export_scene.body_moments_" + name for name in FORMATS}
    pressed = {*CLICKED, *IN_BROWSER, *REDONE}
    for path in Path(__file__).parent.glob("test_*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in (
                "window.press",
                "window.choose",
            ):
                pressed |= {word.value for word in node.args if isinstance(word, ast.Constant)}
    assert made - pressed - BY_KEYS == set()
    assert {
        name for name in pressed - made if "body_moments" in name and "_MT_" not in name
    } == set()
