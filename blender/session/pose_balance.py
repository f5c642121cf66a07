# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance Pose: the least move of a bone that brings the center of mass over the support.

The armature is evaluated at every trial, so that constraints, drivers and inverse kinematics count as they are. A trial
is good if the contacts stay; legs that would be stretched get a lower hip, by the least height.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

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
NO_CONTACT = "No mesh of “{armature}” can touch the ground. Show its meshes, or press Set Contacts with Any Bone."
BALANCED = "The center of mass is over its target already"


@dataclass(frozen=True)
class Outcome:
    """The result of a search. problem: the English text of why nothing has changed, or "". values: fill the texts."""

    problem: str = ""
    values: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class _Look:
    """An evaluated trial: (3,) center and head of the bone, and the farthest move of a contact with its bone."""

    center: NDArray[np.float64]
    head: NDArray[np.float64]
    slip: float


class _Handle:
    """Three channels of a bone, changes of which are tried: its location, or its rotation about its own axes."""

    def __init__(self, bone: PoseBone, turns: bool):
        self.bone, self.turns = bone, turns
        self.mode = "quaternion" if bone.rotation_mode == "QUATERNION" else "euler"
        self.mode = "axis_angle" if bone.rotation_mode == "AXIS_ANGLE" else self.mode
        self.channel = "rotation_" + self.mode if turns else "location"
        self.start = tuple(getattr(bone, self.channel))
        locks = bone.lock_rotation if turns else bone.lock_location
        self.free = [axis for axis in range(3) if not locks[axis]]
        if turns and self.mode != "euler" and any(locks):
            self.free = []

    def put(self, change: NDArray) -> None:
        """Set the channels to their first values, changed by (3,) lengths or angles."""
        if self.channel == "location" or self.channel == "rotation_euler":
            setattr(self.bone, self.channel, [value + float(add) for value, add in zip(self.start, change)])
            return
        turn = Vector(change)
        angle = turn.length
        first = Quaternion(self.start) if self.mode == "quaternion" else Quaternion(self.start[1:], self.start[0])
        turned = first @ Quaternion(turn, angle) if angle else first
        if self.mode == "axis_angle":
            axis, angle = turned.to_axis_angle()
            self.bone.rotation_axis_angle = (angle, *axis)
        else:
            self.bone.rotation_quaternion = turned

    def reset(self) -> None:
        """Restore the first values, to the bit."""
        setattr(self.bone, self.channel, self.start)


