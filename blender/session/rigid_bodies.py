# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies as Blender's physics engine takes them to be, for one object or a thousand.

Bullet takes an object's origin as its center of mass and its axes as principal axes, so these
belong together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import bpy
import numpy as np
from bpy.types import Context, Mesh, Object

from ...core import inertia, verdict
from ...core.measurement import NO_VOLUME
from ...core.mesh import convex_hull, triangle_areas
from .. import read, scale, scene, settings, write
from ..bodies.measure_object import measured_in_turn
from ..bodies.stack import Measured as MeasuredObject
from . import stored, tracking
from .colliders import colliders_kept_current

# Blender's collision shapes of colliders that are primitives; all others are convex hulls.
COLLISION_SHAPES = {"box": "BOX", "sphere": "SPHERE", "capsule": "CAPSULE", "cylinder": "CYLINDER"}
# of the size and of the area: over 100 times the rounding of float32 points, 6e-8 of their size
FLAT_RTOL = 1e-5
PROBE_DENSITY = 1e6  # for Calculate Mass: high, as Blender's rigid bodies weigh no less than a gram


Body = tuple[Object, ...]  # an object, and the objects below it that belong to the same body


class Measured(NamedTuple):
    """A measured body. density: mean density, kg/m³. parts: its objects with their measurements."""

    target: scene.snap_targets.SnapTarget
    density: float
    parts: dict[Object, MeasuredObject]


class RigidBodies(NamedTuple):
    """New rigid bodies by their objects, their masses in kg by Calculate Mass, the refusals of
    other bodies, and passive bodies without a mass.
    """

    measured: dict[Object, Measured]
    calculated: dict[Object, float]
    failures: list[verdict.Finding]
    floors: list[Object]


def make_rigid_bodies(
    context: Context, objects: Sequence[Object], type: str, shape: str, frame: str, compounds: bool
) -> RigidBodies:
    """Make objects, or with `compounds` each with its descendants, rigid bodies with their mass,
    center of mass and principal axes, and store their results.

    type: "ACTIVE" or "PASSIVE". shape: Blender's collision shape, or "KEEP". frame: "ORIGIN" for
    the center of mass alone, "AXES" with the principal axes, or "KEEP".
    """
    bodies = _bodies(objects) if compounds else [(obj,) for obj in objects]
    measured: dict[Object, Measured] = {}
    failures: list[verdict.Finding] = []
    floors: list[Object] = []
    measure_part = _measure_in_turn(context, bodies)
    with write.reports.progress(len(bodies)) as step:
        for finished, body in enumerate(bodies, 1):
            try:
                measured[body[0]] = _measured(context, body, measure_part)
            except Exception as error:
                code = error.finding.code if isinstance(error, verdict.MeasureError) else None
                if type == "PASSIVE" and code in {scene.findings.OPEN_OBJECT, NO_VOLUME}:
                    floors += body  # no engine asks for their mass
                else:
                    failures.append(write.reports.failure(body[0].name_full, error))
            step(finished)
    # Blender reports a rigid body as a change of the shape, and again when results are stored on it
    with (
        stored.assembly.kept_up_to_date(context),
        colliders_kept_current(context, objects),
        read.tracking.tracking_paused(),
    ):
        failures += _place(context, measured, frame)
        new = _add(context, measured, type, shape)
        new_floors = [obj for obj in floors if obj.rigid_body is None]
        scene.rigid_world.add_rigid_bodies(context, new_floors, type)
        depsgraph = context.evaluated_depsgraph_get()
        for obj in floors:
            obj.rigid_body.type = "PASSIVE"
            is_polygon = _is_convex_polygon(obj.evaluated_get(depsgraph).data)
            obj.rigid_body.collision_shape = "CONVEX_HULL" if is_polygon else "MESH"
        calculated = _calculated_masses(context, measured)
        for obj in [*new, *new_floors]:
            # The final mesh was weighed. It is set last, as Calculate Mass takes the default one.
            obj.rigid_body.mesh_source = "FINAL"
        for obj, measured_body in measured.items():
            obj.rigid_body.mass = measured_body.target.mass
        stored.results.store_measured(
            context,
            [part for measured_body in measured.values() for part in measured_body.parts.items()],
        )
    return RigidBodies(measured, calculated, failures, floors)


