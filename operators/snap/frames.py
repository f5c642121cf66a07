# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Origins and axes: objects get the frames of their bodies, or turn them to the world.

Physics engines take an object's origin as its center of mass and a diagonal inertia along its axes. Blender's own
operator for origins ignores modifiers and moves other users of the data.
"""

from bpy.props import BoolProperty, EnumProperty
from bpy.types import Context, Object, Operator

from ...blender import scene, session
from ...blender.write import reports
from .. import selection

STRICT_PROPERTY = BoolProperty(
    name="Zhang and Chen's Rule",
    description=(
        "Take axes 1 and 2 in the direction of positive third moments, as in the paper. Objects for which "
        "the rule is undefined, such as most symmetric ones, are left unchanged"
    ),
)


def reframe_selected(
    operator: Operator, context: Context, along_axes: bool, done: tuple[str, str], strict: bool = False
) -> set[str]:
    """Give each selected object an origin at its center of mass while nothing visible moves, and report it.

    along_axes: also align its axes with the principal axes. done: the report, for one object and for `count` objects.
    """
    objects = selection.selected_measurable(context)
    target_matrix = scene.matrix_along_axes if along_axes else scene.matrix_at_center
    changed, failures = session.reframe_objects(context, objects, target_matrix, not along_axes, strict)
    findings = [found.of_sources([plan.obj.name]) for plan in changed for found in plan.findings]
    text, idle = reports.phrase(*done, count=len(changed)), reports.phrase("already in place")
    return selection.summarize(operator, len(changed), len(objects), text, failures, findings, idle)


class OBJECT_OT_body_moments_origin_to_center(selection.OnSelectionInObjectMode, Operator):
    """Move the origin to the exact center of mass of the evaluated object."""

    bl_idname = "object.body_moments_origin_to_center"
    bl_label = "Origin to Center of Mass"
    bl_description = (
        "Move the origin to the exact center of mass of the evaluated object. Nothing visible moves: children and "
        "other users of the data stay in place. Objects whose modifiers depend on the origin are left unchanged"
    )

    def execute(self, context: Context) -> set[str]:
        done = (
            "Moved the origin of {count} object to the center of mass",
            "Moved the origins of {count} objects to the center of mass",
        )
        return reframe_selected(self, context, False, done)


class OBJECT_OT_body_moments_axes_to_principal(selection.OnSelectionInObjectMode, Operator):
    """Make the principal frame the frame of the object."""

    bl_idname = "object.body_moments_axes_to_principal"
    bl_label = "Axes to Principal Axes"
    bl_description = (
        "Move the origin to the center of mass and align the local X, Y and Z axes with the principal axes, from the "
        "smallest moment to the largest, with unit scale. Nothing visible moves"
    )

    strict: STRICT_PROPERTY

    def execute(self, context: Context) -> set[str]:
        done = (
            "Aligned the axes of {count} object to its principal axes",
            "Aligned the axes of {count} objects to their principal axes",
        )
        return reframe_selected(self, context, True, done, self.strict)


# Targets of principal axes 1, 2 and 3. An odd order would mirror the body, so axis 3 is reversed in it.
ORDERS = ("XYZ", "YZX", "ZXY", "XZY", "YXZ", "ZYX")


class OBJECT_OT_body_moments_align_to_world(selection.OnSelectionInObjectMode, Operator):
    """Rotate the object so that its principal axes align with the world axes."""

    bl_idname = "object.body_moments_align_to_world"
    bl_label = "Align Object to World"
    bl_description = (
        "Rotate the object so that its principal axes align with the world axes, about its center of mass or at the "
        "world origin. Children follow"
    )

    order: EnumProperty(
        name="Axes",
        description="World axes for principal axes 1, 2 and 3 (smallest to largest moment)",
        items=[
            (
                order,
                "1 → {:s}, 2 → {:s}, 3 → {:s}{:s}".format(order[0], order[1], "" if i < 3 else "−", order[2]),
                "Smallest moment about {:s}, largest moment about {:s}".format(order[0], order[2]),
            )
            for i, order in enumerate(ORDERS)
        ],
        default="XYZ",
    )
    pivot: EnumProperty(
        name="Center of Mass",
        description="New location of the center of mass",
        items=(
            ("CENTER", "Keep", "Rotate about the center of mass"),
            ("ORIGIN", "World Origin", "Move the center of mass to the world origin"),
        ),
    )

    strict: STRICT_PROPERTY

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)

        def align(obj: Object) -> bool:
            return scene.align_to_world(context, obj, self.order, self.pivot == "ORIGIN", self.strict)

        moved, failures = selection.apply_to_all(
            objects, align
        )  # one after the other, for a child moves with its parent
        session.remeasure(context, moved)
        done = reports.phrase(
            "Aligned {count} object to the world axes", "Aligned {count} objects to the world axes", count=len(moved)
        )
        idle = reports.phrase("already aligned")
        return selection.summarize(self, len(moved), len(objects), done, failures, idle=idle)


CLASSES = (
    OBJECT_OT_body_moments_origin_to_center,
    OBJECT_OT_body_moments_axes_to_principal,
    OBJECT_OT_body_moments_align_to_world,
)
