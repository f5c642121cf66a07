# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that no other test clicks in the window: of sub-panels, File menus and file browsers.

Their buttons are far down in sub-panels, so each is the only entry of a menu of the test's own.
"""

import ast
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.robots.formats import FORMATS

from tests.window.conftest import ROOT
from tests.window.test_every_operator import BRICK, PACKAGE, PART, PRESSED

MENU = "VIEW3D_MT_test_body_moments"
MADE = f"""
class {MENU}(bpy.types.Menu):
    bl_label = "Test"

    def draw(self, context):
        self.layout.operator_context = "INVOKE_DEFAULT"
        idname, options = bpy.app.driver_namespace["pressed"]
        button = self.layout.operator(idname)
        for name, value in options.items():
            setattr(button, name, value)

bpy.utils.register_class({MENU})
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
REFUSED = f"__import__('sys').modules['{PACKAGE}.blender.session.stored.outcome'].last() is not None"
RIG_OBJECT = "bpy.data.objects['Rig']"
# operator: options, what is there before, what must have happened
CLICKED = {
    "object.body_moments_copy_value": ({"value": "7.5", "unit": "kg"}, "", f"{CLIPBOARD} == '7.5'"),
    "object.body_moments_copy_inertial": ({}, MEASURED, f"'inertia' in {CLIPBOARD}"),
    "object.body_moments_store_reference": ({}, MEASURED, f"'body_reference' in {PART}"),
    "object.body_moments_copy_reference": ({}, MEASURED, f"'Part, about' in {CLIPBOARD}"),
    "object.body_moments_axis_from_selection": (
        {},
        "bpy.ops.object.duplicate()\nbpy.context.object.location.x += 9.0\npart.select_set(True)",
        "bpy.context.scene.body_moments_reference.about == 'AXIS'",
    ),
    "object.body_moments_copy_moments": (
        {},
        MEASURED + "bpy.ops.object.body_moments_compute_moments('EXEC_DEFAULT', True)",
        f"len({CLIPBOARD}.splitlines()) > 20",
    ),
    "object.body_moments_copy_section": (
        {},
        ONE_FACE + "bpy.ops.object.body_moments_measure_section('EXEC_DEFAULT', True)",
        f"'Part' in {CLIPBOARD}",
    ),
    "object.body_moments_measure_as_shell": ({}, "", f"{PART}.body_moments.kind == 'SHELL'"),
    "object.body_moments_equal_inertia": ({}, MEASURED, "len(bpy.data.objects) == 2"),
    "object.body_moments_rigid_bodies": ({}, "", f"{PART}.rigid_body is not None"),
    "object.body_moments_preset_add": (
        {"name": "Window"},
        "",
        "'Window.py' in [path.name for d in bpy.utils.preset_paths('body_moments') "
        "for path in __import__('pathlib').Path(d).iterdir()]",
    ),
    "object.body_moments_select_found": (
        {"name": "Part"},
        "bpy.ops.object.select_all(action='DESELECT')",
        "[obj.name for obj in bpy.context.selected_objects] == ['Part']",
    ),
    "object.body_moments_sculpt_balance": (
        {},
        EDIT + "bpy.context.scene.cursor.location = (1.6, 2.0, 3.0)",
        "bpy.context.window_manager.operators[-1].bl_idname == 'OBJECT_OT_body_moments_sculpt_balance'",
    ),
    "object.body_moments_select_refused": (
        {},
        "part.modifiers.new('Cast', 'CAST')\n"
        "bpy.ops.object.body_moments_origin_to_center('EXEC_DEFAULT', True)\n"
        "bpy.ops.object.select_all(action='DESELECT')",
        "[obj.name for obj in bpy.context.selected_objects] == ['Part']",
    ),
    "object.body_moments_measure_assembly": ({"target": "COLLECTION"}, "", f"'body_mass' in {COLLECTION}"),
    "object.body_moments_clear_assembly": ({"target": "COLLECTION"}, ASSEMBLY, f"'body_mass' not in {COLLECTION}"),
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
    "object.body_moments_measure_bones": ({}, RIG, f"'body_mass' in {RIG_OBJECT}.pose.bones['Upper']"),
    "object.body_moments_clear_bones": (
        {},
        RIG + "bpy.ops.object.body_moments_measure_bones()",
        f"'body_mass' not in {RIG_OBJECT}.pose.bones['Upper']",
    ),
    "object.body_moments_rig_center": ({}, RIG, "'Rig Center of Mass' in bpy.data.objects"),
    "object.body_moments_physics_rig": ({}, RIG, "any(obj.rigid_body for obj in bpy.data.objects)"),
}
# operator: the ending of the file that its browser is for, what is there before, what must have happened
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
    "object.body_moments_export_bill": ("csv", ASSEMBLY, "{path}.is_file()"),
    "object.body_moments_save_numbers": ("json", MEASURED, "{path}.is_file()"),
    "object.body_moments_fourier": ("npz", "", "{path}.is_file()"),
    "object.body_moments_import_scan": ("npy", "", "any(obj.type == 'VOLUME' for obj in bpy.data.objects)"),
    "object.body_moments_import_surfaces": ("obj", "", "any(obj.type == 'SURFACE' for obj in bpy.data.objects)"),
    "import_scene.body_moments_audit": ("urdf", "", "'Audit of window.urdf' in bpy.data.texts"),
    "object.body_moments_find_in_library": (
        "jsonl",
        "",
        "bpy.context.scene.body_moments_search.looked_at == 'window.jsonl'",
    ),
    "object.body_moments_measure_library": ("", "", "{path}.with_name('body_moments.jsonl').exists()"),
}
# pressed through another one, and the search for a material of a slot, which a key chooses
BY_OTHERS = {
    "object.body_moments_fourier_run": "object.body_moments_fourier",
    "material.body_moments_set_density": "object.body_moments_set_material",
}


