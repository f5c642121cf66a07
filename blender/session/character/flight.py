# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters over frames: their momenta, and keys that put them on a parabola or keep their spin.

The keys go to the carrier of the whole character: its root bone, or the armature object. A small
move is tried first, and every part must follow. So the pose stays as it is, and the center goes to
its intended place.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from bpy.types import Context, Depsgraph, Object, PoseBone, Scene
from mathutils import Euler, Quaternion
from numpy.typing import NDArray

from ...core.bodies.reading import float64_matrix
from ...core.numerics.rotations import quaternion, rotation_matrix
from ...core.rig import motion
from ...core.verdict.finding import EditRefusedError
from ..read.rig import require_armature
from ..read.tracking import tracking_paused
from ..scale import meters_per_unit
from ..scene import fcurves
from ..scene.changes import require_editable
from ..scene.transforms import TransformChannels
from ..write.reports import Refused
from .balance_group import BalanceGroup
from .findings import NO_SUCH_NAME
from .live import character
from .live.character import Parts
from .stored import balance_groups

# of the character's size: a trial move, and the tolerance of the parts that follow
TRIAL = 1e-2
FOLLOWS = 1e-4
LAYER = "Body Moments"  # the name of the track and the strip
CHECKED = 16  # frames that are looked at again after the keys

NOT_FREE = (
    "“{name}” cannot be keyed: its {channel:word} is {state:word}. Free it, or choose another bone."
)
NOT_CARRIED = (
    "No bone carries the whole character: “{part}” does not follow “{name}”. Choose the bone that "
    "all others hang on, "
    "or parent the targets of its constraints to one."
)
HELD_IN_PART = (
    "“{names}” is held at some of the frames only. Choose frames at which the same objects are "
    "held."
)
LAYERED_TIMES = (
    "A layer cannot move the landing. Turn off As Layer and empty the NLA, or keep the times."
)
MODIFIED_TIMES = (
    "“{curve}” has F-curve modifiers, which cannot move with the landing. Bake its channel in the "
    "Graph Editor, or "
    "keep the times."
)
NO_FLIGHT = (
    "“{name}” does not leave the ground and land again in frames {start} to {end}. Turn off Find "
    "by Contacts and type "
    "Take-off and Landing, or set Ground."
)


