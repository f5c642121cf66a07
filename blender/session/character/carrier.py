# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bone or object whose channels carry all parts of a character, and its keys."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from bpy.types import Context, Depsgraph, Object, PoseBone

from ....core import bodies, numerics, rig
from ... import scene, write
from ...read.tracking import tracking_paused
from .weight import Character

# relative to the character's size: a trial move, and the tolerance of the parts that follow
TRIAL = 1e-2
FOLLOWS = 1e-4
LEAST_NORM = 0.5  # of quaternions and axes that keep the length of the earlier ones
LAYER = "Body Moments"  # the name of the track and the strip

NOT_FREE = (
    "“{name}” cannot be keyed: its {channel:word} is {state:word}. Free it, or choose another bone."
)
SHARED = (
    "The action of “{name}” also animates {others}. Make it a single user in the Action Editor."
)


@dataclass(eq=False)
class Carrier:
    """A root bone or an armature object whose location and rotation carry all parts of a character.

    frames: at each time so far, its (4, 4) matrices in the world and of its channels, and the
    channels' values.
    """

    armature: Object
    owner: PoseBone | Object
    frames: list[tuple[numerics.NDArray, numerics.NDArray, dict[str, numerics.NDArray]]] = field(
        default_factory=list
    )

    @property
    def rotation(self) -> str:
        """The name of the rotation's channel."""
        kinds = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
        return kinds.get(self.owner.rotation_mode, "rotation_euler")

    @property
    def axes(self) -> numerics.Array:
        """(s, 3, 3) rotations of the carrier in the world."""
        polar, _ = numerics.polar_rotation(np.array([world for world, _, _ in self.frames]))
        return polar * np.sign(np.linalg.det(polar))[:, None, None]

    @property
    def uneven_parent(self) -> Object | None:
        """The object whose scale differs by direction, so that a turn shears the parts, if any."""
        above = self.armature.parent if self.owner == self.armature else self.armature
        while above is not None:
            scale = np.abs(above.scale)
            if np.ptp(scale) > FOLLOWS * scale.max():
                return above
            above = above.parent
        return None

    def path(self, channel: str) -> str:
        """Return the data path of a channel from the armature object."""
        return channel if self.owner == self.armature else self.owner.path_from_id(channel)

    def read(self, depsgraph: Depsgraph) -> None:
        """Add the frame that the depsgraph shows."""
        owner = evaluated = self.armature.evaluated_get(depsgraph)
        world = bodies.float64_matrix(evaluated.matrix_world)
        if self.owner != self.armature:
            owner = evaluated.pose.bones[self.owner.name]
            world = world @ bodies.float64_matrix(owner.matrix)
        values = {
            name: np.array(getattr(owner, name), np.float64)
            for name in ("location", self.rotation, "scale")
        }
        self.frames.append((world, bodies.float64_matrix(owner.matrix_basis), values))

    def require_free(self, turns: bool) -> None:
        """Raise Refused unless keys on the channels have an effect and are allowed."""
        scene.changes.require_editable(self.armature)
        owner = self.owner
        if sharing := scene.fcurves.sharing(self.armature):
            raise write.reports.Refused(SHARED, name=self.armature.name, others=sharing)
        for channel in ("location", "rotation")[: 1 + turns]:
            path = self.path("location" if channel == "location" else self.rotation)
            for state, holds in self._states(channel, path):
                if holds:
                    raise write.reports.Refused(
                        NOT_FREE, name=owner.name, channel=channel, state=state
                    )

    def _states(self, channel: str, path: str) -> Iterator[tuple[str, bool]]:
        """Yield the reasons why keys on a channel would be of no use, and whether they hold."""
        owner = self.owner
        animation = self.armature.animation_data
        curves = scene.fcurves.existing_curves(self.armature)
        keyed = [curve for curve in curves if curve.data_path == path]
        locked = any(getattr(owner, "lock_" + channel)) or any(curve.lock for curve in keyed)
        yield "locked", locked
        yield (
            "constrained",
            any(not modifier.mute and modifier.influence > 0.0 for modifier in owner.constraints),
        )
        yield "muted", any(curve.mute for curve in keyed)
        modifiers = [
            modifier for curve in keyed for modifier in curve.modifiers if not modifier.mute
        ]
        yield "changed by F-curve modifiers", bool(modifiers)
        if animation is not None:
            yield "driven", any(driver.data_path == path for driver in animation.drivers)
            yield "being tweaked in the NLA editor", animation.use_tweak_mode
        if owner == self.armature:
            turns = *owner.delta_rotation_euler, *owner.delta_rotation_quaternion[1:]
            sizes = (factor != 1.0 for factor in owner.delta_scale)
            yield "changed by Delta Transforms", any((*owner.delta_location, *turns, *sizes))

    def left_behind(self, context: Context, character: Character, turns: bool) -> str:
        """Try a small move at this frame; return the name of a part that does not follow, or ""."""
        depsgraph = context.evaluated_depsgraph_get()
        trial = Carrier(self.armature, self.owner)
        trial.read(depsgraph)
        before = character.pose(self.armature, depsgraph)
        move = np.eye(4)
        move[:3, 3] = TRIAL * character.size
        if turns:
            move[:3, :3] = numerics.rotation_matrix([1.0, TRIAL, TRIAL, TRIAL])
            move[:3, 3] += before.center - move[:3, :3] @ before.center
        stored = scene.transforms.TransformChannels(self.owner)
        with tracking_paused():
            place, turn = trial.channel_values(move[None])
            self.owner.location = place[0]
            values = trial.values(turn, trial._old(self.rotation))
            setattr(self.owner, self.rotation, values[0])
            context.view_layer.update()
            after = character.pose(self.armature, context.evaluated_depsgraph_get())
            stored.restore()
            context.view_layer.update()
        expected = move @ before.matrices
        units = [np.abs(expected[:, :3, :3]).max()] * 3 + [character.size]
        off = (np.abs(after.matrices - expected)[:, :3] / units).max(axis=(1, 2))
        return before.names[int(off.argmax())] if off.max() > FOLLOWS else ""

    def channel_values(self, moves: numerics.NDArray) -> tuple[numerics.Array, numerics.Array]:
        """Return the (s, 3) locations and (s, 4) continuous quaternions of the channels for a (4,
        4) move in the world at each time read.
        """
        world, basis = (np.array([frame[part] for frame in self.frames]) for part in (0, 1))
        new_basis = basis @ np.linalg.inv(world) @ moves @ world
        turns = numerics.quaternion(new_basis[:, :3, :3] / self._old("scale")[:, None])
        return new_basis[:, :3, 3], rig.continuous(turns)

    def values(self, turns: numerics.NDArray, old: numerics.NDArray) -> numerics.Array:
        """Return the (s, k) values of the rotation's channels for (s, 4) quaternions.

        old: (s, k) values, which decide on the first of several and on lengths of no effect.
        """
        values = rig.rotation_values(
            numerics.rotation_matrix(turns), self.owner.rotation_mode, old[0]
        )
        if self.rotation != "rotation_euler":
            part = slice(-3, None) if self.rotation == "rotation_axis_angle" else slice(None)
            norms = np.linalg.norm(old[:, part], axis=1, keepdims=True)
            values[:, part] *= np.maximum(norms, LEAST_NORM)
        return values

    def _old(self, name: str) -> numerics.Array:
        """Return the (s, k) values of a channel at the times read."""
        return np.array([values[name] for _world, _basis, values in self.frames])

    def key(
        self, moves: numerics.NDArray, times: numerics.NDArray, turns: bool, as_layer: bool
    ) -> None:
        """Key (4, 4) moves at the nodes of frames, which begin and end at these times of F-curves.

        Frames have further keys between them if cubics would not follow the rotation.
        """
        armature = self.armature
        old = {name: self._old(name) for name in ("location", self.rotation)[: 1 + turns]}
        locations, quaternions = self.channel_values(moves)
        places = np.arange(len(times)).astype(np.float64)
        if turns:
            mode = self.owner.rotation_mode
            shortest = scene.fcurves.JUMP / (times[1] - times[0])
            places = rig.divide_frames(quaternions, mode, old[self.rotation][0], shortest)
        times = np.interp(places, np.arange(len(times)), times)
        channels = {}
        for name, before in old.items():
            scene.fcurves.ensure_keyed(armature, self.path(name), before[0], times[0], as_layer)
            before = rig.in_pieces(before, places)
            if name == "location":
                new = rig.in_pieces(locations, places)
            else:
                new = self.values(rig.in_pieces(quaternions, places), before)
            if as_layer and name == "rotation_quaternion":
                first, last = numerics.rotation_matrix(before), numerics.rotation_matrix(new)
                new = rig.continuous(numerics.quaternion(first.swapaxes(1, 2) @ last))
                new *= np.sign(new[0, 0])
            elif as_layer:
                new = new - before
            channels.update({(self.path(name), axis): values for axis, values in enumerate(new.T)})
        if as_layer:
            scene.strips.add_layer(armature, LAYER, times, channels)
            return
        for curve in scene.fcurves.ensure_curves(armature):
            values = channels.get((curve.data_path, curve.array_index))
            if values is not None:
                scene.fcurves.replace_section(curve, times, values)
