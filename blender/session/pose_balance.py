# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance Pose: the least move of a bone that brings the center of mass over the support.

The armature is evaluated at every trial, so that constraints, drivers and inverse kinematics count as they are. A trial
is good if the contacts stay; legs that would be stretched get a lower hip, by the least height.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from bpy.types import Context, Object, PoseBone
from mathutils import Quaternion, Vector
from numpy.typing import NDArray

from ...core.numerics.float32 import shortest_decimal
from ...core.statics.support import ground_axes
from ..read.tracking import tracking_paused
from .live import character
from .live.character import Character, Weight, bone_matrices

# Relative to the character's size.
NUDGE = 1e-3
REACHED = 1e-5  # distance from the target
STAYED = 5e-5  # move of a contact
SLIP = 0.05  # contacts that move this far with a bone, relative to its or the center's move, hang on it
LEAST_SHIFT, LEAST_TURN = 0.05, 0.02  # moves of the center that are smaller, by a bone's move or turn, are no use
FARTHEST = 1.0  # moves and, in radians, turns of a bone
MAX_STEPS, MAX_LOWERINGS = 10, 15

Outcome = tuple[str, dict[str, object]]  # an English text and its values
MOVED = "Moved “{bone}”: the center is {gap:length} from its target, {margin:length} inside the support"
BALANCED = "Nothing to do: the center of mass is over its target"
UNMOVABLE = (
    "No channel of “{bone}” balances the pose: they are locked or driven, or move the contacts along. Unlock them, "
    "give the legs inverse kinematics, or choose another bone."
)
NO_BONE = (
    "No bone moves the center and leaves the contacts in place. Unlock the hips and give the legs inverse kinematics, "
    "or choose a bone."
)
TOO_FAR = "“{bone}” cannot bring the center nearer than {gap:length} to its target. Choose another bone."
STRETCHED = (
    "Balancing with “{bone}” would move the contacts by {slip:length}, as the legs are stretched. Lower the hips "
    "first, or choose another bone."
)
IN_AIR = "Nothing touches the ground: the lowest point is {height:length} above it. Lower the pose, or set Ground."
NO_CONTACT = "No mesh of “{armature}” can touch the ground. Show its meshes, or turn off Contact of bones without any."


class _Handle:
    """Three channels of a bone, changes of which are tried: its location, or its rotation about its own axes."""

    def __init__(self, bone: PoseBone, turns: bool):
        self.bone, self.turns = bone, turns
        mode = bone.rotation_mode.lower()
        self.channel = "rotation_{:s}".format(mode if mode == "quaternion" else "euler") if turns else "location"
        self.start = getattr(bone, self.channel).copy()
        locks = bone.lock_rotation if turns else bone.lock_location
        self.free = [axis for axis in range(3) if not locks[axis]]
        if turns and (mode == "axis_angle" or mode == "quaternion" and any(locks)):
            self.free = []  # their channels are none about an axis

    def put(self, change: NDArray) -> None:
        """Set the channels to their first values, changed by (3,) lengths or angles."""
        if self.channel == "rotation_quaternion":
            turn = Vector(change)
            self.bone.rotation_quaternion = self.start @ Quaternion(turn, turn.length)
        else:
            setattr(self.bone, self.channel, [value + float(add) for value, add in zip(self.start, change)])


