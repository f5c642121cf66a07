# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A character and an assembly in the real window: buttons pressed by the mouse, what panels and
overlay then show.
"""

import pytest

from tests.window.conftest import OPEN

BUILD = """
import bmesh
from mathutils import Matrix
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
scene = bpy.context.scene
armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
scene.collection.objects.link(armature)
bpy.context.view_layer.objects.active = armature
bpy.ops.object.mode_set(mode="EDIT")
above = None
for number in range(4):
    bone = armature.data.edit_bones.new("bone {}".format(number))
    bone.head, bone.tail, bone.parent = (0, 0, number), (0, 0, number + 1), above
    above = bone
bpy.ops.object.mode_set(mode="OBJECT")
mesh, made = bpy.data.meshes.new("Skin"), bmesh.new()
tall = Matrix.Diagonal((1, 1, 4, 1)) @ Matrix.Translation((0, 0, 0.5))
bmesh.ops.create_cube(made, size=1.0, matrix=tall)
for level in (1, 2, 3):
    everything = [*made.verts, *made.edges, *made.faces]
    bmesh.ops.bisect_plane(made, geom=everything, plane_co=(0, 0, level), plane_no=(0, 0, 1))
made.to_mesh(mesh)
skin = bpy.data.objects.new("Skin", mesh)
arms = bpy.data.collections.new("Character")
scene.collection.children.link(arms)
arms.objects.link(skin)
skin.parent = armature
skin.modifiers.new("Armature", "ARMATURE").object = armature
groups = [skin.vertex_groups.new(name=bone.name) for bone in armature.data.bones]
for vertex in mesh.vertices:
    level = round(vertex.co.z)
    for number in {max(level - 1, 0), min(level, 3)}:
        groups[number].add([vertex.index], 0.5, "REPLACE")
hat = bpy.data.objects.new("Hat", bpy.data.meshes.new("Hat"))
made.clear()
bmesh.ops.create_cube(made, size=0.5)
made.to_mesh(hat.data)
arms.objects.link(hat)
hat.parent, hat.parent_type, hat.parent_bone = armature, "BONE", "bone 3"
hat.matrix_parent_inverse = Matrix.Translation((0, 0.25, 0))
armature.pose.bones["bone 2"].rotation_mode = "XYZ"
armature.pose.bones["bone 2"].rotation_euler = (0.6, 0, 0)
armature.select_set(True)
"""
BONES = "bpy.data.objects['Rig'].pose.bones"


@pytest.fixture(scope="module")
def rig(window):
    window.ask(BUILD)
    window.ask(OPEN)
    window.open_tab("Moments")
    return window


def first_in_properties(tab):
    return (
        "next(one for one in window.screen.areas"
        f" if one.type == 'PROPERTIES').spaces.active.context = {tab!r}\n"
        f"cls = bpy.types.{tab}_PT_body_moments\n"
        "bpy.utils.unregister_class(cls)\n"
        "cls.bl_options, cls.bl_order = set(), -1\n"
        "bpy.utils.register_class(cls)"
    )


def test_bones_are_measured_and_drawn_in_their_pose(rig):
    window = rig
    window.press("object.body_moments_measure_bones")
    window.wait(f"'body_mass' in {BONES}['bone 0']")
    masses = window.get(f"[bone['body_mass'] for bone in {BONES}]")
    assert [round(mass, 6) for mass in masses] == [1000.0, 1000.0, 1000.0, 1125.0]
    window.picture("rig-posed")
    window.ask("bpy.context.scene.body_moments.overlay.show = True")
    window.ask("bpy.ops.object.mode_set(mode='POSE')\nbpy.ops.pose.select_all(action='SELECT')")
    window.ask(
        "with bpy.context.temp_override(area=area, region=regions['WINDOW']):\n    "
        "bpy.ops.view3d.view_all()"
    )
    window.picture("rig-overlay")


def test_the_bone_has_its_numbers_in_its_properties(rig):
    window = rig
    window.ask(
        "bpy.data.objects['Rig'].data.bones.active = bpy.data.objects['Rig'].data.bones['bone 3']\n"
        + first_in_properties("BONE")
    )
    window.picture("rig-bone-properties")


def test_the_assembly_is_a_tree(rig):
    window = rig
    window.ask(
        "bpy.ops.object.mode_set(mode='OBJECT')\n"
        "bpy.context.view_layer.active_layer_collection = "
        "bpy.context.view_layer.layer_collection.children['Character']"
    )
    window.ask("bpy.ops.object.body_moments_measure_assembly('EXEC_DEFAULT', True)")
    # bent, so a little less
    assert 4000.0 < window.get("bpy.data.collections['Character']['body_mass']") < 4125.0
    window.ask(
        "bpy.context.view_layer.objects.active = bpy.data.objects['Skin']\n"
        + first_in_properties("COLLECTION")
    )
    assert (
        len(window.get("[row.name for row in bpy.data.collections['Character'].body_moments.rows]"))
        == 3
    )
    window.picture("rig-assembly")
