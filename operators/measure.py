# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring objects: read them, hand them to the core, report what came out.

`measure_object` is the one way from an object to its numbers; the button, the snapping operators and the command line
all go through it.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..core.canonical import ORDER
from ..core.decimal import decimal
from ..core.mass import MassProperties
from ..core.measurement import Measurement
from ..core.moments import Moments
from . import staleness, wall_slider
from .body import Body
from .curve_body import region_body, wire_body
from .density import density_field, density_key, grid_key
from .fingerprint import effective_hash, fingerprint, matrix_hash
from .grid_body import grid_body
from .grid_options import GridOptions
from .inside_body import inside_body
from .mesh_body import mesh_body
from .nurbs_body import nurbs_body
from .read import Reading, Unreadable, read_lines, read_object, shows_flat_region
from .read.volume import VolumeReading, volume_reading
from .wall_body import find_walls
from .weigh import Weighed, weigh

AT_ONCE = 20_000  # faces up to which moments of higher order, for a frame that needs them, take no time to speak of
KNOWN = 3  # the order to which every measurement has its moments
THREADS = os.cpu_count() or 1  # for what takes long
UNASKED = ("Its principal axes are those nearest to the object's that moments to third order allow; with so many faces "
           "higher ones were not looked at. Snapping and --pose do, and may choose others.")


@dataclass(frozen=True)
class MeasureOptions:
    """What overrides the objects' own settings; None leaves the setting. SI units.

    kind: "solid", "shell" or "wire"; density: kg/m³, of a wire kg/m; mass: kg; thickness: m; overlap: "signed" or
    "union"; wall: of a shell, "thin", "inward", "outward" or "centered"; unit_scale: metres per Blender unit, else the
    scene's. order: of the moments that the measurement is to hold; None for what mass properties need. surface: those
    of the area too. pose: the principal frame follows the body's shape to sixth order however many faces it has.
    compare: whether what needs no display mesh is compared with it.
    """

    kind: str | None = None
    density: float | None = None
    mass: float | None = None
    thickness: float | None = None
    overlap: str | None = None
    wall: str | None = None
    unit_scale: float | None = None
    threads: int = 1
    order: int | None = None
    surface: bool = False
    pose: bool = False
    compare: bool = True


def measure_object(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph,
                   options: MeasureOptions = MeasureOptions()) -> Measurement:
    """The mass properties of one object as it is evaluated, in SI units and world axes.

    Raises `Unreadable`, with the reason and the remedy, where there is nothing to measure.
    """
    return measure_body(obj, depsgraph, options)[0]


def measure_body(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph,
                 options: MeasureOptions = MeasureOptions()) -> tuple[Measurement, Body]:
    """As `measure_object`, with the body that was measured."""
    scene = depsgraph.scene
    unit = options.unit_scale or decimal(scene.unit_settings.scale_length)
    grid = GridOptions.of(obj.body_moments, options.density)
    with staleness.paused(), volume_reading(obj, depsgraph, grid.grid) as volume:
        if volume is not None:
            return _measure_grid(obj, volume, grid, options, unit)
    given = options.density is not None or options.mass is not None
    options = resolved(options, obj, unit)
    shell = options.kind == "shell"
    try:
        density = None if given or options.kind == "wire" else density_field(obj.body_moments)
        lines, unknown = _lines(obj, depsgraph, unit, options) if density is None else (None, "")
        if lines is not None:
            return to_order(as_measurement(obj, *lines, options, unit), lines[1], options), lines[1]
        reading = read_object(obj, depsgraph, materials=density is not None and density.kind == "materials",
                              attribute=density.attribute if density is not None and shell else None)
        if unknown:
            reading.warnings.append("The faces that Blender fills its curves with were measured, overlapping or not, "
                                    "as the region that they bound is not known. {:s}".format(unknown))
        if reading.has_patches and density is None:
            body = nurbs_body(reading, unit, wall=options.wall if shell else None, thickness=options.thickness,
                              union=options.overlap == "union", threads=options.threads, compare=options.compare)
            return to_order(as_measurement(obj, reading, body, options, unit), body, options), body
        if reading.has_patches:
            reading.warnings.append("A density that is not one value needs polygons: the display mesh of its surface "
                                    "was measured, as fine as the viewport's resolution.")
        elif density is not None and shell and obj.type == "CURVE" and shows_flat_region(obj):
            reading.warnings.append("A density that is not one value needs polygons: the faces that Blender fills the "
                                    "curve with were measured.")
        body = mesh_body(reading, unit, shell=shell, union=options.overlap == "union", threads=options.threads)
        weighed = None
        if density is not None:
            _require_volume(body, options)
            if density.kind == "volume":
                body, weighed = _filled(obj, body, shell, depsgraph, unit)
            else:
                weighed = weigh(reading, body, density, unit=unit, shell=shell, thickness=options.thickness,
                                others=options.density, threads=options.threads)
                body = replace(body, mass=weighed.mass, warnings=(*body.warnings, *weighed.warnings))
        walls = find_walls(reading, body, options.wall) if shell and options.wall != "thin" else None
        if walls is not None:
            body = walls.body(options.thickness)
        measurement = as_measurement(obj, reading, body, options, unit, weighed)
        if walls is not None:
            wall_slider.keep(obj, reading, walls, measurement, unit)
        return to_order(measurement, body, options), body
    except ValueError as error:
        raise Unreadable(obj.name, str(error)) from error


