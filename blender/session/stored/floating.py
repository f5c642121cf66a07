# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating objects: where they rest, and the numbers of the place in which they are held.

An object floats as one body with the objects that it carries (its children). The body is read on
request; it is remembered until a shape, a setting or a place within it changes, and read again
then by the timer of Live if that is on (`follow`). The waterline follows the place, the liquid and
its density at once.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.types import Context, Depsgraph, Object, Scene

from ....core import floating, numerics, verdict
from ....core.bodies import float64_matrix
from ... import settings, write
from ...bodies.measure_body import measure_body
from ...bodies.measure_object import measure_many
from ...read import visibility
from ...scale import meters_per_unit
from ...scene import changes, fcurves, findings, reframe, rigid_world
from ...scene.transforms import TransformChannels, world
from .. import memory
from ..tracking import handlers, staleness
from ..tracking.stamps import Kind
from . import results

# relative: float32 matrices are rounded by 6e-8, some 1e-7 after turns of several parents
PLACE_RTOL = 1e-5
SAME_REST = 1e-4  # rad: positions of rest that differ by less are the same; chosen
GZ_KEY = "body_righting_arm"


@dataclass(eq=False)
class Afloat:
    """A floating body.

    uids: the session uids of its objects, which survive undo; name: of the first one. places:
    (k, 4, 4) their matrices when it was read; roles: of the members.
    rest: where it settles from there, in m. curve: its righting arms. rests: all positions of rest.
    displayed: the key of `held_body`, and the outcome for it. seconds: of reading the body.
    """

    uids: tuple[int, ...]
    name: str
    places: numerics.Array
    roles: tuple
    rest: floating.Flotation
    curve: floating.RightingCurve | None = None
    rests: tuple[floating.Flotation, ...] = ()
    displayed: tuple[tuple, Held | verdict.Finding | None] | None = None
    seconds: float = 0.0


@dataclass(frozen=True, eq=False)
class Held:
    """A body as its objects stand now.

    state: the position with their attitude, in the body's coordinates. matrix: (4, 4) from these to
    the world, m. up: against gravity. is_at_rest: whether it is at its level, and does not turn.
    heel, trim: of the root's axes, rad.
    """

    afloat: Afloat
    state: floating.Flotation
    matrix: numerics.Array
    up: numerics.Array
    is_at_rest: bool
    heel: float
    trim: float

    def to_world(self, points: numerics.Array) -> numerics.Array:
        """Return (..., 3) points in the world, m."""
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]


def bodies_of(objects: Iterable[Object], as_one: bool) -> list[tuple[Object, ...]]:
    """Return the objects of each floating body, its root first. as_one: all are one body."""
    bodies = [
        (root, *[child for child in root.children_recursive if visibility.measurable(child)])
        for root in dict.fromkeys(_roots([_carrier(obj) for obj in objects]))
    ]
    bodies = [body for body in bodies if any(map(visibility.measurable, body))]
    if as_one and bodies:
        return [tuple(dict.fromkeys(obj for body in bodies for obj in body))]
    return bodies


def _roots(objects: Sequence[Object]) -> list[Object]:
    """Return the objects that no other one of them carries."""
    return [
        obj
        for obj in objects
        if not any(ancestor in objects for ancestor in changes.ancestors(obj.parent))
    ]


def _carrier(obj: Object) -> Object:
    """Return the body that an object belongs to as a tank or a flooded space, else the object."""
    while obj.body_moments_tank.role != "BODY" and obj.parent is not None:
        obj = obj.parent
    return obj


def _up(scene: Scene) -> numerics.Array:
    """Return the (3,) unit vector against gravity, or raise MeasureError if there is none."""
    if not rigid_world.has_gravity(scene):
        raise verdict.MeasureError(floating.FLOAT_UNAVAILABLE, fault=floating.NO_GRAVITY)
    return -rigid_world.down(scene)


def _roles(members: Iterable[Object]) -> tuple:
    tanks = [member.body_moments_tank for member in members]
    return tuple((tank.role, tank.fill if tank.role == "TANK" else 0.0) for tank in tanks)


