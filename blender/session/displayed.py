# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The displayed numbers of objects, and the verdict on them: panels, list and overlay ask here.

Loads no numpy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

import bpy
from bpy.types import ID, Context, Object, PoseBone, Scene, ViewLayer
from mathutils import Matrix

from ...core.bodies import DENSITY_DEFAULTED
from ...core.inertia import PlainBody, add_bodies
from ...core.lazy import loaded_module
from ...core.verdict import (
    Finding,
    Group,
    Method,
    Procedure,
    Verdict,
    find_verdict,
    grouped,
    open_body_caveats,
)
from .. import read, scale, write
from ..settings.chosen import chosen_objects
from . import character, live, memory, stored
from .live import following
from .tracking import armatures, handlers, staleness, stamps

ASSEMBLY = Method(Procedure.ASSEMBLY)
BY_OTHERS = ("MATERIALS", "VOLUME")  # densities that change without an update of the object
RANKS = {verdict: rank for rank, verdict in enumerate(Verdict)}


class Displayed(NamedTuple):
    """The displayed numbers of an object, SI.

    numbers: in the object frame. world: in the world frame. unit: meters per Blender unit. reason:
    the reason if the numbers are out of date. live: the object with Live on. lag: the lag of live
    numbers behind the object. is_posed: whether the numbers are a sum of parts in the present pose.
    is_plumbed: whether a plumb line is drawn with a support polygon, in place of a drop line.
    shows_axes: whether principal axes may be drawn.
    """

    numbers: PlainBody
    world: PlainBody
    unit: float
    method: Method | None
    findings: Sequence[Finding]
    verdict: Verdict
    reason: stamps.Stale | None = None
    live: following.Followed | None = None
    lag: following.Lag = following.Lag.NONE
    is_posed: bool = False
    is_plumbed: bool = False
    shows_axes: bool = True

    @property
    def is_assumed(self) -> bool:
        """True if nobody has set the density."""
        return any(finding.code == DENSITY_DEFAULTED for finding in self.findings)

    def in_frame(self, frame: str) -> PlainBody:
        """Return the numbers in the frame of a setting, "OBJECT" or "WORLD"."""
        return self.numbers if frame == "OBJECT" else self.world


@dataclass(frozen=True, eq=False)
class Total:
    """Selected objects as one body.

    count: objects with results; numbers: SI, world axes, None if they have no mass; missing: names
    of objects without results; stale: names of objects with outdated results; assumed: the number
    of objects whose density nobody has set; findings: caveats about the sum; verdict: incomplete if
    some objects have no results, else the least of any object; groups: the objects' own findings.
    """

    count: int
    volume: float
    area: float
    numbers: PlainBody | None
    missing: tuple[str, ...]
    stale: tuple[str, ...]
    assumed: int
    findings: tuple[Finding, ...]
    verdict: Verdict | None
    groups: tuple[Group, ...]


def displayed(obj: Object, scene: Scene) -> Displayed | None:
    """Return the displayed numbers of an original object: posed, live or stored; None if there are
    none.
    """
    weighed = _weighed(obj, scene) if obj.type == "ARMATURE" else None
    if weighed is not None:
        return weighed
    if obj.type == "ARMATURE" and armatures.stands_for_meshes(obj):
        meshes = armatures.deformed_meshes(obj)
        # Stored bones follow the pose at once; with Live on, edits of the meshes count, too.
        if "body_mass" in obj and not any(mesh in memory.followed for mesh in meshes):
            parts = [drawn_bone(bone, scene) for bone in obj.pose.bones]
        else:
            parts = [displayed(mesh, scene) for mesh in meshes]
        if (total := _as_one(obj, scene, parts)) is not None:
            return total
    current = memory.followed.get(obj)
    if current is not None and (measurement := current.measurement) is not None:
        numbers = live.mapping.map_properties(obj, current, measurement, scene)
        method = measurement.method
        findings = stored.density.noted(obj, measurement, scene).findings
        lag = live.mapping.lag(obj)
        reason = staleness.stale_reason(obj, scene, stamps.Kind.LIVE)
        is_behind = reason is not None or lag == following.Lag.BEHIND
        verdict = Verdict.OUT_OF_DATE if is_behind else find_verdict(method, findings)
        unit = scale.meters_per_unit(scene)
        return Displayed(
            numbers,
            numbers.in_world(obj.matrix_world, unit),
            unit,
            method,
            findings,
            verdict,
            reason,
            current,
            lag,
        )
    numbers = write.properties.stored(obj) if "body_mass" in obj else None
    return None if numbers is None else _stored(obj, scene, numbers, obj.matrix_world, obj)


def _stored(
    obj: Object, scene: Scene, numbers: PlainBody, matrix: Matrix, measured: Object | PoseBone
) -> Displayed:
    """Return stored numbers at their place in the world.

    obj: the object, or the armature of a bone. numbers: in the object's or bone's frame. matrix:
    from this frame to the world, in Blender units. measured: the owner of the stored method.
    """
    unit = scale.meters_per_unit(scene)
    world = numbers.in_world(matrix, unit)
    method = write.properties.method(measured)
    findings = write.properties.findings(obj)
    reason = staleness.stale_reason(obj, scene)
    verdict = find_verdict(method, findings) if reason is None else Verdict.OUT_OF_DATE
    return Displayed(numbers, world, unit, method, findings, verdict, reason)


