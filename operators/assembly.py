# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies: a collection, or an empty with its children, as one body, with its place in the scene
and its bill.
"""

from collections.abc import Callable
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy.types import Context, Operator
from bpy_extras.io_utils import ExportHelper
from mathutils import Matrix

from ..blender import bodies, read, scale, scene, session, settings, write
from ..core.verdict import EditRefusedError, MeasureError, Procedure, Severity, of_severity
from . import modal, selection
from .findings import NO_ACTIVE_ASSEMBLY
from .snap.frames import turn_cursor

TARGET = EnumProperty(
    name="Assembly",
    description="What is measured as one body",
    items=(
        ("COLLECTION", "Collection", "The active collection with its nested collections"),
        ("OBJECT", "Empty", "The active empty with its children"),
        (
            "OF_OBJECT",
            "Collection of Object",
            "The collection of the active object, or the empty itself",
        ),
    ),
)


def target_of(context: Context, target: str) -> settings.assembly.Root:
    """Return the assembly that an operator works on; raise MeasureError if there is none."""
    if target == "OF_OBJECT":
        return settings.assembly.active_assembly(context)
    data = context.collection if target == "COLLECTION" else context.object
    if data is None or target == "OBJECT" and not settings.assembly.is_assembly(data):
        raise MeasureError(NO_ACTIVE_ASSEMBLY)
    return data


def measured_assembly(context: Context, target: str) -> "bodies.Assembly":
    """Measure an operator's assembly as it is now; raise MeasureError if it has no mass."""
    depsgraph = context.evaluated_depsgraph_get()
    return bodies.measure_assembly(target_of(context, target), depsgraph)


class OBJECT_OT_body_moments_measure_assembly(modal.ModalSteps, Operator):
    """Measure all members of a collection or all children of an empty, and store the total"""

    bl_label = "Measure Assembly"
    MAX_AT_ONCE = selection.MAX_OBJECTS_WITHOUT_REDRAW

    target: TARGET

    def _begin(self, context: Context) -> int:
        """Prepare the steps that measure the members; return the number of objects to measure."""
        depsgraph = context.evaluated_depsgraph_get()
        data = target_of(context, self.target)
        write.properties.require_storable(data)
        self._member = read.assembly.members_of(data, depsgraph)
        self._results: bodies.Results = {}
        self._steps = bodies.measure_members(self._member, depsgraph, self._results)
        return sum(member.is_measured for member in self._member.walk())

    def _finish(self, context: Context) -> set[str]:
        assembly = bodies.assemble(self._member, self._results, context.evaluated_depsgraph_get())
        failures = session.stored.assembly.store(context, assembly)
        measurement = assembly.measurement
        summary = [
            write.reports.phrase(
                "{assembly}: {mass:.7g} kg from {count} object",
                "{assembly}: {mass:.7g} kg from {count} objects",
                assembly=measurement.name,
                count=sum(part.measurement is not None for part in assembly.root.walk()),
                mass=measurement.mass_properties.mass,
            )
        ]
        if failures:
            names = [name for name, _ in failures]
            summary.append(write.reports.phrase("Results not stored on {names}.", names=names))
        findings = of_severity(measurement.findings, Severity.WARNING, Severity.ERROR)
        return selection.report(self, *summary, *findings)


class OBJECT_OT_body_moments_clear_assembly(Operator):
    """Remove the stored results of the assembly. Settings and results of members are kept"""

    bl_label = "Clear Assembly Results"

    target: TARGET

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        return report_cleared(self, session.stored.assembly.clear(target_of(context, self.target)))


def report_cleared(operator: Operator, is_cleared: bool) -> set[str]:
    """Report that results were removed, or that there were none; return the result of `execute`."""
    text = "Removed the results of {count} object" if is_cleared else selection.NO_RESULTS
    return selection.finish(operator, [write.reports.phrase(text, count=1)], is_changed=is_cleared)


# ID property of an empty: the collection, scene or empty whose frame it shows
FRAME_OF = "principal_frame_of_assembly"


class _SnapToAssembly:
    """Base of operators that move something to an assembly's center of mass.

    `_place` moves it, given the context, the measured assembly and its center of mass in the world,
    in Blender's units, and returns the report.
    """

    target: TARGET
    _place: Callable[..., str]

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        assembly = measured_assembly(context, self.target)
        for part in assembly.root.walk():
            if part.measurement is not None and part.measurement.method.procedure == Procedure.OPEN:
                raise EditRefusedError(scene.findings.OPEN_OBJECT, subject=part.member.name)
        unit = scale.meters_per_unit(context.scene)
        center = (assembly.measurement.mass_properties.center / unit).tolist()
        return selection.report(self, self._place(context, assembly, center))


