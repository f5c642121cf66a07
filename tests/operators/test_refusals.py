# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Refusals of operators, reached through the scene and checked by their codes."""

from contextlib import suppress

import bpy
import pytest

from tests.blender.boxes import box_mesh
from tests.blender.objects import add, measure, mesh_body, only, strip_mesh
from tests.operators.assemblies import assembly_of_boxes, linked_assembly
from tests.operators.characters import character
from tests.operators.overlapping_boxes import boxes
from tests.operators.standing import wedge

pytestmark = pytest.mark.usefixtures("scene")


def parts():
    """Add measured bodies, one with faults and a material; two of them are selected."""
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
    measure(body, other, nested)
    only(body, other)


def empty_tree():
    root = add(None, "Root", (1, 0, 0))
    add(box_mesh(1, 2, 4), "Child", (0, 3, 0)).parent = root
    only(root)
    bpy.context.view_layer.update()
    bpy.ops.object.body_moments_measure_assembly(target="OBJECT")


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


def held_root():
    empty_tree()
    bpy.data.objects["Root"].constraints.new("LIMIT_LOCATION").use_max_y = True


def held_child():
    empty_tree()
    mirror = bpy.data.objects["Child"].constraints.new("COPY_LOCATION")
    mirror.target, mirror.use_y, mirror.use_z, mirror.invert_x = (
        bpy.data.objects["Root"],
        False,
        False,
        True,
    )


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


def computed_about_nothing():
    body()
    bpy.ops.object.body_moments_compute_moments()
    bpy.context.scene.body_moments.moments_about = "REFERENCE"
    bpy.context.scene.body_moments_reference.about = "OBJECT"


def stored_about_nothing():
    body()
    bpy.ops.object.body_moments_measure()
    bpy.context.scene.body_moments_reference.about = "OBJECT"


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


def no_gravity(_obj):
    bpy.context.scene.use_gravity = False


def massless_group():
    only(*(add(box_mesh(1, 2, 4), name) for name in "ab"))
    for obj in bpy.context.selected_objects:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 0.0


def alike():
    only(add(mesh_body(), "a b"), add(mesh_body(), "a.b", (9, 0, 0)))


NOWHERE = "/no such folder/file"
CASES = {  # scene, operator, options, code of the refusal (None: a text)
    "cursor to open": (open_member, "view3d.cursor_to_assembly", {}, "open_object"),
    "assembly of nothing": (
        empty_assembly,
        "object.measure_assembly",
        {},
        "assembly_without_members",
    ),
    "assembly of a body": (
        body,
        "object.measure_assembly",
        {"target": "OBJECT"},
        "no_active_assembly",
    ),
    "origin that is held": (
        held_root,
        "object.assembly_origin",
        {"target": "OBJECT"},
        "transform_constrained",
    ),
    "origin of a linked collection": (
        linked_assembly,
        "object.assembly_origin",
        {},
        "linked_object",
    ),
    "child that is held": (
        held_child,
        "object.assembly_origin",
        {"target": "OBJECT"},
        "child_not_held",
    ),
    "inertial of an empty mesh": (no_faces, "object.copy", {"what": "urdf"}, "no_faces"),
    "urdf of no collections": (
        empty_assembly,
        "export_scene.urdf",
        {"filepath": NOWHERE, "links": "COLLECTION"},
        "assembly_without_members",
    ),
    "usd of names alike": (alike, "export_scene.usd", {"filepath": NOWHERE}, "robot_names_alike"),
    "fourier without a file": (body, "object.fourier", {}, None),
    "fourier nowhere": (body, "object.fourier", {"filepath": NOWHERE}, "file_not_written"),
    "fourier of nothing": (no_faces, "object.fourier", {"filepath": "a.npz"}, "no_faces"),
    "moments about nothing": (
        computed_about_nothing,
        "object.copy",
        {"what": "MOMENTS"},
        "reference_object_missing",
    ),
    "reference to nothing": (
        stored_about_nothing,
        "object.copy",
        {"what": "REFERENCE"},
        "reference_object_missing",
    ),
    "bones that deform nothing": (no_bones, "object.measure_bones", {}, "rig_without_parts"),
    "bones of a linked armature": (linked_armature, "object.measure_bones", {}, "linked_object"),
    "clear bones of a linked armature": (
        linked_armature,
        "object.clear_bones",
        {},
        "linked_object",
    ),
    "bones being edited": (edited_bones, "object.measure_bones", {}, "armature_unavailable"),
    "physics rig that deform nothing": (no_bones, "object.physics_rig", {}, "rig_without_parts"),
    "physics rig too light": (light_bones, "object.physics_rig", {}, "rigid_body_mass_too_small"),
    "rigid bodies too light": (light_body, "object.rigid_bodies", {}, "rigid_body_mass_too_small"),
    "rigid body of a curve": (
        curve,
        "object.set_rigid_body_mass",
        {"add": True},
        "rigid_body_unfit",
    ),
    "joint of its own density": (
        joint_of_own_density,
        "object.rigid_bodies",
        {},
        "density_coordinates",
    ),
    "union of an override": (overridden, "object.remedy", {"remedy": "UNION"}, "linked_object"),
    "shell of an override": (overridden, "object.remedy", {"remedy": "SHELL"}, "linked_object"),
    "accept of an override": (
        overridden,
        "object.accept",
        {"code": "flipped_faces"},
        "linked_object",
    ),
    "defects of an override": (overridden, "object.select_faults", {}, "linked_object"),
    "outside of an override": (overridden, "object.remedy", {"remedy": "OUTSIDE"}, "linked_object"),
    "library of shapes nowhere": (body, "object.find_in_library", {"filepath": NOWHERE}, None),
    "orientation of a strip": (strip, "object.create_orientation", {}, "open_object"),
    "balance of a linked mesh": (
        grouped(linked_mesh),
        "object.sculpt_balance",
        {},
        "linked_object",
    ),
    "balance without gravity": (
        grouped(no_gravity),
        "object.sculpt_balance",
        {},
        "balance_folds_faces",
    ),
    "group without mass": (massless_group, "object.balance_group", {}, "zero_quantity"),
    "rest of damaged numbers": (damaged, "object.rest_on_ground", {}, None),
    "stability of a strip": (strip, "object.stability", {}, "open_object"),
}


@pytest.mark.parametrize("case", CASES)
def test_operators_refuse_with_the_code_of_the_reason(case, reported):
    build, operator, options, code = CASES[case]
    category, _, name = operator.partition(".")
    build()
    bpy.context.view_layer.update()
    reported.clear()
    with suppress(RuntimeError):  # an error report
        assert getattr(getattr(bpy.ops, category), "body_moments_" + name)(**options) == {
            "CANCELLED"
        }
    assert reported.codes[-1] == code if code else reported.texts and not reported.codes
