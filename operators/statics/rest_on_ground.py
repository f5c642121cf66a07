# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rest on Ground: turn an object the least so that it lies on the ground in a stable pose."""

from math import degrees

from bpy.props import EnumProperty, IntProperty
from bpy.types import Context, Object, Operator

from ...blender import session
from ...blender.session import stored
from ...blender.write import reports
from ...blender.write.translations import localized
from ...core.verdict.finding import Finding
from .. import selection


class OBJECT_OT_body_moments_rest_on_ground(selection.OnSelectionInObjectMode, Operator):
    """Lay the selected objects on the ground in a pose in which they stay."""

    bl_idname = "object.body_moments_rest_on_ground"
    bl_label = "Rest on Ground"
    bl_description = (
        "Lay the selected objects on the ground in a stable pose, the likeliest or another one. They turn by the "
        "smallest angle about the center of mass, which stays above the same point"
    )
    bl_options = {"REGISTER", "UNDO"}

    pose: IntProperty(
        name="Pose",
        description="Stable pose, the likeliest first. 0 for the one that is reached by the smallest turn",
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
            share, angle = 100.0 * poses.shares[place], degrees(poses.tipping_angles[place])
            layout.label(text=text.format(place + 1, count, share, angle), translate=False)
        layout.prop(self, "ground")

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        notes: list[str] = []

        def lay(obj: Object) -> bool:
            return session.lay_on_ground(context, obj, self.pose, self.ground, notes)

        moved, failures = selection.apply_to_all(objects, lay)  # one after the other, for a child moves with its parent
        session.remeasure(context, moved)
        texts = ("Laid {count} object on the ground", "Laid {count} objects on the ground")
        done, idle = reports.phrase(*texts, count=len(moved)), reports.phrase("already on the ground")
        return selection.summarize(self, len(moved), len(objects), done, failures, notes, idle)


CLASSES = (OBJECT_OT_body_moments_rest_on_ground,)