class VIEW3D_OT_body_moments_cursor_to_assembly(_SnapToAssembly, Operator):
    """Move the 3D cursor to the center of mass of the assembly"""

    bl_label = "Cursor to Center of Assembly"

    rotate: BoolProperty(
        name="Rotate to Principal Axes", description="Align the 3D cursor with the principal axes"
    )

    def _place(self, context: Context, assembly: "bodies.Assembly", center: list[float]) -> str:
        context.scene.cursor.location = center
        if self.rotate:
            turn_cursor(
                context.scene.cursor, assembly.measurement.mass_properties.principal.axes.tolist()
            )
        return write.reports.phrase(
            "Moved the 3D cursor to the center of mass of “{assembly}”",
            assembly=assembly.measurement.name,
        )


class OBJECT_OT_body_moments_assembly_empty(_SnapToAssembly, Operator):
    """Add or move an empty at the assembly's center of mass, along its principal axes"""

    bl_label = "Add Empty at Assembly"

    def _place(self, context: Context, assembly: "bodies.Assembly", center: list[float]) -> str:
        root = assembly.root.member.data
        body = assembly.measurement.mass_properties
        # An ID property cannot point to a scene's own collection, but to the scene.
        owner = context.scene if root == context.scene.collection else root
        empty = next((obj for obj in context.scene.objects if obj.get(FRAME_OF) == owner), None)
        if empty is None:
            empty = bpy.data.objects.new("{:s} Principal Frame".format(root.name), None)
            empty.empty_display_type = "ARROWS"
            empty.show_in_front = True
            empty.rotation_mode = "QUATERNION"
            empty[FRAME_OF] = owner
            context.scene.collection.objects.link(empty)
        scene.changes.require_editable(empty)
        unit = scale.meters_per_unit(context.scene)
        # An empty of a point mass would have no size: no empty is smaller than 0.001 units.
        empty.empty_display_size = max(float(body.radii_of_gyration.max()) / unit, 1e-3)
        frame = Matrix(body.principal.axes.tolist()).to_4x4()
        frame.translation = center
        empty.matrix_world = frame
        return write.reports.phrase(
            "Placed an empty at the principal frame of “{assembly}”", assembly=root.name
        )


class OBJECT_OT_body_moments_assembly_origin(_SnapToAssembly, Operator):
    """Put the origin of the assembly at its center of mass: the offset of a collection's instances,
    or the empty, whose children stay where they are
    """

    bl_label = "Origin to Center of Assembly"

    def _place(self, context: Context, assembly: "bodies.Assembly", center: list[float]) -> str:
        root = assembly.root.member.data
        if isinstance(root, bpy.types.Collection):
            scene.changes.require_editable(root)
            root.instance_offset = center
            return write.reports.phrase(
                "Instances of “{assembly}” are placed by its center of mass", assembly=root.name
            )
        scene.move_parent(context, root, center)
        if write.properties.is_stored(root):
            # The empty is the active object: no other one is an operator's assembly.
            session.stored.assembly.store(context, measured_assembly(context, "OBJECT"))
        return write.reports.phrase(
            "Moved “{assembly}” to the center of mass; its children stay", assembly=root.name
        )


class OBJECT_OT_body_moments_export_bill(Operator, ExportHelper):
    """Write masses, centers and inertia of an assembly's members as a table (.csv), in SI units"""

    bl_label = "Export Bill of Masses"
    bl_options = {"REGISTER"}
    filename_ext = ".csv"

    target: TARGET
    filter_glob: StringProperty(default="*.csv", options={"HIDDEN"})

    @selection.report_refusals
    def execute(self, context: Context) -> set[str]:
        assembly = measured_assembly(context, self.target)
        if not self.filepath:
            return selection.refuse(self, selection.NO_FILE)
        path = Path(bpy.path.abspath(self.filepath))
        lines = session.bill_csv(assembly.root, assembly.measurement.mass_properties.mass)
        selection.write_file(path, lines)
        texts = (
            "Wrote the masses of {count} member to “{file}”",
            "Wrote the masses of {count} members to “{file}”",
        )
        count = len(lines) - 2  # without the header and the assembly itself
        return selection.report(self, write.reports.phrase(*texts, count=count, file=path.name))
