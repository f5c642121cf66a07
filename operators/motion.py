# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters over frames: keys on a parabola or of a constant spin, curves of momenta, the path."""

from contextlib import suppress
from time import perf_counter

from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator, Scene, UILayout

from ..blender import session, write
from ..core.verdict import MeasureError, Severity
from . import modal, rig, selection

EMPTY_FLIGHT = "Landing must be at least two frames after Take-off. Change one of them."
LOOK_SECONDS = 2.0  # for the flight that the dialog shows; a longer search waits until it is closed


def _scene_frames(scene: Scene) -> range:
    """Return the frames that are played."""
    if scene.use_preview_range:
        return range(scene.frame_preview_start, scene.frame_preview_end + 1)
    return range(scene.frame_start, scene.frame_end + 1)


class KeyedFlight(modal.ModalDialog, rig.OnArmature):
    """Base of operators that key a character between take-off and landing."""

    TURNS = False
    DONE = ""
    OWN: tuple[str, ...] = ()  # properties that only a subclass has
    layout: UILayout
    # values in subclasses without these properties
    lead = 0
    blend = 0
    keep = "TIMES"
    anyway = False
    _is_found = False  # True if take-off and landing are those by contacts

    use_contacts: BoolProperty(
        name="Find by Contacts",
        description=(
            "Find take-off and landing by the contacts with the ground: of the flight at the "
            "current frame, or the longest one"
        ),
        default=True,
    )
    take_off: IntProperty(name="Take-off", description="Last frame on the ground", default=1)
    landing: IntProperty(name="Landing", description="First frame on the ground again", default=24)
    bone: StringProperty(
        name="Bone",
        description=(
            "Bone that carries the whole character. If empty, its root, or the armature object"
        ),
    )
    use_layer: BoolProperty(
        name="As Layer",
        description=(
            "Put the keys into a strip of the NLA that is combined with the action, which becomes "
            "a strip, too"
        ),
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        if context.window is not None:
            self._is_found = False
            with suppress(MeasureError, write.reports.Refused):  # reported when the keys are made
                self._look(context)
        return super().invoke(context, event)

    def _look(self, context: Context) -> None:
        """Find the flight for the dialog, if that does not take long."""
        followed = session.CharacterMotion(context, _scene_frames(context.scene))
        steps = followed.find_flight(context.scene)
        start = perf_counter()
        for _ in steps:
            if perf_counter() - start > LOOK_SECONDS:
                steps.close()
                return
        self._show_found(followed)

    def _show_found(self, followed: "session.CharacterMotion") -> None:
        self.take_off = followed.first
        self.landing = followed.last
        self._is_found = True

    def draw(self, context: Context) -> None:
        layout = selection.draw_properties(self, "use_contacts")
        column = layout.column(align=True)
        column.enabled = not self.use_contacts
        if self._is_found or not self.use_contacts:
            column.prop(self, "take_off")
            column.prop(self, "landing")
        else:
            column.label(text="Take-off and landing are found afterwards")
        layout.prop_search(self, "bone", context.object.pose, "bones", icon="BONE_DATA")
        layout.prop(self, "use_layer")
        for name in self.OWN:
            layout.prop(self, name)

    def _begin(self, context: Context) -> int:
        frames = _scene_frames(context.scene)
        flight = None
        if not self.use_contacts:
            flight = self.take_off, self.landing
            if self.landing < self.take_off + 2:  # no frame between them could be keyed
                raise write.reports.Refused(EMPTY_FLIGHT)
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
        self._show_found(followed)  # for the redo panel
        followed.key(context, self.TURNS, self.anyway)
        values = {"name": followed.armature.name, "start": followed.first, "end": followed.landing}
        texts = [write.reports.phrase(self.DONE, off=followed.deviation, **values)]
        level = Severity.NOTE
        if followed.landing != followed.last:
            text = "The landing moves from frame {old} to {new}, as the fall takes {count} frames"
            values = {
                "old": followed.last,
                "new": followed.landing,
                "count": followed.landing - followed.first,
            }
            texts.append(write.reports.phrase(text, **values))
        if followed.off > 0.0:
            texts.append(
                write.reports.phrase(
                    "The center is off by up to {off}: constraints hold parts in the world",
                    off=write.reports.distance(followed.off),
                )
            )
            level = Severity.WARNING
        if followed.is_lost:
            texts.append(
                write.reports.phrase(
                    "The momentum changes by more than 1%, most at frame {frame}",
                    frame=round(followed.worst, 1),
                )
            )
            level = Severity.WARNING
        return selection.report(self, *texts, level=level)


class POSE_OT_body_moments_parabola(KeyedFlight, Operator):
    """Key the root for a free fall of the center of mass from take-off to landing; poses stay"""

    bl_label = "Put on Parabola"
    DONE = "The center of “{name}” falls freely from frame {start} to {end}"
    OWN = ("keep",)

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

    bl_label = "Keep Spin"
    DONE = "“{name}” keeps its angular momentum within {off:percent} from frame {start} to {end}"
    TURNS = True
    OWN = ("lead", "blend", "anyway")

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
    anyway: BoolProperty(
        name="Key Anyway",
        description="Keep the keys even if the angular momentum changes by more than 1%",
    )


class KeyedPath(modal.ModalSteps, rig.OnArmature):
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
        return selection.report(
            self,
            write.reports.phrase(
                "Keys of the center of mass on “{empty}”: {count}. Spans with momentum from "
                "nothing: {spans}",
                empty=empty.name,
                count=len(followed.centers),
                spans=spans,
            ),
        )


class POSE_OT_body_moments_bake_curves(KeyedPath, Operator):
    """Key the character's momentum and balance on an empty, and list momentum from nothing"""

    bl_label = "Bake Curves"
    CURVES = True


class POSE_OT_body_moments_trace(KeyedPath, Operator):
    """Key the path of the center of mass on an empty, and draw it beside the arcs of free fall"""

    bl_label = "Trace"
