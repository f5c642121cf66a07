# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene follows an assembly: cursor, empty, and the origin that its instances and its children are placed by."""

from collections.abc import Callable

import bpy
import numpy as np
from bpy.props import BoolProperty
from bpy.types import Context, Object, Operator
from mathutils import Matrix
from numpy.typing import NDArray

from ...blender.bodies.assembly.assembly import Assembly
from ...blender.read.assembly import Root
from ...blender.read.tracking import tracking_paused
from ...blender.scene.findings import LINKED_OBJECT, TRANSFORM_CONSTRAINED
from ...blender.scene.transforms import TransformChannels, require_editable, world
from ...blender.session.stored import assembly as stored_assembly
from ...blender.write import properties, reports
from ...core.inertia.mass_properties import MassProperties
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError, Finding, MeasureError, finding
from ...core.verdict.method import Verdict
from .. import selection
from ..findings import (
    ASSEMBLY_HAS_OPEN_MEMBERS,
    ASSEMBLY_OFFSET_SET,
    ASSEMBLY_ORIGIN_MOVED,
    CHILDREN_WOULD_MOVE,
    CURSOR_TO_ASSEMBLY,
    EMPTY_AT_ASSEMBLY,
)
from .assembly import TARGET, measured_assembly

PLACE_RTOL = 4e-6  # rounding of places in float32 matrices
FRAME_OF = "principal_frame_of_assembly"  # ID property of an empty: the collection or empty whose frame it shows


class _SnapToAssembly:
    """Base of the operators that place something at an assembly's center of mass."""

    bl_options = {"REGISTER", "UNDO"}
    target: TARGET
    _place: Callable[[Context, Assembly], list[Finding]]

    def execute(self, context: Context) -> set[str]:
        try:
            assembly = measured_assembly(context, self.target)
            if any(
                part.measurement is not None and part.measurement.method.verdict == Verdict.OPEN
                for part in assembly.root.walk()
            ):
                raise EditRefusedError(ASSEMBLY_HAS_OPEN_MEMBERS, subject=assembly.measurement.name)
            findings = self._place(context, assembly)
        except MeasureError as error:
            selection.report(self, reports.refusal(error))
            return {"CANCELLED"}
        selection.report(self, *findings)
        return {"FINISHED"}


def _center(context: Context, body: MassProperties) -> NDArray[np.float64]:
    """Return the assembly's (3,) center in Blender units."""
    return body.center / shortest_decimal(context.scene.unit_settings.scale_length)


class VIEW3D_OT_body_moments_cursor_to_assembly(_SnapToAssembly, Operator):
    """Move the 3D cursor to the center of mass of the assembly"""

    bl_idname = "view3d.body_moments_cursor_to_assembly"
    bl_label = "Cursor to Center of Assembly"

    rotate: BoolProperty(
        name="Rotate to Principal Axes", description="Align the 3D cursor with the principal axes", default=False
    )

    def _place(self, context: Context, assembly: Assembly) -> list[Finding]:
        body, cursor = assembly.measurement.mass_properties, context.scene.cursor
        cursor.location = _center(context, body)
        if self.rotate:
            cursor.rotation_mode = "QUATERNION"
            cursor.rotation_quaternion = Matrix(body.principal.axes).to_quaternion()
        return [finding(CURSOR_TO_ASSEMBLY, assembly=assembly.measurement.name)]


