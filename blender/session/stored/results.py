# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results are stored here, and made ready to be shown: in the wanted frame, and summed over a selection.

A panel is drawn at every movement of the mouse, so both are cached: one object's by its stored numbers and place, the
totals until Blender reports any change.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import chain, groupby
from typing import Any

import bpy
import numpy as np
from bpy.types import Context, Object, Scene
from mathutils import Matrix
from numpy.typing import NDArray

from ....core.inertia.mass_properties import MassProperties, combine
from ....core.numerics.float32 import shortest_decimal
from ....core.numerics.rotations import rotation_matrix
from ....core.verdict.finding import Finding
from ....core.verdict.method import Method, Verdict
from ...bodies.grids.threshold import ThresholdGridBody
from ...bodies.measure_object import Measured
from ...bodies.stacks.stack import MeasuredStack, Stacked
from ...bodies.wall import WallBody
from ...read.fingerprint import settings_hash
from ...read.rig import skinned_objects
from ...read.total_caveats import open_body_caveats, total_caveats
from ...settings.density import is_density_unset
from ...write import properties
from ..live import live
from ..tracking import handlers, posed, staleness, updates
from ..tracking.cache import SessionCache
from . import density, faults, reference, threshold, trust, walls


@dataclass(frozen=True, eq=False)
class Total:
    """Selected objects as one body, SI, world axes.

    count: objects with results; body: None if they have no mass; missing: names of objects without results; stale,
    doubtful: names of objects with outdated or untrustworthy results; findings: on possible non-parts.
    """

    count: int
    volume: float
    area: float
    body: MassProperties | None
    missing: tuple[str, ...]
    stale: tuple[str, ...]
    doubtful: tuple[str, ...]
    findings: tuple[Finding, ...]


ASSEMBLY = Method(Verdict.ASSEMBLY)
_failures: SessionCache[tuple[Finding, str]] = SessionCache()  # why, and the digest of the settings of then
_worlds: SessionCache[tuple[tuple, properties.StoredProperties | None]] = SessionCache()  # and what they were made from
_totals: SessionCache[tuple[tuple, Total]] = SessionCache()  # a scene's last one, after what was computed for it


def store(obj: Object, measured: Measured, scene: Scene) -> None:
    """Write a measurement on the object, and remember the data for its sliders.

    Raises EditRefusedError if the object cannot hold results.
    """
    measured = replace(measured, measurement=density.noted(obj, measured.measurement, scene))
    staleness.note_edits(obj)
    about = reference.stored_choice(obj)
    properties.store(obj, measured.measurement)
    faults.remember(obj, measured)
    reference.follow(obj, scene, about)
    if isinstance(measured.body, WallBody):
        walls.cache_walls(obj, measured, _unit(scene))
    elif isinstance(measured.body, ThresholdGridBody):
        threshold.cache_grid(obj, measured, _unit(scene))


def store_many(
    measured: Sequence[tuple[Object, Measured | Stacked]], scene: Scene
) -> Iterator[tuple[Object, Exception | None]]:
    """Store the results of many objects as `store` does; yield each with its error or None.

    An object has an error if it cannot hold results.
    """
    for stack, run in groupby(measured, key=lambda item: getattr(item[1], "stack", None)):
        items: list[tuple[Object, Any]] = list(run)
        if stack is None:
            for obj, alone in items:
                try:
                    store(obj, alone, scene)
                except Exception as error:
                    yield obj, error
                else:
                    yield obj, None
        else:
            yield from _store_stack(stack, [each.index for _, each in items], scene)


def _store_stack(stack: MeasuredStack, which: list[int], scene: Scene) -> Iterator[tuple[Object, Exception | None]]:
    part = stack.some(which)
    objects = [member.obj for member in part.members]
    about = {}
    for obj in objects:
        staleness.note_edits(obj)
        if "body_reference" in obj:
            about[obj] = reference.stored_choice(obj)
    findings = list(part.findings)
    for i, (obj, from_mass) in enumerate(zip(objects, part.from_mass.tolist())):
        if not from_mass and is_density_unset(obj.body_moments, scene):
            findings[i] = density.with_default_note(findings[i], "density")
    refusals = properties.store_stack(
        objects,
        part.in_object_frames(),
        part.density,
        part.volume.raw[:, 0],
        part.area.raw[:, 0],
        part.error_bounds,
        zip([member.shape.method for member in part.members], findings, part.fingerprints),
    )
    for obj, member, refusal in zip(objects, part.members, refusals):
        if refusal is None:
            if (defects := member.shape.defects) is None:
                faults.forget(obj)
            else:
                faults.remember_own(obj, member.shape.surface, defects)
            if obj in about:
                reference.follow(obj, scene, about[obj])
        yield obj, refusal