class CharacterMotion(BalanceGroup):
    """A character that is followed over frames, on the ground that Show Weight shows or finds at
    the first of them.
    """

    def __init__(self, context: Context, frames: range):
        scene = context.scene
        armature = require_armature(context.object)
        character.require_gravity(scene)
        self.gravity = np.array(scene.gravity, np.float64)
        before = scene.frame_current
        subframe = scene.frame_subframe
        scene.frame_set(frames[0])
        try:
            self._found = self.known, self.ground, _rig = character.find(context, armature)
        finally:
            scene.frame_set(before, subframe=subframe)
        self._context = context
        self.unit = meters_per_unit(scene)
        self.armature, self.frames = armature, frames
        self.step = scene.render.fps_base / scene.render.fps
        self.objects, self.feet = [armature], [armature]
        self.centers, self.supports = [], []
        self.carrier: Carrier | None = None
        self._parts: list[Parts] = []

    def clear(self, rows: Sequence[int] = ()) -> None:
        """Forget all frames but those of some rows."""
        lists: list[list[Any]] = [self.centers, self.supports, self._parts]
        for kept in (*lists, [] if self.carrier is None else self.carrier.frames):
            kept[:] = [kept[row] for row in rows if kept]

    def _add_frame(self, motion: object, depsgraph: Depsgraph) -> None:
        parts, _contacts, support = self.known.stand(self.armature, depsgraph, self.ground)
        if self._parts and parts.names != self._parts[0].names:
            several = set(parts.names).symmetric_difference(self._parts[0].names)
            raise Refused(HELD_IN_PART, names=", ".join(sorted(several)))
        self._parts.append(parts)
        self.centers.append(parts.center)
        self.supports.append(support)
        if self.carrier is not None:
            self.carrier.read(depsgraph)

    @property
    def course(self) -> motion.Course:
        """The frames, in Blender's units."""
        centers, spreads = (
            np.array([getattr(one, name) for one in self._parts]) for name in ("centers", "spreads")
        )
        linear = np.array([parts.matrices[:, :3, :3] for parts in self._parts])
        return motion.Course(self.step, self._parts[0].masses, centers, spreads, linear)

    @property
    def touching(self) -> NDArray[np.bool_]:
        """Mask (f,) of the frames in which the character touches the ground."""
        return np.array([support is not None for support in self.supports])

    def find_carrier(self, context: Context, name: str, turns: bool, as_layer: bool) -> None:
        """Find the carrier of all parts: the named bone, else the root, else the object; Refused if
        there is none.
        """
        self.is_layered = as_layer or fcurves.has_strips(self.armature)
        bones = self.armature.pose.bones
        part = ""
        if name and name not in bones:
            raise EditRefusedError(NO_SUCH_NAME, kind="bone", name=name)
        roots = {
            [bones[known], *bones[known].parent_recursive][-1].name for known in self.known.names
        }
        owners = (
            [bones[name]]
            if name
            else [*map(bones.get, roots if len(roots) == 1 else ()), self.armature]
        )
        for owner in owners:
            self.carrier = Carrier(self.armature, owner)
            self.carrier.require_free(turns)
            part = self.carrier.left_behind(context, self.known, turns)
            if not part:
                return
        raise Refused(NOT_CARRIED, part=part, name=owners[0].name)

    def follow_flight(
        self,
        scene: Scene,
        flight: tuple[int, int] | None,
        keep_height: bool,
        before: int,
        after: int,
    ) -> Iterator[int]:
        """Find a flight if none is given, and follow it at the original times of its poses.

        keep_height: the flight lasts as long as its height demands. before, after: numbers of
        frames also followed.
        """
        if keep_height and self.is_layered:
            raise Refused(LAYERED_TIMES)
        frames = self.frames
        yield from self.follow(scene, frames)
        self.first, self.last = flight or self._find_flight(scene.frame_current)
        count = self.last - self.first
        rows = slice(self.first - frames[0], self.last - frames[0] + 1)
        if keep_height:
            count = max(
                2,
                round(
                    motion.frames_of_height(np.array(self.centers[rows]), self.step, self.gravity)
                ),
            )
        self.landing = self.first + count
        if self.landing != self.last:
            for curve in fcurves.existing_curves(self.armature):
                if any(not one.mute for one in curve.modifiers):
                    raise Refused(MODIFIED_TIMES, curve=curve.data_path)
        self.before, self.after = before, after
        self.times = [
            *range(self.first - before, self.first),
            *np.linspace(self.first, self.last, count + 1).tolist(),
        ]
        self.times += range(self.last + 1, self.last + after + 1)
        if set(self.times) <= set(frames):
            self.clear([round(time) - frames[0] for time in self.times])
        else:
            self.clear()
            yield from (len(frames) for _ in self.follow(scene, self.times))

    def _find_flight(self, current: int) -> tuple[int, int]:
        """Return take-off and landing of the flight at the current frame, else of the longest
        one.
        """
        touching, frames = self.touching, self.frames
        found = [flight for flight in motion.find_flights(touching) if touching[list(flight)].all()]
        if not found:
            raise Refused(NO_FLIGHT, name=self.armature.name, start=frames[0], end=frames[-1])
        first, last = max(
            found,
            key=lambda flight: (frames[flight[0]] <= current < frames[flight[1]], np.ptp(flight)),
        )
        return frames[first], frames[last]

    def _moves(self, turns: bool) -> NDArray[np.float64]:
        """Return (f, 4, 4) moves onto the arc between the ends, or turns of constant spin, blended
        around it.
        """
        centers = np.array(self.centers)
        moves = np.tile(np.eye(4), (len(self.centers), 1, 1))
        if not turns:
            arc = motion.ballistic_arc(
                centers[0], centers[-1], len(centers) - 1, self.step, self.gravity
            )
            moves[:, :3, 3] = arc - centers
            return moves
        first = self.before
        last = self.before + self.landing - self.first
        spins = motion.turns_of_constant_spin(
            self.course, first, last, first / (first + self.after)
        )
        rows = np.arange(len(centers))
        near = np.clip(rows, first, last)
        moves[:, :3, :3] = spins[near - first]
        for row in np.flatnonzero(rows != near):
            left = 1.0 - abs(row - near[row]) / (first if row < first else self.after)
            whole = Quaternion(quaternion(moves[row, :3, :3]))
            moves[row, :3, :3] = rotation_matrix(
                Quaternion().slerp(whole, left * left * (3.0 - 2.0 * left))
            )
        moves[:, :3, 3] = centers - np.einsum("fij,fj->fi", moves[:, :3, :3], centers)
        return moves

    def key(self, context: Context, turns: bool) -> float:
        """Key the carrier for a constant spin or a parabola.

        Return the remaining distance of the center from its intended place, in meters.
        """
        moves = self._moves(turns)
        carrier = self.carrier
        assert carrier is not None
        character.keep(self.armature, *self._found)
        targets = np.einsum("fij,fj->fi", moves, np.insert(self.centers, 3, 1.0, axis=1))[:, :3]
        if (
            empty := balance_groups.find(context.scene, self.objects)
        ) is not None:  # its path is of the earlier motion
            balance_groups.store(empty, np.zeros(0), np.zeros((0, 3)), {}, (), ())
        with tracking_paused():
            carrier.key(moves, self.times, turns, self.is_layered)
            self.clear()
            self.carrier = None
            places = np.unique(np.linspace(0, len(moves) - 1, CHECKED).astype(int))
            for _ in self.follow(context.scene, (self.first - self.before + places).tolist()):
                pass
        off = float(np.linalg.norm(self.centers - targets[places], axis=1).max())
        return off * self.unit if off > FOLLOWS * self.known.size else 0.0

    def bake(self, context: Context, curves: bool) -> tuple[Object, int]:
        """Key the path on an empty, with curves of the momenta; return it and the number of
        unexplained spans.
        """
        character.keep(self.armature, *self._found)
        course = self.course
        touching = self.touching
        unit = self.unit
        flights = motion.find_flights(touching)
        spans = motion.find_unexplained(course, flights, self.gravity)
        unexplained = np.zeros(len(touching), bool)
        for first, last, _impulse, _twist in spans:
            unexplained[first : last + 1] = True
        signals = {balance_groups.CONTACT: touching, balance_groups.UNEXPLAINED: unexplained}
        if curves:
            now, change = motion.momenta(course, flights)
            mass = course.masses.sum()
            stands = [
                (np.nan, np.nan) if one is None else (one.margin, one.height)
                for one in self.supports
            ]
            margin, height = np.array(stands).T
            force = mass * change[:, :3]
            torque = change[:, 3:6]
            zero = motion.zero_moment_points(
                course.center, height, force, torque, mass * self.gravity
            )
            velocity = unit * now[:, :3]
            angular = unit**2 * now[:, 3:6]
            energy = unit**2 * now[:, 6]
            values = velocity, mass * velocity, angular, energy, unit * margin, zero
            signals.update(zip(list(balance_groups.DESCRIPTIONS)[3:], values))
        start = self._frames[0]
        rows = [
            (start + span[0], start + span[1], unit * span[2], unit**2 * span[3]) for span in spans
        ]
        return self.store(context, signals, rows), len(rows)


