# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance Group: the center of mass of several objects over the frames, as an empty with keys and a path."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator

import bpy
import numpy as np
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Depsgraph, Event, Object, Operator
from numpy.typing import NDArray

from ...blender.bodies.assembly.assembly import measure_assembly
from ...blender.read.assembly import Member, MemberKind, members_of, settings_of
from ...blender.read.rig import is_skin_of
from ...blender.read.visibility import measurable
from ...blender.session.live.motion import Motion
from ...blender.session.stored import balance_groups, stability
from ...blender.settings.preferences import copy_defaults
from ...blender.write import reports
from ...core.numerics.float32 import shortest_decimal
from ...core.statics.support import Support, support_of_contacts
from ...core.verdict import internal_error
from ...core.verdict.finding import EditRefusedError, Finding, finding
from .. import selection
from ..findings import (
    BALANCE_GROUP_EMPTY_GROUP,
    BALANCE_GROUP_INSIDE,
    BALANCE_GROUP_MADE,
    BALANCE_GROUP_WITHOUT_CONTACTS,
    NO_SUCH_COLLECTION,
)
from ..modal import ModalSteps, redraw

REACH = 0.01  # contact with the ground within this distance, relative to the contact objects' extent


class OBJECT_OT_body_moments_balance_group(ModalSteps, Operator):
    """Follow the center of mass of several objects over the frame range."""

    bl_idname = "object.body_moments_balance_group"
    bl_label = "Balance Group"
    bl_description = (
        "Follow the common center of mass of the selected objects, of a collection, or of the meshes that the selected "
        "armatures deform, over the frame range. Adds an empty with keys, and draws the path"
    )
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = "Following the center of mass: {share:percent}. Esc to cancel"
    CANCELED = "Balance Group canceled; nothing was changed"
    _assembly: bpy.types.Collection | None = None  # the collection, where its mass is given
    _is_interactive = False  # its dialog has just been confirmed; False in a script, and from the redo panel

    collection: StringProperty(
        name="Collection",
        description="Collection whose objects are followed. If empty, the selected objects",
    )
    contacts: StringProperty(
        name="Contact Objects",
        description=(
            "Collection whose objects can touch the ground, such as feet. What of them is near the ground spans the "
            "support polygon. If empty, there is none"
        ),
    )
    ground: FloatProperty(
        name="Ground Height",
        description="Height of the ground, against gravity from the world origin",
        unit="LENGTH",
    )
    reach: FloatProperty(
        name="Contact Distance",
        description="What is that near to the ground touches it. 0 for 1% of the size of the contact objects",
        default=0.0,
        min=0.0,
        unit="LENGTH",
        precision=4,
    )
    use_scene_range: BoolProperty(
        name="Scene Range",
        description="Follow the frame range of the scene",
        default=True,
    )
    frame_start: IntProperty(name="Start", description="First frame", default=1)
    frame_end: IntProperty(name="End", description="Last frame", default=250)
    frame_step: IntProperty(name="Step", description="Frames from one key to the next", default=1, min=1)

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode not in {"OBJECT", "POSE"}:
            return reports.unavailable(cls, "Switch to Object Mode or Pose Mode")
        return True

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop_search(self, "collection", bpy.data, "collections")
        layout.prop_search(self, "contacts", bpy.data, "collections")
        if self.contacts:
            layout.prop(self, "ground")
            layout.prop(self, "reach")
        layout.prop(self, "use_scene_range")
        column = layout.column(align=True)
        column.active = not self.use_scene_range
        column.prop(self, "frame_start")
        column.prop(self, "frame_end")
        layout.prop(self, "frame_step")

    def invoke(self, context: Context, _event: Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        self._is_interactive = True
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: Context) -> set[str]:
        copy_defaults(context.scene)
        try:
            frames = self._begin(context)
        except EditRefusedError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        if self._is_interactive:
            self._is_interactive = False  # the redo panel executes this instance again, which must not become modal
            return self.start_modal(context, len(frames))
        return self.run_all_steps(context, len(frames))

    def _begin(self, context: Context) -> range:
        self._assembly = None
        self._objects = self._members(context)
        self._feet = (
            [obj for obj in self._collection(self.contacts).all_objects if measurable(obj)] if self.contacts else []
        )
        if self.contacts and not self._feet:
            raise EditRefusedError(BALANCE_GROUP_WITHOUT_CONTACTS, collection=self.contacts)
        scene = context.scene
        start, end = self.frame_start, self.frame_end
        if self.use_scene_range:
            start, end = scene.frame_start, scene.frame_end
        frames = range(start, max(start, end) + 1, self.frame_step)
        self._centers: list[NDArray] = []
        self._supports: list[Support | None] = []
        self._failure: Finding | None = None
        self._steps = self._follow(context, frames)
        self._frames = np.array(frames, np.float64)
        return frames

    def _collection(self, name: str) -> bpy.types.Collection:
        collection = bpy.data.collections.get(name)
        if collection is None:
            raise EditRefusedError(NO_SUCH_COLLECTION, collection=name)
        return collection

    def _members(self, context: Context) -> list[Object]:
        """Return the followed objects, by name."""
        if self.collection:
            depsgraph = context.evaluated_depsgraph_get()
            root = members_of(self._collection(self.collection), depsgraph)
            objects: Iterable[Object] = counted(root)
            self._assembly = root.data if has_given_mass(root) else None
        else:
            objects = context.view_layer.objects.selected
            if context.mode == "POSE":
                objects = [context.object]
        layer = set(context.view_layer.objects)
        members: dict[Object, None] = {}
        for obj in objects:
            several = deformed_by(obj, layer) if obj.type == "ARMATURE" else [obj]
            members.update(dict.fromkeys(one for one in several if one in layer and measurable(one)))
        if not members:
            raise EditRefusedError(BALANCE_GROUP_EMPTY_GROUP)
        return sorted(members, key=lambda obj: obj.name_full)

    def _follow(self, context: Context, frames: range) -> Generator[int, None, None]:
        """Each frame in turn; the scene is at the frame of before when it ends, however it ends."""
        scene = context.scene
        before, subframe = scene.frame_current, scene.frame_subframe
        motion = Motion(len(frames))
        try:
            for done, frame in enumerate(frames, 1):
                scene.frame_set(frame)
                try:
                    self._add_frame(motion, context.evaluated_depsgraph_get())
                except Exception as error:
                    self._failure = internal_error.finding_of(error)
                    return
                yield done
        finally:
            scene.frame_set(before, subframe=subframe)

    def _add_frame(self, motion: Motion, depsgraph: Depsgraph) -> None:
        center = self._center(motion, depsgraph)
        self._centers.append(center)
        self._supports.append(self._support(motion, depsgraph, center) if self._feet else None)

    def _center(self, motion: Motion, depsgraph: Depsgraph) -> NDArray[np.float64]:
        """Return the common center at this frame, in Blender's units."""
        if self._assembly is not None:
            body = measure_assembly(self._assembly, depsgraph).measurement.mass_properties
            return body.center / shortest_decimal(depsgraph.scene.unit_settings.scale_length)
        masses, centers = zip(*[motion.mass_and_center(obj, depsgraph) for obj in self._objects])
        return centers[0] + np.einsum("i,ij->j", np.array(masses) / np.sum(masses), np.array(centers) - centers[0])

    def _support(self, motion: Motion, depsgraph: Depsgraph, center: NDArray) -> Support | None:
        """Return the support of the contact objects at this frame, or None if they are all in the air."""
        down = stability.down(depsgraph.scene)
        points = np.concatenate([motion.hull_points(obj, depsgraph) for obj in self._feet])
        reach = self.reach or REACH * float(np.ptp(points, axis=0).max())
        touching = points[-points @ down <= self.ground + reach]
        return support_of_contacts(touching, center, down) if len(touching) else None

    def _finish(self, context: Context) -> set[str]:
        if self._failure is not None:
            selection.report(self, self._failure)
            return {"CANCELLED"}
        inside = None
        if self._feet:
            inside = np.array([support is not None and support.stands for support in self._supports])
        path = balance_groups.Path(self._frames, np.array(self._centers), inside)
        scene = context.scene
        empty = balance_groups.find(scene, self._objects)
        if empty is None:
            empty = bpy.data.objects.new("Balance", None)
            empty.empty_display_type, empty.show_in_front = "SPHERE", True
            empty.empty_display_size = 0.05 * float(np.ptp(path.centers, axis=0).max())
            empty[balance_groups.GROUP] = balance_groups.group_text(self._objects)
            scene.collection.objects.link(empty)
        balance_groups.store(empty, path, self._supports)
        context.view_layer.update()
        redraw(context)
        findings = [
            finding(BALANCE_GROUP_MADE, count=len(self._frames), objects_count=len(self._objects), empty=empty.name)
        ]
        if inside is not None:
            findings.append(finding(BALANCE_GROUP_INSIDE, count=int(inside.sum()), total=len(inside)))
        selection.report(self, *findings)
        return {"FINISHED"}


def counted(member: Member) -> Iterator[Object]:
    """Yield the objects of an assembly that count; of an instance, the instancer."""
    if member.is_measured or member.kind == MemberKind.INSTANCE:
        yield member.data
    if member.kind != MemberKind.INSTANCE:
        for below in member.members:
            yield from counted(below)


def has_given_mass(root: Member) -> bool:
    """Return whether the mass of an assembly, or of one in it, is given: then it is not the sum of its objects'."""
    kinds = (MemberKind.COLLECTION, MemberKind.EMPTY)
    return any(member.kind in kinds and settings_of(member.data).mass_from == "MASS" for member in root.walk())


def deformed_by(armature: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the objects that an armature deforms, and the ones that are parented to its bones."""
    return [obj for obj in objects if is_skin_of(obj, armature) or obj.parent == armature and obj.parent_type == "BONE"]


CLASSES = (OBJECT_OT_body_moments_balance_group,)
