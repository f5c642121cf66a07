# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measuring objects: read them, hand them to the core, report what came out.

`measure_object` is the one way from an object to its numbers; the button, the snapping operators and the command line
all go through it.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace

import bpy

from ...core.measurement import Measurement
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding, MeasureError, ReadError, finding
from ..read import Reading, read_lines, read_object, shows_flat_region
from ..read.quiet import paused
from ..read.volume import VolumeReading, volume_reading
from ..settings.density import density_field
from ..settings.digest import density_key, grid_key
from ..settings.grid import GridOptions
from ..settings.options import AS_SET, MeasureOptions, with_object_settings
from .body import MeasuredBody
from .curve import region_body, wire_body
from .grid import grid_body
from .mass import MassResult, mass_result
from .measurement import _require_volume, as_measurement, with_moments
from .mesh import mesh_body
from .nurbs import nurbs_body
from .voxel_filled import voxel_filled_body
from .wall import Walls, find_walls

THREADS = os.cpu_count() or 1  # for what takes long


@dataclass(frozen=True, eq=False)
class Measured:
    """One object's measurement, and what it was made from. walls: of a shell of real thickness."""

    measurement: Measurement
    reading: Reading | VolumeReading
    body: MeasuredBody
    walls: Walls | None = None


def measure_object(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, options: MeasureOptions = AS_SET
) -> Measurement:
    """The mass properties of one object as it is evaluated, in SI units and world axes.

    Raises MeasureError where there is nothing to measure.
    """
    return measure_body(obj, depsgraph, options).measurement


def measure_body(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, options: MeasureOptions = AS_SET) -> Measured:
    """As `measure_object`, with what was read and the body that was measured."""
    scene = depsgraph.scene
    unit = options.unit_scale or shortest_decimal(scene.unit_settings.scale_length)
    grid = GridOptions.of(obj.body_moments, options.density)
    with paused(), volume_reading(obj, depsgraph, grid.grid) as volume:
        if volume is not None:
            return _measure_grid(obj, volume, grid, options, unit)
    given = options.density is not None or options.mass is not None
    options = with_object_settings(options, obj, unit)
    shell = options.kind == "shell"
    try:
        density = None if given or options.kind == "wire" else density_field(obj.body_moments)
        lines, unknown = _measure_curves(obj, depsgraph, unit, options) if density is None else (None, None)
        if lines is not None:
            reading, body = lines
            return _measured(obj, reading, body, options, unit)
        reading = read_object(
            obj,
            depsgraph,
            materials=density is not None and density.kind == "materials",
            attribute=density.attribute if density is not None and shell else None,
        )
        if unknown is not None:
            reading.findings.append(finding("curve_fill_measured", cause=unknown.as_record()))
        if reading.has_patches and density is None:
            body = nurbs_body(
                reading,
                unit,
                wall=options.wall if shell else None,
                thickness=options.thickness,
                union=options.overlap == "union",
                threads=options.threads,
                compare=options.compare,
            )
            return _measured(obj, reading, body, options, unit)
        if reading.has_patches:
            reading.findings.append(finding("display_mesh_for_density"))
        elif density is not None and shell and obj.type == "CURVE" and shows_flat_region(obj):
            reading.findings.append(finding("curve_fill_for_density"))
        body = mesh_body(reading, unit, shell=shell, union=options.overlap == "union", threads=options.threads)
        weighed = None
        if density is not None:
            _require_volume(body, options)
            if density.kind == "volume":
                body, weighed = _with_volume_density(obj, body, shell, depsgraph, unit)
            else:
                weighed = mass_result(
                    reading,
                    body,
                    density,
                    unit=unit,
                    shell=shell,
                    thickness=options.thickness,
                    default_density=options.density,
                    threads=options.threads,
                )
                body = replace(body, mass=weighed.mass, findings=(*body.findings, *weighed.findings))
        walls = find_walls(reading, body, options.wall) if shell and options.wall != "thin" else None
        if walls is not None:
            body = walls.body(options.thickness)
        return replace(_measured(obj, reading, body, options, unit, weighed), walls=walls)
    except MeasureError as error:
        error.about(obj.name)
        raise


def _measured(
    obj: bpy.types.Object,
    reading: Reading | VolumeReading,
    body: MeasuredBody,
    options: MeasureOptions,
    unit: float,
    weighed: MassResult | None = None,
    key: str | None = None,
) -> Measured:
    """As `as_measurement`, with the moments to the order that was requested."""
    measurement = as_measurement(obj, reading, body, options, unit, weighed, key)
    return Measured(with_moments(measurement, body, options), reading, body)


def _measure_curves(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, unit: float, options: MeasureOptions
) -> tuple[tuple[Reading, MeasuredBody] | None, Finding | None]:
    """A curve object as a wire, or as the flat region that it bounds; None for what is measured by its surface, with
    the reason where that is only what Blender fills."""
    if options.kind == "wire":
        reading = read_lines(obj, depsgraph)
        return (reading, wire_body(reading.curves, reading.matrix, unit)), None
    if options.kind != "shell" or obj.type != "CURVE" or not shows_flat_region(obj) or options.wall != "thin":
        return None, None
    reading = read_lines(obj, depsgraph)
    filled = obj.data.dimensions == "2D" and obj.data.fill_mode != "NONE"
    if not filled:
        reading.findings.append(finding("curve_not_filled"))
    try:
        return (reading, region_body(reading.curves, reading.matrix, unit)), None
    except MeasureError as error:
        if not filled:
            raise
        return None, error.finding


def _measure_grid(
    obj: bpy.types.Object, volume: VolumeReading, grid: GridOptions, options: MeasureOptions, unit: float
) -> Measured:
    """As `measure_body`, of a grid of voxels."""
    kind = options.kind or ("solid" if obj.type == "VOLUME" else obj.body_moments.kind.lower())
    if kind != "solid":
        raise ReadError("grid_as_shell")
    key = grid_key(obj, options.density) if obj.type == "VOLUME" else density_key(obj, ())
    options = with_object_settings(replace(options, kind="solid"), obj, unit)
    body = grid_body(volume, grid, unit, options.threads)
    weighed = None if body.mass is None else MassResult(body.mass, finding("density_from_grid", grid=volume.grid))
    return _measured(obj, volume, body, options, unit, weighed, key)


def _with_volume_density(
    obj: bpy.types.Object, body: MeasuredBody, shell: bool, depsgraph: bpy.types.Depsgraph, unit: float
) -> tuple[MeasuredBody, MassResult]:
    """The solid with the density of the Volume object that its settings name."""
    if shell:
        raise ReadError("density_volume_of_shell")
    source = obj.body_moments.density_volume
    grid = GridOptions.of(source.body_moments)
    try:
        with paused(), volume_reading(source, depsgraph, grid.grid) as volume:
            if volume is None:
                raise ReadError("object_without_grid")
            body = voxel_filled_body(body, volume, grid, unit, obj.name)
            return body, MassResult(body.mass, finding("density_from_grid_of", grid=volume.grid, object=source.name))
    except MeasureError as error:
        if error.subject == obj.name:  # about both together
            raise
        raise ReadError(
            "density_volume_unreadable", subject=obj.name, object=source.name, cause=error.finding.as_record()
        ) from error
