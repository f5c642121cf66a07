# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of the objects of a file: bodies together or one by one, with their shapes; flat shapes; transforms."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Sequence
from typing import Any

import bpy
import numpy as np

from ...blender.bodies.flat.flat import NO_BODY, area_findings, clearer_refusal, flat_region
from ...blender.bodies.flat.flat_shape import flat_shape_of
from ...blender.bodies.fourier import flat_transform, object_transform
from ...blender.bodies.measure_object import Measured, measure_object
from ...blender.bodies.shape.shape import NoShapeError, shape_of
from ...blender.bodies.stacks.many import measured_in_turn
from ...blender.bodies.stacks.stack import Stacked
from ...blender.read.objects import read_object
from ...blender.settings.options import MeasureOptions
from ...blender.write import spectrum
from ...blender.write.thumbnail import thumbnail
from ...core.bodies.findings import SIGNATURE_NEEDS_POLYGONS
from ...core.measurement.measurement import Measurement
from ...core.measurement.record import flat_record
from ...core.moments.complex_form import flusser_invariants, hu_invariants, normalize
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding, MeasureError, finding
from ...core.verdict.method import Source
from ..files.output import guard
from ..findings import SIGNATURE_OF_DISPLAY_MESH
from ..options.file import unused

LEAST_ORDER = 2  # moments to this order are always computed
HU_ORDER = 3  # order for Hu's invariants


def measured_together(
    objects: Sequence[bpy.types.Object], options: Namespace, measure_options: MeasureOptions
) -> Callable[[bpy.types.Object], Measured | Stacked] | None:
    """Return a function that measures objects in batches, or None if they have to be measured one by one.

    That is the case if an object needs settings or results of its own besides mass properties.
    """
    if options.order is not None or options.pose or options.signature:
        return None
    if options.threshold is not None or options.polynomial is not None or options.density_from is not None:
        return None
    return measured_in_turn(objects, bpy.context.evaluated_depsgraph_get(), measure_options)


def measure_shape(
    obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions
) -> tuple[Measurement, dict[str, Any], tuple[Finding, ...]]:
    """Return an object's measurement, its pose and signature if requested, and findings about these.

    Pose and signature are None for objects without a shape of their own, which are still measured.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    requested = [name for name in ("pose", "signature") if getattr(options, name)]
    if not requested:
        return measure_object(obj, depsgraph, measure_options), {}, ()
    try:
        shape = shape_of(obj, depsgraph, measure_options)
    except NoShapeError as refusal:
        return refusal.measurement, dict.fromkeys(requested), (refusal.finding,)
    more: dict[str, Any] = {"pose": shape.pose()} if options.pose else {}
    findings: tuple[Finding, ...] = ()
    if options.signature and shape.has_surface:
        more["signature"] = shape.signature().as_record()
        if shape.measurement.method.source == Source.NURBS:
            findings = (finding(SIGNATURE_OF_DISPLAY_MESH),)
    elif options.signature:
        more["signature"] = None
        findings = (finding(SIGNATURE_NEEDS_POLYGONS),)
    return shape.measurement, more, findings


def thumbnail_of(obj: bpy.types.Object, measurement: Measurement, unit: float | None) -> str | None:
    """Return the picture of a measured object, or None if it shows no faces.

    unit: meters per unit, else the scene's.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    unit = unit or shortest_decimal(depsgraph.scene.unit_settings.scale_length)
    try:
        surface = read_object(obj, depsgraph, edges=False).join()
    except MeasureError:  # such as a grid of densities
        return None
    triangles = surface.all_triangles()[0]
    if not len(triangles):
        return None
    properties = measurement.mass_properties
    return thumbnail(surface.points.astype(np.float64) * unit, triangles, properties.center, properties.principal.axes)


def write_transform(obj: bpy.types.Object, options: Namespace, measure_options: MeasureOptions) -> tuple[Finding, ...]:
    """Write an object's Fourier transform to a file, and return findings. Raises MeasureError and OSError."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    if options.flat:
        unit = measure_options.unit_scale
        under_way = flat_transform(obj, depsgraph, options.waves, frame=options.frame, unit=unit)
    else:
        under_way = object_transform(obj, depsgraph, measure_options, options.waves, frame=options.frame)
    for _ in under_way.steps():
        pass
    transform, findings = under_way.result()
    spectrum.save(options.fourier, transform, options.frame, guard(options.force), under_way.arrays)
    return findings


def is_flat_shape(options: Namespace, refusal: MeasureError) -> bool:
    """Return whether --flat is given and the refusal says that an object is no body."""
    return options.flat and refusal.finding.code in NO_BODY


def record_of_flat(
    label: str,
    obj: bpy.types.Object,
    options: Namespace,
    unit: float | None,
    refusal: MeasureError,
    findings: tuple[Finding, ...],
) -> dict[str, Any]:
    """Return the record of an object as a flat shape.

    refusal: the reason why it is no body. findings: about its file. Raises MeasureError.
    """
    try:
        return _record(label, obj, options, unit, findings)
    except MeasureError as error:
        raise clearer_refusal(refusal, error) from None


def _record(
    label: str, obj: bpy.types.Object, options: Namespace, unit: float | None, findings: tuple[Finding, ...]
) -> dict[str, Any]:
    depsgraph = bpy.context.evaluated_depsgraph_get()
    order = options.order
    region = flat_region(obj, depsgraph, selected=False, unit=unit)
    moments = region.moments(max(order or 0, LEAST_ORDER))
    posed = unused(["pose"] if options.pose else [])
    more: dict[str, Any] = {"pose": None} if options.pose else {}
    more |= {"signature": flat_shape_of(obj, depsgraph, unit).signature().as_record()} if options.signature else {}
    invariants = []
    if order is not None and order >= HU_ORDER:
        normalized = normalize(moments)
        invariants = [*hu_invariants(normalized), *flusser_invariants(normalized)]
    return flat_record(
        label,
        obj.type,
        region.plane,
        moments,
        (*region.findings, *area_findings(region, moments.total), *posed, *findings),
        order=order,
        invariants=invariants,
        more=more,
        about=options.about,
        frame=(options.frame, region.rotation, region.location),
    )
