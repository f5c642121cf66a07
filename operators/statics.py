# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability of objects, their resting poses, and the balance of groups over time."""

from functools import partial
from math import degrees

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Object, Operator

from ..blender import session, write
from ..core.verdict import Finding, finding
from . import findings, modal, selection


class OBJECT_OT_body_moments_stability(selection.OnSelection, Operator):
    """Compute whether the selected objects stand on the ground below them, how far the ground can
    be tilted, and in which poses they rest. Objects are measured where their results are out of
    date
    """

    bl_label = "Check Stability"

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        measured: list[Object] = []
        notes: list[Finding | str] = []

        def check(obj: Object) -> None:
            notes.extend(session.check_stability(context, obj, measured))

        checked, failures = selection.apply_to_all(objects, check)
        session.tracking.staleness.mark_up_to_date(context, measured)
        supports = {obj: session.stored.stability.support(obj, context.scene) for obj in objects}
        standing = [
            obj for obj, support in supports.items() if support is not None and support.stands
        ]
        falling = [
            obj.name for obj in objects if obj in session.memory.hulls and obj not in standing
        ]
        if falling:
            notes.insert(0, finding(findings.OBJECTS_TIP, count=len(falling), names=falling))
        summary = write.reports.phrase(
            "{count} of {total} object stands",
            "{count} of {total} objects stand",
            count=len(standing),
            total=len(checked),
        )
        return selection.summarize(self, len(checked), len(objects), summary, failures, notes)


class OBJECT_OT_body_moments_rest_on_ground(selection.OnSelectionInObjectMode, Operator):
    """Lay the selected objects on the ground in a stable pose, the likeliest or another one. They
    turn by the smallest angle about the center of mass, which stays above the same point
    """

    bl_label = "Rest on Ground"

    pose: IntProperty(
        name="Pose",
        description="Stable pose, the likeliest first. 0 for the one that is reached by the "
        "smallest turn",
        default=1,
        min=0,
        soft_max=12,
    )
    ground: EnumProperty(
        name="Ground",
        description="Height of the ground",
        items=(
            ("FLOOR", "Floor", "The world origin, the floor of the viewport"),
            ("CURSOR", "3D Cursor", "The 3D cursor"),
            ("LOWEST", "Lowest Point", "The lowest point of each object as it is"),
        ),
        default="FLOOR",
    )

    def draw(self, context: Context) -> None:
        layout = selection.draw_properties(self, "pose")
        obj = session.selected.subject(context)
        poses = None if obj is None else session.stored.stability.poses(obj, context.scene)
        if self.pose and poses is not None and not isinstance(poses, Finding):
            count = len(poses.shares)
            place = (self.pose - 1) % count  # as for the operator, poses begin again after the last
            text = write.translations.localized("Pose {:d} of {:d}: {:.1f}%, tips at {:.1f}°")
            share = 100.0 * poses.shares[place]
            angle = degrees(poses.tipping_angles[place])
            layout.label(text=text.format(place + 1, count, share, angle), translate=False)
        layout.prop(self, "ground")

    def execute(self, context: Context) -> set[str]:
        notes: list[str] = []
        return selection.change_all(
            self,
            selection.selected_measurable(context),
            lambda obj: session.lay_on_ground(context, obj, self.pose, self.ground, notes),
            ("Laid {count} object on the ground", "Laid {count} objects on the ground"),
            "already on the ground",
            notes,
            then=partial(session.remeasure, context),
        )


class OBJECT_OT_body_moments_balance_group(modal.ModalDialog, Operator):
    """Follow the common center of mass of the selected objects, of a collection, or of the meshes
    that the selected armatures deform, over the frame range. Adds an empty with keys, and draws the
    path
    """

    bl_label = "Follow Center"

    collection: StringProperty(
        name="Collection",
        description="Collection whose objects are followed. If empty, the selected objects",
    )
    contacts: StringProperty(
        name="Contact Objects",
        description=(
            "Collection whose objects can touch the ground, such as feet. What of them is near the "
            "ground spans the "
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
        description="Points that are no higher above the ground touch it. 0 for 1% of the size of "
        "the contact objects",
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
    frame_step: IntProperty(
        name="Step", description="Frames from one key to the next", default=1, min=1
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return context.mode in {"OBJECT", "POSE"} or write.reports.unavailable(
            cls, "Switch to Object Mode or Pose Mode"
        )

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

    def _begin(self, context: Context) -> int:
        scene = context.scene
        stated_range = (self.frame_start, max(self.frame_start, self.frame_end))
        first, last = (scene.frame_start, scene.frame_end) if self.use_scene_range else stated_range
        frames = range(first, last + 1, self.frame_step)
        self._group = session.BalanceGroup(
            context, self.collection, self.contacts, self.ground, self.reach
        )
        self._steps = self._group.follow(scene, frames)
        return len(frames)

    def _finish(self, context: Context) -> set[str]:
        group = self._group
        empty = group.store(context)
        texts = [
            write.reports.phrase(
                "“{empty}” has {count} key of the center of mass; objects: {objects_count}",
                "“{empty}” has {count} keys of the center of mass; objects: {objects_count}",
                empty=empty.name,
                count=len(group.centers),
                objects_count=len(group.objects),
            )
        ]
        if group.feet:
            inside = sum(support is not None and support.stands for support in group.supports)
            texts.append(
                write.reports.phrase(
                    "It is over the support polygon at {count} of {total} frames",
                    count=inside,
                    total=len(group.supports),
                )
            )
        return selection.report(self, *texts)