@dataclass(eq=False)
class Carrier:
    """A root bone or an armature object whose location and rotation carry all parts of a character.

    frames: at each frame so far, its (4, 4) matrices in the world and of its channels, and the
    channels' values.
    """

    armature: Object
    owner: PoseBone | Object
    frames: list[tuple[NDArray, NDArray, dict[str, NDArray]]] = field(default_factory=list)

    @property
    def rotation(self) -> str:
        """The name of the rotation's channel."""
        kinds = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
        return kinds.get(self.owner.rotation_mode, "rotation_euler")

    @property
    def is_bone(self) -> bool:
        """True for a bone, False for the object."""
        return self.owner != self.armature

    def path(self, channel: str) -> str:
        """Return the data path of a channel from the armature object."""
        return self.owner.path_from_id(channel) if self.is_bone else channel

    def read(self, depsgraph: Depsgraph) -> None:
        """Add the frame that the depsgraph shows."""
        evaluated = self.armature.evaluated_get(depsgraph)
        owner = evaluated.pose.bones[self.owner.name] if self.is_bone else evaluated
        place = float64_matrix(evaluated.matrix_world)
        world = place @ float64_matrix(owner.matrix) if self.is_bone else place
        values = {
            name: np.array(getattr(owner, name), np.float64)
            for name in ("location", self.rotation, "scale")
        }
        self.frames.append((world, float64_matrix(owner.matrix_basis), values))

    def require_free(self, turns: bool) -> None:
        """Raise Refused unless keys on the channels have an effect and are allowed."""
        require_editable(self.armature)
        owner = self.owner
        animation = self.armature.animation_data
        for channel in ("location", "rotation")[: 1 + turns]:
            path = self.path("location" if channel == "location" else self.rotation)
            keyed = [
                curve for curve in fcurves.existing_curves(self.armature) if curve.data_path == path
            ]
            states = {
                "locked": any(getattr(owner, "lock_" + channel))
                or any(curve.lock for curve in keyed),
                "driven": animation is not None
                and any(driver.data_path == path for driver in animation.drivers),
                "constrained": any(
                    not one.mute and one.influence > 0.0 for one in owner.constraints
                ),
                "muted": any(curve.mute for curve in keyed),
                "being tweaked in the NLA editor": animation is not None
                and animation.use_tweak_mode,
                "changed by F-curve modifiers": any(
                    not one.mute for curve in keyed for one in curve.modifiers
                ),
                "keyed for several objects": bool(keyed) and fcurves.is_shared(self.armature),
                "changed by Delta Transforms": not self.is_bone and _has_deltas(owner),
            }
            for state, holds in states.items():
                if holds:
                    raise Refused(NOT_FREE, name=owner.name, channel=channel, state=state)

    def left_behind(self, context: Context, known: character.Character, turns: bool) -> str:
        """Try a small move at this frame; return the name of a part that does not follow, or ""."""
        depsgraph = context.evaluated_depsgraph_get()
        trial = Carrier(self.armature, self.owner)
        trial.read(depsgraph)
        before = known.pose(self.armature, depsgraph)
        move = np.eye(4)
        move[:3, 3] = TRIAL * known.size
        if turns:
            move[:3, :3] = rotation_matrix([1.0, TRIAL, TRIAL, TRIAL])
            move[:3, 3] += before.center - move[:3, :3] @ before.center
        stored = TransformChannels(self.owner)
        with tracking_paused():
            for name, values in trial.moved([move]).items():
                setattr(self.owner, name, values[0])
            context.view_layer.update()
            after = known.pose(self.armature, context.evaluated_depsgraph_get())
            stored.restore()
            context.view_layer.update()
        expected = move @ before.matrices
        units = [np.abs(expected[:, :3, :3]).max()] * 3 + [known.size]
        off = (np.abs(after.matrices - expected)[:, :3] / units).max(axis=(1, 2))
        return before.names[int(off.argmax())] if off.max() > FOLLOWS else ""

    def moved(self, moves: Sequence[NDArray] | NDArray) -> dict[str, NDArray]:
        """Return (f, k) values of the channels for a (4, 4) move in the world at each frame
        read.
        """
        values: dict[str, list] = {"location": [], self.rotation: []}
        mode = self.owner.rotation_mode
        last = None
        for move, (world, basis, old) in zip(moves, self.frames):
            wanted = basis @ np.linalg.inv(world) @ move @ world
            turn = Quaternion(quaternion(wanted[:3, :3] / old["scale"]))
            last = old[self.rotation] if last is None else last
            if self.rotation == "rotation_quaternion":
                new = np.array(turn) * (1.0 if np.dot(turn, last) >= 0.0 else -1.0)
            elif self.rotation == "rotation_euler":
                new = np.array(turn.to_euler(mode, Euler(last, mode)))
            else:
                axis, angle = turn.to_axis_angle()
                new = np.array([angle, *axis]) * (1.0 if np.dot(axis, last[1:]) >= 0.0 else -1.0)
            values["location"].append(wanted[:3, 3])
            values[self.rotation].append(new)
            last = new
        return {name: np.array(rows) for name, rows in values.items()}

    def key(self, moves: NDArray, times: Sequence[float], turns: bool, as_layer: bool) -> None:
        """Key (f, 4, 4) moves at whole frames from the first of (f,) times of poses on; later keys
        may move.
        """
        armature = self.armature
        first = round(times[0])
        last = round(times[-1])
        names = ("location", self.rotation)[: 1 + turns]
        values = self.moved(moves)
        curves = () if as_layer else fcurves.ensure_curves(armature)
        for name in names:
            if not fcurves.is_keyed(armature, self.path(name), values[name].shape[1]):
                self.owner.keyframe_insert(name, frame=first)
            if as_layer:
                old = [each[name] for _world, _basis, each in self.frames]
                pairs = zip(map(Quaternion, old), map(Quaternion, values[name]))
                is_turn = name == "rotation_quaternion"
                values[name] = (
                    np.array([a.inverted() @ b for a, b in pairs])
                    if is_turn
                    else values[name] - old
                )
        channels = {
            (self.path(name), axis): rows
            for name in names
            for axis, rows in enumerate(values[name].T)
        }
        if as_layer:
            fcurves.add_layer(armature, LAYER, first + np.arange(len(moves)), channels)
        is_retimed = list(times) != [*range(first, first + len(times))]
        for curve in curves:
            rows = channels.get((curve.data_path, curve.array_index))
            if rows is None and is_retimed:
                rows = np.array([curve.evaluate(time) for time in times])
            if rows is not None:
                fcurves.replace_section(curve, first, last, rows)


def _has_deltas(obj: Object) -> bool:
    """Return whether the delta transforms of an object change its location, rotation or scale."""
    turns = *obj.delta_rotation_euler, *obj.delta_rotation_quaternion[1:]
    return any((*obj.delta_location, *turns, *(factor != 1.0 for factor in obj.delta_scale)))
