# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Rigid Bodies: fulfillment of the assumptions of Blender's physics engine, for one object or a thousand.

Bullet takes an object's origin as its center of mass and its axes as principal axes; Blender's own Calculate Mass
weighs the collision shape. So mass, origin and axes belong together, and the result of Calculate Mass is shown beside
the exact mass.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Menu, Object, Operator

from ...blender.bodies.measure_object import Measured as MeasuredBody
from ...blender.bodies.stacks.many import measured_in_turn
from ...blender.bodies.stacks.stack import Stacked
from ...blender.read.tracking import tracking_paused
from ...blender.scene import reframe
from ...blender.scene.rigid_world import add_joint, add_rigid_bodies, remove_joint, require_rigid_world
from ...blender.scene.transforms import require_storable_data
from ...blender.session.findings import OPEN_OBJECT
from ...blender.session.stored import assembly, results
from ...blender.session.tracking import staleness
from ...blender.settings.options import MeasureOptions
from ...blender.write import properties, reports
from ...blender.write.findings import REFUSED
from ...blender.write.translations import localized
from ...blender.write.units import Units
from ...core.inertia.mass_properties import combine
from ...core.inertia.third_moment_frames import EQUAL_AXES
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import EditRefusedError, Finding, MeasureError, finding
from ...core.verdict.method import Verdict
from .. import selection
from ..findings import (
    LIBRARY_OVERRIDE_MASS,
    RIGID_BODIES_MADE,
    RIGID_BODY_DISPLAY_SCALED,
    RIGID_BODY_MASS_TOO_SMALL,
    RIGID_BODY_NEEDS_MESH,
)
from ..modal import progress
from ..snap import base as snapping
from ..snap.origin import matrix_at_center
from ..snap.principal_axes import matrix_along_axes

SHOWN = 12  # bodies in the redo panel
PROBE_DENSITY = 1e6  # with which Calculate Mass is asked: rigid bodies weigh no less than a gram


@dataclass(frozen=True, eq=False)
class Body:
    """An object that becomes a rigid body, with the objects below it that are parts of the same one."""

    obj: Object
    members: tuple[Object, ...] = ()


@dataclass(frozen=True, eq=False)
class Measured:
    """A measured body. density: mean density, kg/m³. parts: its objects with their measurements."""

    body: Body
    target: snapping.SnapTarget
    density: float
    parts: tuple[tuple[Object, MeasuredBody | Stacked], ...]


