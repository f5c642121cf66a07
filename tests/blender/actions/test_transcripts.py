# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator, run with each of its options changed alone: what it says and all that it changes, kept as text.

The numbers are tested where they are measured; here is that each option does what it should and nothing else.
"""

import re
import zlib
from importlib import import_module
from pathlib import Path

import bpy
import pytest
from body_moments.operators import PARTS

from tests.blender.actions.assembly.test_assembly import assembly_of_boxes
from tests.blender.actions.measure.test_section import I_BEAM, flat_mesh
from tests.blender.actions.rig.test_rig import character
from tests.blender.actions.scene_state import difference, panels, state
from tests.blender.actions.setup.test_remedy_buttons import boxes
from tests.blender.actions.test_stability import wedge
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.conftest import six_digits
from tests.blender.objects import add, measured, mesh_body, only, strip_mesh

pytestmark = pytest.mark.usefixtures("scene")
OF_BLENDER = re.compile(  # what its exporters and its dependency graph log, and what it weighs
    r"\d\d:\d\d|INFO |ERROR |WARN |.*would say|.* took |D.* cycle| *\|? *\w+/|[ |]*$"
)
MAX_LINES = 60  # of files that are kept; others by their length and checksum


def parts():
    """Measured bodies, one with faults and a material; two of them selected. Nothing of the scene is as it starts."""
    scene = bpy.context.scene
    scene.unit_settings.scale_length, scene.gravity = 0.5, (0.0, 3.0, -9.0)
    scene.cursor.location, scene.cursor.rotation_euler = (0.5, 0.25, -0.75), (0.1, 0.2, 0.3)
    nested = add(boxes(2.0, 1.0, reverse=[0]), "Nested", location=(-6, 0, 0))
    nested.data.materials.append(bpy.data.materials.new("Steel"))
    other = add(wedge(), "Wedge", location=(5, 0, 1))
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.2, 0.1), (1, 1, 2))
    body.body_moments.density = 500.0
    group = body.vertex_groups.new(name="Group")
    group.add([6, 7, 8], 0.5, "REPLACE")
    only(body, other, nested)
    bpy.ops.object.body_moments_measure()
    only(body, other)


def trouble():
    """Selected things of which each is refused by some operators, and one that is not."""
    parts()
    body = bpy.data.objects["Body"]
    locked = add(body.data, "Locked", (8, 0, 0))
    locked.lock_location, locked.lock_rotation, locked.lock_scale = ((True, True, True) for _ in range(3))
    cast = add(mesh_body(), "Cast", (0, 8, 0))
    cast.modifiers.new("Cast", "CAST").factor = 0.8
    child = add(wedge(), "Child", (0, 0, 4))
    child.parent = body
    keys = add(mesh_body(), "Keys", (0, 0, 9))
    keys.shape_key_add(name="Basis")
    strip, damaged = add(strip_mesh(), "Strip", (9, 9, 0)), add(mesh_body(), "Damaged", (-9, 0, 0))
    others = [add(None, "Empty"), add(bpy.data.cameras.new("Camera"), "Camera"), add(bpy.data.meshes.new("No"), "No")]
    only(damaged)
    bpy.ops.object.body_moments_measure()
    damaged["body_center_of_mass"] = "gone"
    only(body, locked, cast, child, keys, strip, damaged, *others)


def protected():
    """Selected things that are not the file's own, wholly or in part, and one that is. All but one are measured."""
    parts()
    made = [add(mesh_body(name), name, (0, 9 * place, 0)) for place, name in enumerate(("Linked", "Override", "Mesh"))]
    only(*made)
    bpy.ops.object.body_moments_measure()
    path = bpy.app.tempdir + "protected.blend"
    bpy.data.libraries.write(path, {*made})
    bpy.data.batch_remove([*(obj.data for obj in made), *made])
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.objects, names.meshes = ["Linked", "Override"], ["Mesh"]
    linked, source = names.objects
    objects = [linked, source.override_create()]
    for obj in objects:
        bpy.context.scene.collection.objects.link(obj)
    objects.append(add(names.meshes[0], "Of a linked mesh", (0, 18, 0)))
    only(*objects, bpy.data.objects["Wedge"])