class OBJECT_OT_body_moments_assembly_empty(_SnapToAssembly, Operator):
    """Add an empty at the center of mass of the assembly, along its principal axes. One added before is moved"""

    bl_idname = "object.body_moments_assembly_empty"
    bl_label = "Add Empty at Assembly"

    def _place(self, context: Context, assembly: Assembly) -> list[Finding]:
        root, body = assembly.root.member.data, assembly.measurement.mass_properties
        owner = context.scene if root == context.scene.collection else root  # nothing else can point to it
        empty = next((obj for obj in context.scene.objects if obj.get(FRAME_OF) == owner), None)
        if empty is None:
            empty = bpy.data.objects.new("{:s} Principal Frame".format(root.name), None)
            empty.empty_display_type, empty.show_in_front, empty.rotation_mode = "ARROWS", True, "QUATERNION"
            empty[FRAME_OF] = owner
            context.scene.collection.objects.link(empty)
        require_editable(empty)
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = body.principal.axes, _center(context, body)
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        empty.empty_display_size = max(float(body.radii_of_gyration.max()) / unit, 1e-3)
        empty.matrix_world = Matrix(frame)
        return [finding(EMPTY_AT_ASSEMBLY, assembly=root.name)]


class OBJECT_OT_body_moments_assembly_origin(_SnapToAssembly, Operator):
    """Put the origin of the assembly at its center of mass."""

    bl_idname = "object.body_moments_assembly_origin"
    bl_label = "Origin to Center of Assembly"
    bl_description = (
        "Put the origin of the assembly at its center of mass: the offset of a collection's instances, or the empty, "
        "whose children stay where they are"
    )

    def _place(self, context: Context, assembly: Assembly) -> list[Finding]:
        root, center = assembly.root.member.data, _center(context, assembly.measurement.mass_properties)
        if isinstance(root, bpy.types.Collection):
            if not root.is_editable:
                raise EditRefusedError(LINKED_OBJECT, subject=root.name)
            root.instance_offset = center
            return [finding(ASSEMBLY_OFFSET_SET, assembly=root.name)]
        require_editable(root)
        _move_parent(context, root, center)
        _refresh(context, root)
        return [finding(ASSEMBLY_ORIGIN_MOVED, assembly=root.name)]


def _move_parent(context: Context, empty: Object, center: NDArray) -> None:
    """Put an empty at a point while its children stay. EditRefusedError if something else holds one of them."""
    children = [child for child in empty.children if child.parent_type == "OBJECT"]
    saved = TransformChannels(empty)
    inverses = {child: child.matrix_parent_inverse.copy() for child in children}
    places = {child: world(child) for child in empty.children_recursive}
    was = world(empty)
    size = float(np.abs([place[:3, 3] - center for place in places.values()]).max())
    tolerance = PLACE_RTOL * max(size, float(np.abs(center).max()))
    with tracking_paused():
        try:
            target = was.copy()
            target[:3, 3] = center
            empty.matrix_world = Matrix(target)
            context.view_layer.update()
            change = np.linalg.solve(world(empty), was)
            for child in children:
                child.matrix_parent_inverse = Matrix(change @ np.array(inverses[child], np.float64))
            context.view_layer.update()
            moved = [child for child, place in places.items() if not _is_at(child, place, tolerance)]
            if np.abs(world(empty)[:3, 3] - center).max() > tolerance:
                raise EditRefusedError(TRANSFORM_CONSTRAINED, subject=empty.name, channel="location")
            if moved:
                raise EditRefusedError(CHILDREN_WOULD_MOVE, subject=empty.name, names=[child.name for child in moved])
        except BaseException:
            for child, inverse in inverses.items():
                child.matrix_parent_inverse = inverse
            saved.restore()
            context.view_layer.update()
            raise


def _is_at(obj: Object, place: NDArray, tolerance: float) -> bool:
    """Return whether an object is at a place: within `tolerance`, and with equal rotation and scale to rounding."""
    off = np.abs(world(obj) - place)
    return bool(off[:, 3].max() <= tolerance and off[:, :3].max() <= PLACE_RTOL * np.abs(place[:, :3]).max())


def _refresh(context: Context, root: Root) -> None:
    """Measure again an assembly with stored results that an operator has moved."""
    if properties.is_stored(root):
        stored_assembly.store(context, measured_assembly(context, "OBJECT"))


CLASSES = (
    VIEW3D_OT_body_moments_cursor_to_assembly,
    OBJECT_OT_body_moments_assembly_empty,
    OBJECT_OT_body_moments_assembly_origin,
)
