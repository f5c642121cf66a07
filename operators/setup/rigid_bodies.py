# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Rigid Bodies, and Set Rigid Body Mass, in kilograms.

Blender's own Calculate Mass weighs the collision shape, not the object; its result is shown beside
the exact mass. Bullet, Blender's physics engine, takes the object's origin as the center of mass
and a diagonal inertia along the object's axes; after Axes to Principal Axes both are true.
"""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Object, Operator

from ...blender import read, scale, scene, session, write
from ...core.verdict import EditRefusedError, Finding, finding
from .. import modal, selection
from ..findings import NOT_A_RIGID_BODY, RIGID_BODY_CENTER_ELSEWHERE

SHOWN = 12  # bodies in the redo panel


class OBJECT_OT_body_moments_rigid_bodies(selection.OnSelectionInObjectMode, Operator):
    """Make the selected objects rigid bodies: mass from density and true volume, origin at the
    center of mass, axes along the principal axes. Nothing visible moves, and joints stay where they
    are
    """

    bl_label = "Make Rigid Bodies"

    type: EnumProperty(
        name="Type",
        description="Type of new rigid bodies",
        items=(
            ("ACTIVE", "Active", "Moved by the simulation"),
            ("PASSIVE", "Passive", "Moved by animation alone"),
        ),
    )
    shape: EnumProperty(
        name="Shape",
        description="Collision shape",
        items=(
            (
                "KEEP",
                "Keep",
                "Leave the shape of rigid bodies as it is; new ones get a convex hull",
            ),
            ("CONVEX_HULL", "Convex Hull", "The convex hull of the object"),
            ("MESH", "Mesh", "The mesh itself, slow"),
            ("BOX", "Box", "The bounding box along the object's axes"),
        ),
    )
    frame: EnumProperty(
        name="Frame",
        description="What the physics engine takes as center of mass and principal axes",
        items=(
            (
                "ORIGIN",
                "Origin",
                "Origin at the center of mass; the axes stay, and a scale that mirrors or shears "
                "is applied, with colliders any scale",
            ),
            (
                "AXES",
                "Principal Axes",
                "Origin at the center of mass, axes along the principal axes, unit scale",
            ),
            ("KEEP", "Keep", "Leave origin and axes as they are"),
        ),
    )
    use_density: BoolProperty(name="Set Density", description="Give all objects one density first")
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
        description="Make an object and the selected objects that are parented to it one body with "
        "their total mass",
        default=True,
    )
    comparison: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def draw(self, _context: Context) -> None:
        density = ("density",) if self.use_density else ()
        selection.draw_properties(
            self, "type", "shape", "frame", "compounds", "use_density", *density
        )
        column = self.layout.column(align=True)
        for line in self.comparison.splitlines():
            column.label(text=line, translate=False)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        if self.use_density:
            for obj in objects:
                if obj.is_editable:
                    obj.body_moments.mass_from = "DENSITY"
                    obj.body_moments.density_from = "VALUE"
                    obj.body_moments.density = self.density
        rigid_bodies = session.make_rigid_bodies(
            context, objects, self.type, self.shape, self.frame, self.compounds
        )
        self.comparison = _compare_masses(context, rigid_bodies)
        count = len(rigid_bodies.measured)
        mass = float(sum(body.target.mass for body in rigid_bodies.measured.values()))
        summary = write.reports.phrase(
            "{count} rigid body of {mass:.7g} kg",
            "{count} rigid bodies of {mass:.7g} kg",
            count=count,
            mass=mass,
        )
        if rigid_bodies.calculated and all(rigid_bodies.calculated.values()):
            summary += write.reports.phrase(
                "; Calculate Mass would say {calculated:.7g} kg",
                calculated=float(sum(rigid_bodies.calculated.values())),
            )
        if rigid_bodies.floors:
            floors = write.reports.phrase(
                "{count} passive body without volume",
                "{count} passive bodies without volume",
                count=len(rigid_bodies.floors),
            )
            summary = "; ".join([summary, floors]) if count else floors
            count += len(rigid_bodies.floors)
        findings = [
            body.target.finding.of_sources([obj.name])
            for obj, body in rigid_bodies.measured.items()
            if body.target.finding is not None and self.frame == "AXES"
        ]
        findings = [*_display_scaled(context, count), *findings]
        if self.frame == "KEEP":
            findings += _centers_elsewhere([body.target for body in rigid_bodies.measured.values()])
        return selection.summarize(
            self,
            count,
            count + len(rigid_bodies.failures),
            summary,
            rigid_bodies.failures,
            findings,
        )


def _compare_masses(context: Context, rigid_bodies: "session.rigid_bodies.RigidBodies") -> str:
    """Return a line for each of the first bodies: its exact mass, and its mass by Calculate
    Mass.
    """
    units = write.units.Units.from_settings(context.scene.unit_settings)
    lines = []
    for obj, body in list(rigid_bodies.measured.items())[:SHOWN]:
        line = "{:s}: {:s}".format(obj.name, units.text("mass", body.target.mass))
        if rigid_bodies.calculated[obj] > 0.0:  # Calculate Mass weighs no compound
            calculated = units.text("mass", rigid_bodies.calculated[obj])
            line += write.translations.localized("; Calculate Mass: {:s}").format(calculated)
        lines.append(line)
    if len(rigid_bodies.measured) > SHOWN:
        lines.append(
            write.translations.localized("And {:d} more").format(len(rigid_bodies.measured) - SHOWN)
        )
    return "\n".join(lines)


class OBJECT_OT_body_moments_set_rigid_body_mass(
    modal.ModalSteps, selection.OnSelectionInObjectMode, Operator
):
    """Set the mass of rigid bodies to the measured mass in kilograms. The physics engine uses the
    origin as center of mass; use Axes to Principal Axes as well
    """

    bl_label = "Set Rigid Body Mass"
    MAX_AT_ONCE = selection.MAX_OBJECTS_WITHOUT_REDRAW

    add: BoolProperty(
        name="Add Rigid Bodies",
        description="Add an active rigid body to objects without one",
    )
    axes: BoolProperty(
        name="Set Origins and Axes",
        description=(
            "Move origins to the centers of mass and align the local axes with the principal axes, "
            "as the physics "
            "engine takes them to be. Nothing visible moves"
        ),
    )

    def _begin(self, context: Context) -> int:
        self._objects = selection.selected_measurable(context)
        self._bodies: list[scene.snap_targets.SnapTarget] = []
        self._failures: list[Finding] = []
        target_in_turn = scene.targets_in_turn(context, self._objects)

        def measure(obj: Object) -> None:
            scene.changes.require_storable_data(obj)
            if obj.rigid_body is None and not self.add:
                raise EditRefusedError(scene.findings.RIGID_BODY_UNFIT, fault=NOT_A_RIGID_BODY)
            if obj.rigid_body is None and obj.type != "MESH":
                raise EditRefusedError(
                    scene.findings.RIGID_BODY_UNFIT, fault=scene.findings.RIGID_BODY_NEEDS_MESH
                )
            if obj.rigid_body is None:
                scene.rigid_world.require_rigid_world(context.scene)
            body = target_in_turn(obj)
            if body.mass < scene.rigid_world.MIN_MASS:
                raise EditRefusedError(
                    scene.findings.RIGID_BODY_MASS_TOO_SMALL,
                    mass=float(body.mass),
                    limit=scene.rigid_world.MIN_MASS,
                )
            self._bodies.append(body)

        self._steps = selection.iterate_objects(self._objects, measure, self._failures)
        return len(self._objects)

    def _finish(self, context: Context) -> set[str]:
        bodies, failures = self._bodies, self._failures
        # Blender reports a rigid body as a change of the shape.
        with read.tracking.tracking_paused():
            new = [body.obj for body in bodies if body.obj.rigid_body is None]
            scene.rigid_world.add_rigid_bodies(context, new)
            changed = set(new)
            for body in bodies:
                before = body.obj.rigid_body.mass
                body.obj.rigid_body.mass = body.mass  # is rounded to float32
                if body.obj.rigid_body.mass != before:
                    changed.add(body.obj)
            context.view_layer.update()
        findings = []
        if self.axes:
            objects = [body.obj for body in bodies]
            plans, refused = session.reframe_objects(
                context, objects, scene.matrix_along_axes, move_only=False
            )
            failures += refused
            changed |= {plan.obj for plan in plans}
            findings += [
                finding.of_sources([plan.obj.name]) for plan in plans for finding in plan.findings
            ]
        count = len(changed)
        findings += _display_scaled(context, count)
        findings += _centers_elsewhere(bodies) if count else []
        summary = write.reports.phrase(
            "Set the rigid body mass of {count} object",
            "Set the rigid body mass of {count} objects",
            count=count,
        )
        idle = write.reports.phrase("the masses are equal")
        return selection.summarize(
            self, count, len(self._objects), summary, failures, findings, idle
        )


def _centers_elsewhere(bodies: "list[scene.snap_targets.SnapTarget]") -> list[Finding]:
    """Return the warning that names the bodies whose center of mass is not their origin, if any."""
    names = [body.obj.name for body in bodies if scene.matrix_at_center(body.obj, body) is not None]
    return [finding(RIGID_BODY_CENTER_ELSEWHERE, objects=names)] if names else []


def _display_scaled(context: Context, count: int) -> list[str]:
    """Return a list of one message: Blender multiplies displayed masses by the cube of the unit
    scale; [] if it does not, or if no body of `count` shows one.
    """
    unit = scale.meters_per_unit(context.scene)
    if not count or unit == 1.0 or context.scene.unit_settings.system == "NONE":
        return []
    return [
        write.reports.phrase(
            "Physics properties show masses times {factor:.6g} (unit scale cubed); the physics "
            "engine uses kilograms.",
            factor=unit**3,
        )
    ]