def assembly():
    assembly_of_boxes()
    only(bpy.data.objects["b0"])
    bpy.ops.object.body_moments_measure_assembly()


def empty_tree():
    root = add(None, "Root", (1, 0, 0))
    add(box_mesh(1, 2, 4), "Child", (0, 3, 0)).parent = root
    only(root)
    bpy.context.view_layer.update()
    bpy.ops.object.body_moments_measure_assembly(target="OBJECT")


def bones():
    character()
    bpy.ops.object.body_moments_measure_bones()


def flat():
    add(flat_mesh(I_BEAM), "Beam", location=(1, 2, 3), rotation=(1.5, 0, 0))
    bpy.ops.object.body_moments_measure_section()


def edited(select=3):
    parts()
    only(bpy.data.objects["Body"])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for vertex in bpy.context.object.data.vertices[:select]:
        vertex.select = True
    bpy.ops.object.mode_set(mode="EDIT")


def near(build):
    """The cursor is near the center of mass of a body that is alone."""

    def near_it():
        build()
        obj = bpy.data.objects["Body"]
        if obj.mode == "OBJECT":
            only(obj)
        unit = bpy.context.scene.unit_settings.scale_length
        bpy.context.scene.cursor.location = measured(obj).mass_properties.center / unit + (0.01, 0.02, 0.0)

    near_it.__name__ = "near_" + build.__name__
    return near_it


def moving():
    obj = add(wedge(), "Wedge")
    for frame, at in ((1, 0.0), (4, 3.0)):
        obj.location = (at, at * at, 0.0)
        obj.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, 4


def nothing():
    add(bpy.data.cameras.new("Camera"), "Camera")


def faulty():
    parts()
    only(bpy.data.objects["Nested"])


def similar():
    parts()
    for name, scale in (("Copy", (1, 1, 2)), ("Twice", (2, 2, 4)), ("Mirror", (-1, 1, 2))):
        add(bpy.data.objects["Body"].data, name, (0, 9, 0), (0, 0, 1), scale)
    only(*(bpy.data.objects[name] for name in ("Body", "Copy", "Twice", "Mirror")))


def similar_ones_measured():
    similar()
    bpy.ops.object.body_moments_measure()


def symmetric():
    """Measured bodies whose symmetries were found."""
    parts()
    bpy.ops.object.body_moments_find_symmetry()


def all_results():
    """A flat mesh with each kind of results."""
    obj = add(flat_mesh(I_BEAM), "Beam", location=(1, 2, 3), rotation=(1.5, 0, 0))
    obj.body_moments.kind = "SHELL"
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_measure_section()
    bpy.ops.object.body_moments_find_symmetry()


def searched():
    similar()
    bpy.ops.object.body_moments_find_similar()


def computed():
    parts()
    bpy.context.scene.body_moments.moments_order = 2
    bpy.ops.object.body_moments_compute_moments()


def stable():
    parts()
    bpy.ops.object.body_moments_stability()


def refused():
    parts()
    bpy.data.objects["Body"].modifiers.new("Cast", "CAST")
    bpy.ops.object.body_moments_origin_to_center()


def large():
    add(box_mesh(10, 20, 40), "Print")
    bpy.ops.object.body_moments_measure()