def remember_failure(obj: Object, reason: Finding | None) -> None:
    """Keep, while the file is open, the reason why the object could not be measured; None forgets it."""
    if reason is None:
        _failures.forget(obj)
    else:
        _failures[obj] = reason, settings_hash(obj, bpy.context.scene)


def failure(obj: Object) -> Finding | None:
    """Return the reason why the last measurement with these settings failed, if it did."""
    remembered = _failures.get(obj)
    if remembered is None:
        return None
    reason, settings = remembered
    return reason if settings == settings_hash(obj, bpy.context.scene) else None


def of_object(obj: Object, scene: Scene) -> properties.StoredProperties | None:
    """Return the results in the displayed frame, live if Live is on, else stored; None if any are missing."""
    return _of_object(obj, scene, scene.body_moments.frame == "OBJECT")


def in_world(obj: Object, scene: Scene) -> properties.StoredProperties | None:
    """Return the results as `of_object` does, always in the world frame."""
    if live.is_live(obj) or posed.stands_for_meshes(obj):
        return _of_object(obj, scene, False)
    key = (updates.last_change(obj), properties.numbers(obj), _unit(scene))
    known = _worlds.get(obj)
    if known is None or known[0] != key:
        known = _worlds[obj] = (key, _of_object(obj, scene, False))
    return known[1]


def _of_object(obj: Object, scene: Scene, in_own_frame: bool) -> properties.StoredProperties | None:
    if posed.stands_for_meshes(obj) and (posed_body := _of_meshes(obj, scene)) is not None:
        location, turn, _ = obj.matrix_world.decompose()
        own = rotation_matrix(turn), np.array(location, np.float64) * _unit(scene)
        if not in_own_frame:
            return posed_body
        values = posed_body.density, posed_body.volume, posed_body.area, posed_body.error_bound
        return properties.StoredProperties.of_body(posed_body.body.in_frame(*own), *values)
    shown = live.current_properties(obj, scene)
    if shown is not None:
        return shown if in_own_frame else shown.in_world(obj.matrix_world, _unit(scene))
    numbers = properties.numbers(obj)
    if numbers is None:
        return None
    return _in_frame(numbers, None if in_own_frame else _world_matrix(obj), _unit(scene))


def _summed(bodies: Sequence[MassProperties]) -> MassProperties | None:
    """Return bodies as one, by the parallel-axis theorem, for all of them at once; None if they have no mass."""
    masses = np.array([body.mass for body in bodies])
    if not masses.sum() > 0.0:  # the stored values were changed
        return None
    centers = np.array([body.center for body in bodies])
    about = masses @ centers / masses.sum()
    arms = centers - about
    inertia = np.array([body.inertia for body in bodies])
    second = np.trace(inertia, axis1=1, axis2=2).sum() / 2.0 * np.eye(3) - inertia.sum(axis=0)
    second += np.einsum("i,ij,ik->jk", masses, arms, arms)
    inertia = np.trace(second) * np.eye(3) - second
    whole = replace(bodies[0], mass=float(masses.sum()), center=about, inertia=inertia)
    return combine([(whole.as_moments(), 1.0)])


def _of_meshes(armature: Object, scene: Scene) -> properties.StoredProperties | None:
    """Return the sum of an armature's meshes that have numbers, in the world; None if there is no mass."""
    parts = [part for mesh in posed.deformed_meshes(armature) if (part := _of_object(mesh, scene, False)) is not None]
    body = _summed([part.body for part in parts])
    if body is None:
        return None
    volume, area = sum([part.volume for part in parts]), sum([part.area for part in parts])
    bound = _bound_of_sum(parts, body.center, [part.error_bound for part in parts])
    bound["input"] = _bound_of_sum(parts, body.center, [part.error_bound["input"] for part in parts])
    return properties.StoredProperties.of_body(body, body.mass / volume if volume else 0.0, volume, area, bound)


