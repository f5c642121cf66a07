# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colliders of measured objects, and their effect on the physics of each object, stored on it."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from bpy.types import Context, Object

from ...core import bodies, colliders, inertia, mesh, moments, numerics, robots, verdict
from ...core.measurement import Measurement, digest, plain
from .. import read, write
from ..bodies.stack import Measured
from ..read.fingerprint import colliders_digest, scale_products
from ..scale import meters_per_unit
from ..scene import changes
from ..scene import colliders as scene
from ..settings.given import COLLIDER, COLLIDERS
from .tracking import staleness, stamps
from .tracking.stamps import Kind, Stale, Stamp

# Relative. Float32 entries are rounded by 6e-8, so matrices of turned copies differ by some 1e-7.
SAME = 1e-5
LIMITED = ("automatic", "hull", "pieces")  # shapes with tolerances


@dataclass(frozen=True, eq=False)
class Plan:
    """The colliders of an object, in its frame, with their effect.

    stretch: (3, 3) map from the object's coordinates to its frame. record: the shapes' settings,
    distances and effects as plain values. fingerprint: of the measurement. key: equal for objects
    that share their meshes.
    """

    obj: Object
    shapes: tuple[robots.Shape, ...]
    stretch: numerics.Array
    record: dict[str, Any]
    fingerprint: str
    key: str


def plan_colliders(
    obj: Object,
    measured: Measured,
    unit: float,
    fit_request: colliders.Wanted,
    is_share: bool,
    correct: str,
    known_plans: dict[str, Plan],
) -> Generator[float, None, Plan]:
    """Plan the colliders of an object, in steps that yield the completed share; MeasureError if it
    cannot have any.

    unit: meters per Blender unit. is_share: the tolerances of `fit_request` are parts of the size,
    else they are in m. correct: "NONE", "MASSES" or "VERTICES". known_plans: plans of this run by
    their keys, to which this one is added.
    """
    changes.require_storable_data(obj)
    measurement = measured.measurement
    surface = _surface(obj, measured)
    stretch = scene.stretch_of(obj, measurement.rotation)
    if moments.are_singular(stretch[None])[0]:
        raise verdict.ReadError(read.findings.SCALE_ZERO_AXIS)
    body = measurement.in_object_frame()
    key = _mesh_key(obj, measured)
    if key in known_plans:
        return replace(known_plans[key], obj=obj, fingerprint=measurement.fingerprint)
    if is_share:
        size = float(np.ptp(surface.points, axis=0).max())
        fit_request = replace(
            fit_request, outward=size * fit_request.outward, inward=size * fit_request.inward
        )
    hull = colliders.hull_of(surface)
    shapes = yield from colliders.make_colliders(surface, body, fit_request, hull)
    # Masses and effects are those of the float32 vertices that the file will hold.
    shapes = [scene.as_stored(shape, stretch, unit) for shape in shapes]
    masses = colliders.uniform_masses(measurement.density, shapes)
    if correct == "VERTICES":
        shapes = yield from colliders.correct_vertices(
            body, shapes, surface, fit_request.outward, fit_request.inward
        )
        shapes = [scene.as_stored(shape, stretch, unit) for shape in shapes]
        masses = colliders.uniform_masses(measurement.density, shapes)
    if correct == "MASSES":
        masses = colliders.correct_masses(body, shapes)
    elif correct == "VERTICES" or fit_request.shape.startswith("equal_"):
        masses = [mass * body.mass / sum(masses) for mass in masses]
    shapes = [replace(shape, mass=float(mass)) for shape, mass in zip(shapes, masses)]
    record: dict[str, Any] = {
        "shape": fit_request.shape,
        "correct": correct.lower(),
        "count": len(shapes),
    }
    if fit_request.shape in LIMITED:
        record["tolerance"] = [fit_request.outward, fit_request.inward]
        record["limits"] = [fit_request.pieces, fit_request.vertices]
    record |= zip(
        ("outward", "inward", "distance_bound"), colliders.distances(surface, shapes, hull)
    )
    record |= colliders.effect(body, shapes, measurement.volume).as_record()
    record["body"] = _describe_body(body)
    known_plans[key] = Plan(
        obj, tuple(shapes), stretch, plain(record), measurement.fingerprint, key
    )
    return known_plans[key]


def _mesh_key(obj: Object, measured: Measured) -> str:
    """Return a key that is equal for objects with the same settings and meshes in the same places
    of their frames, up to `SAME`; other bodies than solids have keys of their own.
    """
    measurement = measured.measurement
    parts = []
    to_frame = robots.Pose(measurement.location, measurement.rotation).inverse()
    for solid, matrices in getattr(measured.body, "solids", ()):
        linear = to_frame.rotation @ matrices[:, :3, :3]
        places = matrices[:, :3, 3] @ to_frame.rotation.T + to_frame.position
        scale = np.abs(linear).max()
        size = scale * np.abs(solid.given_surface.points).max()
        # A step of the logarithm is a relative one; adding zero makes -0 equal to 0.
        rounded = [
            np.round(coordinates / SAME) + 0.0
            for coordinates in (linear / scale, places / size, np.log(scale))
        ]
        parts += [solid.given_surface.points, solid.given_surface.all_triangles()[0], *rounded]
    if not parts:
        return str(obj.session_uid)
    settings = Stamp.parse(measurement.fingerprint).settings.encode()
    parts.append(np.float64(measurement.density))
    return digest(settings + b"".join(np.ascontiguousarray(part).tobytes() for part in parts))