def read(
    depsgraph: Depsgraph,
    members: Sequence[Object],
    options: settings.options.MeasureOptions = settings.options.AS_SET,
    density: float | None = None,
) -> Afloat:
    """Read a floating body and settle it, without moving anything; MeasureError if it does not
    float.

    options: of the objects with a mass of their own. density: of the liquid, kg/m³, in place of the
    scene's.
    """
    start = time.thread_time()
    scene = depsgraph.scene
    # Options that replace density or mass are not meant for tanks and flooded spaces.
    space_options = replace(settings.options.AS_SET, unit_scale=options.unit_scale)
    parts = {
        obj: measure_body(
            obj, depsgraph, options if obj.body_moments_tank.role == "BODY" else space_options
        )
        for obj in members
        if visibility.measurable(obj)
    }

    def having(role: str) -> list[Object]:
        return [obj for obj in parts if obj.body_moments_tank.role == role]

    own_bodies = [parts[obj].measurement.mass_properties for obj in having("BODY")]
    own_masses = np.array([properties.mass for properties in own_bodies])
    mass = float(own_masses.sum())
    shares = own_masses / (mass or 1.0)  # `settle` refuses a mass of 0
    center = shares @ np.reshape([properties.center for properties in own_bodies], (-1, 3))
    bounds = np.reshape([parts[obj].measurement.center_bounds for obj in having("BODY")], (-1, 2))
    rest = floating.settle(
        [parts[obj].body for obj in having("BODY")],
        mass,
        center,
        settings.floating.liquid_density(scene) if density is None else density,
        _up(scene),
        [
            (parts[obj].body, obj.body_moments_tank.fill / 100.0, parts[obj].measurement.density)
            for obj in having("TANK")
        ],
        [parts[obj].body for obj in having("FLOODED")],
        shares @ bounds,
    )
    places = np.array([float64_matrix(obj.matrix_world) for obj in members])
    uids = tuple(obj.session_uid for obj in members)
    return Afloat(
        uids, members[0].name, places, _roles(members), rest, seconds=time.thread_time() - start
    )


def remember(afloat: Afloat, members: Iterable[Object], depsgraph: Depsgraph) -> None:
    """Keep a body for the panel and the overlay."""
    for obj in members:
        memory.afloat[obj] = afloat
        staleness.carry(obj, Kind.FLOATING, depsgraph)


def _keep(context: Context, afloat: Afloat, members: Iterable[Object]) -> Afloat:
    """Remember a body; measure its members whose results are missing or out of date."""
    outdated = [
        obj
        for obj in members
        if visibility.measurable(obj)
        and obj.body_moments_tank.role == "BODY"
        and (not write.properties.is_stored(obj) or staleness.stale_reason(obj, context.scene))
    ]
    results.store_measured(
        context,
        [
            (obj, outcome)
            for together in measure_many(outdated, context.evaluated_depsgraph_get())
            for obj, outcome in together
            if not isinstance(outcome, Exception)
        ],
    )
    remember(afloat, members, context.evaluated_depsgraph_get())
    return afloat


def float_body(
    context: Context, members: Sequence[Object], position: int, notes: list[verdict.Finding]
) -> bool:
    """Move the objects of a body to where it rests, and remember it there; return whether they had
    to move. All stay if one cannot follow.

    position: 0 to settle from the present attitude, else the number of a position of rest, from 1
    on. notes: findings about the position are appended.
    """
    roots = _roots(members)
    for root in roots:
        reframe.check_movable(root)
    afloat = _read_again(context, members)
    rest = afloat.rest
    if position:
        rests = afloat.rests or rest.body.find_rests([rest])
        rest = rests[(position - 1) % len(rests)]
        if not rest.is_near(afloat.rest, SAME_REST):
            afloat.curve = None  # it begins at another position
    notes += rest.findings
    scene = context.scene
    unit = meters_per_unit(scene)
    matrix = rest.matrix(_up(scene), scene.body_moments_liquid.level * unit)
    matrix[:3, 3] /= unit
    size = rest.body.size / unit
    saved = [TransformChannels(root) for root in roots]
    is_moved = False
    targets = {member: matrix @ world(member) for member in members}
    try:
        # A second pass corrects roots that constraints bind to others, which moved after them.
        for root in roots * 2:
            target = targets[root]
            off = np.abs(target - world(root))
            # 1e-6 is over 10 times the rounding of float32 matrices.
            is_turned = off[:, :3].max() > 1e-6 * np.abs(target[:, :3]).max()
            if is_turned or off[:, 3].max() > reframe.location_tolerance(root, size):
                is_moved = True
                reframe.move(context, reframe.Plan(root, target, size, move_only=False))
        for member, target in targets.items():
            if not _is_close(world(member), target, size):
                raise verdict.EditRefusedError(findings.CHILD_NOT_HELD, object=member.name)
    except BaseException:
        for channels in saved:
            channels.restore()
        context.view_layer.update()
        raise
    _keep(context, replace(afloat, rest=rest), members)
    return is_moved


