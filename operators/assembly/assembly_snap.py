# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene follows an assembly: cursor, empty, and the origin that its instances and its children are placed by."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty
from bpy.types import Context, Operator
from mathutils import Matrix

from ...blender import scene
from ...blender.scene.changes import require_editable
from ...blender.scene.findings import OPEN_OBJECT
from ...blender.session import stored
from ...blender.write import properties, reports
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError
from ...core.verdict.method import Verdict
from .. import selection
from ..snap.cursor import turn_cursor
from .assembly import TARGET, measured_assembly

if TYPE_CHECKING:
    from ...blender.bodies.assembly.assembly import Assembly

FRAME_OF = "principal_frame_of_assembly"  # ID property of an empty: the collection or empty whose frame it shows


class _SnapToAssembly:
    """Base of the operators that place something at an assembly's center of mass."""

    bl_options = {"REGISTER", "UNDO"}
    target: TARGET
    _place: Callable[..., str]  # does it, and returns the report

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        assembly = measured_assembly(context, self.target)
        for part in assembly.root.walk():
            if part.measurement is not None and part.measurement.method.verdict == Verdict.OPEN:
                raise EditRefusedError(OPEN_OBJECT, subject=part.member.name)
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        center = (assembly.measurement.mass_properties.center / unit).tolist()
        selection.report(self, self._place(context, assembly, center))
        return {"FINISHED"}


class VIEW3D_OT_body_moments_cursor_to_assembly(_SnapToAssembly, Operator):
    """Move the 3D cursor to the center of mass of the assembly"""

    bl_idname = "view3d.body_moments_cursor_to_assembly"
    bl_label = "Cursor to Center of Assembly"

    rotate: BoolProperty(
        name="Rotate to Principal Axes", description="Align the 3D cursor with the principal axes", default=False
    )

    def _place(self, context: Context, assembly: "Assembly", center: list[float]) -> str:
        context.scene.cursor.location = center
        if self.rotate:
            turn_cursor(context.scene.cursor, assembly.measurement.mass_properties.principal.axes.tolist())
        return reports.phrase(
            "Moved the 3D cursor to the center of mass of “{assembly}”", assembly=assembly.measurement.name
        )


class OBJECT_OT_body_moments_assembly_empty(_SnapToAssembly, Operator):
    """Add an empty at the center of mass of the assembly, along its principal axes. One added before is moved"""

    bl_idname = "object.body_moments_assembly_empty"
    bl_label = "Add Empty at Assembly"

    def _place(self, context: Context, assembly: "Assembly", center: list[float]) -> str:
        root, body = assembly.root.member.data, assembly.measurement.mass_properties
        owner = context.scene if root == context.scene.collection else root  # nothing else can point to it
        empty = next((obj for obj in context.scene.objects if obj.get(FRAME_OF) == owner), None)
        if empty is None:
            empty = bpy.data.objects.new("{:s} Principal Frame".format(root.name), None)
            empty.empty_display_type, empty.show_in_front, empty.rotation_mode = "ARROWS", True, "QUATERNION"
            empty[FRAME_OF] = owner
            context.scene.collection.objects.link(empty)
        require_editable(empty)
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        empty.empty_display_size = max(float(body.radii_of_gyration.max()) / unit, 1e-3)
        frame = Matrix(body.principal.axes.tolist()).to_4x4()
        frame.translation = center
        empty.matrix_world = frame
        return reports.phrase("Placed an empty at the principal frame of “{assembly}”", assembly=root.name)


class OBJECT_OT_body_moments_assembly_origin(_SnapToAssembly, Operator):
    """Put the origin of the assembly at its center of mass."""

    bl_idname = "object.body_moments_assembly_origin"
    bl_label = "Origin to Center of Assembly"
    bl_description = (
        "Put the origin of the assembly at its center of mass: the offset of a collection's instances, or the empty, "
        "whose children stay where they are"
    )

    def _place(self, context: Context, assembly: "Assembly", center: list[float]) -> str:
        root = assembly.root.member.data
        if isinstance(root, bpy.types.Collection):
            require_editable(root)
            root.instance_offset = center
            return reports.phrase("Instances of “{assembly}” are placed by its center of mass", assembly=root.name)
        scene.move_parent(context, root, center)
        if properties.is_stored(root):
            stored.assembly.store(context, measured_assembly(context, "OBJECT"))
        return reports.phrase("Moved “{assembly}” to the center of mass; its children stay", assembly=root.name)


CLASSES = (
    VIEW3D_OT_body_moments_cursor_to_assembly,
    OBJECT_OT_body_moments_assembly_empty,
    OBJECT_OT_body_moments_assembly_origin,
)