def _place(context: Context, measured: dict[Object, Measured], frame: str) -> list[verdict.Finding]:
    """Give each body the requested frame, and its new measurement in `measured`; remove refused
    bodies from there, and return the reasons.

    The joint of a moved body stays where it was, on an empty below the body.
    """
    failures: list[verdict.Finding] = []
    if frame == "KEEP":
        return failures
    frame_of = (
        scene.snap_targets.matrix_for_bullet
        if frame == "ORIGIN"
        else scene.snap_targets.matrix_along_axes
    )
    for _ in range(2):  # a new scale may cut faces that are not flat into other triangles
        plans = []
        joints = {}
        for obj, measured_body in list(measured.items()):
            target = frame_of(obj, measured_body.target)
            if target is None:
                continue
            try:
                scene.reframe.check(obj)
                joints[obj] = _joint_in_place(context, obj)
            except Exception as error:
                failures.append(write.reports.failure(obj.name_full, error))
                del measured[obj]
                continue
            move_only = np.array_equal(target[:3, :3], scene.transforms.world(obj)[:3, :3])
            plans.append(
                scene.reframe.Plan(obj, target, measured_body.target.size, move_only=move_only)
            )
        with write.reports.progress(len(plans)) as step:
            changed, refused = scene.reframe.reframe(context, plans, step)
        for plan in changed:
            if joints[plan.obj] is not None:
                scene.rigid_world.remove_joint(context, plan.obj)
        for obj, refusal in refused:
            failures.append(write.reports.failure(obj.name_full, refusal))
            del measured[obj]
            if joints[obj] is not None:
                bpy.data.objects.remove(joints[obj])
        measure_part = _measure_in_turn(context, [measured[plan.obj].parts for plan in changed])
        for plan in changed:
            measured[plan.obj] = _measured(context, (*measured[plan.obj].parts,), measure_part)
        tracking.staleness.mark_axes_changed(plan.obj for plan in changed if not plan.move_only)
    return failures


def _add(context: Context, measured: dict[Object, Measured], type: str, shape: str) -> list[Object]:
    """Add rigid bodies and set collision shapes; "KEEP" keeps them and uses existing colliders.

    Return the objects, not their colliders, that had no rigid body before.
    """
    parts = [part for measured_body in measured.values() for part in measured_body.parts]
    colliders = scene.colliders.colliders_by_body(context.scene.objects) if shape == "KEEP" else {}
    used_colliders = [collider for part in parts for collider in colliders.get(part, ())]
    new = [obj for obj in parts if obj.rigid_body is None]
    for collider in used_colliders:
        scene.colliders.apply_for_bullet(collider)
    scene.rigid_world.add_rigid_bodies(
        context, [*new, *(obj for obj in used_colliders if obj.rigid_body is None)], type
    )
    for collider in used_colliders:
        collider.rigid_body.collision_shape = COLLISION_SHAPES.get(
            collider[settings.given.COLLIDER]["kind"], "CONVEX_HULL"
        )
    fresh = set(new)
    for obj, measured_body in measured.items():
        # Blender joins the shapes of children to those of their parents, if these are compounds.
        parents = {part.parent for part in measured_body.parts if part != obj}
        for part in measured_body.parts:
            if part in fresh:
                part.rigid_body.collision_shape = "CONVEX_HULL"
            if part in parents or part in colliders:
                part.rigid_body.collision_shape = "COMPOUND"
            elif shape != "KEEP":
                part.rigid_body.collision_shape = shape
    for obj in (*new, *used_colliders):
        if obj.rigid_body.collision_shape == "CONVEX_HULL":
            # The margin rounds acute corners, and Blender shrinks hulls by it before their scale.
            obj.rigid_body.use_margin = True
            obj.rigid_body.collision_margin = 0.0
    return new


def _is_convex_polygon(mesh: Mesh) -> bool:
    """Return whether a mesh is flat and fills its hull, so that the hull can be its collision
    shape: compounds come to rest on a hull, but Bullet rocks them for ever on a mesh.
    """
    surface = read.mesh.mesh_surface(mesh, edges=False)
    try:
        hull = convex_hull(surface.points, FLAT_RTOL)
    except verdict.MeasureError:
        return False
    area = triangle_areas(surface.points, surface.all_triangles()[0]).sum()
    # A flat hull is closed: it has its triangles on both sides.
    both_sides = triangle_areas(hull.points, hull.triangles).sum()
    return hull.is_flat and abs(2.0 * area - both_sides) <= FLAT_RTOL * both_sides


