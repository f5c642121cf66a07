# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters over frames: their momenta, and keys that put them on a parabola or keep their spin.

The keys go to the carrier of the whole character: its root bone, or the armature object. A small
move is tried first, and every part must follow. So the pose stays as it is, and the center goes to
its intended place. Poses are sampled within the frames, too, as the curves pass between the keys.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from bpy.types import Context, Depsgraph, Object, Scene
from mathutils import Quaternion

from ....core import numerics, verdict
from ....core.rig import Parts, motion, spin
from ... import read, write
from ...scale import meters_per_unit
from ...scene import fcurves
from ..balance_group import BalanceGroup
from ..findings import NO_SUCH_NAME
from ..stored import balance_groups
from . import weight
from .carrier import FOLLOWS, Carrier

# the largest deviation in a flight, between frames, too, relative to the angular momentum; chosen
KEPT = 0.01
MOMENTUM = "body_balance_momentum"

NOT_CARRIED = (
    "No bone carries the whole character: “{part}” does not follow “{name}”. Choose the bone that "
    "all others hang on, or parent the targets of its constraints to one."
)
UNEVENLY_SCALED = (
    "“{name}” cannot turn: an uneven scale above it would shear it. Apply the scale of “{above}”."
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
    "Graph Editor, or keep the times."
)
NO_FLIGHT = (
    "“{name}” does not leave the ground and land again in frames {start} to {end}. Turn off Find "
    "by Contacts and type Take-off and Landing, or set Ground."
)
SPIN_LOST = (
    "Nothing was keyed: the keys would change the angular momentum of “{name}” by {off:percent}, "
    "most at frame {frame}. {advice:word}"
)
SMOOTH_KEYS = "Smooth the keys near this frame, or turn on Key Anyway."
TURN_BY_QUATERNION = (
    "Set its Rotation Mode to Quaternion, smooth the keys near this frame, or turn on Key Anyway."
)


