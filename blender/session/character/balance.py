# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance Pose: the least move of a bone that brings the center of mass over the support.

The armature is evaluated at every trial, so that constraints, drivers and inverse kinematics count
as they are. A trial is good if the contacts stay; legs that would be stretched get a lower hip, by
the least height.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from bpy.types import Context, Object, PoseBone
from mathutils import Quaternion, Vector

from ....core import numerics, statics, verdict
from ... import read, scale, write
from ..findings import NO_SUCH_NAME
from . import weight as character
from .weight import Character, Weight, bone_matrices

# Relative to the character's size. These limits and the next ones are chosen, not derived.
NUDGE = 1e-3  # trial move
REACHED = 1e-5  # distance from the target
STAYED = 5e-5  # move of a contact
# Contacts that move this far with a bone, relative to its or the center's move, hang on it.
SLIP = 0.05
# Moves of the center below these, relative to a bone's move or turn, are of no use.
LEAST_SHIFT = 0.05
LEAST_TURN = 0.02
FARTHEST = 0.5  # moves and, in radians, turns of a bone in a step
TORN = 0.05  # share of the mass above a bone that its location may leave behind
MAX_STEPS = 20
HALVINGS = 6  # halvings of a step that does not bring the center nearer
FLAT = 1e-3  # relative to the largest rate: channels below it are left alone
TURNS = (0.6, -0.6, 1.2, -1.2, 1.8, -1.8)  # rad: further first turns, if the center stays away

UNMOVABLE = (
    "No bone that may move leaves the contacts in place. Unlock the hips, remove drivers, give the "
    "legs inverse "
    "kinematics, or choose another bone."
)
TOO_FAR = "“{bone}” cannot bring the center nearer than {gap} to its target. Choose another bone."
STRETCHED = (
    "Balancing with “{bone}” would move the contacts by {slip}. Lower the hips, or choose "
    "another bone."
)
IN_AIR = (
    "Nothing touches the ground: the lowest point is {height} above it. Lower the pose, or "
    "set Ground."
)
NO_CONTACT = (
    "No mesh of “{armature}” can touch the ground. Show its meshes, or turn off Contact of bones "
    "without any."
)


class _Look(NamedTuple):
    """The (3,) center, the bone's (3,) head, and the farthest move of a contact's bone."""

    center: numerics.Array
    head: numerics.Array
    slip: float


class _Handle:
    """Three channels of a bone that are changed on trial: its location, or its rotation about its
    own axes.

    channel: the name of the property. start: its first value. free: the axes that may change.
    """

    def __init__(self, bone: PoseBone, turns: bool):
        self.bone, self.turns = bone, turns
        mode = bone.rotation_mode.lower()
        self.channel = (
            "rotation_{:s}".format(mode if mode == "quaternion" else "euler")
            if turns
            else "location"
        )
        self.start = getattr(bone, self.channel).copy()
        locks = bone.lock_rotation if turns else bone.lock_location
        self.free = [axis for axis in range(3) if not locks[axis]]
        if turns and (mode == "axis_angle" or mode == "quaternion" and any(locks)):
            self.free = []  # no channel of these is the rotation about one axis

    def put(self, change: numerics.NDArray) -> None:
        """Set the channels to their first values, changed by (3,) lengths or angles."""
        if self.channel == "rotation_quaternion":
            turn = Vector(change)
            self.bone.rotation_quaternion = self.start @ Quaternion(turn, turn.length)
        else:
            setattr(
                self.bone,
                self.channel,
                [value + float(add) for value, add in zip(self.start, change)],
            )