def _bodies(objects: Sequence[Object]) -> list[Body]:
    """Return a body for each object without a parent among `objects`, with its descendants among
    them.
    """
    object_set = set(objects)
    members: dict[Object, list[Object]] = {
        obj: [] for obj in objects if obj.parent not in object_set
    }
    for obj in objects:
        top = obj
        while top.parent in object_set:
            top = top.parent
        if top != obj:
            members[top].append(obj)
    return [(obj, *below) for obj, below in members.items()]


def _measure_in_turn(
    context: Context, bodies: Iterable[Iterable[Object]]
) -> Callable[[Object], MeasuredObject]:
    """Return a function that measures the objects of the bodies, one at a time and in order."""
    return measured_in_turn(
        [part for body in bodies for part in body], context.evaluated_depsgraph_get()
    )


def _measured(
    context: Context, body: Body, measure_part: Callable[[Object], MeasuredObject]
) -> Measured:
    """Measure a body as it is now; raise EditRefusedError if it cannot be a rigid body."""
    scene.rigid_world.require_rigid_world(
        context.scene, joints=body[0].rigid_body_constraint is not None
    )
    parts = {body[0]: _measured_part(body[0], measure_part)}
    for part in body[1:]:
        try:
            parts[part] = _measured_part(part, measure_part)
        except verdict.MeasureError as error:
            raise verdict.EditRefusedError(error.finding.of_sources([part.name_full])) from error
    measurements = [measured.measurement for measured in parts.values()]
    if len(parts) > 1:
        compound = inertia.combine(
            [measurement.mass_moments for measurement in measurements],
            preferred_axes=measurements[0].rotation,
        )
        target = scene.snap_targets.SnapTarget.of_body(
            body[0], compound, compound.principal, scale.meters_per_unit(context.scene)
        )
    else:
        target = scene.snap_targets.target_of(context, body[0], parts[body[0]])
    if target.mass < scene.rigid_world.MIN_MASS:
        raise verdict.EditRefusedError(
            scene.findings.RIGID_BODY_MASS_TOO_SMALL,
            mass=float(target.mass),
            limit=scene.rigid_world.MIN_MASS,
        )
    return Measured(
        target, target.mass / sum(measurement.volume for measurement in measurements), parts
    )


def _measured_part(
    part: Object, measure_part: Callable[[Object], MeasuredObject]
) -> MeasuredObject:
    """Measure an object of a body, or raise a MeasureError if it is no closed mesh."""
    scene.changes.require_storable_data(part)
    if part.type != "MESH":
        raise verdict.EditRefusedError(
            scene.findings.RIGID_BODY_UNFIT, fault=scene.findings.RIGID_BODY_NEEDS_MESH
        )
    measured = measure_part(part)
    if measured.measurement.method.procedure == verdict.Procedure.OPEN:
        raise verdict.EditRefusedError(scene.findings.OPEN_OBJECT)
    return measured


def _calculated_masses(context: Context, measured: dict[Object, Measured]) -> dict[Object, float]:
    """Return the mass in kg that Blender's Calculate Mass gives each body at the body's mean
    density. Leaves other masses on the rigid bodies, which the caller replaces.
    """
    objects = list(measured)
    if not objects:
        return {}
    with context.temp_override(object=objects[0], selected_objects=objects):
        bpy.ops.rigidbody.mass_calculate(material="Custom", density=PROBE_DENSITY)
    # The operator multiplies its volume by the density.
    return {
        obj: obj.rigid_body.mass * measured_body.density / PROBE_DENSITY
        for obj, measured_body in measured.items()
    }


def _joint_in_place(context: Context, obj: Object) -> Object | None:
    """Add an empty with a copy of the object's joint, in its place, and return it; None without a
    joint.
    """
    joint = obj.rigid_body_constraint
    if joint is None:
        return None
    empty = bpy.data.objects.new("{:s} Joint".format(obj.name), None)
    for collection in obj.users_collection:
        collection.objects.link(empty)
    location, turn, _scale = obj.matrix_world.decompose()
    empty.rotation_mode = "QUATERNION"
    empty.location = location
    empty.rotation_quaternion = turn
    copy = scene.rigid_world.add_joint(context, empty, joint.type)
    for prop in joint.bl_rna.properties:
        if not prop.is_readonly:
            setattr(copy, prop.identifier, getattr(joint, prop.identifier))
    empty.parent = obj
    empty.matrix_parent_inverse = obj.matrix_world.inverted()
    return empty
