# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of bodies: given to objects as origins and axes, to the world, the 3D cursor, empties and
orientations.

Physics engines take an object's origin as its center of mass and a diagonal inertia along its axes.
Blender's own operator for origins ignores modifiers and moves other users of the data. Blender
makes orientations only from a 3D view; without one, as in background mode, that operator only
warns. A node group shows the center at every frame.
"""

from collections.abc import Sequence
from functools import partial

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Object, Operator, View3DCursor
from mathutils import Matrix

from ...blender import bodies, read, scale, scene, session, write
from ...core import inertia, verdict
from .. import selection

STRICT_PROPERTY = BoolProperty(
    name="Zhang and Chen's Rule",
    description=(
        "Take axes 1 and 2 in the direction of positive third moments, as in the paper. Objects "
        "for which "
        "the rule is undefined, such as most symmetric ones, are left unchanged"
    ),
)


def reframe_selected(
    operator: Operator,
    context: Context,
    along_axes: bool,
    summary_texts: tuple[str, str],
    strict: bool = False,
) -> set[str]:
    """Give each selected object an origin at its center of mass while nothing visible moves, and
    report it.

    along_axes: also align its axes with the principal axes. summary_texts: the report, for one
    object and for `count` objects.
    """
    objects = selection.selected_measurable(context)
    target_matrix = scene.matrix_along_axes if along_axes else scene.matrix_at_center
    changed, failures = session.reframe_objects(
        context, objects, target_matrix, not along_axes, strict
    )
    findings = [
        finding.of_sources([plan.obj.name]) for plan in changed for finding in plan.findings
    ]
    text = write.reports.phrase(*summary_texts, count=len(changed))
    idle = write.reports.phrase("already in place")
    return selection.summarize(operator, len(changed), len(objects), text, failures, findings, idle)


class OBJECT_OT_body_moments_origin_to_center(selection.OnSelectionInObjectMode, Operator):
    """Move the origin to the exact center of mass of the evaluated object. Nothing visible moves:
    children and other users of the data stay in place. Objects whose modifiers depend on the origin
    are left unchanged
    """

    bl_label = "Origin to Center of Mass"

    def execute(self, context: Context) -> set[str]:
        return reframe_selected(
            self,
            context,
            False,
            (
                "Moved the origin of {count} object to the center of mass",
                "Moved the origins of {count} objects to the center of mass",
            ),
        )


class OBJECT_OT_body_moments_axes_to_principal(selection.OnSelectionInObjectMode, Operator):
    """Move the origin to the center of mass and align the local X, Y and Z axes with the principal
    axes, from the smallest moment to the largest, with unit scale. Nothing visible moves
    """

    bl_label = "Axes to Principal Axes"

    strict: STRICT_PROPERTY

    def execute(self, context: Context) -> set[str]:
        return reframe_selected(
            self,
            context,
            True,
            (
                "Aligned the axes of {count} object to its principal axes",
                "Aligned the axes of {count} objects to their principal axes",
            ),
            self.strict,
        )


# World axes for the principal axes 1, 2 and 3. The last three orders are odd: they would mirror the
# body, so axis 3 is reversed.
ORDERS = ("XYZ", "YZX", "ZXY", "XZY", "YXZ", "ZYX")


class OBJECT_OT_body_moments_align_to_world(selection.OnSelectionInObjectMode, Operator):
    """Rotate the object so that its principal axes align with the world axes, about its center of
    mass or at the world origin. Children follow
    """

    bl_label = "Align Object to World"

    order: EnumProperty(
        name="Axes",
        description="World axes for principal axes 1, 2 and 3 (smallest to largest moment)",
        items=[
            (
                order,
                "1 → {:s}, 2 → {:s}, 3 → {:s}{:s}".format(
                    order[0], order[1], "" if i < 3 else "−", order[2]
                ),
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
        def align(obj: Object) -> bool:
            return scene.align_to_world(
                context, obj, self.order, self.pivot == "ORIGIN", self.strict
            )

        return selection.change_all(
            self,
            selection.selected_measurable(context),
            align,
            (
                "Aligned {count} object to the world axes",
                "Aligned {count} objects to the world axes",
            ),
            "already aligned",
            then=partial(session.remeasure, context),
        )


class VIEW3D_OT_body_moments_cursor_to_center(selection.OnSelection, Operator):
    """Move the 3D cursor to the common center of mass of the selected objects"""

    bl_label = "Cursor to Center of Mass"

    rotate: BoolProperty(
        name="Rotate to Principal Axes",
        description="Align the 3D cursor with the principal axes",
    )

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        measured = bodies.measured_in_turn(objects, context.evaluated_depsgraph_get())
        measurements = []

        def add(obj: Object) -> None:
            measurement = measured(obj).measurement
            if measurement.method.procedure == verdict.Procedure.OPEN:
                raise verdict.EditRefusedError(scene.findings.OPEN_OBJECT)
            measurements.append(measurement)

        added, failures = selection.apply_to_all(objects, add)
        findings = []
        if measurements:
            # A single body keeps its measured frame, whose signs come from exact third moments.
            total = measurements[0].mass_properties
            if len(measurements) > 1:
                total = inertia.combine([measurement.mass_moments for measurement in measurements])
            cursor = context.scene.cursor
            cursor.location = total.center / scale.meters_per_unit(context.scene)
            if self.rotate:
                turn_cursor(cursor, total.principal.axes.tolist())
                findings = [total.principal.finding] if total.principal.finding is not None else []
        summary = write.reports.phrase(
            "Moved the 3D cursor to the center of mass of {count} object",
            "Moved the 3D cursor to the center of mass of {count} objects",
            count=len(added),
        )
        return selection.summarize(self, len(added), len(objects), summary, failures, findings)


def turn_cursor(cursor: View3DCursor, axes: Sequence[Sequence[float]]) -> None:
    """Turn the 3D cursor to the columns of a (3, 3) rotation, without a change of its rotation
    mode.
    """
    mode = cursor.rotation_mode
    rotation = Matrix(axes).to_quaternion()
    if mode == "QUATERNION":
        cursor.rotation_quaternion = rotation
    elif mode == "AXIS_ANGLE":
        axis, angle = rotation.to_axis_angle()
        cursor.rotation_axis_angle = (angle, *axis)
    else:
        cursor.rotation_euler = rotation.to_euler(mode)


class OBJECT_OT_body_moments_add_empty(selection.OnSelectionInObjectMode, Operator):
    """Add an empty at the center of mass, along the principal axes, with arrows as long as the
    largest radius of gyration. An empty added before is moved
    """

    bl_label = "Add Empty at Principal Frame"

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
        with write.reports.progress(len(objects)) as step:
            placed, refused = scene.place_empties(
                context, objects, self.parent, self.display, self.size, step
            )
        findings = [
            body.finding.of_sources([body.obj.name]) for body in placed if body.finding is not None
        ]
        failures = [write.reports.failure(obj.name_full, error) for obj, error in refused.items()]
        summary = write.reports.phrase(
            "Placed an empty at the principal frame of {count} object",
            "Placed empties at the principal frames of {count} objects",
            count=len(placed),
        )
        idle = write.reports.phrase("the empties are in place")
        return selection.summarize(
            self, len(placed), len(objects), summary, failures, findings, idle
        )


class OBJECT_OT_body_moments_create_orientation(Operator):
    """Create a transform orientation along the principal axes of the active object"""

    bl_label = "Orientation from Principal Axes"

    name: StringProperty(
        name="Name",
        description="Name of the orientation. If empty, the object's name. An orientation of this "
        "name is replaced",
    )
    use: BoolProperty(
        name="Use After Creation",
        description="Make it the current transform orientation",
        default=True,
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = context.view_layer.objects.active
        if obj is None or not obj.select_get():
            return write.reports.unavailable(cls, "Make an object active and select it")
        return selection.poll_object_mode(cls, context)

    def execute(self, context: Context) -> set[str]:
        obj = context.view_layer.objects.active
        try:
            body = scene.snap_target(context, obj)
        except verdict.MeasureError as error:
            return selection.refuse(self, write.reports.failure(obj.name_full, error))
        place = _view_3d(context)
        if place is None:
            write.reports.report(
                self,
                write.reports.phrase("A transform orientation needs an open 3D Viewport."),
                level=verdict.Severity.WARNING,
            )
            return {"CANCELLED"}
        name = self.name or "{:s} Principal".format(obj.name)
        slot = context.scene.transform_orientation_slots[0]
        before = slot.type
        # `use` makes the new orientation that of the slot, where its matrix can be set.
        with context.temp_override(**place):
            bpy.ops.transform.create_orientation(name=name, use=True, overwrite=True)
        slot.custom_orientation.matrix = Matrix(body.axes.tolist())
        if not self.use:
            slot.type = before
        free = [body.finding] if body.finding is not None else []
        return write.reports.report(
            self,
            write.reports.phrase("Created the transform orientation “{name}”", name=name),
            *free,
        )


def _view_3d(context: Context) -> dict | None:
    """Return a 3D view to create orientations from: the operator's own, or the first that is
    open.
    """
    windows = [context.window] if context.window else []
    windows += [window for window in context.window_manager.windows if window not in windows]
    for window in windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                regions = [region for region in area.regions if region.type == "WINDOW"]
                return {"window": window, "area": area, "region": regions[0]}
    return None


class OBJECT_OT_body_moments_add_nodes(selection.InObjectMode, Operator):
    """Add the node group “Center of Mass” to the file, marked as an asset: it computes center,
    volume and mass in geometry nodes, follows modifiers and animation, and works without the add-on
    """

    bl_label = "Center of Mass Node Group"

    marker: BoolProperty(
        name="Add Marker",
        description="Add an object that shows the center of mass of the active object at every "
        "frame",
        default=True,
    )

    def execute(self, context: Context) -> set[str]:
        group = scene.center_of_mass_group()
        obj = session.selected.subject(context)
        if not self.marker or obj is None or not read.visibility.measurable(obj):
            return write.reports.report(
                self, write.reports.phrase("Added the node group “{group}”", group=group.name)
            )
        marker = scene.add_marker(context, obj, group)
        texts = [
            write.reports.phrase(
                "Added the node group “{group}” and the marker “{object}”",
                group=group.name,
                object=marker.name,
            )
        ]
        settings = obj.body_moments
        if (settings.kind, settings.mass_from, settings.density_from) != (
            "SOLID",
            "DENSITY",
            "VALUE",
        ):
            texts.append(write.reports.phrase("nodes take the object as a solid of one density"))
        return write.reports.report(self, *texts)