SCENES = {
    "MATERIAL_OT_body_moments_set_density": (faulty,),
    "OBJECT_OT_body_moments_accept": (faulty,),
    "OBJECT_OT_body_moments_assembly_empty": (assembly, empty_tree),
    "OBJECT_OT_body_moments_assembly_origin": (assembly, empty_tree),
    "OBJECT_OT_body_moments_axis_from_selection": (edited, lambda: edited(2), parts),
    "OBJECT_OT_body_moments_balance_group": (moving,),
    "OBJECT_OT_body_moments_align_to_world": (symmetric,),
    "OBJECT_OT_body_moments_clear": (parts, flat, stable, all_results),
    "OBJECT_OT_body_moments_clear_assembly": (assembly, empty_tree),
    "OBJECT_OT_body_moments_clear_bones": (bones,),
    "OBJECT_OT_body_moments_copy_moments": (computed,),
    "OBJECT_OT_body_moments_copy_section": (flat,),
    "OBJECT_OT_body_moments_count_as_union": (faulty,),
    "OBJECT_OT_body_moments_export_bill": (assembly, empty_tree),
    "OBJECT_OT_body_moments_find_similar": (similar,),
    "OBJECT_OT_body_moments_match_pose": (similar, similar_ones_measured),
    "OBJECT_OT_body_moments_measure": (parts, protected),
    "OBJECT_OT_body_moments_measure_as_shell": (faulty,),
    "OBJECT_OT_body_moments_measure_assembly": (assembly, empty_tree),
    "OBJECT_OT_body_moments_measure_bones": (bones,),
    "OBJECT_OT_body_moments_measure_section": (flat, parts),
    "OBJECT_OT_body_moments_physics_rig": (bones,),
    "OBJECT_OT_body_moments_rig_center": (bones,),
    "OBJECT_OT_body_moments_rigid_bodies": (symmetric,),
    "OBJECT_OT_body_moments_recalculate_outside": (faulty,),
    "OBJECT_OT_body_moments_sculpt_balance": (edited, parts, near(edited), near(parts)),
    "OBJECT_OT_body_moments_select_faults": (faulty, parts),
    "OBJECT_OT_body_moments_select_found": (searched,),
    "OBJECT_OT_body_moments_select_refused": (refused,),
    "SCENE_OT_body_moments_keep_units": (large,),
    "SCENE_OT_body_moments_set_millimeters": (large,),
    "VIEW3D_OT_body_moments_cursor_to_assembly": (assembly, empty_tree),
    "WM_OT_body_moments_dismiss": (refused,),
}
GIVEN = {  # what an operator is told in each of its runs, and what else is tried of a text
    "MATERIAL_OT_body_moments_set_density": {"target": "Steel"},
    "OBJECT_OT_body_moments_accept": {"code": "flipped_faces"},
    "OBJECT_OT_body_moments_copy_value": {"value": "1.5", "unit": "kg"},
    "OBJECT_OT_body_moments_select_found": {"name": "Twice"},
    "OBJECT_OT_body_moments_fourier": {"count": 4},
}
TEXTS = {"name": "Other", "group": "Missing", "collection": "Missing", "contacts": "Missing", "value": "2", "unit": "m"}
ELSEWHERE = (  # what needs files or processes, and is tested with them
    *("fourier_run", "import_scan", "import_surfaces", "measure_library", "find_in_library", "audit", "preset_add"),
    "live",
)
MODULES = [import_module("body_moments.operators." + name) for name in PARTS if name.startswith("actions.")]
OPERATORS = {
    name: cls
    for module in MODULES
    for name, cls in vars(module).items()
    if isinstance(cls, type) and issubclass(cls, bpy.types.Operator) and "_OT_body_moments" in name
    if cls.__module__ == module.__name__
}


def operator_of(name):
    category, _, function = name.partition("_OT_")
    return getattr(getattr(bpy.ops, category.lower()), function)


def variants(name):
    """The options of each run."""
    given = GIVEN.get(name, {})
    yield given
    for prop in operator_of(name).get_rna_type().properties:
        if prop.is_hidden or prop.identifier in ("rna_type", "filepath", "check_existing", "code", "target_name"):
            continue
        if prop.type == "ENUM":
            items = [item.identifier for item in prop.enum_items]
            for item in items[:4] if len(items) > 12 else items:
                yield given | {prop.identifier: {item} if prop.is_enum_flag else item}
        elif prop.type == "BOOLEAN":
            yield given | {prop.identifier: not prop.default}
        elif prop.type in ("FLOAT", "INT"):
            value = type(prop.default)(min(max(prop.default + 1, prop.soft_min), prop.soft_max))
            yield given | {prop.identifier: [value] * prop.array_length if prop.is_array else value}
        elif prop.identifier in TEXTS:
            yield given | {prop.identifier: TEXTS[prop.identifier]}