class CharacterMotion(BalanceGroup):
    """A character that is followed over frames, on the ground that Show Weight shows or finds at
    the first of them.

    step: seconds a frame. mover: the carrier that `find_carrier` has found; carrier: its samples
    while one is followed, else the supports are found. first, last, landing: frames of take-off and
    landing, and the new frame of landing. before, after: numbers of frames around the flight in
    which it is blended in and out. momentum: (3,), to be kept.

    off: the largest distance of the center from its intended place after keying, in meters.
    deviation, worst: the largest deviation of the angular momentum, relative to it, and its frame.
    """

    def __init__(self, context: Context, frames: range):
        scene = context.scene
        armature = read.rig.require_armature(context.object)
        weight.require_gravity(scene)
        self.gravity = np.array(scene.gravity, np.float64)
        frame_before = scene.frame_current
        subframe = scene.frame_subframe
        scene.frame_set(frames[0])
        try:
            self._found_character = weight.find(context, armature)
        finally:
            scene.frame_set(frame_before, subframe=subframe)
        self.character, self.ground, _ = self._found_character
        self._context = context
        self.unit = meters_per_unit(scene)
        self.armature = armature
        self.frames = frames
        self.step = scene.render.fps_base / scene.render.fps
        self.objects = self.feet = [armature]
        self.carrier: Carrier | None = None
        self._forget()

    def _forget(self) -> None:
        """Forget the followed frames."""
        self.centers = []
        self.supports = []
        self._parts: list[Parts] = []

    def _add_frame(self, motion: object, depsgraph: Depsgraph) -> None:
        """Append the parts and their center, and the support or the carrier's frame. `motion` is
        not used, as a character keeps its own.
        """
        if self.carrier is None:
            parts, _contacts, support = self.character.stand(self.armature, depsgraph, self.ground)
            self.supports.append(support)
        else:
            parts = self.character.pose(self.armature, depsgraph)
            self.carrier.read(depsgraph)
        if self._parts and parts.names != self._parts[0].names:
            changed_names = set(parts.names).symmetric_difference(self._parts[0].names)
            raise write.reports.Refused(HELD_IN_PART, names=", ".join(sorted(changed_names)))
        self._parts.append(parts)
        self.centers.append(parts.center)

    @property
    def course(self) -> motion.Course:
        """The parts at the followed frames, in Blender's units."""
        centers, spreads = (
            np.array([getattr(frame_parts, name) for frame_parts in self._parts])
            for name in ("centers", "spreads")
        )
        linear = np.array([parts.matrices[:, :3, :3] for parts in self._parts])
        return motion.Course(self.step, self._parts[0].masses, centers, spreads, linear)

    @property
    def touching(self) -> numerics.Mask:
        """Mask (f,) of the frames in which the character touches the ground."""
        return np.array([support is not None for support in self.supports])

    def find_carrier(self, context: Context, name: str, turns: bool, as_layer: bool) -> None:
        """Find the carrier of all parts: the named bone, else the only root, else the object; raise
        Refused if there is none. turns: it has to turn them, too. as_layer: keys go to a layer, as
        they always do if there are strips.
        """
        self.is_layered = as_layer or fcurves.has_strips(self.armature)
        bones = self.armature.pose.bones
        part_left = ""
        if name and name not in bones:
            raise verdict.EditRefusedError(NO_SUCH_NAME, kind="bone", name=name)
        roots = {
            [bones[part_name], *bones[part_name].parent_recursive][-1].name
            for part_name in self.character.names
        }
        owners = (
            [bones[name]]
            if name
            else [*map(bones.get, roots if len(roots) == 1 else ()), self.armature]
        )
        for owner in owners:
            self.mover = Carrier(self.armature, owner)
            self.mover.require_free(turns)
            part_left = self.mover.left_behind(context, self.character, turns)
            if not part_left:
                return
        # The refusal is about the last owner that was tried, the object if no bone was named.
        if turns and (above := self.mover.uneven_parent) is not None:
            raise write.reports.Refused(UNEVENLY_SCALED, name=owners[-1].name, above=above.name)
        raise write.reports.Refused(NOT_CARRIED, part=part_left, name=owners[0].name)

    def find_flight(self, scene: Scene) -> Iterator[int]:
        """Follow all frames, and find take-off and landing of the flight at the current frame, else
        of the longest one.
        """
        yield from self.follow(scene, self.frames)
        touching = self.touching
        frames = self.frames
        # The followed frames may begin or end in the air; such flights are not whole.
        flights = [
            flight for flight in motion.find_flights(touching) if touching[list(flight)].all()
        ]
        if not flights:
            raise write.reports.Refused(
                NO_FLIGHT, name=self.armature.name, start=frames[0], end=frames[-1]
            )
        current = scene.frame_current
        first, last = max(
            flights,
            key=lambda flight: (frames[flight[0]] <= current < frames[flight[1]], np.ptp(flight)),
        )
        self.first, self.last = frames[first], frames[last]

    def follow_flight(
        self,
        scene: Scene,
        flight: tuple[int, int] | None,
        keep_height: bool,
        before: int,
        after: int,
    ) -> Iterator[int]:
        """Find a flight if none is given, and follow it at the original times of its poses.

        flight: frames of take-off and landing. keep_height: the flight lasts as long as its height
        demands, at least 2 frames. before, after: numbers of frames that are also followed.
        """
        if keep_height and self.is_layered:
            raise write.reports.Refused(LAYERED_TIMES)
        if flight is None:
            yield from self.find_flight(scene)
        else:
            self.first, self.last = flight
        count = self.last - self.first
        if keep_height:
            self._forget()
            yield from (0 for _ in self.follow(scene, range(self.first, self.last + 1)))
            fall = motion.frames_of_height(np.array(self.centers), self.step, self.gravity)
            count = max(2, round(fall))
        self.landing = self.first + count
        if self.landing != self.last:
            for curve in fcurves.existing_curves(self.armature):
                if any(not modifier.mute for modifier in curve.modifiers):
                    raise write.reports.Refused(MODIFIED_TIMES, curve=curve.data_path)
        self.before, self.after = before, after
        yield from self._sample(
            scene,
            [
                *range(self.first - before, self.first),
                *np.linspace(self.first, self.last, count + 1).tolist(),
                *range(self.last + 1, self.last + after + 1),
            ],
        )

    def _sample(self, scene: Scene, frames: Sequence[float]) -> Iterator[int]:
        """Follow the poses and the carrier at LAST f + 1 samples: the nodes of f frames, each of
        which begins at the last node of the one before. frames: (f + 1) times, also fractions.
        """
        self._forget()
        self.carrier = Carrier(self.armature, self.mover.owner)
        times = (
            np.array(frames[:-1])[:, None] + np.diff(frames)[:, None] * spin.NODES[:-1]
        ).ravel()
        # The samples count as the last frame of the progress.
        return (len(self.frames) for _ in self.follow(scene, [*times.tolist(), frames[-1]]))

    @property
    def _flight(self) -> slice:
        """The flight's rows of the samples, with both ends; the frames before and after are around
        it.
        """
        end = self.before + self.landing - self.first
        return slice(spin.LAST * self.before, spin.LAST * end + 1)

    def _carried(self) -> spin.CarriedParts:
        """Return the parts in flight, in the axes of the carrier."""
        course = self.course
        flight = self._flight
        arrays = (array[flight] for array in (course.centers, course.spreads, course.linear))
        section = motion.Course(self.step, course.masses, *arrays)
        assert self.carrier is not None
        return spin.CarriedParts.of_course(section, self.carrier.axes[flight])

    def _moves(self, turns: bool) -> numerics.Array:
        """Return (s, 4, 4) moves of the samples in the world: onto the arc between the ends, or
        turns about the center that keep the momentum in flight, and fade around the flight. Keep
        this momentum for `_check`.
        """
        centers = np.array(self.centers)
        moves = np.tile(np.eye(4), (len(centers), 1, 1))
        # times of the samples from the first one, in frames
        places = np.arange(len(centers) // spin.LAST)[:, None] + spin.NODES[:-1]
        places = np.append(places, len(centers) // spin.LAST)
        if not turns:
            shares = places / places[-1]
            arc = motion.ballistic_arc(
                centers[0], centers[-1], shares, self.step * places[-1], self.gravity
            )
            moves[:, :3, 3] = arc - centers
            return moves
        flight = self._flight
        parts = self._carried()
        self.momentum = parts.first_momentum
        by_node = parts.constant_spin(self.momentum) @ parts.axes.swapaxes(-1, -2)
        # The last node of a frame is the first of the next one.
        spun = np.concatenate([by_node[:, :-1].reshape(-1, 3, 3), by_node[-1:, -1]])
        # A turn about the momentum keeps it. So the turn about it that the poses at landing would
        # have to make up is shared with those at take-off, by the frames that they have for it.
        axis = self.momentum / max(float(np.linalg.norm(self.momentum)), np.finfo(float).tiny)
        share = self.before / (self.before + self.after)
        twist = numerics.quaternion(spun[-1])
        back = spin.rotation(-2.0 * share * np.arctan2(twist[1:] @ axis, twist[0]) * axis)
        moves[flight, :3, :3] = back @ spun
        for edge, rows, frames in (
            (flight.start, range(flight.start), self.before),
            (flight.stop - 1, range(flight.stop, len(moves)), self.after),
        ):
            edge_turn = Quaternion(numerics.quaternion(moves[edge, :3, :3]))
            for row in rows:
                # from 0 at the far end to 1 at the flight; the smoothstep has no slope at either
                nearness = 1.0 - abs(places[edge] - places[row]) / frames
                moves[row, :3, :3] = numerics.rotation_matrix(
                    Quaternion().slerp(edge_turn, nearness * nearness * (3.0 - 2.0 * nearness))
                )
        # about the center of each sample
        moves[:, :3, 3] = centers - np.einsum("fij,fj->fi", moves[:, :3, :3], centers)
        return moves

    def key(self, context: Context, turns: bool, anyway: bool = False) -> None:
        """Key the carrier for a constant spin or a parabola, and check it on the evaluated scene.

        Raise Refused, with all keys as before, if the angular momentum changes by more than 1%
        between any two frames, unless it shall be keyed anyway.
        """
        scene = context.scene
        moves = self._moves(turns)
        targets = np.einsum("fij,fj->fi", moves, np.insert(self.centers, 3, 1.0, axis=1))[:, :3]
        scale = fcurves.time_scale(scene)
        frames = range(self.first - self.before, self.landing + self.after + 1)
        restore = fcurves.backup(self.armature)
        assert self.carrier is not None
        with read.tracking.tracking_paused():
            try:
                if self.landing != self.last:
                    for curve in fcurves.ensure_curves(self.armature):
                        fcurves.stretch(
                            curve,
                            scale * self.first,
                            scale * self.last,
                            scale * (self.landing - self.last),
                        )
                self.carrier.key(moves, scale * np.array(frames), turns, self.is_layered)
                for _ in self._sample(scene, frames):
                    pass
                self._check(np.array(self.centers) - targets, turns)
                if self.is_lost and not anyway:
                    owner = self.mover.owner
                    is_quaternion = owner.rotation_mode == "QUATERNION"
                    raise write.reports.Refused(
                        SPIN_LOST,
                        name=owner.name,
                        off=self.deviation,
                        frame=round(self.worst, 1),
                        advice=SMOOTH_KEYS if is_quaternion else TURN_BY_QUATERNION,
                    )
            except BaseException:
                restore()
                raise
        weight.keep(self.armature, *self._found_character)
        self._retrace(context)

    def _check(self, off: numerics.NDArray, turns: bool) -> None:
        """Set `off`, and `deviation` and `worst` if the rotation is keyed.

        off: (s, 3) distances of the centers from their intended places, in Blender units. Only
        those at frames count, where keys are; below the carrier's tolerance they count as zero.
        """
        distance = float(np.linalg.norm(off[:: spin.LAST], axis=1).max())
        self.off = distance * self.unit if distance > FOLLOWS * self.character.size else 0.0
        self.deviation = self.worst = 0.0
        if turns:
            deviations = self._carried().deviations(self.momentum)
            frame, node = np.unravel_index(int(deviations.argmax()), deviations.shape)
            self.deviation = float(deviations.max())
            self.worst = float(self.first + frame + spin.NODES[node])

    @property
    def is_lost(self) -> bool:
        """True if the keys do not keep the angular momentum."""
        return self.deviation > KEPT

    def _retrace(self, context: Context) -> None:
        """Follow the new motion over the frames of the earlier path, if there is one, and replace
        the path and its curves.
        """
        empty = balance_groups.find(context.scene, self.objects)
        if empty is None:
            return
        self.carrier = None
        self._forget()
        if (path := balance_groups.path(empty)) is not None:
            ends = path.frames[[0, -1]] / fcurves.time_scale(context.scene)
            for _ in self.follow(context.scene, range(round(ends[0]), round(ends[1]) + 1)):
                pass
            self.bake(context, MOMENTUM in empty)

    def bake(self, context: Context, curves: bool) -> tuple[Object, int]:
        """Key the path on an empty, with curves of the momenta; return it and the number of
        unexplained spans.
        """
        weight.keep(self.armature, *self._found_character)
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
            # (f, 7), per mass: velocity, angular momentum and kinetic energy, and their rates
            now, change = motion.momenta(course, flights)
            mass = course.masses.sum()
            stands = [
                (np.nan, np.nan) if support is None else (support.margin, support.height)
                for support in self.supports
            ]
            margin, height = np.array(stands).T
            force = mass * change[:, :3]
            zero = motion.zero_moment_points(
                course.center, height, force, change[:, 3:6], mass * self.gravity
            )
            velocity = unit * now[:, :3]
            angular = unit**2 * now[:, 3:6]
            values = velocity, mass * velocity, angular, unit**2 * now[:, 6], unit * margin, zero
            # The first three descriptions are those of truth values.
            signals.update(zip(list(balance_groups.DESCRIPTIONS)[3:], values))
        start = self._frames[0]
        unexplained_spans = [
            (start + first, start + last, unit * impulse, unit**2 * twist)
            for first, last, impulse, twist in spans
        ]
        return self.store(context, signals, unexplained_spans), len(unexplained_spans)