@pytest.fixture(scope="module")
def prepared(window):
    window.ask(MADE)
    return window


def click(window, operator, options, before):
    window.ask("if bpy.context.mode != 'OBJECT':\n    bpy.ops.object.mode_set(mode='OBJECT')\n" + BRICK + before)
    window.ask(f"bpy.app.driver_namespace['pressed'] = ({operator!r}, {options!r})")
    window.choose(MENU, operator)


@pytest.mark.parametrize("operator", CLICKED)
def test_a_click_does_its_work(prepared, operator):
    options, before, after = CLICKED[operator]
    click(prepared, operator, options, before)
    if operator.endswith("preset_add"):  # its dialog
        prepared.redraw()
        prepared.key("Return")
    prepared.wait(after, limit=60.0)
    assert "Traceback" not in prepared.output()


@pytest.mark.parametrize("operator", IN_BROWSER)
def test_a_click_opens_a_file_browser_and_return_goes_on(prepared, operator, tmp_path):
    ending, before, after = IN_BROWSER[operator]
    path = tmp_path / f"window.{ending}"
    write_input(operator, path)
    click(prepared, operator, {}, before)
    prepared.wait("area.type == 'FILE_BROWSER' and area.spaces.active.params is not None")
    prepared.ask(
        f"params = area.spaces.active.params\nparams.directory = {str(tmp_path).encode()!r}\n"
        + (f"params.filename = {path.name!r}" if ending else "")
    )
    prepared.redraw()
    prepared.move(800, 500)
    prepared.key("Return")
    prepared.wait("area.type == 'VIEW_3D'", limit=60.0)
    prepared.wait(after.format(path=f"__import__('pathlib').Path({str(path)!r})"), limit=120.0)
    assert "Traceback" not in prepared.output()


def write_input(operator, path: Path) -> None:
    if operator.endswith("import_scan"):
        np.save(path, np.ones((4, 4, 4), np.float32))
    elif operator.endswith("import_surfaces"):
        corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n"
        surface = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\nend\n"
        path.write_text(corners + surface, "utf-8")
    elif operator.endswith("audit"):
        inertial = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        path.write_text(f'<robot name="r"><link name="l">{inertial}</link></robot>', "utf-8")
    elif operator.endswith("measure_library"):
        corners, faces = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"], ["1 3 2", "1 2 4", "1 4 3", "2 3 4"]
        lines = [*("v " + corner for corner in corners), *("f " + face for face in faces)]
        path.with_name("corner.obj").write_text("\n".join(lines), "utf-8")
    elif operator.endswith("find_in_library"):
        path.write_text("", "utf-8")


def test_every_operator_has_been_pressed():
    """By the strings that the tests of the window press, choose and click."""
    made = set()
    for folder in ("operators", "panels"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if not isinstance(node, ast.Assign) or ast.unparse(node.targets[0]) != "bl_idname":
                    continue
                if isinstance(node.value, ast.Constant) and "." in node.value.value:
                    made.add(node.value.value)
    made |= {"export_scene.body_moments_" + name for name in FORMATS}
    pressed = {*PRESSED, *CLICKED, *IN_BROWSER}
    for path in Path(__file__).parent.glob("test_*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("window.press", "window.choose"):
                pressed |= {word.value for word in node.args if isinstance(word, ast.Constant)}
    pressed |= {one for one, other in BY_OTHERS.items() if other in {*pressed, "object.body_moments_set_material"}}
    assert made - pressed - {"object.body_moments_set_material"} == set()  # test_every_operator chooses it in its menu.
    assert pressed - made <= {"VIEW3D_MT_body_moments"}
