# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorials' steps in the real window, with the picture of each step (see test_pictures.py)."""

import pytest
from body_moments.core.robots.formats import FORMATS

from tests.window.conftest import FIGURE, ROOT, open_window

# Show one sub-panel open and the others closed: Blender keeps that by name, so they get new names.
ONLY = """
import bpy
panels = bpy.types.Panel.__subclasses__()
classes = [cls for cls in panels if cls.__name__.startswith("VIEW3D_PT_body_moments_")]
names = {{}}
for cls in reversed(classes):
    bpy.utils.unregister_class(cls)
for cls in classes:
    old = getattr(cls, "bl_idname", cls.__name__)
    names[old] = cls.bl_idname = old + "_"
    cls.bl_parent_id = names.get(cls.bl_parent_id, cls.bl_parent_id)
    closed = set() if cls.bl_label in {!r} else {{"DEFAULT_CLOSED"}}
    cls.bl_options = cls.bl_options - {{"DEFAULT_CLOSED"}} | closed
    bpy.utils.register_class(cls)
"""
EMPTY = """
from mathutils import Euler
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
view = area.spaces.active.region_3d
view.view_rotation = Euler((1.1, 0.0, 0.7)).to_quaternion()
scene = bpy.context.scene
scene.cursor.location = (0, 0, 0)
scene.unit_settings.scale_length, scene.unit_settings.length_unit = 1.0, "METERS"
"""
# In the middle of what the sidebar leaves free.
FRAME = """
bpy.ops.view3d.view_selected()
view = area.spaces.active.region_3d
view.view_distance *= {}
from mathutils import Vector
view.view_location += view.view_rotation @ Vector((0.2 * view.view_distance, 0, 0))
"""
EXPORT_BRACKET = """
import bpy
bpy.data.objects["Bracket"].select_set(True)
bpy.ops.wm.stl_export(filepath={!r}, export_selected_objects=True, ascii_format=False)
"""
PRINTED_PART = """
scene.unit_settings.scale_length, scene.unit_settings.length_unit = 0.001, "MILLIMETERS"
area.spaces.active.clip_end = 10000
bpy.ops.wm.stl_import(filepath={!r})
"""
SHARDS = """
import bmesh, random
from mathutils import Vector
chance = random.Random(4)
made = bmesh.new()
bmesh.ops.create_cube(made, size=1.0)
bmesh.ops.scale(made, vec=(2.0, 0.2, 1.2), verts=made.verts)
bmesh.ops.translate(made, vec=(0, 0, 0.6), verts=made.verts)
pieces = [made]
for _ in range(5):
    halves = []
    for piece in pieces:
        corners = [vertex.co for vertex in piece.verts]
        middle = sum(corners, Vector()) / len(corners)
        normal = Vector((chance.uniform(-1, 1), chance.uniform(-0.2, 0.2), chance.uniform(-1, 1)))
        for side in (normal, -normal):
            half = piece.copy()
            everything = [*half.verts, *half.edges, *half.faces]
            cut = bmesh.ops.bisect_plane(
                half, geom=everything, plane_co=middle, plane_no=side, clear_outer=True
            )
            edges = [e for e in cut["geom_cut"] if isinstance(e, bmesh.types.BMEdge)]
            bmesh.ops.contextual_create(half, geom=edges)
            halves.append(half)
    pieces = halves
for number, piece in enumerate(pieces):
    bmesh.ops.recalc_face_normals(piece, faces=piece.faces)
    mesh = bpy.data.meshes.new("Shard")
    piece.to_mesh(mesh)
    shard = bpy.data.objects.new("Shard", mesh)
    bpy.context.collection.objects.link(shard)
    shard.select_set(True)
bpy.context.view_layer.objects.active = shard
"""
FALL = """
bpy.ops.mesh.primitive_plane_add(size=8)
bpy.ops.rigidbody.object_add(type="PASSIVE")
for shard in [obj for obj in bpy.data.objects if obj.name.startswith("Shard")]:
    shard.location.z += 0.4
for frame in range(1, 32):
    bpy.context.scene.frame_set(frame)
"""
PARTS = """
from mathutils import Euler
def add(kind, location, turn=(0, 0, 0), scale=1.0, **options):
    getattr(bpy.ops.mesh, "primitive_" + kind + "_add")(location=location, rotation=turn, **options)
    bpy.context.object.scale *= scale
    return bpy.context.object
add("torus", (2.5, 0, 0.4), (0.5, 0.3, 0), 0.7)
add("cone", (-2.5, 1.5, 1), vertices=32)
add("monkey", (0, 2.5, 0.8), (0.3, 0, 1.2))
add("cube", (-2.5, -1, 0.5), size=1)
active = add("monkey", (0, 0, 0.8))
"""
SCAN = """
import numpy as np
x, y, z = np.meshgrid(*(np.linspace(-1, 1, 32),) * 3, indexing="ij")
hollow = (x**2 + y**2 + z**2 < 0.8) & ((x - 0.3)**2 + y**2 + z**2 > 0.1)
np.save({file!r}, np.where(hollow, 0.9, 0.0).astype(np.float32))
spacing = {{"use_spacing": True, "spacing": (0.004, 0.004, 0.004)}}
bpy.ops.object.body_moments_import_scan("EXEC_DEFAULT", True, filepath={file!r}, **spacing)
"""
# The tutorial's own script, without its file.
SCRIPT = (
    (ROOT / "docs" / "tutorial-arm.md")
    .read_text(encoding="utf-8")
    .split("```python")[1]
    .partition("```")[0]
)
KEPT = [line for line in SCRIPT.splitlines() if "bpy.ops.wm" not in line]
SELECT_ARM = """
bpy.ops.object.select_all(action="DESELECT")
for part in (fore, upper, base):
    part.select_set(True)
bpy.context.view_layer.objects.active = base
"""
LETTER = """
bpy.ops.object.text_add()
bpy.context.object.data.body = "E"
"""
WHEEL = """
bpy.ops.mesh.primitive_torus_add()
bpy.context.object.name = "Wheel"
next(area for area in window.screen.areas if area.type == "PROPERTIES").type = "IMAGE_EDITOR"
path = __import__("tempfile").mkdtemp() + "/wheel.npz"
bpy.ops.object.body_moments_fourier("EXEC_DEFAULT", filepath=path, count=64)
"""
# A block with a plate that hangs far over, in millimeters.
HOOK = """
scene.unit_settings.scale_length, scene.unit_settings.length_unit = 0.001, "MILLIMETERS"
area.spaces.active.clip_end = 10000
outline = [(0, 0), (10, 0), (10, 26), (34, 26), (34, 28), (0, 28)]
points = [(x, y, z) for y in (0, 20) for x, z in outline]
sides = [(6 + i, 6 + (i + 1) % 6, (i + 1) % 6, i) for i in range(6)]
mesh = bpy.data.meshes.new("Hook")
mesh.from_pydata(points, [], [(0, 1, 2, 3, 4, 5), (11, 10, 9, 8, 7, 6), *sides])
obj = bpy.data.objects.new("Hook", mesh)
scene.collection.objects.link(obj)
bpy.context.view_layer.objects.active = obj
obj.select_set(True)
settings = obj.body_moments
settings.kind, settings.density, settings.print_infill = "PRINTED", 1240.0, 5.0
"""
# picture: the scene, the panels that are open, and the operator of the button that is pressed
PAGES = {
    "assembly": (PARTS, ("Assembly",), "object.body_moments_measure_assembly"),
    "walls": (
        "bpy.ops.mesh.primitive_cube_add(size=1)\nsettings = bpy.context.object.body_moments\n"
        "settings.kind, settings.wall, settings.thickness = 'SHELL', 'INWARD', 0.05\n",
        ("Density",),
        "object.body_moments_measure",
    ),
    "prints": (
        "scene.unit_settings.scale_length = 0.001\narea.spaces.active.clip_end = 10000\n"
        "bpy.ops.mesh.primitive_cube_add(size=20)\nsettings = bpy.context.object.body_moments\n"
        "settings.kind, settings.density, settings.spool_price = 'PRINTED', 1240.0, 22.0\n",
        ("Density",),
        "object.body_moments_measure",
    ),
    "densities": (
        "bpy.ops.mesh.primitive_cone_add()\nsettings = bpy.context.object.body_moments\n"
        "settings.density_from, settings.density_polynomial = 'POLYNOMIAL', '1000 + 300*z'\n",
        ("Density",),
        "object.body_moments_measure",
    ),
    "arm": ("\n".join(KEPT) + SELECT_ARM, (), "object.body_moments_measure"),
    "section": (LETTER, ("Section",), "object.body_moments_measure_section"),
    "moments": (
        "bpy.ops.mesh.primitive_cone_add()\n",
        ("Advanced", "Moments"),
        "object.body_moments_compute_moments",
    ),
    "fourier": (WHEEL, ("Advanced",), "object.body_moments_measure"),
}