def _turn_since(afloat: Afloat, members: Sequence[Object], scene: Scene) -> numerics.Array | None:
    """Return the (4, 4) rigid motion of a body since it was read, in Blender units and the world;
    None if its members have changed otherwise, or moved against each other.
    """
    if _roles(members) != afloat.roles or any(
        staleness.stale_reason(member, scene, Kind.FLOATING) for member in members
    ):
        return None
    present = np.array([world(member) for member in members])
    before = afloat.places[0]
    # The nearest rotation, and stretches that are 1 for a rigid motion.
    left, stretches, right = np.linalg.svd(present[0, :3, :3] @ np.linalg.inv(before[:3, :3]))
    turn = np.eye(4)
    turn[:3, :3] = left @ right
    turn[:3, 3] = present[0, :3, 3] - turn[:3, :3] @ before[:3, 3]
    size = afloat.rest.body.size / meters_per_unit(scene)
    is_rigid = (np.abs(stretches - 1.0) <= PLACE_RTOL).all()
    return turn if is_rigid and _is_close(turn @ afloat.places, present, size) else None


def _read_again(context: Context, members: Sequence[Object]) -> Afloat:
    """Read a body; take over the positions of rest and the righting arms that are remembered if
    only its place has changed. Their attitudes are turned with the body.
    """
    afloat = read(context.evaluated_depsgraph_get(), members)
    remembered = memory.afloat.get(members[0])
    if (
        remembered is None
        or remembered.uids != afloat.uids
        or remembered.rest.body.density != afloat.rest.body.density
    ):
        return afloat
    if (turn := _turn_since(remembered, members, context.scene)) is not None:
        settle_at = afloat.rest.body.settle
        with suppress(verdict.MeasureError):
            afloat.rests = tuple(settle_at(turn[:3, :3] @ rest.up) for rest in remembered.rests)
        if np.linalg.norm(turn[:3, :3] @ remembered.rest.up - afloat.rest.up) < SAME_REST:
            afloat.curve = remembered.curve
    return afloat


def _is_close(places: numerics.Array, expected: numerics.Array, size: float) -> bool:
    """Return whether (..., 4, 4) matrices are equal up to rounding; size: of their body, in the
    unit of the matrices.
    """
    off = np.abs(places - expected)
    # Locations far from the origin are rounded by up to this; a sum with those of parents by more.
    far = float(np.spacing(np.float32(np.abs(expected[..., 3]).max())))
    return bool(
        off[..., :3].max() <= PLACE_RTOL * np.abs(expected[..., :3]).max()
        and off[..., 3].max() <= PLACE_RTOL * size + 4.0 * far
    )


def find_positions(context: Context, members: Sequence[Object]) -> Afloat:
    """Find all positions of rest of a body, and keep them."""
    afloat = _read_again(context, members)
    afloat.rests = tuple(afloat.rest.body.find_rests([afloat.rest]))
    return _keep(context, afloat, members)


def heel(
    context: Context, members: Sequence[Object], angles: numerics.Array, free_trim: bool
) -> Afloat:
    """Compute the righting arms of a body from where it settles, and keep them."""
    afloat = _read_again(context, members)
    afloat.curve = floating.righting_curve(afloat.rest, angles, free_trim=free_trim)
    return _keep(context, afloat, members)