class OBJECT_OT_body_moments_rigid_bodies(Operator):
    """Make the selected objects rigid bodies with their exact mass, center of mass and principal axes."""

    bl_idname = "object.body_moments_rigid_bodies"
    bl_label = "Make Rigid Bodies"
    bl_description = (
        "Make the selected objects rigid bodies: mass from density and true volume, origin at the center of mass, axes "
        "along the principal axes. Nothing visible moves, and joints stay where they are"
    )
    bl_options = {"REGISTER", "UNDO"}

    type: EnumProperty(
        name="Type",
        description="Type of new rigid bodies",
        items=(("ACTIVE", "Active", "Moved by the simulation"), ("PASSIVE", "Passive", "Moved by animation alone")),
        default="ACTIVE",
    )
    shape: EnumProperty(
        name="Shape",
        description="Collision shape",
        items=(
            ("KEEP", "Keep", "Leave the shape of rigid bodies as it is; new ones get a convex hull"),
            ("CONVEX_HULL", "Convex Hull", "The convex hull of the object"),
            ("MESH", "Mesh", "The mesh itself, slow"),
            ("BOX", "Box", "The bounding box along the object's axes"),
        ),
        default="KEEP",
    )
    frame: EnumProperty(
        name="Frame",
        description="What the physics engine takes as center of mass and principal axes",
        items=(
            ("AXES", "Principal Axes", "Origin at the center of mass, axes along the principal axes, unit scale"),
            ("ORIGIN", "Origin", "Origin at the center of mass; the axes stay"),
            ("KEEP", "Keep", "Leave origin and axes as they are"),
        ),
        default="AXES",
    )
    use_density: BoolProperty(name="Set Density", description="Give all objects one density first", default=False)
    density: FloatProperty(
        name="Density",
        description="Density in kg/m³, independent of the scene units",
        default=1000.0,
        min=1e-6,
        soft_max=25000.0,
        precision=3,
    )
    compounds: BoolProperty(
        name="Compound Parents",
        description="Make an object and the selected objects that are parented to it one body with their total mass",
        default=True,
    )
    comparison: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("type", "shape", "frame", "compounds", "use_density"):
            layout.prop(self, name)
        if self.use_density:
            layout.prop(self, "density")
        column = layout.column(align=True)
        for line in self.comparison.splitlines():
            column.label(text=line, translate=False)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        if self.use_density:
            for obj in objects:
                if obj.is_editable:
                    obj.body_moments.mass_from, obj.body_moments.density_from = "DENSITY", "VALUE"
                    obj.body_moments.density = self.density
        bodies = _bodies(objects) if self.compounds else [Body(obj) for obj in objects]
        measured: dict[Object, Measured] = {}
        by_obj = {body.obj: body for body in bodies}

        ask = _measure_in_turn(context, by_obj.values())

        def measure(obj: Object) -> None:
            measured[obj] = _measured(context, by_obj[obj], ask)

        _, failures = selection.apply_to_all(list(by_obj), measure)
        # Blender reports a rigid body as a change of the shape, and again when results are stored on it
        with assembly.kept_up_to_date(context), tracking_paused():
            failures += self._place(context, measured)
            new = self._add(context, measured)
            blender = _calculated_masses(context, measured)
            for obj in new:
                obj.rigid_body.mesh_source = "FINAL"  # the mesh that was weighed; Calculate Mass takes the default
            for obj, one in measured.items():
                obj.rigid_body.mass = one.target.mass
            _store(context, measured)
        return self._report(context, measured, blender, len(bodies), failures)

    def _place(self, context: Context, measured: dict[Object, Measured]) -> list[Finding]:
        """Give each body the requested frame; leave out bodies that cannot have it, and return the reasons."""
        failures: list[Finding] = []
        if self.frame == "KEEP":
            return failures
        move_only = self.frame == "ORIGIN"
        frame_of = matrix_at_center if move_only else matrix_along_axes
        for _ in range(1 if move_only else 2):  # without its scale what is not flat is cut into other triangles
            plans, joints = [], {}
            for obj, one in list(measured.items()):
                target = frame_of(obj, one.target)
                if target is None:
                    continue
                try:
                    reframe.check(obj)
                    joints[obj] = _joint_in_place(context, obj)
                except Exception as error:
                    failures.append(reports.failure(obj.name_full, error))
                    del measured[obj]
                    continue
                plans.append(reframe.Plan(obj, target, one.target.size, move_only=move_only))
            with progress(len(plans)) as step:
                changed, refused = reframe.reframe(context, plans, step)
            for plan in changed:
                if joints[plan.obj] is not None:
                    remove_joint(context, plan.obj)
            for obj, refusal in refused:
                failures.append(reports.failure(obj.name_full, refusal))
                del measured[obj]
                if joints[obj] is not None:
                    bpy.data.objects.remove(joints[obj])
            ask = _measure_in_turn(context, [measured[plan.obj].body for plan in changed])
            for plan in changed:
                measured[plan.obj] = _measured(context, measured[plan.obj].body, ask)
            if not move_only:
                staleness.mark_axes_changed(plan.obj for plan in changed)
        return failures

    def _add(self, context: Context, measured: dict[Object, Measured]) -> list[Object]:
        """Make them rigid bodies with their shapes; the objects that were none."""
        parts = [part for one in measured.values() for part in (one.body.obj, *one.body.members)]
        new = [obj for obj in parts if obj.rigid_body is None]
        add_rigid_bodies(context, new, self.type)
        fresh = set(new)
        for one in measured.values():
            inner = {part.parent for part in one.body.members}
            for part in (one.body.obj, *one.body.members):
                if part in fresh:
                    part.rigid_body.collision_shape = "CONVEX_HULL"
                if part in inner:
                    part.rigid_body.collision_shape = "COMPOUND"
                elif self.shape != "KEEP":
                    part.rigid_body.collision_shape = self.shape
        return new

    def _report(
        self,
        context: Context,
        measured: dict[Object, Measured],
        blender: dict[Object, float],
        total: int,
        failures: list[Finding],
    ) -> set[str]:
        units = Units.from_settings(context.scene.unit_settings)
        lines = []
        for obj, one in list(measured.items())[:SHOWN]:
            template = localized("{:s}: {:s}; Calculate Mass: {:s}")
            masses = (units.text("mass", one.target.mass), units.text("mass", blender[obj]))
            lines.append(template.format(obj.name, *masses))
        if len(measured) > SHOWN:
            lines.append(localized("And {:d} more").format(len(measured) - SHOWN))
        self.comparison = "\n".join(lines)
        exact = sum(one.target.mass for one in measured.values())
        done = finding(
            RIGID_BODIES_MADE, count=len(measured), mass=float(exact), calculated=float(sum(blender.values()))
        )
        findings = [
            one.target.finding.of_sources([obj.name])
            for obj, one in measured.items()
            if one.target.finding is not None and self.frame == "AXES"
        ]
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        if measured and unit != 1.0 and context.scene.unit_settings.system != "NONE":
            findings.insert(0, finding(RIGID_BODY_DISPLAY_SCALED, factor=unit**3))
        return selection.summarize(self, len(measured), total, done, failures, findings)


def _bodies(objects: list[Object]) -> list[Body]:
    """Return a body for each selected object without a selected parent, with its selected children."""
    chosen = set(objects)
    members: dict[Object, list[Object]] = {obj: [] for obj in objects if obj.parent not in chosen}
    for obj in objects:
        top = obj
        while top.parent in chosen:
            top = top.parent
        if top != obj:
            members[top].append(obj)
    return [Body(obj, tuple(below)) for obj, below in members.items()]