def _bound_of_sum(parts: Sequence[properties.StoredProperties], center: NDArray, bounds: Sequence[dict]) -> dict:
    """Return the bound of a sum of bodies, from the bound of each."""
    volume, area, center_error, inertia = np.array(
        [[bound[name] for name in properties.BOUND_KEYS] for bound in bounds], np.float64
    ).T
    mass = np.array([part.body.mass for part in parts])
    arm = np.linalg.norm([part.body.center - center for part in parts], axis=1)
    sizes = np.array([(part.volume, part.area) for part in parts]).T  # a shell without thickness has its mass by area
    share = np.where(sizes[0] > 0.0, volume, area) / np.maximum(np.where(sizes[0] > 0.0, *sizes), np.finfo(float).tiny)
    own = mass * (1.0 + share)
    center_of_sum = float((own * center_error + share * mass * arm).sum() / mass.sum())
    reach = arm + center_error + center_of_sum
    inertia_of_sum = inertia + own * (reach * reach - arm * arm) + share * mass * arm * arm
    values = volume.sum(), area.sum(), center_of_sum, inertia_of_sum.sum()
    return dict(zip(properties.BOUND_KEYS, map(float, values)))


def are_meshes_measured(armature: Object, scene: Scene) -> bool:
    """Return whether the meshes that an armature deforms have a mass, stored or live."""
    found = [of_object(mesh, scene) for mesh in posed.deformed_meshes(armature)]
    return sum(stored.body.mass for stored in found if stored is not None) > 0.0


def total(context: Context) -> Total:
    """Return the selected objects as one body, by the parallel-axis theorem, from stored results."""
    key = (handlers.generation(), context.view_layer.name)
    cached = _totals.get(context.scene)
    if cached is None or cached[0] != key:
        cached = _totals[context.scene] = (key, _sum(context))
    return cached[1]


def _sum(context: Context) -> Total:
    scene = context.scene
    stored, counted, missing, stale, doubtful = [], [], [], [], []
    chosen = posed.subjects(context.view_layer.objects.selected)
    selected = set(chosen)
    for obj in chosen:
        if properties.method(obj) == ASSEMBLY and not selected.isdisjoint(_members(obj, selected)):
            continue  # its members count by themselves
        body_now = in_world(obj, scene)
        if body_now is None:
            missing.append(obj.name)
            continue
        stored.append(body_now)
        counted.append(obj)
        verdict = trust.trust(obj, scene)
        if verdict == trust.Trust.OUT_OF_DATE:
            stale.append(obj.name)
        elif verdict == trust.Trust.DOUBTFUL:
            doubtful.append(obj.name)
    caveats = open_body_caveats((obj.name, properties.method(obj)) for obj in counted)
    return Total(
        len(stored),
        sum(body_stored.volume for body_stored in stored),
        sum(body_stored.area for body_stored in stored),
        _summed([body_stored.body for body_stored in stored]),
        tuple(missing),
        tuple(stale),
        tuple(doubtful),
        (*caveats, *total_caveats(counted, context.view_layer)),
    )


def _members(obj: Object, objects: Iterable[Object]) -> list[Object]:
    """Return the objects of an assembly or a character."""
    return [*obj.children_recursive, *skinned_objects(obj, objects)]


@lru_cache(maxsize=512)
def _in_frame(numbers: tuple, place: tuple[float, ...] | None, unit: float) -> properties.StoredProperties:
    stored = properties.from_numbers(numbers)
    if place is None:
        return stored
    return stored.in_world(Matrix([place[i : i + 4] for i in range(0, 16, 4)]), unit)


def _world_matrix(obj: Object) -> tuple[float, ...]:
    return tuple(chain.from_iterable(obj.matrix_world))


def _unit(scene: Scene) -> float:
    return shortest_decimal(scene.unit_settings.scale_length)