class _Search:
    """The search for one character; failure: of the last bone that had an effect."""

    def __init__(self, context: Context, armature: Object, known: Character, weight: Weight, margin: float | None):
        assert weight.support is not None
        self.context, self.armature, self.known = context, armature, known
        self.unit = shortest_decimal(context.scene.unit_settings.scale_length)
        self.failure: Outcome = "", {}
        self.axes = ground_axes(-weight.support.up)
        self.target = weight.support.target(margin)
        is_carried = weight.contacts.bones >= 0
        self.bones, self.points = weight.contacts.bones[is_carried], weight.contacts.points[is_carried]
        matrices = bone_matrices(armature, context.evaluated_depsgraph_get())[self.bones]
        self.local = np.linalg.solve(matrices[:, :3, :3], (self.points - matrices[:, :3, 3])[:, :, None])

    def gap(self, center: NDArray) -> NDArray[np.float64]:
        """Return how far the target is from a center, (2,) along the ground."""
        return (self.target - center) @ self.axes[:, :2]

    def look(self, handle: _Handle, change: NDArray) -> tuple[NDArray, NDArray, float]:
        """Evaluate a change: return the (3,) center, the bone's head, and the farthest move of a contact's bone."""
        handle.put(change)
        self.context.view_layer.update()
        depsgraph = self.context.evaluated_depsgraph_get()
        matrices = bone_matrices(self.armature, depsgraph)
        head = matrices[self.armature.pose.bones.find(handle.bone.name), :3, 3]
        matrices = matrices[self.bones]
        moves = (matrices[:, :3, :3] @ self.local)[:, :, 0] + matrices[:, :3, 3] - self.points
        slip = float(np.linalg.norm(moves, axis=1).max(initial=0.0))
        return self.known.pose(self.armature, depsgraph).center, head, slip

    def effects(self, handle: _Handle, center: NDArray, head: NDArray) -> tuple[list[NDArray], NDArray, NDArray]:
        """Return a unit of each usable channel, and the (3, k) moves of the center and of the bone by them."""
        scale = max(map(abs, self.armature.matrix_world.to_scale()))
        nudge, least = NUDGE * self.known.size, 1e-2 * NUDGE * self.known.size
        used, of_center, of_bone = [], [], []
        for axis in handle.free:
            for sign in (1.0, -1.0):
                unit = sign * np.eye(3)[axis] * (1.0 / self.known.size if handle.turns else 1.0 / scale)
                shown, moved, slip = self.look(handle, nudge * unit)
                gained, move = shown - center, nudge * sign * np.eye(3)[axis] if handle.turns else moved - head
                if handle.turns or not move @ self.axes[:, 2] > least:
                    break  # else it lifts the bone, which would stretch the legs
            reach = float(np.linalg.norm(gained if handle.turns else move))
            if reach > least and slip <= SLIP * reach:
                used.append(unit)
                of_center.append(gained / nudge)
                of_bone.append(move / nudge)
        return used, np.array(of_center).reshape(-1, 3).T, np.array(of_bone).reshape(-1, 3).T

    def balance(self, handle: _Handle) -> bool:
        """Move the bone and return True, or if that is impossible, leave it and return False."""
        center, head, _ = self.look(handle, np.zeros(3))
        units, of_center, of_bone = self.effects(handle, center, head)
        least, tolerance = LEAST_TURN if handle.turns else LEAST_SHIFT, STAYED * self.known.size
        lower, change = 0.0, np.zeros(len(units))
        if len(units) > 1 and np.linalg.svd(self.axes[:, :2].T @ of_center)[1][-1] >= least:
            for _ in range(MAX_LOWERINGS if len(units) == 3 and not handle.turns else 1):
                place = head - lower * self.axes[:, 2]
                change, gap, slip = self._solve(handle, np.array(units), of_center, of_bone, change, place)
                if slip <= tolerance and gap <= REACHED * self.known.size:
                    return True
                values = {"bone": handle.bone.name, "gap": gap * self.unit, "slip": slip * self.unit}
                self.failure = TOO_FAR if slip <= tolerance else STRETCHED, values
                if slip <= tolerance:
                    break
                lower += 1.05 * slip + tolerance / 2.0
        setattr(handle.bone, handle.channel, handle.start)
        return False

    def _solve(
        self, handle: _Handle, units: NDArray, of_center: NDArray, of_bone: NDArray, change: NDArray, place: NDArray
    ) -> tuple[NDArray, float, float]:
        """Return the least change to the target with the bone's head at the height of a place, its gap and its slip.

        The effects of the channels are corrected by each trial (Broyden). The height of the head is given, as bent
        knees move the center, too.
        """
        up = self.axes[:, 2:].T[:0] if handle.turns else self.axes[:, 2:].T
        effect = np.concatenate([self.axes[:, :2].T @ of_center, up @ of_bone])
        inverse = np.linalg.inv(np.linalg.qr(of_bone)[1])  # from moves of the bone to changes
        before = None
        for step in range(MAX_STEPS + 1):
            center, head, slip = self.look(handle, change @ units)
            missing = np.concatenate([self.gap(center), up @ (place - head)])
            if np.linalg.norm(missing) <= 0.5 * REACHED * self.known.size or step == MAX_STEPS:
                break
            if before is not None:
                moved = change - before[0]
                effect = effect + np.outer(before[1] - missing - effect @ moved, moved) / max(moved @ moved, 1e-300)
            before = change, missing
            change = inverse @ np.linalg.pinv(effect @ inverse) @ (effect @ change + missing)
            change *= min(1.0, FARTHEST * self.known.size / np.linalg.norm(of_bone @ change))
        return change, float(np.linalg.norm(self.gap(center))), slip


def balance_pose(context: Context, armature: Object, name: str, margin: float | None) -> Outcome:
    """Move a bone of a posed character so that it is balanced, or leave it; return the outcome.

    name: of the bone, "" for the active one or another that is fit. margin: in Blender's units, None for the middle.
    """
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    character.prepare(context, armature)
    weight, known = character.weight(armature, context.evaluated_depsgraph_get()), character.character(armature, unit)
    assert weight is not None and known is not None
    if weight.contacts.height is None:
        return NO_CONTACT, {"armature": armature.name}
    if weight.support is None:
        return IN_AIR, {"height": weight.contacts.height * unit}
    search = _Search(context, armature, known, weight, margin)
    if np.linalg.norm(search.gap(weight.parts.center)) <= REACHED * known.size:
        return BALANCED, {}
    with tracking_paused():
        moved = next(filter(search.balance, _handles(context, armature, known, name)), None)
        context.view_layer.update()
    if moved is None:
        return search.failure if search.failure[0] else (UNMOVABLE, {"bone": name}) if name else (NO_BONE, {})
    if context.scene.tool_settings.use_keyframe_insert_auto:
        moved.bone.keyframe_insert(moved.channel)
    armature.update_tag()
    context.view_layer.update()
    after = character.weight(armature, context.evaluated_depsgraph_get())
    gap, margin = float(np.linalg.norm(search.gap(after.parts.center))) * unit, after.support.margin * unit
    return MOVED, {"bone": moved.bone.name, "gap": gap, "margin": margin}


def _handles(context: Context, armature: Object, known: Character, name: str) -> Iterator[_Handle]:
    """Yield the channels to try: locations of bones that no part hangs above, then rotations, from the root on."""
    chosen = context.active_pose_bone
    bones = [bone for bone in context.visible_pose_bones or () if bone.id_data == armature]
    bones.sort(key=lambda bone: (bone != chosen, len(bone.parent_recursive)))
    bones = [armature.pose.bones[name]] if name else bones
    yield from (
        _Handle(bone, False) for bone in bones if not {up.name for up in bone.parent_recursive} & {*known.names}
    )
    yield from (_Handle(bone, True) for bone in bones)