def drawn(obj: Object, scene: Scene) -> Displayed | None:
    """Return the numbers of an original object at its place, or of a character in its pose; None
    without a mass.
    """
    return all_drawn([obj], scene)[0]


def all_drawn(objects: Iterable[Object], scene: Scene) -> list[Displayed | None]:
    """Return `drawn` of many objects, cached until Blender or the session reports a change of the
    object.
    """
    settings = scene.body_moments
    key = (
        scene.session_uid,
        scene.unit_settings.scale_length,
        settings.default_material,
        settings.default_density,
    )
    if key != memory.state.drawn_in:
        memory.drawn.clear()
        memory.state.drawn_in = key
    bodies = []
    for obj in objects:
        uid = obj.session_uid
        cached = memory.drawn.get(uid)
        bodies.append(
            cached if cached is not None and uid not in memory.moved else _draw(obj, scene, cached)
        )
    return bodies


def _draw(obj: Object, scene: Scene, before: Displayed | None) -> Displayed | None:
    """Return `drawn` of an object; keep it if it depends on no other object. before: its numbers
    before it moved, None if more has changed.
    """
    if obj.type == "ARMATURE":
        body = displayed(obj, scene)
        if body is not None and not body.is_posed:  # its own stored numbers are of the rest pose
            body = _as_one(obj, scene, [drawn_bone(bone, scene) for bone in obj.pose.bones])
    else:
        stamp = None if before is None or before.reason is not None else stamps.stamp_of(obj)
        # An object that has only moved keeps its numbers if their stamp holds at the new place.
        if (
            before is not None
            and stamp is not None
            and read.fingerprint.has_transform(obj, stamp.transform)
        ):
            body = before._replace(world=before.numbers.in_world(obj.matrix_world, before.unit))
        else:
            body = displayed(obj, scene) if "body_mass" in obj or obj in memory.followed else None
    if body is None or not body.world.mass > 0.0:
        return None
    # Other objects change such numbers without a report about this one. Those of Live are changed
    # by a timer.
    depends_on_others = (
        obj.type == "ARMATURE"
        or obj.instance_type != "NONE"
        or len(obj.particle_systems)
        or body.method == ASSEMBLY
        or obj.body_moments.density_from in BY_OTHERS
    )
    if not depends_on_others and body.live is None:
        memory.drawn[obj.session_uid] = body
        memory.moved.discard(obj.session_uid)
    return body


def note_updates(events: handlers.Updates) -> None:
    """Drop the cached numbers of objects that Blender has evaluated again; after a move, only the
    place.
    """
    for uid in (*events.reshaped, *events.others):
        memory.drawn.pop(uid, None)
    memory.moved.update(memory.drawn.keys() & events.moved)


def forget_drawn(data: ID | None = None) -> None:
    """Drop the cached numbers of an object, or of all."""
    if data is None:
        memory.drawn.clear()
        memory.moved.clear()
    else:
        memory.drawn.pop(data.session_uid, None)


def drawn_bone(bone: PoseBone, scene: Scene) -> Displayed | None:
    """Return the numbers of an original armature's bone at the bone's current place, or None if
    there are none.
    """
    numbers = write.properties.stored(bone)
    if numbers is None:
        return None
    armature = bone.id_data
    return _stored(armature, scene, numbers, armature.matrix_world @ bone.matrix, bone)


def _as_one(armature: Object, scene: Scene, parts: Iterable[Displayed | None]) -> Displayed | None:
    """Return the sum of a character's meshes or bones in its current pose; None if they have no
    mass.
    """
    measured_parts = [part for part in parts if part is not None]
    world = add_bodies([part.world for part in measured_parts])
    if world is None:
        return None
    unit = scale.meters_per_unit(scene)
    rest_mass = write.properties.optional(armature, "body_mass")
    if rest_mass is not None:  # posing stretches and squeezes the skin, and leaves the mass
        factor = rest_mass / world.mass
        world = world._replace(
            mass=rest_mass,
            density=factor * world.density,
            inertia=tuple(factor * value for value in world.inertia),
            moments=tuple(factor * value for value in world.moments),
        )
    numbers = world.in_object(armature.matrix_world, unit)
    worst = max(measured_parts, key=lambda part: RANKS[part.verdict])
    return Displayed(
        numbers, world, unit, worst.method, worst.findings, worst.verdict, is_posed=True
    )


def _weighed(armature: Object, scene: Scene) -> Displayed | None:
    """Return a character whose weight is shown, by its bones in the present pose; None for
    others.
    """
    depsgraph = bpy.context.view_layer.depsgraph
    # Nothing is weighed before Show Weight has loaded the module.
    weight_module = loaded_module(character, "weight")
    if not armature.body_moments_weight.show or weight_module is None or depsgraph is None:
        return None
    weight = weight_module.weight(armature, depsgraph)
    if weight is None:
        return None
    numbers = weight.body.in_object(armature.matrix_world, scale.meters_per_unit(scene))
    return _stored(armature, scene, numbers, armature.matrix_world, armature)._replace(
        world=weight.body,
        is_posed=True,
        is_plumbed=True,
        shows_axes=armature.body_moments_weight.show_axes,
    )


