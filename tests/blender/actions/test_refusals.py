# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators refuse, reached as a user reaches it: what is reported, with its values, and what changes, which is
nothing but what is said. Kept as text."""

import re

import bpy
import pytest
from body_moments.core.verdict.finding import finding
from body_moments.operators.actions.assembly.assembly import target_of
from mathutils import Matrix, Quaternion

from tests.blender.actions.assembly.test_assembly import assembly_of_boxes
from tests.blender.actions.measure.test_section import I_BEAM, flat_mesh
from tests.blender.actions.rig.test_rig import character
from tests.blender.actions.scene_state import difference, panels, state
from tests.blender.actions.test_dialogs import DIGEST
from tests.blender.actions.test_stability import wedge
from tests.blender.actions.test_transcripts import edited, empty_tree, parts
from tests.blender.bodies.test_assembly import box_mesh, empty
from tests.blender.findings import refused
from tests.blender.objects import add, mesh_body, only, strip_mesh

pytestmark = pytest.mark.usefixtures("scene")


def body():
    add(mesh_body())


def no_faces():
    add(bpy.data.meshes.new("No"), "No")


def strip():
    add(strip_mesh(), "Strip")


def open_member():
    root = assembly_of_boxes()
    strip = add(strip_mesh(), "Strip", select=False)
    bpy.context.scene.collection.objects.unlink(strip)
    root.objects.link(strip)


def empty_assembly():
    root = assembly_of_boxes()
    for obj in [*root.all_objects]:
        bpy.data.objects.remove(obj)


def damaged_member():
    assembly_of_boxes()
    obj = bpy.data.objects["b0"]
    obj.data.transform(Matrix.Translation((1, 2, 3)))
    only(obj)
    bpy.ops.object.body_moments_measure_assembly()
    obj["body_center_of_mass"] = "gone"


def held_root():
    empty_tree()
    bpy.data.objects["Root"].constraints.new("LIMIT_LOCATION").use_max_y = True


def held_child():
    empty_tree()
    mirror = bpy.data.objects["Child"].constraints.new("COPY_LOCATION")
    mirror.target, mirror.use_y, mirror.use_z, mirror.invert_x = bpy.data.objects["Root"], False, False, True


def linked(name):
    """An object of a library, and nothing else of the file that it comes from."""
    path = bpy.app.tempdir + "library.blend"
    bpy.data.libraries.write(path, {add(mesh_body(), name, select=False)})
    bpy.data.batch_remove([*bpy.data.objects, *bpy.data.meshes])
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.objects = [name]
    return names.objects[0]


def overridden():
    made = linked("Override").override_create()
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.update()
    only(made)


def linked_armature():
    """Of a character that was measured before its file was saved."""
    armature, skin = character()
    bpy.ops.object.body_moments_measure_bones()
    path = bpy.app.tempdir + "armature.blend"
    bpy.data.libraries.write(path, {armature, skin})
    bpy.data.batch_remove([*bpy.data.objects, *bpy.data.meshes, *bpy.data.armatures])
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.objects = ["Rig", "Skin"]
    for obj in names.objects:
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    only(bpy.data.objects["Rig"])


def linked_assembly():
    """A collection of a library in the scene, the active one."""
    root = assembly_of_boxes()
    path = bpy.app.tempdir + "assembly.blend"
    name = root.name
    bpy.data.libraries.write(path, {root})
    bpy.data.batch_remove([*bpy.data.objects, *bpy.data.meshes, *bpy.data.collections])
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.collections = [name]
    bpy.context.scene.collection.children.link(names.collections[0])
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children[name]


def refused_ones_are_gone():
    body()
    bpy.context.object.modifiers.new("Cast", "CAST")
    bpy.ops.object.body_moments_origin_to_center()
    bpy.data.objects.remove(bpy.context.object)


def linked_member():
    obj = linked("Linked")
    assembly_of_boxes().objects.link(obj)


def light_bones():
    character(density=1e-9)


def light_body():
    add(mesh_body(), "Light", scale=(0.01, 0.01, 0.01)).body_moments.density = 1.0


def no_bones():
    """A character none of whose bones deforms it."""
    armature, _ = character()
    for bone in armature.data.bones:
        bone.use_deform = False


def edited_bones():
    character()
    bpy.ops.object.mode_set(mode="EDIT")


def joint_of_own_density():
    """A joint whose density varies in its own coordinates."""
    obj = add(mesh_body(), location=(1, 2, 3))
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "900 + x"
    bpy.ops.rigidbody.world_add()
    bpy.ops.rigidbody.constraint_add(type="HINGE")


def curve():
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.data.bevel_depth = 0.1


def damaged():
    body()
    bpy.ops.object.body_moments_measure()
    bpy.context.object["body_center_of_mass"] = "gone"


def damaged_section():
    add(flat_mesh(I_BEAM), "Beam")
    bpy.ops.object.body_moments_measure_section()


def computed_about_nothing():
    body()
    bpy.ops.object.body_moments_compute_moments()
    bpy.context.scene.body_moments.moments_about = "REFERENCE"
    bpy.context.scene.body_moments_reference.about = "OBJECT"


def stored_about_nothing():
    body()
    bpy.ops.object.body_moments_measure()
    bpy.context.scene.body_moments_reference.about = "OBJECT"


def inversion():
    """A prism whose only symmetry is its center."""
    add(box_mesh(1, 2, 4), "Parallelepiped")
    for vertex in bpy.context.object.data.vertices:
        x, y, z = vertex.co
        vertex.co = (x + 0.3 * y, y + 0.2 * z, z + 0.1 * x)


def grouped(change):
    def build():
        parts()
        obj = bpy.data.objects["Body"]
        only(obj)
        bpy.context.scene.cursor.location = (1.5, 2.5, 3.5)
        change(obj)

    return build


def linked_mesh(obj):
    path = bpy.app.tempdir + "mesh.blend"
    bpy.data.libraries.write(path, {obj.data})
    with bpy.data.libraries.load(path, link=True) as (_, names):
        names.meshes = [obj.data.name]
    obj.data = names.meshes[0]


def varying(obj):
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "900 + x"


def instances(obj):
    add(box_mesh(9, 9, 9), "Instancer", select=False).instance_type = "VERTS"
    obj.parent = bpy.data.objects["Instancer"]


def no_gravity(_obj):
    bpy.context.scene.use_gravity = False


def out_of_reach(obj):
    bpy.context.scene.cursor.location = (100, 0, 0)


def massless_group():
    only(*(add(box_mesh(1, 2, 4), name) for name in "ab"))
    for obj in bpy.context.selected_objects:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 0.0


def posed():
    character()
    bpy.ops.object.mode_set(mode="POSE")


def upside_down():
    obj = add(wedge(), "Wedge")
    bpy.ops.object.body_moments_rest_on_ground()
    obj.rotation_mode = "QUATERNION"
    obj.rotation_quaternion = Quaternion((0.0, 1.0, 0.0, 0.0)) @ obj.matrix_world.to_quaternion()


def sheared():
    parent = empty(bpy.context.scene.collection, "Parent")
    parent.scale, child = (1, 2, 1), add(mesh_body(), "Sheared", rotation=(0.5, 0.4, 0.3))
    child.parent = parent
    bpy.context.view_layer.update()


def mirrored():
    add(mesh_body(), "Mirrored", scale=(-1, 1, 1))


def alike():
    only(add(mesh_body(), "a b"), add(mesh_body(), "a.b", (9, 0, 0)))


def collections():
    root = assembly_of_boxes()
    empty_one = bpy.data.collections.new("Nothing")
    bpy.context.scene.collection.children.link(empty_one)
    assert root


def no_collections():
    empty_assembly()


NOWHERE = "/no such folder/file"
CASES = {
    "cursor to open": (open_member, "view3d.cursor_to_assembly", {}),
    "assembly of nothing": (empty_assembly, "object.measure_assembly", {}),
    "assembly of a body": (body, "object.measure_assembly", {"target": "OBJECT"}),
    "clear no assembly": (body, "object.clear_assembly", {"target": "OBJECT"}),
    "assembly with a linked member": (linked_member, "object.measure_assembly", {}),
    "origin of a damaged member": (damaged_member, "object.origin_to_center", {}),
    "origin that is held": (held_root, "object.assembly_origin", {"target": "OBJECT"}),
    "origin of a linked collection": (linked_assembly, "object.assembly_origin", {}),
    "child that is held": (held_child, "object.assembly_origin", {"target": "OBJECT"}),
    "bill nowhere": (assembly_of_boxes, "object.export_bill", {"filepath": NOWHERE}),
    "bill without a file": (assembly_of_boxes, "object.export_bill", {}),
    "numbers nowhere": (damaged, "object.save_numbers", {"filepath": NOWHERE + ".csv"}),
    "numbers without a file": (damaged, "object.save_numbers", {}),
    "numbers as text": (damaged, "object.save_numbers", {"filepath": NOWHERE + ".txt"}),
    "inertial of an empty mesh": (no_faces, "object.copy_inertial", {}),
    "urdf nowhere": (body, "export_scene.urdf", {"filepath": NOWHERE}),
    "urdf of no collections": (no_collections, "export_scene.urdf", {"filepath": NOWHERE, "links": "COLLECTION"}),
    "usd of names alike": (alike, "export_scene.usd", {"filepath": NOWHERE}),
    "fourier without a file": (body, "object.fourier", {}),
    "fourier nowhere": (body, "object.fourier", {"filepath": NOWHERE}),
    "fourier of nothing": (no_faces, "object.fourier", {"filepath": "a.npz"}),
    "library nowhere": (body, "object.measure_library", {"directory": NOWHERE}),
    "moments about nothing": (computed_about_nothing, "object.copy_moments", {}),
    "reference to nothing": (stored_about_nothing, "object.copy_reference", {}),
    "section of a body": (body, "object.measure_section", {}),
    "bones that deform nothing": (no_bones, "object.measure_bones", {}),
    "bones of a linked armature": (linked_armature, "object.measure_bones", {}),
    "clear bones of a linked armature": (linked_armature, "object.clear_bones", {}),
    "bones being edited": (edited_bones, "object.measure_bones", {}),
    "center of bones that deform nothing": (no_bones, "object.rig_center", {}),
    "physics rig that deform nothing": (no_bones, "object.physics_rig", {}),
    "physics rig too light": (light_bones, "object.physics_rig", {}),
    "rigid body too light": (light_body, "object.set_rigid_body_mass", {"add": True}),
    "rigid bodies too light": (light_body, "object.rigid_bodies", {}),
    "rigid body of a curve": (curve, "object.set_rigid_body_mass", {"add": True}),
    "rigid bodies of a curve": (curve, "object.rigid_bodies", {}),
    "joint of its own density": (joint_of_own_density, "object.rigid_bodies", {}),
    "union of an override": (overridden, "object.count_as_union", {}),
    "shell of an override": (overridden, "object.measure_as_shell", {}),
    "accept of an override": (overridden, "object.accept", {"code": "flipped_faces"}),
    "defects of an override": (overridden, "object.select_faults", {}),
    "outside of an override": (overridden, "object.recalculate_outside", {}),
    "library of shapes nowhere": (body, "object.find_in_library", {"filepath": NOWHERE}),
    "symmetry of a parallelepiped": (inversion, "object.find_symmetry", {}),
    "orientation of a strip": (strip, "object.create_orientation", {}),
    "balance of a linked mesh": (grouped(linked_mesh), "object.sculpt_balance", {}),
    "balance of a varying density": (grouped(varying), "object.sculpt_balance", {}),
    "balance of instances": (grouped(instances), "object.sculpt_balance", {}),
    "balance without gravity": (grouped(no_gravity), "object.sculpt_balance", {}),
    "balance out of reach": (grouped(out_of_reach), "object.sculpt_balance", {"limit": 0.01}),
    "balance of what is edited": (
        lambda: (edited(), out_of_reach(None)),
        "object.sculpt_balance",
        {"limit": 0.01},
    ),
    "group without mass": (massless_group, "object.balance_group", {}),
    "group of a posed character": (posed, "object.balance_group", {"use_scene_range": False, "frame_end": 2}),
    "rest upside down": (upside_down, "object.rest_on_ground", {}),
    "rest of damaged numbers": (damaged, "object.rest_on_ground", {}),
    "select refused ones that are gone": (refused_ones_are_gone, "object.select_refused", {}),
    "stability of a strip": (strip, "object.stability", {}),
}
WITH_FILES = {
    "urdf of collections": (collections, "export_scene.urdf", {"links": "COLLECTION"}),
    "usd of a sheared object": (sheared, "export_scene.usd", {}),
    "usd of a mirrored object": (mirrored, "export_scene.usd", {}),
    "gltf by another name": (body, "export_scene.gltf", {}),
}


def report(build, operator, options, reported):
    category, _, name = operator.partition(".")
    build()
    bpy.context.view_layer.update()
    reported.clear()
    before = state()
    try:
        answer = ", ".join(getattr(getattr(bpy.ops, category), "body_moments_" + name)(**options))
    except RuntimeError as error:
        answer = "error: {!s}".format(error).strip()
        assert "Traceback" not in answer, answer
    codes = ["{:s} {}".format(found.code, found.values) for found in reported]
    lines = [answer, *map(str, reported[:1]), *codes, *difference(before, state()), *panels()]
    return [re.sub(DIGEST, "digest", line) for line in lines]


@pytest.mark.parametrize("case", CASES)
def test_what_is_refused(case, kept, reported):
    kept("refused/{:s}.txt".format(case.replace(" ", "_")), "\n".join(report(*CASES[case], reported)))


@pytest.mark.parametrize("case", WITH_FILES)
def test_what_is_said_of_a_file(case, kept, reported, tmp_path):
    build, operator, options = WITH_FILES[case]
    lines = report(build, operator, {"filepath": str(tmp_path / "robot.usda"), **options}, reported)
    kept("refused/{:s}.txt".format(case.replace(" ", "_")), "\n".join(lines).replace(str(tmp_path), "FOLDER"))


def test_an_assembly_needs_an_active_collection():
    from types import SimpleNamespace

    with refused("no_active_collection"):
        target_of(SimpleNamespace(collection=None), "COLLECTION")
    assert str(finding("no_active_collection"))
