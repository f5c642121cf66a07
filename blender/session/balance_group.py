# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The common center of mass of several objects over a range of frames, and the support below it."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from math import floor

import bpy
import numpy as np
from bpy.types import Collection, Context, Depsgraph, Object, Scene
from numpy.typing import NDArray

from ...core import numerics, statics
from ...core.verdict import EditRefusedError, MeasureError, internal_error
from .. import bodies, read, scale, write
from ..scene import fcurves, rigid_world
from . import findings, stored
from .live.motion import Motion

# Points up to this height touch the ground, relative to the extent of the contact objects; chosen.
REACH = 0.01

# members whose mass may be given in place of the sum of their own members' masses
SUMS = (read.assembly.MemberKind.COLLECTION, read.assembly.MemberKind.EMPTY)


class BalanceGroup:
    """Objects whose common center of mass is followed over a range of frames.

    collection, contacts: names of collections; "" follows the selection, or has no contacts.
    ground: its height in Blender units, against gravity from the world's origin. reach: points up
    to this height above the ground touch it, in Blender units; 0 for `REACH`.

    objects: the followed objects, sorted by name. feet: objects that may touch the ground. centers:
    a (3,) center in Blender units for each frame so far. supports: a support for each frame, None
    if nothing touches the ground.
    """

    def __init__(
        self, context: Context, collection: str, contacts: str, ground: float, reach: float
    ):
        self._context = context
        self._ground = ground
        self._reach = reach
        self._assembly: Collection | None = None  # the collection, if its mass is given
        self.objects = self._members(collection)
        self.feet = (
            [obj for obj in _collection(contacts).all_objects if read.visibility.measurable(obj)]
            if contacts
            else []
        )
        if contacts and not self.feet:
            raise EditRefusedError(findings.BALANCE_GROUP_EMPTY, place=[contacts])
        self.centers: list[NDArray] = []
        self.supports: list[statics.Support | None] = []

    def _members(self, collection: str) -> list[Object]:
        """Return the followed objects, sorted by name: armatures bring their meshes and the objects
        that are parented to their bones. Keep the collection in `_assembly` if a mass is given.
        """
        context = self._context
        if collection:
            root = read.assembly.members_of(
                _collection(collection), context.evaluated_depsgraph_get()
            )
            objects: Iterable[Object] = counted(root)
            has_given_masses = [
                read.assembly.settings_of(member.data).mass_from == "MASS"
                for member in root.walk()
                if member.kind in SUMS
            ]
            # The sum of the objects' masses would differ from a given mass.
            self._assembly = root.data if any(has_given_masses) else None
        else:
            objects = context.view_layer.objects.selected
            if context.mode == "POSE":
                objects = [context.object]
        layer = set(context.view_layer.objects)
        members: set[Object] = set()
        for obj in objects:
            members.add(obj)
            if obj.type == "ARMATURE":
                members |= {
                    layer_object
                    for layer_object in layer
                    if read.rig.is_skin_of(layer_object, obj)
                    or (layer_object.parent == obj and layer_object.parent_type == "BONE")
                }
        followed = [obj for obj in members & layer if read.visibility.measurable(obj)]
        if not followed:
            raise EditRefusedError(findings.BALANCE_GROUP_EMPTY, place="the selection")
        return sorted(followed, key=lambda obj: obj.name_full)

    def follow(self, scene: Scene, frames: Sequence[float]) -> Generator[int, None, None]:
        """Append the center and support of each frame, yield the number of finished frames, and
        restore the scene's frame at the end.
        """
        frame_before = scene.frame_current
        subframe = scene.frame_subframe
        motion = Motion(len(frames))
        self._frames = frames
        try:
            for finished, frame in enumerate(frames, 1):
                scene.frame_set(floor(frame), subframe=frame % 1.0)
                self._add_frame(motion, self._context.evaluated_depsgraph_get())
                yield finished
        except (MeasureError, write.reports.Refused):
            raise
        except Exception as error:
            raise MeasureError(internal_error.finding_of(error)) from error
        finally:
            scene.frame_set(frame_before, subframe=subframe)

    def _add_frame(self, motion: Motion, depsgraph: Depsgraph) -> None:
        """Append the center and the support at the frame that the depsgraph shows."""
        self.centers.append(self._center(motion, depsgraph))
        gravity = rigid_world.down(depsgraph.scene)
        touching = np.zeros((0, 3))
        if self.feet:
            points = np.concatenate([motion.hull_points(obj, depsgraph) for obj in self.feet])
            reach = self._reach or REACH * float(np.ptp(points, axis=0).max())
            _, touching, _ = statics.find_contacts(points, np.eye(4), gravity, self._ground, reach)
        self.supports.append(
            statics.support_of_contacts(touching, self.centers[-1], gravity)
            if len(touching)
            else None
        )

    def _center(self, motion: Motion, depsgraph: Depsgraph) -> numerics.Array:
        """Return the (3,) common center at this frame, in Blender's units."""
        if self._assembly is not None:
            body = bodies.assembly.measure.measure_assembly(
                self._assembly, depsgraph
            ).measurement.mass_properties
            return body.center / scale.meters_per_unit(depsgraph.scene)
        masses, centers = zip(*[motion.mass_and_center(obj, depsgraph) for obj in self.objects])
        # Offsets from the first center keep their digits far from the origin.
        return centers[0] + np.einsum(
            "i,ij->j", np.array(masses) / np.sum(masses), np.array(centers) - centers[0]
        )

    def store(
        self,
        context: Context,
        signals: Mapping[str, NDArray] | None = None,
        spans: Sequence[tuple[float, float, float, float]] = (),
    ) -> Object:
        """Store the path and whether the group stands as keys of the group's empty, which is added
        if there is none, and return the empty. signals, spans: as in `balance_groups.store`.
        """
        signals = dict(signals or {})
        centers = np.array(self.centers)
        if self.feet:
            stands = [support is not None and support.stands for support in self.supports]
            signals[stored.balance_groups.INSIDE] = np.array(stands)
        empty = stored.balance_groups.find(context.scene, self.objects)
        if empty is None:
            empty = bpy.data.objects.new("Balance", None)
            empty.empty_display_type = "SPHERE"
            empty.show_in_front = True
            # chosen: a twentieth of the path's extent
            empty.empty_display_size = 0.05 * float(np.ptp(centers, axis=0).max())
            empty[write.properties.BALANCE_GROUP] = stored.balance_groups.group_text(self.objects)
            context.scene.collection.objects.link(empty)
        stored.balance_groups.store(
            empty,
            np.array(self._frames, np.float64),
            fcurves.time_scale(context.scene),
            centers,
            signals,
            self.supports,
            spans,
        )
        context.view_layer.update()
        return empty


def _collection(name: str) -> Collection:
    collection = bpy.data.collections.get(name)
    if collection is None:
        raise EditRefusedError(findings.NO_SUCH_NAME, kind="collection", name=name)
    return collection


def counted(member: read.assembly.Member) -> Iterator[Object]:
    """Yield the objects of an assembly that count; an instanced collection counts as its
    instancer.
    """
    if member.is_measured or member.kind == read.assembly.MemberKind.INSTANCE:
        yield member.data
    if member.kind != read.assembly.MemberKind.INSTANCE:
        for below in member.members:
            yield from counted(below)