class _Search:
    """The search for one character, in Blender units and the world.

    failure: the refusal to be raised, of the first suitable bone. axes: (3, 3), two columns along
    the ground, the third up. target: (3,) place on the ground for the center. points, bones: (k, 3)
    contacts that a bone carries, and the indices of these bones. local: (k, 3, 1) the contacts in
    the spaces of their bones. noise: float32 rounding of places, which inverse kinematics see.
    """

    def __init__(
        self,
        context: Context,
        armature: Object,
        measured_character: Character,
        weight: Weight,
        margin: float | None,
    ):
        assert weight.support is not None
        self.context = context
        self.armature = armature
        self.character = measured_character
        self.unit = scale.meters_per_unit(context.scene)
        self.failure = write.reports.Refused(UNMOVABLE)
        self.axes = statics.ground_axes(-weight.support.up)
        self.target = weight.support.target(margin)
        is_carried = weight.contacts.bones >= 0
        self.bones = weight.contacts.bones[is_carried]
        self.points = weight.contacts.points[is_carried]
        matrices = bone_matrices(armature, context.evaluated_depsgraph_get())[self.bones]
        self.noise = float(np.finfo(np.float32).eps * np.abs(weight.contacts.points).max())
        self.local = np.linalg.solve(
            matrices[:, :3, :3], (self.points - matrices[:, :3, 3])[:, :, None]
        )

    def gap(self, center: numerics.NDArray) -> numerics.Array:
        """Return the (2,) displacement along the ground from a center to the target."""
        return (self.target - center) @ self.axes[:, :2]

    def look(self, handle: _Handle, change: numerics.NDArray) -> _Look:
        """Evaluate the pose with a (3,) change of the channels, which stays."""
        handle.put(change)
        self.context.view_layer.update()
        depsgraph = self.context.evaluated_depsgraph_get()
        matrices = bone_matrices(self.armature, depsgraph)
        head = matrices[self.armature.pose.bones.find(handle.bone.name), :3, 3]
        matrices = matrices[self.bones]
        moves = (matrices[:, :3, :3] @ self.local)[:, :, 0] + matrices[:, :3, 3] - self.points
        slip = float(np.linalg.norm(moves, axis=1).max(initial=0.0))
        return _Look(self.character.pose(self.armature, depsgraph).center, head, slip)

    def balance(self, handle: _Handle) -> bool:
        """Move the bone and return True, or if that is impossible, leave it and return False.

        nudge: length of a trial move. scale: lengths for a unit of the channels; an angle moves
        parts by up to the size. Changes are measured as lengths, so that both kinds are alike.
        """
        size = self.character.size
        up = self.axes[:, 2]
        start = self.look(handle, np.zeros(3))
        self.nudge = max(NUDGE * size, 10.0 * self.noise)
        self.scale = size if handle.turns else max(map(abs, self.armature.matrix_world.to_scale()))
        # (3,) directions of usable channels, and the center's move for a unit of length
        units: list[numerics.NDArray] = []
        shifts = []
        for axis, sign in ((axis, sign) for axis in handle.free for sign in (1.0, -1.0)):
            unit = sign * np.eye(3)[axis]
            trial = self.look(handle, self.nudge / self.scale * unit)
            move = trial.center - start.center if handle.turns else trial.head - start.head
            reach = float(np.linalg.norm(move))
            lifts = not handle.turns and move @ up > 1e-2 * self.nudge  # stretches the legs
            # An axis is tried the other way only if the first way is of no use.
            if (
                reach > (1e-3 if handle.turns else 1e-2) * self.nudge
                and trial.slip <= SLIP * reach + self.noise
                and not lifts
                and not any(unit @ usable for usable in units)
            ):
                units.append(unit)
                shifts.append((trial.center - start.center) / self.nudge)
        # Locations have to move the center both ways along the ground. Of turns one effect is
        # enough: a turn may first lift the center, or two turns be one near gimbal lock, and only a
        # further turn move the center along the ground.
        space = np.eye(3) if handle.turns else self.axes[:, :2]
        effects = np.linalg.svd(np.array(shifts) @ space)[1] if len(units) > 1 else np.zeros(2)
        is_useful = effects[0] >= LEAST_TURN if handle.turns else effects[1] >= LEAST_SHIFT
        if is_useful:
            changes = [np.zeros(len(units))]
            if handle.turns:
                changes += [size * turn * unit for turn in TURNS for unit in np.eye(len(units))]
            if any(self._solve(handle, np.array(units), change, start.head) for change in changes):
                return True
        setattr(handle.bone, handle.channel, handle.start)
        return False

    def _solve(
        self,
        handle: _Handle,
        units: numerics.NDArray,
        change: numerics.NDArray,
        head: numerics.NDArray,
    ) -> bool:
        """Find the least move from a first change on; return whether the center is over the target,
        the bone's head no higher than at first, and the contacts in place.

        units: (u, 3) directions of channels. change: (u,) lengths along them. head: (3,), at first;
        it is lowered while legs are stretched. Each step solves the linearized equations.
        """
        size = self.character.size
        up = self.axes[:, 2]
        reached = REACHED * size + self.noise
        tolerance = STAYED * size + self.noise

        def missing(current: _Look) -> numerics.NDArray:
            """Return the moves that are left: (2,) along the ground, and up for a location."""
            lift = [] if handle.turns else [up @ (head - current.head)]
            return np.array([*((self.target - current.center) @ self.axes[:, :2]), *lift])

        gap = 0.0
        current = self.look(handle, change @ units / self.scale)
        for _ in range(MAX_STEPS):
            gap = float(np.linalg.norm(missing(current)))
            if gap <= reached and current.slip <= tolerance:
                return True
            # Stretched legs: lower the hip by 1.05 times the slip, as a step is not exact, and by
            # half the tolerance, so that the search does not stop short.
            if gap <= reached:
                head = head - (1.05 * current.slip + tolerance / 2.0) * up
            probes = [
                self.look(handle, (change + self.nudge * row) @ units / self.scale)
                for row in np.eye(len(units))
            ]
            effects = (
                np.transpose([missing(current) - missing(probe) for probe in probes]) / self.nudge
            )
            # The pseudoinverse finds the shortest solution. With the factor R of moves = Q R, |R c|
            # is the length by which changes c move the bone, so that R c is made shortest.
            inverse = np.eye(len(units))
            if not handle.turns:
                moves = np.transpose([probe.head - current.head for probe in probes]) / self.nudge
                inverse = np.linalg.inv(np.linalg.qr(moves)[1])
            solve = inverse @ np.linalg.pinv(effects @ inverse, rcond=FLAT)
            step = solve @ (effects @ change + missing(current)) - change
            step *= min(1.0, FARTHEST * size / max(float(np.linalg.norm(step)), 1e-9 * size))
            gap = float(np.linalg.norm(missing(current)))  # again, as the head may be lower
            for share in 0.5 ** np.arange(HALVINGS):
                trial = self.look(handle, (change + share * step) @ units / self.scale)
                if np.linalg.norm(missing(trial)) < gap or gap <= reached:
                    break
            else:
                break
            change = change + share * step
            current = trial
        if self.failure.text == UNMOVABLE:  # no earlier bone has left its own reason
            values = {
                name: write.reports.distance(self.unit * value)
                for name, value in {"gap": gap, "slip": current.slip}.items()
            }
            self.failure = write.reports.Refused(
                TOO_FAR if current.slip <= tolerance else STRETCHED, bone=handle.bone.name, **values
            )
        return False


