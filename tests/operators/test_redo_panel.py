# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the redo panel does, for every operator that has one: undo, then the same action with other
values.

The result is that of these values alone, and one undo brings everything back.
"""

import json

import bpy
import numpy as np
import pytest

from tests.blender.objects import add, editing, measured, mesh_body, only
from tests.core.exact_splines import sphere
from tests.core.iges_files import IgesFile, unrolled
from tests.operators.balancing import edit, figure

pytestmark = pytest.mark.usefixtures("scene")


def plain(value):
    """As json can write it."""
    if isinstance(value, bpy.types.ID):
        return value.name_full
    if isinstance(value, bpy.types.bpy_prop_collection):
        return [settings_of(item) for item in value]
    if isinstance(value, bpy.types.PropertyGroup):
        return settings_of(value)
    if hasattr(value, "to_list"):
        return value.to_list()
    if hasattr(value, "to_dict"):
        return str(value.to_dict())
    return (
        sorted(value)
        if isinstance(value, set)
        else list(value)
        if hasattr(value, "__len__")
        else value
    )


def settings_of(group):
    names = [prop.identifier for prop in group.bl_rna.properties if prop.identifier != "rna_type"]
    return {name: plain(getattr(group, name)) for name in names if group.is_property_set(name)}


def of_data(obj):
    if obj.type == "MESH":
        points = np.empty(3 * len(obj.data.vertices), np.float32)
        obj.data.vertices.foreach_get("co", points)
        elements = (*obj.data.edges, *obj.data.polygons)  # bmesh gives them in any order
        faces = sorted([sorted(element.vertices), element.select] for element in elements)
        return points.tolist(), faces, [vertex.select for vertex in obj.data.vertices]
    if obj.type == "SURFACE":
        return [list(point.co) for spline in obj.data.splines for point in spline.points]
    if obj.type == "VOLUME":
        return measured(obj).volume
    return None


def of_object(obj):
    body = obj.rigid_body
    action = obj.animation_data and obj.animation_data.action
    keys = [] if not action else action.layers[0].strips[0].channelbags[0].fcurves
    return {
        "type": obj.type,
        "parent": obj.parent and obj.parent.name,
        "matrix": [list(row) for row in obj.matrix_world],
        "size": list(obj.dimensions),
        "data": of_data(obj),
        "numbers": {key: str(plain(value)) for key, value in obj.items()},
        "settings": settings_of(obj.body_moments),
        "symmetry": settings_of(obj.body_moments_symmetry),
        "empty": [obj.empty_display_type, obj.empty_display_size],
        "rigid": body and [body.type, body.mass, body.collision_shape],
        "selected": obj.select_get(),
        "keys": [
            [[list(key.co) for key in curve.keyframe_points], curve.data_path] for curve in keys
        ],
    }


def state():
    """Everything in the file that an action could change."""
    if bpy.context.mode == "EDIT_MESH":
        bpy.context.object.update_from_editmode()
    bpy.context.view_layer.update()
    scene, active = bpy.context.scene, bpy.context.object
    found = {
        "objects": {obj.name: of_object(obj) for obj in bpy.data.objects},
        "collections": {
            one.name: [
                {key: str(plain(value)) for key, value in one.items()},
                list(one.instance_offset),
            ]
            for one in [*bpy.data.collections, scene.collection]
        },
        "materials": {one.name: settings_of(one.body_moments) for one in bpy.data.materials},
        "others": [
            sorted(one.name for one in data) for data in (bpy.data.meshes, bpy.data.node_groups)
        ],
        "texts": {one.name: one.as_string() for one in bpy.data.texts},
        "scene": [settings_of(scene.body_moments), settings_of(scene.body_moments_search)],
        "unit": [scene.unit_settings.scale_length, scene.unit_settings.length_unit],
        "cursor": [list(row) for row in scene.cursor.matrix],
        "orientation": scene.transform_orientation_slots[0].type,
        "frame": scene.frame_current,
        "active": [active and active.name, bpy.context.mode],
    }
    return json.loads(json.dumps(found))


def nothing(folder):
    pass


def measure(folder):
    bpy.ops.object.body_moments_measure()


def measure_and_more(folder):
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_find_symmetry()


def assembly(folder):
    bpy.context.object.parent = add(None, "Root", location=(0.0, 0.0, 1.0), select=False)
    only(bpy.data.objects["Root"])
    bpy.context.view_layer.active_layer_collection = (
        bpy.context.view_layer.layer_collection.children["Parts"]
    )


def measured_assembly(folder):
    assembly(folder)
    for target in ("OBJECT", "COLLECTION"):
        bpy.ops.object.body_moments_measure_assembly(target=target)


def steel(folder):
    bpy.context.object.data.materials.append(bpy.data.materials.new("Steel"))


def flipped(folder):
    """One face turned around, one missing."""
    with editing(bpy.context.object.data) as mesh:
        mesh.faces[1].normal_flip()
        mesh.faces.remove(mesh.faces[4])


def edited(folder):
    edit(figure())
    bpy.context.scene.cursor.location = (0.02, 0.01, 0.0)


def animated(folder):
    obj = bpy.context.object
    for frame in (1, 10):
        obj.location.x = frame
        obj.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_end = 10
    bpy.context.scene.frame_set(1)


def rigid(folder):
    bpy.ops.rigidbody.object_add()


def library(folder):
    bpy.ops.object.body_moments_measure()
    (folder / "library.jsonl").write_text("", encoding="utf-8")


def robot(folder):
    (folder / "robot.urdf").write_text(
        '<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" '
        'izz="9" ixy="0" '
        'ixz="0" iyz="0"/></inertial></link></robot>',
        encoding="utf-8",
    )


def scan(folder):
    np.save(folder / "scan.npy", np.arange(60.0, dtype=np.float32).reshape(3, 4, 5))


def surface(folder):
    file = IgesFile()
    file.surface(unrolled(sphere()))
    file.write(folder / "surface.igs")


# operator: what is there before, the values of the action, and those of the redo panel. {}: the
# folder
REDONE = {
    "import_scene.body_moments_audit": (
        robot,
        {"filepath": "{}/robot.urdf"},
        {"filepath": "{}/robot.urdf", "allow_outside": True},
    ),
    "material.body_moments_set_density": (
        steel,
        {"target": "Steel", "material": "PLA"},
        {"target": "Steel", "material": "Copper"},
    ),
    "object.body_moments_add_empty": (
        nothing,
        {"parent": True},
        {"parent": False, "display": "CUBE", "size": 0.5},
    ),
    "object.body_moments_add_nodes": (nothing, {"marker": True}, {"marker": False}),
    "object.body_moments_align_to_world": (
        nothing,
        {"order": "XYZ"},
        {"order": "ZXY", "pivot": "ORIGIN"},
    ),
    "object.body_moments_assembly_empty": (
        measured_assembly,
        {"target": "COLLECTION"},
        {"target": "OBJECT"},
    ),
    "object.body_moments_assembly_origin": (
        measured_assembly,
        {"target": "COLLECTION"},
        {"target": "OBJECT"},
    ),
    "object.body_moments_axes_to_principal": (nothing, {"strict": False}, {"strict": True}),
    "object.body_moments_balance_group": (animated, {"frame_step": 1}, {"frame_step": 3}),
    "object.body_moments_clear": (measure_and_more, {"kinds": {"MASS"}}, {"kinds": {"SYMMETRY"}}),
    "object.body_moments_clear_assembly": (
        measured_assembly,
        {"target": "COLLECTION"},
        {"target": "OBJECT"},
    ),
    "object.body_moments_create_orientation": (
        nothing,
        {"use": True},
        {"use": False, "name": "Other"},
    ),
    "object.body_moments_equal_inertia": (
        measure,
        {"kind": "BOX"},
        {"kind": "CAPSULE", "rigid_body": True},
    ),
    "object.body_moments_find_in_library": (
        library,
        {"filepath": "{}/library.jsonl"},
        {"filepath": "{}/library.jsonl", "scaled": True},
    ),
    "object.body_moments_find_similar": (
        nothing,
        {"select": True},
        {"select": False, "mirrored": True},
    ),
    "object.body_moments_find_symmetry": (nothing, {"tolerance": 1e-6}, {"tolerance": 0.5}),
    "object.body_moments_import_scan": (
        scan,
        {"filepath": "{}/scan.npy", "overwrite": True},
        {
            "filepath": "{}/scan.npy",
            "use_spacing": True,
            "spacing": (1.0, 2.0, 3.0),
            "overwrite": True,
        },
    ),
    "object.body_moments_import_surfaces": (
        surface,
        {"filepath": "{}/surface.igs", "unit": 1.0},
        {"filepath": "{}/surface.igs", "unit": 0.001},
    ),
    "object.body_moments_measure": (
        nothing,
        {"material": "PLA"},
        {"material": "Copper", "kind": "SHELL"},
    ),
    "object.body_moments_remedy": (
        nothing,
        {"remedy": "SHELL", "thickness": 0.01},
        {"remedy": "SHELL", "thickness": 0.02},
    ),
    "object.body_moments_measure_assembly": (
        assembly,
        {"target": "COLLECTION"},
        {"target": "OBJECT"},
    ),
    "object.body_moments_rest_on_ground": (nothing, {"pose": 1}, {"pose": 2, "ground": "LOWEST"}),
    "object.body_moments_rigid_bodies": (
        nothing,
        {"type": "ACTIVE"},
        {"type": "PASSIVE", "shape": "BOX"},
    ),
    "object.body_moments_sculpt_balance": (edited, {"axes": "ALONG_GRAVITY"}, {"axes": "ALL"}),
    "object.body_moments_select_faults": (
        flipped,
        {"kinds": {"flipped_faces"}},
        {"kinds": {"boundary_edges"}},
    ),
    "object.body_moments_select_found": (nothing, {"name": "Twin"}, {"name": "Body"}),
    "object.body_moments_set_material": (nothing, {"material": "PLA"}, {"material": "Copper"}),
    "object.body_moments_set_rigid_body_mass": (
        rigid,
        {"axes": False},
        {"axes": True, "add": True},
    ),
    "scene.body_moments_set_millimeters": (measure, {"remeasure": False}, {"remeasure": True}),
    "view3d.body_moments_cursor_to_assembly": (
        measured_assembly,
        {"target": "COLLECTION"},
        {"target": "OBJECT", "rotate": True},
    ),
    "view3d.body_moments_cursor_to_center": (nothing, {"rotate": False}, {"rotate": True}),
}


# Where the other values change nothing in these small scenes.
SAME = {
    "import_scene.body_moments_audit",
    "object.body_moments_axes_to_principal",
    "object.body_moments_find_in_library",
    "object.body_moments_import_surfaces",  # an IGES file has its own unit
}
# Undo in Edit Mode holds meshes only, so that what was measured is a step of its own.
UNDOS = {"object.body_moments_select_faults": 2}


def undo(operator):
    for _ in range(UNDOS.get(operator, 1)):
        bpy.ops.ed.undo()


def run(operator, values, folder):
    values = {
        name: value.format(folder) if isinstance(value, str) else value
        for name, value in values.items()
    }
    module, _, name = operator.partition(".")
    getattr(getattr(bpy.ops, module), name)("EXEC_DEFAULT", True, **values)


def build(before, folder):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    parts = bpy.data.collections.new("Parts")
    bpy.context.scene.collection.children.link(parts)
    twin = add(mesh_body("Twin"), "Twin", location=(9.0, 0.0, 0.0))
    body = add(mesh_body(), location=(1.0, 2.0, 3.0), rotation=(0.3, 0.2, 0.1))
    for obj in (body, twin):
        bpy.context.scene.collection.objects.unlink(obj)
        parts.objects.link(obj)
    only(body)
    before(folder)
    bpy.ops.ed.undo_push(message="Start")


def differences(one, other, path=""):
    """Where two states differ, and how."""
    if isinstance(one, dict) and isinstance(other, dict):
        return [
            found
            for key in sorted({*one, *other})
            for found in differences(one.get(key), other.get(key), f"{path}/{key}")
        ]
    return [] if one == other else [(path, one, other)]


def but_cursor(found):
    """Blender's undo leaves the 3D cursor where it is."""
    return {key: value for key, value in found.items() if key != "cursor"}


@pytest.mark.parametrize("operator", REDONE)
def test_redo_with_other_values_equals_first_run(operator, tmp_path):
    before, first, other = REDONE[operator]
    build(before, tmp_path)
    start = state()
    run(operator, first, tmp_path)
    acted = state()
    assert acted != start
    undo(operator)
    assert differences(but_cursor(state()), but_cursor(start)) == []
    run(operator, other, tmp_path)
    redone = state()
    assert (redone == acted) == (operator in SAME)
    undo(operator)
    assert differences(but_cursor(state()), but_cursor(start)) == []
    build(before, tmp_path)
    assert differences(state(), start) == []
    run(operator, other, tmp_path)
    assert differences(state(), redone) == []
