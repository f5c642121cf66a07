# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring objects: read, hand to the core, say what came out.

`measure_object` is the one way from an object to its numbers; the button, the snapping operators and the command line
all go through it.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..core.decimal import decimal
from ..core.mass import MassProperties
from ..core.measurement import Measurement
from .body import Body
from .fingerprint import effective_hash, fingerprint, matrix_hash
from .mesh_body import mesh_body
from .nurbs_body import nurbs_body
from .read import Reading, Unreadable, read_object


@dataclass(frozen=True)
class MeasureOptions:
    """What overrides the objects' own settings; None leaves the setting. SI units.

    kind: "solid" or "shell"; density: kg/m³; mass: kg; thickness: m; overlap: "signed" or "union"; unit_scale: metres
    per Blender unit, else the scene's. compare: whether what needs no display mesh is compared with it.
    """

    kind: str | None = None
    density: float | None = None
    mass: float | None = None
    thickness: float | None = None
    overlap: str | None = None
    unit_scale: float | None = None
    threads: int = 1
    compare: bool = True


def measure_object(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph,
                   options: MeasureOptions = MeasureOptions()) -> Measurement:
    """The mass properties of one object as it is evaluated, in SI units and world axes.

    Raises `Unreadable`, with the reason and the remedy, where there is nothing to measure.
    """
    scene = depsgraph.scene
    unit = options.unit_scale or decimal(scene.unit_settings.scale_length)
    options = _resolved(options, obj, unit)
    reading = read_object(obj, depsgraph)
    try:
        body = _body(reading, unit, options)
        return _told(obj, reading, body, options, unit)
    except ValueError as error:
        raise Unreadable(obj.name, str(error)) from error


def _body(reading: Reading, unit: float, options: MeasureOptions) -> Body:
    shell, union = options.kind == "shell", options.overlap == "union"
    if reading.has_patches:
        return nurbs_body(reading, unit, thickness=options.thickness if shell else None, union=union,
                          threads=options.threads, compare=options.compare)
    return mesh_body(reading, unit, shell=shell, union=union, threads=options.threads)


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
        overlap=options.overlap or settings.overlap.lower(), threads=options.threads, compare=options.compare)


def _told(obj: bpy.types.Object, reading: Reading, body: Body, options: MeasureOptions, unit: float) -> Measurement:
    shell = options.kind == "shell"
    volume = body.volume if not shell else body.area * options.thickness if body.sheet is None else body.sheet
    if not volume.total > 0.0:
        raise ValueError("It has no thickness; set one." if shell and body.area.total > 0.0 else
                         "Its faces enclose no volume; measure it as a shell, or close it.")
    density = options.density if options.mass is None else options.mass / volume.total
    if body.mass is not None:
        weighed, factor = body.mass, 1.0 if options.mass is None else options.mass / body.mass.total
        density = body.mass.total * factor / volume.total
    else:
        weighed, factor = ((body.area, density * options.thickness) if shell and body.sheet is None
                           else (volume, density))
    if not density > 0.0:
        raise ValueError("Its {:s} is zero; give it one.".format("density" if options.mass is None else "mass"))
    rotation, location = np.asarray(reading.rotation, np.float64), np.asarray(reading.location, np.float64) * unit
    properties = MassProperties.from_moments(
        weighed, factor, prefer=rotation, refine=None if shell else body.refined)

    def bounds(of: str, delta: dict[str, float]) -> dict[str, float]:
        return {"volume": float(getattr(volume, of)[0]), "area": float(getattr(body.area, of)[0]),
                "center_of_mass": delta["center"], "inertia": delta["inertia"]}

    settings = effective_hash(options.kind.upper(), options.density, options.mass, options.thickness,
                              options.overlap.upper(), unit)
    return Measurement(
        name=obj.name, type=obj.type, kind=options.kind,
        method="shell" if shell and body.sheet is None else body.method, density=density,
        thickness=options.thickness if shell else 0.0, volume=volume.total, area=body.area.total,
        mass_properties=properties, volume_moments=None if shell and body.sheet is None else volume, area_moments=body.area,
        mass_moments=(weighed, factor), health=body.health, warnings=(*reading.warnings, *body.warnings),
        rotation=rotation, location=location, display_volume=body.display_volume,
        error_bound={**bounds("error", properties.error), "input": bounds("input", properties.input)},
        fingerprint=fingerprint(body.volume.raw.tobytes() + body.area.raw.tobytes(), matrix_hash(obj), settings))
