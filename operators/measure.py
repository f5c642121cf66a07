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
from .curve_body import region_body, wire_body
from .fingerprint import effective_hash, fingerprint, matrix_hash
from .mesh_body import mesh_body
from .nurbs_body import nurbs_body
from .read import Reading, Unreadable, read_lines, read_object, shows_flat_region


@dataclass(frozen=True)
class MeasureOptions:
    """What overrides the objects' own settings; None leaves the setting. SI units.

    kind: "solid", "shell" or "wire"; density: kg/m³, of a wire kg/m; mass: kg; thickness: m; overlap:
    "signed" or "union"; unit_scale: metres per Blender unit, else the scene's; compare: whether what needs no display
    mesh is compared with it.
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
    options = resolved(options, obj, unit)
    try:
        reading, body = _measured(obj, depsgraph, unit, options)
        return told(obj, reading, body, options, unit)
    except ValueError as error:
        raise Unreadable(obj.name, str(error)) from error


def _measured(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, unit: float, options: MeasureOptions
              ) -> tuple[Reading, Body]:
    shell, union = options.kind == "shell", options.overlap == "union"
    if options.kind == "wire":
        reading = read_lines(obj, depsgraph)
        return reading, wire_body(reading.curves, reading.matrix, unit)
    if shell and obj.type == "CURVE" and shows_flat_region(obj):
        reading = read_lines(obj, depsgraph)
        filled = obj.data.dimensions == "2D" and obj.data.fill_mode != "NONE"
        try:
            if not filled:
                reading.warnings.append("The curve is not filled; the flat region that it bounds was measured.")
            return reading, region_body(reading.curves, reading.matrix, unit)
        except ValueError:
            if not filled:
                raise
    reading = read_object(obj, depsgraph)
    if reading.has_patches:
        return reading, nurbs_body(reading, unit, thickness=options.thickness if shell else None, union=union,
                                   threads=options.threads, compare=options.compare)
    return reading, mesh_body(reading, unit, shell=shell, union=union, threads=options.threads)


def resolved(options: MeasureOptions, obj: bpy.types.Object, unit: float) -> MeasureOptions:
    """The options with every gap filled from the object's settings."""
    settings = obj.body_moments
    density, mass = options.density, options.mass
    kind = options.kind or settings.kind.lower()
    if density is None and mass is None:
        given = settings.linear_density if kind == "wire" else settings.density
        density, mass = (decimal(given), None) if settings.mass_from == "DENSITY" else (None, decimal(settings.mass))
    return MeasureOptions(
        kind=kind, density=density, mass=mass,
        thickness=decimal(settings.thickness) * unit if options.thickness is None else options.thickness,
        overlap=options.overlap or settings.overlap.lower(), threads=options.threads, compare=options.compare)


def told(obj: bpy.types.Object, reading: Reading, body: Body, options: MeasureOptions, unit: float) -> Measurement:
    """A body as the measurement of an object, in whose reading it was found.

    options: resolved. unit: metres per Blender unit. ValueError, with what to do, where it has no mass.
    """
    shell, wire = options.kind == "shell", options.kind == "wire"
    thin = shell and body.sheet is None
    volume = body.volume if not shell else body.area * options.thickness if thin else body.sheet
    extent = body.length if wire else volume  # what has the density
    if not extent.total > 0.0:
        raise ValueError("It has no thickness; set one." if shell and body.area.total > 0.0 else
                         "Its faces enclose no volume; measure it as a shell, or close it.")
    density = options.density if options.mass is None else options.mass / extent.total
    if body.mass is not None:
        weighed, factor = body.mass, 1.0 if options.mass is None else options.mass / body.mass.total
        density = body.mass.total * factor / volume.total
    else:
        weighed, factor = (body.area, density * options.thickness) if thin else (extent, density)
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
    geometry = b"".join(moments.raw.tobytes() for moments in (body.volume, body.area, body.length) if moments)
    return Measurement(
        name=obj.name, type=obj.type, kind=options.kind, method="shell" if thin and not reading.curves else body.method,
        density=0.0 if wire else density, thickness=options.thickness if shell else 0.0, volume=volume.total,
        area=body.area.total, mass_properties=properties, volume_moments=None if thin else volume,
        area_moments=body.area, mass_moments=(weighed, factor), health=body.health,
        warnings=(*reading.warnings, *body.warnings), rotation=rotation, location=location,
        length=body.length.total if wire else None, display_volume=body.display_volume,
        error_bound={**bounds("error", properties.error), "input": bounds("input", properties.input)},
        fingerprint=fingerprint(geometry, matrix_hash(obj), settings))