def files(folder):
    """What stands in the files of a folder."""
    for path in sorted(Path(folder).rglob("*")):
        if path.is_file():
            name = path.relative_to(folder).as_posix()
            try:
                text = six_digits(path.read_text(encoding="utf-8"))
            except UnicodeDecodeError:
                yield "file {:s}".format(name)
                continue
            lines = text.split("\n")
            yield "file {:s}: {:d} lines, {:08x}".format(name, len(lines), zlib.crc32(text.encode()))
            if len(lines) <= MAX_LINES:
                yield from ("    " + line for line in lines)


@pytest.mark.parametrize("name", [name for name in sorted(OPERATORS) if not name.endswith(ELSEWHERE)])
def test_an_operator(name, kept, tmp_path, capfd):
    pages, operator = [], operator_of(name)
    properties = operator.get_rna_type().properties.keys()
    for number, options in enumerate(variants(name)):
        for build in dict.fromkeys((*SCENES.get(name, (parts,)), *(() if number else (trouble, protected)))):
            bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
            build()
            folder = tmp_path / "{:d}{:s}".format(number, build.__name__.strip("<>"))
            folder.mkdir()
            where = {"filepath": str(folder / "out")} if "filepath" in properties else {}
            before = state()
            capfd.readouterr()
            try:
                answer = ", ".join(operator(**where, **options)) if operator.poll() else "not available"
            except RuntimeError as error:
                answer = "error: {!s}".format(error).strip()
                assert "Traceback" not in answer
            said = [line for line in capfd.readouterr().out.splitlines() if line and not OF_BLENDER.match(line)]
            said = [re.sub(r"(at )\d\.\d+e-\d+", r"\1rounding", line) for line in said]
            written = " ".join("{:s}={!r}".format(*option) for option in options.items())
            pages.append("=== {:s}: {:s}".format(build.__name__, written))
            lines = [answer, *said, *difference(before, state()), *panels(), *files(folder)]
            pages += [line.replace(str(folder), "FOLDER") for line in lines]
    kept("transcripts/{:s}.txt".format(name.replace("_body_moments", "")), "\n".join(pages))


AVAILABLE = {
    "parts": parts,
    "edited": edited,
    "assembly": assembly,
    "bones": bones,
    "flat": flat,
    "a camera": nothing,
    "posed": lambda: (bones(), bpy.ops.object.mode_set(mode="POSE")),
    "a point": lambda: add(None, "Empty"),
    "nothing selected": lambda: (parts(), bpy.ops.object.select_all(action="DESELECT")),
    "not measured": lambda: add(box_mesh(1, 2, 4)),
    "a curve": lambda: bpy.ops.curve.primitive_nurbs_circle_add(),
    "a volume": lambda: add(bpy.data.volumes.new("Cloud")),
    "no object": lambda: None,
}


@pytest.mark.parametrize("where", AVAILABLE)
def test_which_operators_are_available(where, kept, monkeypatch):
    from body_moments.operators.write import reports

    reasons = []
    monkeypatch.setattr(reports, "unavailable", lambda _, reason: reasons.append((reason.code, reason.values)) or False)
    AVAILABLE[where]()
    lines = []
    for name in sorted(OPERATORS):
        reasons.clear()
        available = operator_of(name).poll()
        lines.append("{:s}: {}".format(name, "available" if available else reasons or "not available"))
    kept("available/{:s}.txt".format(where.replace(" ", "_")), "\n".join(lines))


def test_a_window_has_a_clipboard(monkeypatch, capfd):
    from types import SimpleNamespace

    from body_moments.core.verdict.finding import finding
    from body_moments.operators.actions.measure import copy
    from body_moments.operators.write import reports

    said = []
    monkeypatch.setattr(copy, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    monkeypatch.setattr(reports, "report", lambda *reported: said.append(reported))
    context, done = SimpleNamespace(window_manager=SimpleNamespace(clipboard="")), finding("no_faces")
    copy.copy_text("operator", context, "text\n", done)
    assert context.window_manager.clipboard == "text\n" and said == [("operator", done)]
    assert capfd.readouterr().out == ""