def _measure_in_turn(context: Context, bodies: Iterable[Body]) -> Callable[[Object], MeasuredBody | Stacked]:
    """Return a function that measures all their objects in turn."""
    parts = [part for body in bodies for part in (body.obj, *body.members)]
    return measured_in_turn(parts, context.evaluated_depsgraph_get(), MeasureOptions(pose=True))


def _measured(context: Context, body: Body, ask: Callable[[Object], MeasuredBody | Stacked]) -> Measured:
    """Measure a body as it is now. EditRefusedError if it cannot be a rigid body."""
    require_rigid_world(context.scene, joints=body.obj.rigid_body_constraint is not None)
    parts = [(body.obj, _measured_part(body.obj, ask))]
    for part in body.members:
        try:
            parts.append((part, _measured_part(part, ask)))
        except MeasureError as error:
            raise EditRefusedError(REFUSED, object=part.name_full, cause=error.finding.as_record()) from error
    measurements = [measured.measurement for _, measured in parts]
    properties = measurements[0].mass_properties
    if body.members:
        moments = [measurement.mass_moments for measurement in measurements]
        properties = combine(moments, preferred_axes=measurements[0].rotation)
    limit = bpy.types.RigidBodyObject.bl_rna.properties["mass"].hard_min
    if properties.mass < limit:
        raise EditRefusedError(RIGID_BODY_MASS_TOO_SMALL, mass=float(properties.mass), limit=limit)
    unit, principal = shortest_decimal(context.scene.unit_settings.scale_length), properties.principal
    target = snapping.SnapTarget(
        obj=body.obj,
        center=properties.center / unit,
        axes=principal.axes,
        inertia=properties.inertia,
        gyration=properties.radii_of_gyration / unit,
        mass=properties.mass,
        finding=principal.finding,
        shape_axes=tuple(i for i in EQUAL_AXES[principal.symmetry] if i not in principal.undetermined_axes),
        is_unique=principal.is_unique,
    )
    volume = sum(measurement.volume for measurement in measurements)
    return Measured(body, target, properties.mass / volume, tuple(parts))


def _measured_part(part: Object, ask: Callable[[Object], MeasuredBody | Stacked]) -> MeasuredBody | Stacked:
    """Measure an object of a body as it is now. EditRefusedError if it cannot be part of a rigid body."""
    require_storable_data(part, LIBRARY_OVERRIDE_MASS)
    if part.type != "MESH":
        raise EditRefusedError(RIGID_BODY_NEEDS_MESH)
    measured = ask(part)
    if measured.measurement.method.verdict == Verdict.OPEN:
        raise EditRefusedError(OPEN_OBJECT)
    return measured


def _store(context: Context, measured: dict[Object, Measured]) -> None:
    """Update results that are stored on the objects."""
    found = [item for one in measured.values() for item in one.parts if properties.is_stored(item[0])]
    stored = [obj for obj, refusal in results.store_many(found, context.scene) if refusal is None]
    shapes = {obj: result.shape_digest for obj, result in found if isinstance(result, Stacked)}
    staleness.mark_up_to_date(context, stored, shapes)


def _calculated_masses(context: Context, measured: dict[Object, Measured]) -> dict[Object, float]:
    """Return the mass by Blender's Calculate Mass of each body with the same density."""
    objects = list(measured)
    if not objects:
        return {}
    with context.temp_override(object=objects[0], selected_objects=objects):
        bpy.ops.rigidbody.mass_calculate(material="Custom", density=PROBE_DENSITY)
    return {obj: obj.rigid_body.mass * one.density / PROBE_DENSITY for obj, one in measured.items()}


def _joint_in_place(context: Context, obj: Object) -> Object | None:
    """Return an empty that takes over the object's joint at its place, or None if the object is no joint."""
    joint = obj.rigid_body_constraint
    if joint is None:
        return None
    empty = bpy.data.objects.new("{:s} Joint".format(obj.name), None)
    for collection in obj.users_collection:
        collection.objects.link(empty)
    location, turn, _scale = obj.matrix_world.decompose()
    empty.rotation_mode = "QUATERNION"
    empty.location, empty.rotation_quaternion = location, turn
    copy = add_joint(context, empty, joint.type)
    for prop in joint.bl_rna.properties:
        if not prop.is_readonly:
            setattr(copy, prop.identifier, getattr(joint, prop.identifier))
    empty.parent, empty.matrix_parent_inverse = obj, obj.matrix_world.inverted()
    return empty


def _menu(menu: Menu, _context: Context) -> None:
    menu.layout.operator(OBJECT_OT_body_moments_rigid_bodies.bl_idname, icon="RIGID_BODY")


def register() -> None:
    bpy.utils.register_class(OBJECT_OT_body_moments_rigid_bodies)
    bpy.types.VIEW3D_MT_object_rigid_body.append(_menu)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object_rigid_body.remove(_menu)
    bpy.utils.unregister_class(OBJECT_OT_body_moments_rigid_bodies)