@pytest.fixture(scope="module")
def window(run_blender, cube_file, tmp_path_factory):
    with open_window(
        run_blender, cube_file, tmp_path_factory.mktemp("log"), size=(1280, 800)
    ) as opened:
        opened.ask(
            "bpy.context.preferences.system.viewport_aa = '8'\nbpy.context.scene.use_gravity = True"
        )
        yield opened


def begin(window, source: str, *panels: str, closer: float = 1.3) -> None:
    """Build a scene, show it with the tab Moments beside it, with these sub-panels open."""
    window.ask(EMPTY + source + FRAME.format(closer) + "bpy.ops.ed.undo_push(message='Build')")
    window.open_tab("Moments")
    window.ask(ONLY.format(panels))
    window.buttons.clear()


def take_picture(window, name: str) -> None:
    window.point_at_view()
    window.redraw()
    window.picture(name)


def test_printed_part_is_weighed_and_stands(window, run_blender, tmp_path):
    part, file = str(tmp_path / "part.stl"), tmp_path / "bracket.blend"
    run_blender(
        "--background",
        "--python-exit-code",
        "1",
        "--python",
        ROOT / "tools" / "demo.py",
        "--",
        "build",
        file,
    )
    run_blender(
        "--background",
        file,
        "--python-exit-code",
        "1",
        "--python-expr",
        EXPORT_BRACKET.format(part),
    )
    begin(window, PRINTED_PART.format(part), "Stability")
    take_picture(window, "printed-part")
    window.ask("bpy.ops.object.body_moments_set_material(material='PLA')")
    window.press("object.body_moments_measure")
    window.wait("'body_mass' in bpy.context.object")
    take_picture(window, "printed-measured")
    window.press("object.body_moments_stability")
    take_picture(window, "printed-stands")
    assert window.get("bpy.context.object['body_method']") == "exact"