class _Search:
    """The search for one character; margin: from the edge, in Blender's units, or None for the middle."""

    def __init__(
        self, context: Context, armature: Object, known: Character, weight: Weight, margin: float | None, unit: float
    ):
        self.context, self.armature, self.known, self.unit = context, armature, known, unit
        assert weight.support is not None
        self.axes = ground_axes(-weight.support.up)
        self.target = weight.support.target(margin) @ self.axes[:, :2]
        is_carried = weight.contacts.bones >= 0
        self.bones, self.points = weight.contacts.bones[is_carried], weight.contacts.points[is_carried]
        matrices = bone_matrices(armature, context.evaluated_depsgraph_get())[self.bones]
        moves = self.points - matrices[:, :3, 3]
        self.local = np.linalg.solve(matrices[:, :3, :3], moves[:, :, None])
        self.failure: tuple[str, dict[str, Any]] | None = None  # of the last bone that had an effect

    def distance(self, weight: Weight) -> float:
        """Return how far a center is from the target along the ground."""
        return float(np.linalg.norm(self.target - weight.parts.center @ self.axes[:, :2]))

    def look(self, bone: PoseBone) -> _Look:
        """Evaluate the pose as it is."""
        self.context.view_layer.update()
        depsgraph = self.context.evaluated_depsgraph_get()
        matrices = bone_matrices(self.armature, depsgraph)
        head = matrices[self.armature.pose.bones.find(bone.name), :3, 3]
        matrices = matrices[self.bones]
        moves = (matrices[:, :3, :3] @ self.local)[:, :, 0] + matrices[:, :3, 3] - self.points
        slip = float(np.linalg.norm(moves, axis=1).max(initial=0.0))
        return _Look(self.known.pose(self.armature, depsgraph).center, head, slip)

    def gap(self, look: _Look) -> NDArray[np.float64]:
        """Return how far the target is from the center, (2,) along the ground."""
        return self.target - look.center @ self.axes[:, :2]

    def effects(self, handle: _Handle, first: _Look) -> tuple[list[int], NDArray, NDArray]:
        """Return usable channels, and the (3, k) moves of the center and of the bone for a unit of each."""
        size, up = self.known.size, self.axes[:, 2]
        unit = 1.0 if handle.turns else size / max(self.armature.matrix_world.to_scale(), key=abs)
        used, of_center, of_bone = [], [], []
        for axis in handle.free:
            for step in (NUDGE * unit, -NUDGE * unit):
                handle.put(step * np.eye(3)[axis])
                look = self.look(handle.bone)
                move = size * NUDGE * np.eye(3)[axis] if handle.turns else look.head - first.head
                if handle.turns or not move @ up > 1e-2 * NUDGE * size:
                    break  # else it lifts the bone, which would stretch the legs
            gained = look.center - first.center
            reach = float(np.linalg.norm(gained if handle.turns else move))
            if reach > 1e-2 * NUDGE * size and look.slip <= SLIP * reach:
                used.append(axis)
                of_center.append(gained / step)
                of_bone.append(move / abs(step) if handle.turns else move / step)
        handle.reset()
        return used, np.array(of_center).reshape(-1, 3).T, np.array(of_bone).reshape(-1, 3).T

    def balance(self, handle: _Handle) -> bool:
        """Move the bone and return True, or if that is impossible, leave it and return False."""
        first = self.look(handle.bone)
        used, of_center, of_bone = self.effects(handle, first)
        across = self.axes[:, :2].T
        least = LEAST_TURN if handle.turns else LEAST_SHIFT
        if len(used) < 2 or np.linalg.svd(across @ of_center)[1][-1] < least * np.abs(of_bone).max():
            return False
        lower, change, tolerance = 0.0, np.zeros(len(used)), STAYED * self.known.size
        for _ in range(MAX_LOWERINGS):
            change, look = self._solve(handle, used, of_center, of_bone, change, first, lower)
            gap, name = float(np.linalg.norm(self.gap(look))), handle.bone.name
            if look.slip <= tolerance and gap <= REACHED * self.known.size:
                return True
            self.failure = (
                (TOO_FAR, {"bone": name, "gap": gap * self.unit})
                if look.slip <= tolerance
                else (STRETCHED, {"bone": name, "slip": look.slip * self.unit})
            )
            if look.slip <= tolerance or handle.turns or len(used) < 3:
                break
            lower += 1.05 * look.slip + tolerance / 2.0
        handle.reset()
        return False

    def _solve(
        self,
        handle: _Handle,
        used: list[int],
        of_center: NDArray,
        of_bone: NDArray,
        change: NDArray,
        first: _Look,
        lower: float,
    ) -> tuple[NDArray, _Look]:
        """Return the least change of the channels to the target, with the bone's head lower by a height, and its look.

        The effects of the channels are corrected by each trial (Broyden).
        """
        # Locations keep the height that the legs allow: bent knees move the center, too.
        up = self.axes[:, 2:].T[:0] if handle.turns else self.axes[:, 2:].T
        effect = np.concatenate([self.axes[:, :2].T @ of_center, up @ of_bone])
        _, metric = np.linalg.qr(of_bone)
        look, before = self._try(handle, used, change), None
        for _ in range(MAX_STEPS):
            missing = np.concatenate([self.gap(look), -lower - up @ (look.head - first.head)])
            if np.linalg.norm(missing) <= 0.5 * REACHED * self.known.size:
                break
            if before is not None:
                step, gained = change - before[0], before[1] - missing
                effect = effect + np.outer(gained - effect @ step, step) / max(step @ step, 1e-300)
            before = change, missing
            inverse = np.linalg.inv(metric)
            change = inverse @ np.linalg.pinv(effect @ inverse) @ (effect @ change + missing)
            change *= min(1.0, FARTHEST * self.known.size / np.linalg.norm(metric @ change))
            look = self._try(handle, used, change)
        return change, look

    def _try(self, handle: _Handle, used: list[int], change: NDArray) -> _Look:
        values = np.zeros(3)
        values[used] = change
        handle.put(values)
        return self.look(handle.bone)


def balance_pose(context: Context, armature: Object, name: str, margin: float | None) -> Outcome:
    """Move a bone of a posed character so that it is balanced, or leave it and return the reason.

    name: of the bone, "" for the active one or another that is fit. margin: in Blender's units, None for the middle.
    """
    unit = shortest_decimal(context.scene.unit_settings.scale_length)
    character.prepare(context, armature)
    weight, known = character.weight(armature, context.evaluated_depsgraph_get()), character.character(armature, unit)
    assert weight is not None and known is not None
    if weight.contacts.height is None:
        return Outcome(NO_CONTACT, {"armature": armature.name})
    if weight.support is None:
        return Outcome(IN_AIR, {"height": weight.contacts.height * unit})
    search = _Search(context, armature, known, weight, margin, unit)
    if search.distance(weight) <= REACHED * known.size:
        return Outcome(BALANCED)
    with tracking_paused():
        handles = _handles(context, armature, known, name)
        moved = next((handle for handle in handles if search.balance(handle)), None)
        context.view_layer.update()
    if moved is None:
        return Outcome(*search.failure or ((UNMOVABLE, {"bone": name}) if name else (NO_BONE, {})))
    if context.scene.tool_settings.use_keyframe_insert_auto:
        moved.bone.keyframe_insert(moved.channel)
    armature.update_tag()
    context.view_layer.update()
    after = character.weight(armature, context.evaluated_depsgraph_get())
    assert after is not None and after.support is not None
    residual, margin = search.distance(after) * unit, after.support.margin * unit
    return Outcome("", {"bone": moved.bone.name, "residual": residual, "margin": margin})


def _handles(context: Context, armature: Object, known: Character, name: str) -> Iterator[_Handle]:
    """Yield the channels to try: locations of bones that no part hangs above, then rotations, from the root on."""
    chosen = context.active_pose_bone
    bones = [bone for bone in context.visible_pose_bones or () if bone.id_data == armature]
    bones.sort(key=lambda bone: (bone != chosen, len(bone.parent_recursive)))
    if name:
        bones = [armature.pose.bones[name]]
    parts = set(known.names)
    for bone in bones:
        if parts.isdisjoint(above.name for above in bone.parent_recursive):
            yield _Handle(bone, turns=False)
    for bone in bones:
        yield _Handle(bone, turns=True)