def _lines(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, unit: float, options: MeasureOptions
           ) -> tuple[tuple[Reading, Body] | None, str]:
    """A curve object as a wire, or as the flat region that it bounds; None for what is measured by its surface, with
    the reason where that is only what Blender fills."""
    if options.kind == "wire":
        reading = read_lines(obj, depsgraph)
        return (reading, wire_body(reading.curves, reading.matrix, unit)), ""
    if options.kind != "shell" or obj.type != "CURVE" or not shows_flat_region(obj) or options.wall != "thin":
        return None, ""
    reading = read_lines(obj, depsgraph)
    filled = obj.data.dimensions == "2D" and obj.data.fill_mode != "NONE"
    if not filled:
        reading.warnings.append("The curve is not filled; the flat region that it bounds was measured.")
    try:
        return (reading, region_body(reading.curves, reading.matrix, unit)), ""
    except ValueError as error:
        if not filled:
            raise
        return None, str(error)


def _measure_grid(obj: bpy.types.Object, volume: VolumeReading, grid: GridOptions, options: MeasureOptions,
                  unit: float) -> tuple[Measurement, Body]:
    """As `measure_body`, of a grid of voxels."""
    kind = options.kind or ("solid" if obj.type == "VOLUME" else obj.body_moments.kind.lower())
    if kind != "solid":
        raise ValueError("A grid of voxels is no sheet; measure it as a solid.")
    key = grid_key(obj, options.density) if obj.type == "VOLUME" else density_key(obj, ())
    options = resolved(replace(options, kind="solid"), obj, unit)
    body = grid_body(volume, grid, unit, options.threads)
    weighed = None if body.mass is None else Weighed(body.mass, "grid “{:s}”".format(volume.grid))
    return to_order(as_measurement(obj, volume, body, options, unit, weighed, key), body, options), body


def _filled(obj: bpy.types.Object, body: Body, shell: bool, depsgraph: bpy.types.Depsgraph, unit: float
            ) -> tuple[Body, Weighed]:
    """The solid with the density of the Volume object that its settings name."""
    if shell:
        raise ValueError("A grid is a density inside a solid, not on a sheet; measure it as a solid, or choose another "
                         "source of density.")
    source = obj.body_moments.density_volume
    grid = GridOptions.of(source.body_moments)
    try:
        with staleness.paused(), volume_reading(source, depsgraph, grid.grid) as volume:
            if volume is None:
                raise Unreadable(source.name, "It shows no grid of voxels.")
            body = inside_body(body, volume, grid, unit)
            return body, Weighed(body.mass, "grid “{:s}” of “{:s}”".format(volume.grid, source.name))
    except Unreadable as error:
        raise ValueError("Its density is to come from “{:s}”: {:s}".format(source.name, error.reason)) from error


def resolved(options: MeasureOptions, obj: bpy.types.Object, unit: float) -> MeasureOptions:
    """The options with every gap filled from the object's settings."""
    settings = obj.body_moments
    density, mass = options.density, options.mass
    kind = options.kind or settings.kind.lower()
    if density is None and mass is None:
        given = settings.linear_density if kind == "wire" else settings.density
        density, mass = (decimal(given), None) if settings.mass_from == "DENSITY" else (None, decimal(settings.mass))
    return replace(
        options, kind=kind, density=density, mass=mass,
        thickness=decimal(settings.thickness) * unit if options.thickness is None else options.thickness,
        overlap=options.overlap or settings.overlap.lower(), wall=options.wall or settings.wall.lower())