def shown_objects(context: Context) -> list[Object]:
    """Return the objects whose numbers the panel shows: the chosen ones.

    The meshes of a posed armature stand in its place.
    """
    return armatures.subjects(chosen_objects(context))


def total(context: Context) -> Total:
    """Return the selected objects as one body, by the parallel-axis theorem, from displayed
    numbers.
    """
    return _sum(context.scene, context.view_layer, *shown_objects(context))


def places(objects: Iterable[Object]) -> frozenset[tuple]:
    """Return a key that changes if other objects are chosen or if one moves."""
    return frozenset((obj.session_uid, *map(tuple, obj.matrix_world)) for obj in objects)


def _members(obj: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the members of an assembly or character: its descendants, and the `objects` that it
    deforms.
    """
    return [*obj.children_recursive, *read.rig.skinned_objects(obj, objects)]


@memory.until_change
def _sum(scene: Scene, layer: ViewLayer, *objects: Object) -> Total:
    """Return the sum of the displayed numbers of objects. An assembly or character is left out if
    some of its members are among the objects.
    """
    selected = set(objects)
    parts = {}
    missing = []
    for obj in objects:
        if write.properties.method(obj) == ASSEMBLY and not selected.isdisjoint(
            _members(obj, selected)
        ):
            continue  # its members count by themselves
        body = displayed(obj, scene)
        if body is None:
            missing.append(obj.name)
        else:
            parts[obj] = body
    worlds = [body.world for body in parts.values()]
    single_body = next((world for world in worlds if world.mass > 0.0), None)
    stale = tuple(obj.name for obj, body in parts.items() if body.verdict == Verdict.OUT_OF_DATE)
    # Overlaps hold for the very objects and places at which they were sought.
    overlap_places, overlaps = memory.overlaps.get(scene) or (None, ())
    if stale or overlap_places != places(parts):
        overlaps = ()
    verdict = max((body.verdict for body in parts.values()), key=RANKS.__getitem__, default=None)
    if missing and parts:
        verdict = Verdict.INCOMPLETE
    return Total(
        count=len(parts),
        volume=sum(world.volume for world in worlds),
        area=sum(world.area for world in worlds),
        numbers=add_bodies(worlds) if len(worlds) > 1 else single_body,
        missing=tuple(missing),
        stale=stale,
        assumed=sum(body.is_assumed for body in parts.values()),
        findings=(
            *open_body_caveats((obj.name, write.properties.method(obj)) for obj in parts),
            *read.assembly.total_caveats(parts, layer),
            *overlaps,
        ),
        verdict=verdict,
        groups=tuple(
            grouped(
                (obj.name_full, finding) for obj, body in parts.items() for finding in body.findings
            )
        ),
    )


class SortBy(StrEnum):
    """Sort key of the lines."""

    NAME = "NAME"
    MASS = "MASS"  # the heaviest first
    VERDICT = "VERDICT"  # the least trustworthy first


@memory.until_change
def listed_masses(scene: Scene, view_layer: ViewLayer, units: write.units.Units) -> dict[int, str]:
    """Return texts of the masses of a view layer's measured objects by session uid, with common
    unit and decimals.
    """
    objects = list(view_layer.objects)
    masses = {
        obj.session_uid: body.world.mass
        for obj, body in zip(objects, all_drawn(objects, scene))
        if body is not None
    }
    return dict(zip(masses, units.texts("mass", list(masses.values()))))


@memory.until_change
def listing(
    scene: Scene, view_layer: ViewLayer, name: str, sort_by: SortBy, warnings_first: bool
) -> tuple[list[bool], list[int]]:
    """Return two lists over a view layer's objects: whether each is listed, and its line, warnings
    first on request.
    """
    objects = list(view_layer.objects)
    bodies = [
        body if name.lower() in obj.name.lower() else None
        for obj, body in zip(objects, all_drawn(objects, scene))
    ]
    order = sorted(
        range(len(objects)), key=lambda i: _rank(objects[i], bodies[i], sort_by, warnings_first)
    )
    lines = [0] * len(objects)
    for line, i in enumerate(order):
        lines[i] = line
    return [body is not None for body in bodies], lines


def _rank(obj: Object, body: Displayed | None, sort_by: SortBy, warnings_first: bool) -> tuple:
    """Return the sort key of an object's line; objects without a line come last."""
    if body is None:
        return (True,)
    by = {SortBy.MASS: -body.world.mass, SortBy.VERDICT: -RANKS[body.verdict]}
    is_first = warnings_first and body.verdict in (Verdict.OUT_OF_DATE, Verdict.DOUBTFUL)
    return (False, not is_first, by.get(sort_by, 0.0), obj.name.lower(), obj.name)
