# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Colliders, Remove Colliders, and Add Equal-Inertia Shape, whose shapes are colliders too.

The origin of an equal-inertia shape is the center of mass and its axes are the principal ones,
which Bullet assumes; and from a box Bullet computes exactly the inertia of that box. So a box with
the object as its child falls as the object does.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Object, Operator

from ... import core
from ...blender import bodies, scale, scene, session, settings, write
from ...core.verdict import EditRefusedError, Finding, finding
from .. import findings, modal, selection

SHAPES = (
    ("AUTOMATIC", "Automatic", "The simplest shape within the tolerances, else convex pieces"),
    ("BOX", "Box", "The smallest box around the object"),
    ("AXES_BOX", "Box along Principal Axes", "The smallest box along the principal axes"),
    ("SPHERE", "Sphere", "The smallest sphere around the object"),
    ("CAPSULE", "Capsule", "A small capsule around the object"),
    ("CYLINDER", "Cylinder", "A small cylinder around the object"),
    ("HULL", "Convex Hull", "The convex hull, with a limited number of vertices"),
    ("PIECES", "Convex Pieces", "Several convex hulls, cut where the object is concave"),
    ("EQUAL_BOX", "Equal-Inertia Box", "The box of the same mass, center and inertia"),
    (
        "EQUAL_ELLIPSOID",
        "Equal-Inertia Ellipsoid",
        "The ellipsoid of the same mass, center and inertia",
    ),
    (
        "EQUAL_CAPSULE",
        "Equal-Inertia Capsule",
        "The capsule of the same mass and center, and of the nearest inertia",
    ),
)
HULLS = {"AUTOMATIC", "HULL", "PIECES"}  # shapes with tolerances and limits
ENGINES = (
    ("NONE", "None", "Names that no engine interprets"),
    ("UNREAL", "Unreal", "Prefixes by shape: UBX_, USP_, UCP_ and UCX_"),
    (
        "GODOT",
        "Godot, Convex",
        "Suffix -convcolonly: a StaticBody3D with a convex shape, which may be moved to a body "
        "that moves",
    ),
    ("GODOT_MESH", "Godot, Triangles", "Suffix -colonly: a StaticBody3D with the triangles"),
    ("UNITY", "Unity", "One child for each collider, to which its Collider component is added"),
)
MAX_SHOWN_NAMES = 4


class _Making(selection.OnSelectionInObjectMode, modal.ModalSteps):
    """Base of operators that make colliders: `_wanted` returns their shape and limits."""

    PROGRESS = "Making colliders: {share:.0%}. Esc to cancel"
    CANCELED = "Making colliders canceled; nothing was changed"
    tolerance = "LENGTH"
    correct = "NONE"
    engine = "NONE"
    # returns `core.colliders.fits.Wanted`, whose name Blender would evaluate, and so load numpy
    _wanted: Callable[[], Any]

    def _check(self, obj: Object) -> None:
        """Raise MeasureError for an object that cannot have the colliders."""

    def _begin(self, context: Context) -> float:
        self._plans: list[session.colliders.Plan] = []
        self._failures: list[Finding] = []
        self._objects = bodies_of(context)
        known_plans: dict[str, session.colliders.Plan] = {}
        unit = scale.meters_per_unit(context.scene)
        measured = bodies.measured_in_turn(self._objects, context.evaluated_depsgraph_get())
        fit_request = self._wanted()

        def add_plan(obj: Object) -> Generator[float, None, None]:
            self._check(obj)
            plan = yield from session.plan_colliders(
                obj,
                measured(obj),
                unit,
                fit_request,
                self.tolerance == "SHARE",
                self.correct,
                known_plans,
            )
            self._plans.append(plan)

        self._steps = selection.iterate_objects(self._objects, add_plan, self._failures)
        return len(self._objects)

    def _finish(self, context: Context) -> set[str]:
        self._made = session.store_colliders(context, self._plans, self.engine)
        summary = write.reports.phrase(
            "{count} collider made", "{count} colliders made", count=len(self._made)
        )
        if len(self._plans) == 1:
            summary += "; " + write.reports.phrase(
                "volume {share:percent} of the object's",
                share=self._plans[0].record["volume_ratio"],
            )
        beyond = [
            finding(
                findings.COLLIDERS_BEYOND_TOLERANCE,
                object=plan.obj.name,
                outward=plan.record["outward"],
                inward=plan.record["inward"],
                remedy=session.tolerance_remedy(plan.record),
            )
            for plan in self._plans
            if session.is_beyond_tolerance(plan.record)
        ]
        return selection.summarize(
            self, len(self._plans), len(self._objects), summary, self._failures, beyond
        )


