# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A human figure, 1.75 m tall: one skin with automatic weights, and an armature whose feet inverse
kinematics hold.
"""

import bpy
import numpy as np

# bone: head, tail, the radii of the skin there, and the bone above
BONES = {
    "hips": ((0, 0, 0.95), (0, 0, 1.12), 0.14, 0.12, "root"),
    "spine": ((0, 0, 1.12), (0, 0.01, 1.42), 0.12, 0.13, "hips"),
    "head": ((0, 0.01, 1.46), (0, -0.02, 1.70), 0.06, 0.10, "spine"),
    "arm": ((0.18, 0.01, 1.40), (0.44, 0.02, 1.38), 0.06, 0.045, "spine"),
    "forearm": ((0.44, 0.02, 1.38), (0.76, 0, 1.36), 0.045, 0.04, "arm"),
    "thigh": ((0.10, 0, 0.92), (0.11, -0.02, 0.50), 0.09, 0.06, "hips"),
    "shin": ((0.11, -0.02, 0.50), (0.11, 0.03, 0.06), 0.06, 0.06, "thigh"),
    "foot": ((0.11, 0.03, 0.06), (0.12, -0.16, 0.03), 0.06, 0.04, "shin"),
}
IN_PAIRS = {"arm", "forearm", "thigh", "shin", "foot"}


def sides():
    """Yield (name, head, tail, radii, name of the bone above) of all bones."""
    for name, (head, tail, first, last, above) in BONES.items():
        for side, sign in (("L", 1), ("R", -1)) if name in IN_PAIRS else (("", 1),):
            suffix = "." + side if side else ""
            over = above + suffix if above in IN_PAIRS else above
            yield (
                name + suffix,
                np.array(head) * (sign, 1, 1),
                np.array(tail) * (sign, 1, 1),
                (first, last),
                over,
            )


def armature(name="Figure", held=True):
    """An armature object. held: whether inverse kinematics hold its feet."""
    data = bpy.data.armatures.new(name)
    rig = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    root = data.edit_bones.new("root")
    root.head, root.tail, root.use_deform = (0, 0, 0), (0, 0.3, 0), False
    for bone_name, head, tail, _radii, above in sides():
        bone = data.edit_bones.new(bone_name)
        bone.head, bone.tail, bone.parent = head, tail, data.edit_bones[above]
        bone.use_connect = bone_name[:4] in {"fore", "shin"}
    for side in "LR" if held else "":
        bone, foot = data.edit_bones.new("hold." + side), data.edit_bones["foot." + side]
        bone.head, bone.tail, bone.parent, bone.use_deform = foot.head, foot.tail, root, False
    bpy.ops.object.mode_set(mode="OBJECT")
    for bone in rig.pose.bones:
        bone.rotation_mode = "XYZ"
    for side in "LR" if held else "":
        for owner, kind in (("shin.", "IK"), ("foot.", "COPY_ROTATION")):
            constraint = rig.pose.bones[owner + side].constraints.new(kind)
            constraint.target, constraint.subtarget = rig, "hold." + side
        rig.pose.bones["shin." + side].constraints["IK"].chain_count = 2
    return rig


def skin(rig, levels=2, name="Body"):
    """A closed mesh object around the bones, flat under the feet, with automatic weights."""
    places, edges, radii = [], [], []
    index = {}
    for bone, head, tail, (first, last), above in sides():
        start = index.get(above)
        joint = start is not None and np.linalg.norm(places[start] - head) < 1e-6
        if not joint:
            places.append(head)
            radii.append(first)
            if start is not None:
                edges.append(
                    (index[above + ".head"] if bone.startswith("thigh") else start, len(places) - 1)
                )
        index[bone + ".head"] = start if joint else len(places) - 1
        places.append(tail)
        radii.append(last)
        edges.append((index[bone + ".head"], len(places) - 1))
        index[bone] = len(places) - 1
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(place) for place in places], edges, [])
    sketch = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(sketch)
    sketch.modifiers.new("Skin", "SKIN")
    for vertex, radius in zip(mesh.skin_vertices[0].data, radii):
        vertex.radius = radius, radius
    mesh.skin_vertices[0].data[0].use_root = True
    sketch.modifiers.new("Smooth", "SUBSURF").levels = levels
    bpy.context.view_layer.update()
    body = bpy.data.meshes.new_from_object(
        sketch.evaluated_get(bpy.context.evaluated_depsgraph_get())
    )
    bpy.data.objects.remove(sketch)
    for vertex in body.vertices:
        vertex.co.z = max(vertex.co.z, 0.0)
    obj = bpy.data.objects.new(name, body)
    bpy.context.scene.collection.objects.link(obj)
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    rig.select_set(True)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    for vertex in body.vertices:
        if vertex.co.z < 0.04:  # the soles belong to the feet alone
            for group in obj.vertex_groups:
                group.remove([vertex.index])
            obj.vertex_groups["foot." + ("L" if vertex.co.x > 0.0 else "R")].add(
                [vertex.index], 1.0, "REPLACE"
            )
    obj.body_moments.density = 985.0
    obj.select_set(False)
    return obj


def figure(levels=2, held=True):
    """The armature object, active and selected, and the mesh object of a figure."""
    rig = armature(held=held)
    return rig, skin(rig, levels)
