# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bone or object whose channels carry all parts of a character, and its keys."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from bpy.types import Context, Depsgraph, Object, PoseBone

from ....core import bodies, numerics, rig
from ... import scene, write
from ...read.tracking import tracking_paused
from .weight import Character

# relative to the character's size: a trial move, and the tolerance of the parts that follow
TRIAL = 1e-2
FOLLOWS = 1e-4
# of quaternions and axes that keep the length of the earlier ones: chosen, far from zero
LEAST_NORM = 0.5
LAYER = "Body Moments"  # the name of the track and the strip

NOT_FREE = (
    "“{name}” cannot be keyed: its {channel:word} is {state:word}. Free it, or choose another bone."
)
SHARED = (
    "The action of “{name}” also animates {others}. Make it a single user in the Action Editor."
)


class _Frame(NamedTuple):
    """A carrier at a time: its (4, 4) matrices in the world and of its channels, and the channels'
    values by name.
    """

    world: numerics.NDArray
    basis: numerics.NDArray
    values: dict[str, numerics.NDArray]


@dataclass(eq=False)
class Carrier:
    """A root bone or an armature object whose location and rotation carry all parts of a character.

    frames: the carrier at each of the s times that were read.
    """

    armature: Object
    owner: PoseBone | Object
    frames: list[_Frame] = field(default_factory=list)

    @property
    def rotation(self) -> str:
        """The name of the rotation's channel."""
        kinds = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
        return kinds.get(self.owner.rotation_mode, "rotation_euler")

    @property
    def axes(self) -> numerics.Array:
        """(s, 3, 3) rotations of the carrier in the world; a mirrored carrier is turned over."""
        polar, _ = numerics.polar_rotation(np.array([frame.world for frame in self.frames]))
        return polar * np.sign(np.linalg.det(polar))[:, None, None]

    @property
    def uneven_parent(self) -> Object | None:
        """The nearest object above whose scale differs by direction, so that a turn shears the
        parts, if any.
        """
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
        self.frames.append(_Frame(world, bodies.float64_matrix(owner.matrix_basis), values))

    def require_free(self, turns: bool) -> None:
        """Raise Refused unless keys on the location, and with `turns` on the rotation, have an
        effect and are allowed.
        """
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
        keyed = [
            curve
            for curve in scene.fcurves.existing_curves(self.armature)
            if curve.data_path == path
        ]
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
            # The first component of a quaternion is 1 without a turn.
            turns = *owner.delta_rotation_euler, *owner.delta_rotation_quaternion[1:]
            is_scaled = any(factor != 1.0 for factor in owner.delta_scale)
            yield "changed by Delta Transforms", any((*owner.delta_location, *turns, is_scaled))

    def left_behind(self, context: Context, character: Character, turns: bool) -> str:
        """Try a small move at this frame, and undo it; return the name of the part that follows
        least, or "" if all follow.
        """
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
            locations, quaternions = trial.channel_values(move[None])
            self.owner.location = locations[0]
            values = trial.values(quaternions, trial._old(self.rotation))
            setattr(self.owner, self.rotation, values[0])
            context.view_layer.update()
            after = character.pose(self.armature, context.evaluated_depsgraph_get())
            stored.restore()
            context.view_layer.update()
        expected = move @ before.matrices
        # of the three columns of axes, and of the places
        units = [np.abs(expected[:, :3, :3]).max()] * 3 + [character.size]
        off = (np.abs(after.matrices - expected)[:, :3] / units).max(axis=(1, 2))
        return before.names[int(off.argmax())] if off.max() > FOLLOWS else ""

    def channel_values(self, moves: numerics.NDArray) -> tuple[numerics.Array, numerics.Array]:
        """Return the (s, 3) locations and (s, 4) continuous quaternions of the channels for
        (s, 4, 4) moves in the world, one for each time read.
        """
        world = np.array([frame.world for frame in self.frames])
        basis = np.array([frame.basis for frame in self.frames])
        # world = above @ basis, and above stays: moves @ world = above @ new_basis
        new_basis = basis @ np.linalg.inv(world) @ moves @ world
        turns = numerics.quaternion(new_basis[:, :3, :3] / self._old("scale")[:, None])
        return new_basis[:, :3, 3], rig.continuous(turns)

    def values(self, turns: numerics.NDArray, old: numerics.NDArray) -> numerics.Array:
        """Return the (s, k) values of the rotation's channels for (s, 4) quaternions.

        old: (s, k) earlier values. The first decides which of several equal rotations is keyed, and
        all decide on the lengths of quaternions and axes, which have no effect.
        """
        values = rig.rotation_values(
            numerics.rotation_matrix(turns), self.owner.rotation_mode, old[0]
        )
        if self.rotation != "rotation_euler":
            part = slice(-3, None) if self.rotation == "rotation_axis_angle" else slice(None)
            values[:, part] *= np.maximum(
                np.linalg.norm(old[:, part], axis=1, keepdims=True), LEAST_NORM
            )
        return values

    def _old(self, name: str) -> numerics.Array:
        """Return the (s, k) values of a channel at the times read."""
        return np.array([frame.values[name] for frame in self.frames])

    def key(
        self, moves: numerics.NDArray, times: numerics.NDArray, turns: bool, as_layer: bool
    ) -> None:
        """Key (s, 4, 4) moves at the nodes of f frames between (f + 1,) times of F-curves.

        turns: the rotation is keyed, too. as_layer: the keys go to a strip above the animation,
        which adds the difference. Frames are divided if cubics would not follow the rotation.
        """
        armature = self.armature
        old = {name: self._old(name) for name in ("location", self.rotation)[: 1 + turns]}
        locations, quaternions = self.channel_values(moves)
        places = np.arange(len(times)).astype(np.float64)  # places of the keys, in frames
        if turns:
            mode = self.owner.rotation_mode
            shortest = scene.fcurves.JUMP / (times[1] - times[0])
            places = rig.divide_frames(quaternions, mode, old[self.rotation][0], shortest)
        key_times = np.interp(places, np.arange(len(times)), times)
        channels = {}
        for name, sampled in old.items():
            scene.fcurves.ensure_keyed(armature, self.path(name), sampled[0], times[0], as_layer)
            before = rig.in_pieces(sampled, places)
            if name == "location":
                new = rig.in_pieces(locations, places)
            else:
                new = self.values(rig.in_pieces(quaternions, places), before)
            if as_layer and name == "rotation_quaternion":
                # Strips multiply quaternions; the first is made the nearest to no turn.
                first, last = numerics.rotation_matrix(before), numerics.rotation_matrix(new)
                new = rig.continuous(numerics.quaternion(first.swapaxes(1, 2) @ last))
                new *= np.sign(new[0, 0])
            elif as_layer:
                new = new - before
            channels.update({(self.path(name), axis): values for axis, values in enumerate(new.T)})
        if as_layer:
            scene.strips.add_layer(armature, LAYER, key_times, channels)
            return
        for curve in scene.fcurves.ensure_curves(armature):
            values = channels.get((curve.data_path, curve.array_index))
            if values is not None:
                scene.fcurves.replace_section(curve, key_times, values)