def test_print_is_made_to_stand_by_its_infill(window):
    begin(window, HOOK, "Stability")
    window.press("object.body_moments_measure")
    window.wait("'body_mass' in bpy.context.object")
    window.press("object.body_moments_make_it_stand")
    window.wait("bpy.context.object.body_moments.print_infill > 5.0")
    take_picture(window, "print-stands")
    window.undo()
    window.wait("bpy.context.object.body_moments.print_infill == 5.0")


def test_scan_is_weighed_from_its_voxels(window, tmp_path):
    begin(window, SCAN.format(file=str(tmp_path / "scan.npy")), "Density")
    take_picture(window, "scan-density")
    window.ask("bpy.context.object.body_moments.value_density = 1000.0")
    window.press("object.body_moments_measure")
    window.wait("'body_mass' in bpy.context.object")
    take_picture(window, "scan-measured")


def test_shards_of_a_wall_become_rigid_bodies_and_fall(window):
    begin(window, SHARDS, "Apply to Object")
    take_picture(window, "wall-shards")
    window.press("object.body_moments_rigid_bodies")
    window.wait("bpy.context.object.rigid_body is not None")
    take_picture(window, "wall-bodies")
    window.ask(FALL)
    take_picture(window, "wall-falls")


def test_bones_of_a_figure_are_weighed(window):
    begin(window, FIGURE, "Bones", closer=1.1)
    window.press("object.body_moments_measure_bones")
    window.wait("'body_mass' in bpy.context.object")
    x, y, width, height = window.region("UI")
    window.move(x + width / 2, y + height / 2, *["click", 5] * 8)  # to the list
    window.redraw()
    window.picture("rig-bones")
    window.press("object.body_moments_rig_center")
    window.ask(
        "rig = bpy.data.objects['Figure']\nrig.pose.bones['thigh.L'].rotation_euler.x = -0.8"
    )
    take_picture(window, "rig-center")


def test_copies_are_found_and_laid_onto_the_part(window):
    window.ask(
        "bpy.context.preferences.addons['bl_ext.user_default.body_moments']"
        ".preferences.show_advanced = True"
    )
    begin(window, PARTS, "Advanced", "Shape", closer=1.1)
    window.press("object.body_moments_find_similar")
    window.wait("len(bpy.context.selected_objects) == 2")
    take_picture(window, "library-found")
    window.press("object.body_moments_match_pose")
    take_picture(window, "library-matched")
    assert (
        window.get("(bpy.data.objects['Suzanne'].location - bpy.context.object.location).length")
        < 1e-5
    )


def test_menu_names_the_formats_of_robots(window):
    begin(window, PAGES["arm"][0])
    x, y, width, height = window.region("WINDOW")
    x, y = x + 0.1 * width, y + 0.8 * height
    window.move(x, y)
    window.ask("bpy.ops.wm.call_menu(name='TOPBAR_MT_body_moments_export')")
    window.picture("page-robots")
    entries = {window.button_at(x, y - down) for down in range(-60, 200, 9)}
    assert {"export_scene.body_moments_" + name for name in FORMATS} <= entries
    window.key("Escape")


@pytest.mark.parametrize("name", PAGES)
def test_page_shows_what_its_button_does(window, name):
    source, panels, operator = PAGES[name]
    begin(window, source, *panels)
    window.press(operator)
    take_picture(window, "page-" + name)
    last = window.get("bpy.context.window_manager.operators[-1].bl_idname")
    assert last.lower().replace("_ot_", ".") == operator
