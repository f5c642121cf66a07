# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring objects: read, hand to the core, say what came out.

`measure_object` is the one way from an object to its numbers; the button, the snapping operators and the command line
all go through it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.decimal import decimal
from ..core.mass import MassProperties
from ..core.measurement import Measurement
from ..core.moments import Moments, are_similarities, map_sum, sum_moments
from ..core.polyhedron import solid_and_area
from ..core.solid import Faults, Health, SolidMeasure, measure_solid
from ..core.surface import Surface, boxes_meet, joined
from .fingerprint import effective_hash, fingerprint, matrix_hash
from .read import Part, Reading, Unreadable, read_object
from .read.union import union_surface

COMPARED = 200_000  # triangles up to which instances are compared with each other as shells of one mesh


@dataclass(frozen=True)
class MeasureOptions:
    """What overrides the objects' own settings; None leaves the setting. SI units.

    kind: "solid" or "shell"; density: kg/m³; mass: kg; thickness: m; overlap: "signed" or "union"; unit_scale: metres
    per Blender unit, else the scene's.
    """

    kind: str | None = None
    density: float | None = None
    mass: float | None = None
    thickness: float | None = None
    overlap: str | None = None
    unit_scale: float | None = None
    threads: int = 1


def measure_object(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph,
                   options: MeasureOptions = MeasureOptions()) -> Measurement:
    """The mass properties of one object as it is evaluated, in SI units and world axes.

    Raises `Unreadable`, with the reason and the remedy, where there is nothing to measure.
    """
    scene = depsgraph.scene
    unit = options.unit_scale or decimal(scene.unit_settings.scale_length)
    options = _resolved(options, obj, unit)
    reading = read_object(obj, depsgraph)
    shell = options.kind == "shell"
    if reading.singular and not shell:
        raise Unreadable(obj.name, "A zero scale flattens it; set its scale, or its parents', to something else than "
                                   "zero, or measure it as a shell.")
    try:
        if options.overlap == "union" and not shell:
            body = _united(reading, unit, options.threads)
        else:
            body = _summed(reading, unit, shell, options.threads)
        return _told(obj, reading, body, options, unit)
    except ValueError as error:
        raise Unreadable(obj.name, str(error)) from error


@dataclass(frozen=True)
class _Body:
    """All parts of an object together, in SI units and world axes."""

    volume: Moments
    area: Moments
    health: Health
    method: str
    warnings: tuple[str, ...]
    parts: tuple[tuple[SolidMeasure, NDArray], ...]


def _resolved(options: MeasureOptions, obj: bpy.types.Object, unit: float) -> MeasureOptions:
    """The options with every gap filled from the object's settings."""
    settings = obj.body_moments
    density, mass = options.density, options.mass
    if density is None and mass is None:
        density, mass = ((decimal(settings.density), None) if settings.mass_from == "DENSITY"
                         else (None, decimal(settings.mass)))
    return MeasureOptions(
        kind=options.kind or settings.kind.lower(), density=density, mass=mass,
        thickness=decimal(settings.thickness) * unit if options.thickness is None else options.thickness,
        overlap=options.overlap or settings.overlap.lower(), threads=options.threads)


def _summed(reading: Reading, unit: float, shell: bool, threads: int) -> _Body:
    """Each part measured once in its own coordinates, and mapped to wherever it stands."""
    volumes, areas, healths, methods, warnings, parts = [], [], [], [], [], []
    if not shell and reading.places > 1 and _boxes_meet(reading):
        if sum((len(part.surface.triangles) + 2 * len(part.surface.quads)) * len(part.matrices)
               for part in reading.parts) <= COMPARED:
            return _as_one(reading, unit, threads)
        warnings.append(
            "Overlap was not looked for between its {:d} instances, and boxes around some of them overlap; what "
            "those share counts twice.".format(reading.places))
    for part in reading.parts:
        solid = measure_solid(part.surface, shell=shell, threads=threads)
        matrices = _scaled(part.matrices, unit)
        volumes.append(map_sum(solid.volume, matrices))
        areas.extend(_mapped_areas(part, solid.area, matrices, shell, threads))
        stretch = volumes[-1].total / solid.volume.total if solid.volume.total else 0.0  # Σ |det|
        healths.append((replace(solid.health, volume_spread=solid.health.volume_spread * stretch), len(matrices)))
        methods.append(solid.method)
        if shell and solid.health.duplicate_faces:
            warnings.append("{:d} faces are copies of others and count with them.".format(solid.health.duplicate_faces))
        if not shell:  # a shell is measured as it is
            warnings.extend(w for w in solid.warnings if w not in warnings)
        parts.append((solid, matrices))
    ranked = ("open", "capped", "reoriented", "exact")
    return _Body(sum_moments(volumes), sum_moments(areas), _together(healths), min(methods, key=ranked.index),
                 tuple(warnings), tuple(parts))


def _as_one(reading: Reading, unit: float, threads: int) -> _Body:
    """All parts where they stand as one surface, so that they are compared as the shells of one mesh are."""
    solid = measure_solid(_realized(reading), threads=threads)
    scale = np.diag([unit, unit, unit, 1.0])
    health = replace(solid.health, volume_spread=solid.health.volume_spread * unit**3, faults=Faults())
    return _Body(solid.volume.mapped(scale), solid.area.mapped(scale), health, solid.method, solid.warnings,
                 ((solid, scale[None]),))


def _realized(reading: Reading) -> Surface:
    return joined([part.surface.mapped(matrix[:3, :3], matrix[:3, 3])
                   for part in reading.parts for matrix in part.matrices])