def add_curve(context: Context, afloat: Afloat) -> Object:
    """Add an empty with an F-curve of the righting arms, a frame for each degree of heel."""
    assert afloat.curve is not None
    empty = bpy.data.objects.new("GZ {:s}".format(afloat.name), None)
    context.scene.collection.objects.link(empty)
    empty[GZ_KEY] = 0.0
    empty.id_properties_ui(GZ_KEY).update(description="Righting arm GZ, m; frames are degrees")
    fcurves.write_keys(
        fcurves.ensure_curves(empty, alone=True),
        ('["{:s}"]'.format(GZ_KEY), 0),
        fcurves.time_scale(context.scene) * np.degrees(afloat.curve.angles),
        afloat.curve.arms,
    )
    return empty


def held_body(obj: Object, scene: Scene) -> Held | verdict.Finding | None:
    """Return an object's floating body as it stands now, the reason if it does not float, or None
    if it was not read or is out of date.
    """
    afloat = memory.afloat.get(obj)
    if afloat is None:
        return None
    liquid = scene.body_moments_liquid.level, settings.floating.liquid_density(scene)
    key = (memory.state.generation, scene.session_uid, *liquid)
    if afloat.displayed is None or afloat.displayed[0] != key:
        try:
            value = _read_held(afloat, scene)
        except verdict.MeasureError as refusal:
            value = refusal.finding
        afloat.displayed = (key, value)
    return afloat.displayed[1]


def _members(afloat: Afloat, scene: Scene) -> list[Object]:
    """Return the objects of a body, none if one is gone."""
    by_uid = {member.session_uid: member for member in scene.objects}
    return [by_uid[uid] for uid in afloat.uids] if {*afloat.uids} <= by_uid.keys() else []


def follow(depsgraph: Depsgraph, budget: float) -> bool:
    """Read the bodies with Live on that have changed again, if that took no longer than the budget
    in seconds; return whether others wait.
    """
    waiting = False
    for afloat in {id(afloat): afloat for afloat in memory.afloat}.values():
        members = _members(afloat, depsgraph.scene)
        if not any(member in memory.followed for member in members) or (
            _turn_since(afloat, members, depsgraph.scene) is not None
        ):
            continue
        if afloat.seconds > budget:
            waiting = True
            continue
        try:
            remember(read(depsgraph, members), members, depsgraph)
        except verdict.MeasureError as refusal:
            afloat.displayed = ((), refusal.finding)
            handlers.count_change(members[0])
    return waiting


def _read_held(afloat: Afloat, scene: Scene) -> Held | verdict.Finding | None:
    """Return a floating body as it stands now, None if it is out of date. With Live on it keeps
    its last outcome until the timer reads it again.
    """
    members = _members(afloat, scene)
    if not members:
        return None
    turn = _turn_since(afloat, members, scene)
    if turn is None:
        is_live = any(member in memory.followed for member in members)
        _key, last_outcome = afloat.displayed or (None, None)
        return last_outcome if is_live else None
    unit = meters_per_unit(scene)
    turn[:3, 3] *= unit  # from the body's coordinates, those of the world at reading, in m
    up = _up(scene)
    body = afloat.rest.body
    if body.density != settings.floating.liquid_density(scene):
        body = replace(body, density=settings.floating.liquid_density(scene))
    state = body.at(turn[:3, :3].T @ up)
    level = scene.body_moments_liquid.level * unit
    height = float(up @ turn[:3, 3]) + state.level
    # The level is a float32 setting, rounded by 6e-8.
    tolerance = PLACE_RTOL * body.size + 1e-6 * abs(level)
    is_at_rest = state.residual < PLACE_RTOL and abs(height - level) < tolerance
    # A mirrored matrix has no rotation of its own: its X axis counts as the mirrored one.
    axes = world(members[0])[:3, :3]
    axes /= np.linalg.norm(axes, axis=0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    return Held(afloat, state, turn, up, is_at_rest, *floating.heel_and_trim(up, axes))
