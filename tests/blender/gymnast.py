# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A gymnast of boxes, 1.7 m tall, in somersaults with one tuck; momenta by differences of evaluated
parts.
"""

import bpy
import numpy as np
from mathutils import Euler, Matrix, Quaternion

# bone: head, tail, half extents of its box, the bone above
BONES = {
    "hips": ((0, 0, 0.95), (0, 0, 1.15), (0.17, 0.11, 0.10), "root"),
    "chest": ((0, 0, 1.15), (0, 0, 1.50), (0.19, 0.12, 0.17), "hips"),
    "head": ((0, 0, 1.50), (0, 0, 1.70), (0.08, 0.10, 0.12), "chest"),
    "arm.L": ((0.24, 0, 1.46), (0.24, 0, 0.90), (0.04, 0.05, 0.28), "chest"),
    "arm.R": ((-0.24, 0, 1.46), (-0.24, 0, 0.90), (0.04, 0.05, 0.28), "chest"),
    "thigh.L": ((0.10, 0, 0.95), (0.10, 0, 0.50), (0.07, 0.08, 0.22), "hips"),
    "thigh.R": ((-0.10, 0, 0.95), (-0.10, 0, 0.50), (0.07, 0.08, 0.22), "hips"),
    "shin.L": ((0.10, 0, 0.50), (0.10, 0, 0.0), (0.06, 0.07, 0.25), "thigh.L"),
    "shin.R": ((-0.10, 0, 0.50), (-0.10, 0, 0.0), (0.06, 0.07, 0.25), "thigh.R"),
}
TUCK = {"chest": 0.7, "head": 0.4, "arm": -1.3, "thigh": -1.9, "shin": 2.1}
CHANNELS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
CORNERS = np.array(list(np.ndindex(2, 2, 2))) * 2.0 - 1.0
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def gymnast(root=True, scale=(1.0, 1.0, 1.0)):
    """The armature object, in Pose Mode, measured; its boxes are one skin.

    root: whether one bone carries all; else there are three roots, and the object does.
    """
    data = bpy.data.armatures.new("Gymnast")
    rig = bpy.data.objects.new("Gymnast", data)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    if root:
        bone = data.edit_bones.new("root")
        bone.head, bone.tail, bone.use_deform = (0, 0, 0.95), (0, 0.1, 1.25), False
    for name, (head, tail, _half, above) in BONES.items():
        bone = data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
        if root or not name.startswith("thigh"):
            bone.parent = data.edit_bones.get(above)
    bpy.ops.object.mode_set(mode="OBJECT")
    points = [
        (np.add(head, tail)) / 2.0 + CORNERS * half * scale
        for head, tail, half, _ in BONES.values()
    ]
    faces = [tuple(corner + 8 * box for corner in face) for box in range(9) for face in FACES]
    mesh = bpy.data.meshes.new("Boxes")
    mesh.from_pydata(np.concatenate(points).tolist(), [], faces)
    body = bpy.data.objects.new("Boxes", mesh)
    bpy.context.scene.collection.objects.link(body)
    for box, name in enumerate(BONES):
        body.vertex_groups.new(name=name).add(range(8 * box, 8 * box + 8), 1.0, "REPLACE")
    body.parent = rig
    body.modifiers.new("Armature", "ARMATURE").object = rig
    for bone in rig.pose.bones:
        bone.rotation_mode = "XYZ"
    rig.select_set(True)
    bpy.ops.object.mode_set(mode="POSE")
    assert bpy.ops.object.body_moments_measure_bones() == {"FINISHED"}
    return rig


def somersault(
    rig, seed, fps, mode, carrier="root", turns=1.0, twist=0.0, seconds=0.9, asymmetry=0.0
):
    """Key a floaty somersault with one tuck and return its (take-off, landing).

    asymmetry: how much the left arm swings otherwise than the right one, rad.
    """
    rng = np.random.default_rng(seed)
    scene = bpy.context.scene
    scene.render.fps = fps
    first = 4 + int(rng.integers(0, 6))
    last = first + round(seconds * fps)
    scene.frame_start, scene.frame_end = 1, last + fps // 2
    owner = rig.pose.bones.get(carrier) or rig
    owner.rotation_mode = mode
    channel = CHANNELS.get(mode, "rotation_euler")
    rest = np.array(rig.data.bones[carrier].matrix_local.to_3x3()) if owner != rig else np.eye(3)
    axis = rest.T @ [1.0, 0.0, 0.0]
    long_axis = rest.T @ [0.0, 0.0, 1.0]
    count = max(2, round((last - first) / rng.integers(3, 8)))
    times = sorted({round(time) for time in np.linspace(first, last, count + 1)})
    bent = rng.uniform(0.7, 1.3)
    before = Euler((0, 0, 0), mode if channel == "rotation_euler" else "XYZ")
    previous = None
    for time in times:
        share = ((time - first) / (last - first)) ** bent
        turn = Quaternion(axis, 2.0 * np.pi * turns * share) @ Quaternion(
            long_axis, 2.0 * np.pi * twist * share
        )
        if channel == "rotation_euler":
            before = turn.to_euler(mode, before)
            owner.rotation_euler = before
        elif channel == "rotation_quaternion":
            if previous is not None and previous.dot(turn) < 0.0:
                turn.negate()
            previous = owner.rotation_quaternion = turn
        else:
            owner.rotation_axis_angle = (2.0 * np.pi * turns * share, *axis)
        owner.keyframe_insert(channel, frame=time)
    for time, up in ((first, 0.0), ((first + last) // 2, rng.uniform(0.8, 1.4)), (last, 0.0)):
        place = np.array([0.0, -1.0 * (time - first) / (last - first), up])
        owner.location = rest.T @ place
        owner.keyframe_insert("location", frame=time)
    start, end = rng.uniform(0.05, 0.3), rng.uniform(0.65, 0.95)
    tuck = [round(first + share * (last - first)) for share in (start, (start + end) / 2.0, end)]
    for name in BONES:
        size = TUCK.get(name.split(".")[0], 0.0) * rng.uniform(0.7, 1.1)
        for time, amount in zip((first, *tuck, last), (0.0, 0.1, 1.0, 0.1, 0.0)):
            bone = rig.pose.bones[name]
            swing = asymmetry * amount if name == "arm.L" else 0.0
            bone.rotation_euler = size * amount, 0.3 * swing, swing
            bone.keyframe_insert("rotation_euler", frame=time)
    scene.frame_set(1)
    return first, last


def curves_of(obj):
    animation = obj.animation_data
    return list(animation.action.layers[0].strips[0].channelbag(animation.action_slot).fcurves)


def frame_set(time):
    bpy.context.scene.frame_set(int(np.floor(time)), subframe=float(time % 1.0))


def parts_at(rig, times):
    """Return masses (p,), tensors (p, 3, 3) in the bones' axes, and (f, p, 4, 4) places of the
    parts' centers.
    """
    bones = [bone for bone in rig.pose.bones if "body_mass" in bone]
    xx, yy, zz, xy, xz, yz = np.array([bone["body_inertia"] for bone in bones]).T
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    scale = rig.matrix_world.to_scale()
    arms = [
        Matrix.Translation([c / s for c, s in zip(b["body_center_of_mass"], scale)]) for b in bones
    ]
    places = []
    for time in times:
        frame_set(time)
        places.append([rig.matrix_world @ bone.matrix @ arm for bone, arm in zip(bones, arms)])
    return np.array([bone["body_mass"] for bone in bones]), tensors, np.array(places)


def centers_at(rig, times):
    masses, _, places = parts_at(rig, times)
    return np.einsum("p,fpi->fi", masses / masses.sum(), places[..., :3, 3])


def momenta_at(rig, times, fps, width=0.125):
    """Return (f, 3) angular momenta about the center by central differences over `width` frames."""
    pairs = np.stack([np.subtract(times, width / 2.0), np.add(times, width / 2.0)], axis=1)
    masses, tensors, places = parts_at(rig, pairs.ravel())
    step = width / fps
    ends = places[..., :3, 3].reshape(len(pairs), 2, -1, 3)
    axes = places[..., :3, :3].reshape(len(pairs), 2, -1, 3, 3)
    axes = axes / np.linalg.norm(axes, axis=-2, keepdims=True)
    middle = ends.mean(axis=1)
    arms = middle - np.einsum("p,fpi->fi", masses / masses.sum(), middle)[:, None]
    total = np.einsum("p,fpi->fi", masses, np.cross(arms, (ends[:, 1] - ends[:, 0]) / step))
    between = axes[:, 1] @ axes[:, 0].swapaxes(-1, -2)
    skew = (between - between.swapaxes(-1, -2)) / 2.0
    rates = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    sine = np.linalg.norm(rates, axis=-1, keepdims=True)
    rates *= np.where(sine > 1e-9, np.arcsin(np.minimum(sine, 1.0)) / np.maximum(sine, 1e-9), 1.0)
    half = axes.mean(axis=1)
    u, _, v = np.linalg.svd(half)
    half = u @ v
    spins = half @ tensors @ half.swapaxes(-1, -2) @ (rates / step)[..., None]
    return total + spins[..., 0].sum(axis=1)