def _boxes_meet(reading: Reading) -> bool:
    """Whether the boxes around any two of the places where parts stand share more than a rim."""
    centers, extents = [], []
    for part in reading.parts:
        low, high = part.surface.points.min(axis=0), part.surface.points.max(axis=0)
        linear = part.matrices[:, :3, :3]
        centers.append(linear @ ((low + high) / 2.0).astype(np.float64) + part.matrices[:, :3, 3])
        extents.append(np.abs(linear) @ ((high - low) / 2.0).astype(np.float64))
    return boxes_meet(np.concatenate(centers), np.concatenate(extents))


def _united(reading: Reading, unit: float, threads: int) -> _Body:
    """All parts where they stand as one surface, overlaps removed by Blender's exact boolean."""
    before = _summed(reading, unit, False, threads)
    mended = [solid.mended.mapped(matrix[:3, :3], matrix[:3, 3])
              for solid, matrices in before.parts for matrix in matrices]
    solid = measure_solid(union_surface(joined(mended)), threads=threads)
    if solid.method == "open":
        raise ValueError("Blender's boolean could not unite its shells; close and clean the mesh, or count each.")
    notes = ["Its shells were united by Blender's exact boolean, which rounds to 7 digits."]
    if before.method == "capped":
        notes.append("Its holes were capped before; the caps are {:.3g} % of its area.".format(
            100.0 * before.health.cap_area_share))
    elif before.method != "exact":
        notes.append("Its faces were turned outward before." if before.method == "reoriented" else
                     "Some of its parts are open, so that their union need not be the body that is meant.")
    return _Body(solid.volume, solid.area, before.health, "union", (*notes, *solid.warnings),
                 ((solid, np.eye(4)[None]),))


def _scaled(matrices: NDArray, unit: float) -> NDArray[np.float64]:
    """World matrices to SI."""
    scaled = np.array(matrices, np.float64)
    scaled[:, :3] *= unit
    return scaled


def _mapped_areas(part: Part, area: Moments, matrices: NDArray, shell: bool, threads: int) -> Iterator[Moments]:
    """The area moments of a part's images. Areas do not follow a map that stretches unevenly, so there the mapped
    surface is measured, once for each different map."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield map_sum(area, matrices[even])
    if even.all():
        return
    linear, which = np.unique(matrices[~even, :3, :3].reshape(-1, 9), axis=0, return_inverse=True)
    places = matrices[~even, :3, 3]
    for i, row in enumerate(linear):
        mapped = solid_and_area(part.surface.mapped(row.reshape(3, 3)), threads, shell=shell)[1]
        moved = np.tile(np.eye(4), (np.count_nonzero(which.ravel() == i), 1, 1))
        moved[:, :3, 3] = places[which.ravel() == i]
        yield map_sum(mapped, moved)


def _together(healths: Iterable[tuple[Health, int]]) -> Health:
    """One verdict for all parts and their instances: counts add; faults are named where there is one part only."""
    healths = list(healths)
    first, copies = healths[0]
    if len(healths) == 1 and copies == 1:
        return first
    total = {"faults": type(first.faults)(), "closed": all(h.closed for h, _ in healths),
             "welded": any(h.welded for h, _ in healths),
             "volume_spread": sum(h.volume_spread for h, _ in healths),
             "cap_area_share": max(h.cap_area_share for h, _ in healths)}
    for field in fields(Health):
        if field.name not in total:
            total[field.name] = sum(getattr(h, field.name) * k for h, k in healths)
    return Health(**total)


def _refined(body: _Body, threads: int) -> Moments:
    """The volume moments with exact third order, for a frame that the cheap bounds left undecided."""
    return sum_moments([map_sum(solid.refined(threads), matrices) for solid, matrices in body.parts])


def _flattened(reading: Reading, shell: bool) -> tuple[str, ...]:
    if shell or not reading.flattened:
        return ()
    return ("{:d} of its instances are flattened by a zero scale and enclose nothing.".format(reading.flattened),)


def _told(obj: bpy.types.Object, reading: Reading, body: _Body, options: MeasureOptions, unit: float) -> Measurement:
    shell = options.kind == "shell"
    moments, size = (body.area, options.thickness) if shell else (body.volume, 1.0)
    if not moments.total * size > 0.0:
        raise ValueError("It has no thickness; set one." if shell and moments.total > 0.0 else
                         "Its faces enclose no volume; measure it as a shell, or close it.")
    density = options.density if options.mass is None else options.mass / (moments.total * size)
    if not density > 0.0:
        raise ValueError("Its {:s} is zero; give it one.".format("density" if options.mass is None else "mass"))
    rotation, location = np.asarray(reading.rotation, np.float64), np.asarray(reading.location, np.float64) * unit
    properties = MassProperties.from_moments(
        moments, density * size, prefer=rotation, refine=None if shell else lambda: _refined(body, options.threads))
    volume = body.area * options.thickness if shell else body.volume

    def bounds(of: str, delta: dict[str, float]) -> dict[str, float]:
        return {"volume": float(getattr(volume, of)[0]), "area": float(getattr(body.area, of)[0]),
                "center_of_mass": delta["center"], "inertia": delta["inertia"]}

    settings = effective_hash(options.kind.upper(), options.density, options.mass, options.thickness,
                              options.overlap.upper(), unit)
    return Measurement(
        name=obj.name, type=obj.type, kind=options.kind, method="shell" if shell else body.method, density=density,
        thickness=options.thickness if shell else 0.0, volume=volume.total, area=body.area.total,
        mass_properties=properties, volume_moments=None if shell else body.volume, area_moments=body.area,
        health=body.health, warnings=(*reading.warnings, *_flattened(reading, shell), *body.warnings),
        rotation=rotation, location=location,
        error_bound={**bounds("error", properties.error), "input": bounds("input", properties.input)},
        fingerprint=fingerprint(body.volume.raw.tobytes() + body.area.raw.tobytes(), matrix_hash(obj), settings))