class OBJECT_OT_body_moments_make_colliders(_Making, Operator):
    """Make or renew each selected object's colliders, as children, and compare their physics"""

    bl_label = "Make Colliders"

    shape: EnumProperty(
        name="Shape", description="What collides in place of the object", items=SHAPES
    )
    tolerance: EnumProperty(
        name="Tolerance",
        description="How the largest distances are given",
        items=(
            ("SHARE", "Share of Size", "Parts of the largest extent"),
            ("LENGTH", "Meters", "Lengths in meters"),
        ),
    )
    outward: FloatProperty(
        name="Outward",
        description="Largest distance by which the colliders may stand out of the object",
        default=0.03,
        min=0.0,
        precision=4,
        step=1,
    )
    inward: FloatProperty(
        name="Inward",
        description="Largest distance by which the object may stand out of the colliders",
        default=0.002,
        min=0.0,
        precision=4,
        step=1,
    )
    pieces: IntProperty(
        name="Pieces", description="Largest number of convex pieces", default=16, min=1, max=1024
    )
    vertices: IntProperty(
        name="Vertices",
        description="Largest number of vertices of a hull",
        default=64,
        min=4,
        max=255,
    )
    correct: EnumProperty(
        name="Correct",
        description="How the colliders get the mass, center and inertia of the object",
        items=(
            ("NONE", "Off", "Every collider has the density of the object"),
            (
                "MASSES",
                "Masses",
                "Give the pieces masses that sum to the object's mass, center and inertia",
            ),
            ("VERTICES", "Vertices", "Move vertices of the hulls, within the tolerances"),
        ),
    )
    engine: EnumProperty(
        name="Names For", description="The engine that reads the names", items=ENGINES
    )
    names: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def draw(self, _context: Context) -> None:
        limits = (
            ("tolerance", "outward", "inward", "pieces", "vertices") if self.shape in HULLS else ()
        )
        selection.draw_properties(self, "shape", *limits, "correct", "engine")
        column = self.layout.column(align=True)
        for name in self.names.splitlines():
            column.label(text=name, translate=False)

    def _wanted(self) -> core.colliders.fits.Wanted:
        return core.colliders.fits.Wanted(
            self.shape.lower(), self.outward, self.inward, self.pieces, self.vertices
        )

    def _finish(self, context: Context) -> set[str]:
        result = super()._finish(context)
        names = [obj.name for obj in self._made[: MAX_SHOWN_NAMES + 1]]
        self.names = "\n".join(
            name if index < MAX_SHOWN_NAMES else "…" for index, name in enumerate(names)
        )
        return result


class OBJECT_OT_body_moments_remove_colliders(selection.OnSelectionInObjectMode, Operator):
    """Remove the colliders that were made for the selected objects"""

    bl_label = "Remove Colliders"

    def execute(self, context: Context) -> set[str]:
        objects = bodies_of(context)
        count = session.remove_colliders(context, objects)
        summary = write.reports.phrase(
            "{count} object without colliders", "{count} objects without colliders", count=count
        )
        idle = write.reports.phrase("no selected object has colliders")
        return selection.summarize(self, count, len(objects), summary, idle=idle)


def bodies_of(context: Context) -> list[Object]:
    """Return the selected objects, each once, with the bodies in place of their colliders."""
    return list(dict.fromkeys(map(settings.given.body_of, context.view_layer.objects.selected)))


class OBJECT_OT_body_moments_equal_inertia(_Making, Operator):
    """Add a simple shape with the mass, center of mass and inertia of each selected object"""

    bl_label = "Add Equal-Inertia Shape"

    kind: EnumProperty(
        name="Shape",
        description="What is added",
        items=[
            (name.removeprefix("EQUAL_"), label.split()[-1], tip)
            for name, label, tip in SHAPES[-3:]  # the shapes of equal inertia
        ],
        default="BOX",
    )
    rigid_body: BoolProperty(
        name="As Rigid Body",
        description="Make the shape an active rigid body with the mass, and the object its child",
        default=False,
    )

    def _wanted(self) -> core.colliders.fits.Wanted:
        # the limits do not count for shapes of equal inertia
        return core.colliders.fits.Wanted("equal_" + self.kind.lower(), 0.0, 0.0, 1, 4)

    def _check(self, obj: Object) -> None:
        if self.rigid_body and (not obj.is_editable or obj.parent is not None):
            raise EditRefusedError(
                scene.findings.RIGID_BODY_UNFIT, fault=findings.PRIMITIVE_HAS_PARENT
            )
        if self.rigid_body:
            scene.rigid_world.require_rigid_world(bpy.context.scene)

    def _finish(self, context: Context) -> set[str]:
        result = super()._finish(context)
        scene.rigid_world.add_rigid_bodies(context, self._made if self.rigid_body else [])
        for new, plan in zip(self._made, self._plans) if self.rigid_body else ():
            # The new shape is no collider of the object, but its parent.
            matrix = new.matrix_world.copy()
            new.parent, new.matrix_world = None, matrix
            del new[settings.given.COLLIDER], plan.obj[settings.given.COLLIDERS]
            new.rigid_body.collision_shape = "BOX" if self.kind == "BOX" else "CONVEX_HULL"
            new.rigid_body.mass = plan.shapes[0].mass
            plan.obj.parent = new
            plan.obj.matrix_parent_inverse = matrix.inverted()
        return result
