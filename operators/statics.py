# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability of objects, their resting poses, and the balance of groups over time."""

from math import degrees

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Object, Operator, Scene

from ..blender import session
from ..blender.session import stored
from ..blender.session.tracking import staleness
from ..blender.write import reports
from ..blender.write.translations import localized
from ..core.verdict.finding import Finding, Severity, finding
from . import selection
from .findings import OBJECTS_TIP
from .modal import ModalDialog, ModalSteps
from .rig import OnArmature

EMPTY_FLIGHT = "Landing must be at least two frames after Take-off. Change one of them."


class OBJECT_OT_body_moments_stability(selection.OnSelection, Operator):
    """Compute whether the selected objects stand on the ground, and in which poses they rest."""

    bl_idname = "object.body_moments_stability"
    bl_label = "Check Stability"
    bl_description = (
        "Compute whether the selected objects stand on the ground below them, how far the ground "
        "can be tilted, and in "
        "which poses they rest. Objects are measured where their results are out of date"
    )

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        measured: list[Object] = []
        notes: list[Finding | str] = []

        def check(obj: Object) -> None:
            notes.extend(session.check_stability(context, obj, measured))

        known, failures = selection.apply_to_all(objects, check)
        staleness.mark_up_to_date(context, measured)
        supports = {obj: stored.stability.support(obj, context.scene) for obj in objects}
        standing = [
            obj for obj, support in supports.items() if support is not None and support.stands
        ]
        falling = [
            obj.name for obj in objects if stored.stability.is_known(obj) and obj not in standing
        ]
        if falling:
            notes.insert(0, finding(OBJECTS_TIP, count=len(falling), names=falling))
        texts = ("{count} of {total} object stands", "{count} of {total} objects stand")
        done = reports.phrase(*texts, count=len(standing), total=len(known))
        return selection.summarize(self, len(known), len(objects), done, failures, notes)


class OBJECT_OT_body_moments_rest_on_ground(selection.OnSelectionInObjectMode, Operator):
    """Lay the selected objects on the ground in a pose in which they stay."""

    bl_idname = "object.body_moments_rest_on_ground"
    bl_label = "Rest on Ground"
    bl_description = (
        "Lay the selected objects on the ground in a stable pose, the likeliest or another one. "
        "They turn by the "
        "smallest angle about the center of mass, which stays above the same point"
    )

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
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "pose")
        poses = stored.stability.poses(context.object) if context.object is not None else None
        if self.pose and poses is not None and not isinstance(poses, Finding):
            count = len(poses.shares)
            place = (self.pose - 1) % count
            text = localized("Pose {:d} of {:d}: {:.1f}%, tips at {:.1f}°")
            share = 100.0 * poses.shares[place]
            angle = degrees(poses.tipping_angles[place])
            layout.label(text=text.format(place + 1, count, share, angle), translate=False)
        layout.prop(self, "ground")

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        notes: list[str] = []

        def lay(obj: Object) -> bool:
            return session.lay_on_ground(context, obj, self.pose, self.ground, notes)

        moved, failures = selection.apply_to_all(
            objects, lay
        )  # one after the other, for a child moves with its parent
        session.remeasure(context, moved)
        texts = ("Laid {count} object on the ground", "Laid {count} objects on the ground")
        done = reports.phrase(*texts, count=len(moved))
        idle = reports.phrase("already on the ground")
        return selection.summarize(self, len(moved), len(objects), done, failures, notes, idle)


class OBJECT_OT_body_moments_balance_group(ModalDialog, Operator):
    """Follow the center of mass of several objects over the frame range."""

    bl_idname = "object.body_moments_balance_group"
    bl_label = "Balance Group"
    bl_description = (
        "Follow the common center of mass of the selected objects, of a collection, or of the "
        "meshes that the selected "
        "armatures deform, over the frame range. Adds an empty with keys, and draws the path"
    )

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
        return context.mode in {"OBJECT", "POSE"} or reports.unavailable(
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
        own = (self.frame_start, max(self.frame_start, self.frame_end))
        first, last = (scene.frame_start, scene.frame_end) if self.use_scene_range else own
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
            reports.phrase(
                "“{empty}” has {count} key of the center of mass; objects: {objects_count}",
                "“{empty}” has {count} keys of the center of mass; objects: {objects_count}",
                empty=empty.name,
                count=len(group.centers),
                objects_count=len(group.objects),
            )
        ]
        if group.feet:
            inside = sum(support is not None and support.stands for support in group.supports)
            text = "It is over the support polygon at {count} of {total} frames"
            texts.append(reports.phrase(text, count=inside, total=len(group.supports)))
        return selection.report(self, *texts)


def _scene_frames(scene: Scene) -> range:
    """Return the frames that are played."""
    if scene.use_preview_range:
        return range(scene.frame_preview_start, scene.frame_preview_end + 1)
    return range(scene.frame_start, scene.frame_end + 1)


