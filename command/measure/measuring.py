# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of a file's objects: together if only mass properties are requested, else each with its shape."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Sequence
from typing import Any

import bpy
import numpy as np

from ...blender.bodies.measure_object import Measured, measure_object
from ...blender.bodies.shape.shape import NoShapeError, shape_of
from ...blender.bodies.stacks.many import measured_in_turn
from ...blender.bodies.stacks.stack import Stacked
from ...blender.read.objects import read_object
from ...blender.settings.options import MeasureOptions
from ...blender.write.thumbnail import thumbnail
from ...core.bodies.findings import SIGNATURE_NEEDS_POLYGONS
from ...core.measurement.measurement import Measurement
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding, MeasureError, finding
from ...core.verdict.method import Source
from ..findings import SIGNATURE_OF_DISPLAY_MESH


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