def _surface(obj: Object, measured: Measured) -> mesh.Surface:
    """Return the measured surface, repaired if it is a solid's, in the object's frame in m, or
    raise ReadError if there is none.
    """
    measurement = measured.measurement
    pieces = [*measured.body.surfaces(measurement.kind == "shell")]
    if not pieces:
        raise verdict.ReadError(
            read.findings.OBJECT_WITHOUT_GEOMETRY,
            subject=obj.name,
            type=obj.bl_rna.properties["type"].enum_items[obj.type].name,
        )
    to_frame = robots.Pose(measurement.location, measurement.rotation).inverse()
    return mesh.join_surfaces(pieces).transform(to_frame.rotation, to_frame.position)


def store_colliders(context: Context, plans: Sequence[Plan], engine: str) -> list[Object]:
    """Make the planned colliders in place of earlier ones, store their effects on the bodies, and
    return the colliders.
    """
    unit = meters_per_unit(context.scene)
    earlier = scene.colliders_by_body(context.scene.objects)
    meshes: dict[str, list] = {}
    new_colliders = []
    for plan in plans:
        if plan.key not in meshes:
            meshes[plan.key] = [
                scene.collider_mesh(shape, plan.stretch, unit) for shape in plan.shapes
            ]
        new_colliders += scene.place_colliders(
            context,
            plan.obj,
            earlier.get(plan.obj, ()),
            plan.shapes,
            meshes[plan.key],
            plan.stretch,
            unit,
            engine,
        )
    context.view_layer.update()
    for plan in plans:
        staleness.note_edits(plan.obj)
        marks = {
            "fingerprint": plan.fingerprint,
            "digest": colliders_digest(plan.obj),
            "scale": scale_products(plan.obj),
            "engine": engine,
        }
        # ID properties hold no None.
        effects = {
            key: value
            for key, value in plan.record.items()
            if None not in (value if isinstance(value, list) else [value])
        }
        plan.obj[COLLIDERS] = effects | marks
    staleness.mark_stored(context, [plan.obj for plan in plans], Kind.COLLIDERS)
    return new_colliders


@contextmanager
def colliders_kept_current(context: Context, objects: Iterable[Object]) -> Iterator[None]:
    """Keep the stored effects of colliders valid while a block gives their bodies other frames and
    stores results anew, but changes nothing else. Effects that are out of date before stay so.
    """
    matrices = {
        obj: bodies.float64_matrix(obj.matrix_world)
        for obj in objects
        if COLLIDERS in obj and staleness.stale_reason(obj, context.scene, Kind.COLLIDERS) is None
    }
    yield
    context.view_layer.update()
    for obj, before in matrices.items():
        group = obj[COLLIDERS]
        places = np.array([bodies.float64_matrix(obj.matrix_world), before])
        (axes, axes_before), _is_sheared = numerics.polar_rotation(places)
        # The shift is along the body's axes; in the world it stays.
        group["center_shift"] = (axes.T @ axes_before @ group["center_shift"]).tolist()
        group["fingerprint"] = write.properties.fingerprint(obj) or group["fingerprint"]
        group["digest"] = colliders_digest(obj)
        group["scale"] = scale_products(obj)
        staleness.note_edits(obj)
    staleness.mark_stored(context, matrices, Kind.COLLIDERS)


def remove_colliders(context: Context, objects: Iterable[Object]) -> int:
    """Remove the colliders of objects and their stored effects; return the number of objects that
    had any, with the orphans.

    Orphans, colliders among the objects whose bodies were deleted, are removed themselves.
    """
    by_body = scene.colliders_by_body(context.scene.objects)
    orphans = [obj for obj in objects if COLLIDER in obj and obj.parent is None]
    owners = [obj for obj in objects if obj in by_body or COLLIDERS in obj]
    scene.remove_colliders(
        [*orphans, *(collider for obj in owners for collider in by_body.get(obj, ()))]
    )
    for obj in owners:
        obj.pop(COLLIDERS, None)
    return len(owners) + len(orphans)


def collider_record(
    obj: Object, measurement: Measurement, context: Context
) -> dict[str, Any] | None:
    """Return the effect of an object's colliders for its record, with the reason if it is out of
    date; else None.
    """
    stamp = stamps.stamp_of(obj, Kind.COLLIDERS)
    if stamp is None:
        return None
    stored = {
        key: value.to_list() if hasattr(value, "to_list") else value
        for key, value in obj[COLLIDERS].items()
    }
    reason = staleness.stale_reason(obj, context.scene, Kind.COLLIDERS)
    # Edits that were made without the add-on are not noted, so the geometry is compared, too. A
    # turned body has another digest, but the same numbers.
    is_same = Stamp.parse(measurement.fingerprint).geometry == stamp.geometry or _is_same_body(
        stored.get("body", ()), measurement.in_object_frame()
    )
    if reason is None and not is_same:
        reason = Stale.GEOMETRY
    reported_keys = stored.keys() - {"fingerprint", "digest", "scale", "body", "limits"}
    return {key: stored[key] for key in stored if key in reported_keys} | {
        "out_of_date": reason and str(reason)
    }


def _describe_body(body: inertia.MassProperties) -> list[float]:
    """Return mass, center and inertia as 1 + 3 + 9 numbers, in kg and m in the object's frame, so
    that a turned body is recognized.
    """
    return [body.mass, *body.center.tolist(), *body.inertia.ravel().tolist()]


def _is_same_body(stored: Sequence[float], body: inertia.MassProperties) -> bool:
    """Return whether a body stored by `_describe_body` is this one, but for the rounding of turned
    matrices.
    """
    if len(stored) != 13 or not body.mass > 0.0:
        return False
    size = (float(body.inertia.trace()) / body.mass) ** 0.5  # a radius of gyration
    scales = np.repeat([body.mass, size, body.mass * size**2], [1, 3, 9])
    return bool(
        (np.abs(np.array(stored, np.float64) - _describe_body(body)) <= SAME * scales).all()
    )