def balance_pose(
    context: Context, armature: Object, name: str, margin: float | None
) -> dict[str, str]:
    """Move a bone of a posed character so that it is balanced, or leave it and raise Refused or
    MeasureError.

    name: of the bone, "" for the active bone or another suitable one. margin: in Blender's units,
    None for the middle. Return the bone, the remaining gap and the margin; nothing if the
    character is balanced already.
    """
    unit = scale.meters_per_unit(context.scene)
    character.require_gravity(context.scene)
    if name and name not in armature.pose.bones:
        raise verdict.EditRefusedError(NO_SUCH_NAME, kind="bone", name=name)
    character.prepare(context, armature)
    weight = character.weight(armature, context.evaluated_depsgraph_get())
    measured_character = character.character(armature, unit)
    assert weight is not None and measured_character is not None
    if weight.contacts.height is None:
        raise write.reports.Refused(NO_CONTACT, armature=armature.name)
    if weight.support is None:
        raise write.reports.Refused(
            IN_AIR, height=write.reports.distance(unit * weight.contacts.height)
        )
    search = _Search(context, armature, measured_character, weight, margin)
    if np.linalg.norm(search.gap(weight.parts.center)) <= REACHED * measured_character.size:
        return {}
    with read.tracking.tracking_paused():
        handle = next(
            filter(search.balance, _handles(context, armature, measured_character, name)), None
        )
        context.view_layer.update()
    if handle is None:
        raise search.failure
    if context.scene.tool_settings.use_keyframe_insert_auto:
        handle.bone.keyframe_insert(handle.channel, frame=context.scene.frame_current_final)
    armature.update_tag()
    context.view_layer.update()
    after = character.weight(armature, context.evaluated_depsgraph_get())
    assert after is not None and after.support is not None
    gap = float(np.linalg.norm(search.gap(after.parts.center)))
    values = {
        name: write.reports.distance(unit * value)
        for name, value in {"gap": gap, "margin": after.support.margin}.items()
    }
    return {"bone": handle.bone.name} | values


def _handles(
    context: Context, armature: Object, measured_character: Character, name: str
) -> Iterator[_Handle]:
    """Yield the channels to try from the root on: locations of bones that no heavy part is above,
    then rotations.
    """
    active_bone = context.active_pose_bone
    masses = dict(zip(measured_character.names, measured_character.model.masses))
    bones = [bone for bone in context.visible_pose_bones or () if bone.id_data == armature]
    bones.sort(key=lambda bone: (bone != active_bone, len(bone.parent_recursive)))
    bones = [armature.pose.bones[name]] if name else bones
    for bone in bones:
        # A location tears the bone off the parts above it.
        if (
            sum(masses.get(above.name, 0.0) for above in bone.parent_recursive)
            <= TORN * measured_character.model.masses.sum()
        ):
            yield _Handle(bone, turns=False)
    for bone in bones:
        yield _Handle(bone, turns=True)