class KeyedFlight(ModalDialog, OnArmature):
    """Base of operators that key a character between take-off and landing."""

    TURNS = False
    DONE = ""
    # properties of subclasses
    lead = 0
    blend = 0
    keep = "TIMES"

    use_contacts: BoolProperty(
        name="Find by Contacts",
        description=(
            "Find take-off and landing by the contacts with the ground: of the flight at the "
            "current frame, or the "
            "longest one"
        ),
        default=True,
    )
    take_off: IntProperty(name="Take-off", description="Last frame on the ground", default=1)
    landing: IntProperty(name="Landing", description="First frame on the ground again", default=24)
    bone: StringProperty(
        name="Bone",
        description="Bone that carries the whole character. If empty, its root, or the armature "
        "object",
        search=lambda _self, context, _text: [bone.name for bone in context.object.pose.bones],
    )
    use_layer: BoolProperty(
        name="As Layer",
        description="Put the keys into a strip of the NLA that is combined with the action, which "
        "becomes a strip, too",
    )

    def _begin(self, context: Context) -> int:
        frames = _scene_frames(context.scene)
        flight = None
        if not self.use_contacts:
            flight = self.take_off, self.landing
            if self.landing < self.take_off + 2:
                raise reports.Refused(EMPTY_FLIGHT)
            frames = range(self.take_off - self.lead, self.landing + self.blend + 1)
        followed = session.CharacterMotion(context, frames)
        followed.find_carrier(context, self.bone, self.TURNS, self.use_layer)
        self._steps = followed.follow_flight(
            context.scene, flight, self.keep == "HEIGHT", self.lead, self.blend
        )
        self._followed = followed
        return len(frames)

    def _finish(self, context: Context) -> set[str]:
        followed = self._followed
        off = followed.key(context, self.TURNS)
        texts = [
            reports.phrase(
                self.DONE, name=followed.armature.name, start=followed.first, end=followed.last
            )
        ]
        if followed.landing != followed.last:
            text = "The landing moves from frame {old} to {new}, as the fall takes {count} frames"
            values = {
                "old": followed.last,
                "new": followed.landing,
                "count": followed.landing - followed.first,
            }
            texts.append(reports.phrase(text, **values))
        if off > 0.0:
            text = "The center is off by up to {off:length}: constraints hold parts in the world"
            texts.append(reports.phrase(text, off=off))
        return selection.report(
            self, *texts, level=Severity.WARNING if off > 0.0 else Severity.NOTE
        )


class POSE_OT_body_moments_parabola(KeyedFlight, Operator):
    """Key the root for a free fall of the center of mass from take-off to landing; poses stay"""

    bl_idname = "pose.body_moments_parabola"
    bl_label = "Put on Parabola"
    DONE = "The center of “{name}” falls freely from frame {start} to {end}"

    keep: EnumProperty(
        name="Keep",
        description="What stays as it is",
        items=(
            ("TIMES", "Times", "Take-off and landing stay at their frames, and the height changes"),
            (
                "HEIGHT",
                "Height",
                "The center rises as high as before; the landing and all later keys move",
            ),
        ),
        default="TIMES",
    )


class POSE_OT_body_moments_keep_spin(KeyedFlight, Operator):
    """Turn the root so that angular momentum stays that of take-off: a tucked body spins faster"""

    bl_idname = "pose.body_moments_keep_spin"
    bl_label = "Keep Spin"
    DONE = "“{name}” keeps its angular momentum from frame {start} to {end}"
    TURNS = True

    lead: IntProperty(
        name="Lead",
        description=(
            "Frames before take-off over which the character turns already, so that less is left "
            "after the landing. "
            "If 0, the turn begins at take-off"
        ),
        default=8,
        min=0,
    )
    blend: IntProperty(
        name="Blend",
        description="Frames after the landing over which the turn goes back",
        default=8,
        min=1,
    )


class KeyedPath(ModalSteps, OnArmature):
    """Base of operators that key the path of a character's center on an empty."""

    CURVES = False

    def _begin(self, context: Context) -> int:
        frames = _scene_frames(context.scene)
        self._followed = session.CharacterMotion(context, frames)
        self._steps = self._followed.follow(context.scene, frames)
        return len(frames)

    def _finish(self, context: Context) -> set[str]:
        followed = self._followed
        empty, spans = followed.bake(context, self.CURVES)
        text = (
            "Keys of the center of mass on “{empty}”: {count}. Spans with momentum from nothing: "
            "{spans}"
        )
        return selection.report(
            self, reports.phrase(text, empty=empty.name, count=len(followed.centers), spans=spans)
        )


class POSE_OT_body_moments_bake_curves(KeyedPath, Operator):
    """Key the character's momentum and balance on an empty, and list momentum from nothing"""

    bl_idname = "pose.body_moments_bake_curves"
    bl_label = "Bake Curves"
    CURVES = True


class POSE_OT_body_moments_trace(KeyedPath, Operator):
    """Key the path of the center of mass on an empty, and draw it beside the arcs of free fall"""

    bl_idname = "pose.body_moments_trace"
    bl_label = "Trace"


CLASSES = (
    OBJECT_OT_body_moments_stability,
    OBJECT_OT_body_moments_rest_on_ground,
    OBJECT_OT_body_moments_balance_group,
    POSE_OT_body_moments_parabola,
    POSE_OT_body_moments_keep_spin,
    POSE_OT_body_moments_bake_curves,
    POSE_OT_body_moments_trace,
)
