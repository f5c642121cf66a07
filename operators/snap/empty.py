# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Add Empty at the Principal Frame: something to parent, constrain and look at."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty
from bpy.types import Context, Operator

from ...blender import scene
from ...blender.write import reports
from .. import selection


class OBJECT_OT_body_moments_add_empty(selection.OnSelectionInObjectMode, Operator):
    """Add an empty at the center of mass, along the principal axes."""

    bl_idname = "object.body_moments_add_empty"
    bl_label = "Add Empty at Principal Frame"
    bl_description = (
        "Add an empty at the center of mass, along the principal axes, with arrows as long as the largest radius of "
        "gyration. An empty added before is moved"
    )

    parent: BoolProperty(
        name="Parent to Object",
        description="Parent the empty to the object, so that it moves along",
        default=True,
    )

    display: EnumProperty(
        name="Display As",
        description="How a new empty is drawn",
        items=(
            ("ARROWS", "Arrows", "Arrows along the principal axes"),
            ("PLAIN_AXES", "Plain Axes", "Lines along the principal axes"),
            ("SPHERE", "Sphere", "Sphere around the center of mass"),
            ("CUBE", "Cube", "Cube along the principal axes"),
        ),
    )
    size: FloatProperty(
        name="Size",
        description="Length of the axes as a multiple of the largest radius of gyration",
        default=1.0,
        min=0.001,
        soft_max=10.0,
    )

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        with reports.progress(len(objects)) as step:
            placed, refused = scene.place_empties(context, objects, self.parent, self.display, self.size, step)
        findings = [body.finding.of_sources([body.obj.name]) for body in placed if body.finding is not None]
        failures = [reports.failure(obj.name_full, error) for obj, error in refused.items()]
        done = reports.phrase(
            "Placed an empty at the principal frame of {count} object",
            "Placed empties at the principal frames of {count} objects",
            count=len(placed),
        )
        idle = reports.phrase("the empties are in place")
        return selection.summarize(self, len(placed), len(objects), done, failures, findings, idle)


CLASSES = (OBJECT_OT_body_moments_add_empty,)