def to_order(measurement: Measurement, body: Body, options: MeasureOptions) -> Measurement:
    """With moments to the order that was asked for. What a measurement holds anyway is not measured again."""
    shell, order = options.kind == "shell", options.order
    if order is None or (order < KNOWN and (shell or not options.surface)):
        return measurement
    if body.to_order is None:
        if order > KNOWN or (options.surface and not shell):
            raise ValueError("Of a wall of real thickness only the moments of its volume to order {:d} are known; ask "
                             "for no more, or set Wall to Thin.".format(KNOWN))
        return measurement
    with np.errstate(over="ignore", invalid="ignore"):
        volume, area = body.to_order(order, shell or options.surface)
    for one in (volume, area):
        if one is not None and not np.isfinite([one.raw, one.error, one.input]).all():
            raise ValueError("It is too large for moments of order {:d} to be numbers. Scale it down, or ask for a "
                             "lower order.".format(order))
    return replace(measurement, volume_moments=None if shell else volume, area_moments=area or measurement.area_moments)


def _higher(body: Body, shell: bool) -> Callable[[], Moments] | None:
    """What gives the moments of higher order of what the principal frame is made from, where they are known."""
    if body.to_order is None or body.mass is not None or body.length is not None:
        return None
    return lambda: body.to_order(ORDER, shell)[1 if shell else 0]


def _require_volume(body: Body, options: MeasureOptions) -> Moments:
    """The volume, of a shell that of its sheet or wall."""
    shell = options.kind == "shell"
    volume = body.area * options.thickness if shell and body.wall is None else body.wall or body.volume
    if not volume.total > 0.0:
        if body.solids and not body.area.total > 0.0:
            raise ValueError("None of its faces has an area; move their vertices apart, or choose another object.")
        raise ValueError("It has no thickness; set one." if shell and body.area.total > 0.0 else
                         "Its faces enclose no volume; measure it as a shell, a flat one as a section, or close it.")
    return volume


def as_measurement(obj: bpy.types.Object | None, reading: Reading | VolumeReading, body: Body, options: MeasureOptions,
                   unit: float, weighed: Weighed | None = None, key: str | None = None) -> Measurement:
    """The results of measuring a body. obj: None for what is in a file only. options: resolved. key: in place of
    `density_key`. ValueError where it has no mass."""
    shell = options.kind == "shell"
    wire = options.kind == "wire"
    thin, solid = shell and body.wall is None, body.wall or body.volume
    volume = body.volume if wire else _require_volume(body, options)
    extent = body.length if wire else volume  # what the density is of
    density = options.density if options.mass is None else options.mass / extent.total
    if body.mass is not None:
        moments, factor = body.mass, 1.0 if options.mass is None else options.mass / body.mass.total
        density = body.mass.total * factor / volume.total
    else:
        moments, factor = (body.area, density * options.thickness) if thin else (body.length or solid, density)
    if not density > 0.0:
        raise ValueError("Its {:s} is zero; give it one.".format("density" if options.mass is None else "mass"))
    rotation, location = np.asarray(reading.rotation, np.float64), np.asarray(reading.location, np.float64) * unit
    higher = _higher(body, shell)
    asked = options.pose or body.faces <= AT_ONCE
    properties = MassProperties.from_moments(
        moments, factor, prefer=rotation, refine=None if shell or body.mass is not None else body.refined,
        higher=higher if asked else None)
    notes = () if asked or higher is None or properties.principal.unique else (UNASKED,)

    def bounds(of: str, delta: dict[str, float]) -> dict[str, float]:
        return {"volume": float(getattr(volume, of)[0]), "area": float(getattr(body.area, of)[0]),
                "center_of_mass": delta["center"], "inertia": delta["inertia"]}

    settings = effective_hash(options.kind.upper(), options.density, options.mass, options.thickness,
                              options.overlap.upper(), unit, options.wall.upper(),
                              (density_key(obj, weighed.materials) if weighed else "") if key is None else key)
    digested = [body.volume, body.area, *(one for one in (body.mass, body.length) if one is not None)]
    of_surface = "shell" if shell and not body.method.endswith("shell") else body.method
    return Measurement(
        name=reading.name, type=reading.type, kind=options.kind, method=of_surface,
        density=0.0 if wire else density, thickness=options.thickness if shell else 0.0, volume=volume.total,
        area=body.area.total,
        mass_properties=properties, volume_moments=None if thin else solid, area_moments=body.area,
        mass_moments=(moments, factor), health=body.health, warnings=(*reading.warnings, *body.warnings, *notes),
        rotation=rotation, location=location, length=body.length.total if wire else None,
        display_volume=body.display_volume,
        error_bound={**bounds("error", properties.error), "input": bounds("input", properties.input),
                     **({"estimated": True} if body.estimated else {})},
        fingerprint=fingerprint(b"".join(one.raw.tobytes() for one in digested),
                                "" if obj is None else matrix_hash(obj), settings),
        density_from=weighed.source if weighed else "one value" if options.mass is None else "given mass",
        materials=weighed.materials if weighed else ())
