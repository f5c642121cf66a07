# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--flat: measurement of flat objects, which are no bodies, as shapes in their plane."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

import bpy

from ...blender.bodies.flat.flat import NO_BODY, area_findings, clearer_refusal, flat_region
from ...blender.bodies.flat.flat_shape import flat_shape_of
from ...core.measurement.flat_record import flat_record
from ...core.moments.complex_form import flusser_invariants, hu_invariants
from ...core.moments.normalized import normalize
from ...core.verdict.finding import Finding, MeasureError
from ..options.file import unused

LEAST_ORDER = 2  # moments to this order are always computed
HU_ORDER = 3  # order for Hu's invariants


def is_meant(options: Namespace, refusal: MeasureError) -> bool:
    """Return whether --flat is given and the refusal says that an object is no body."""
    return options.flat and refusal.finding.code in NO_BODY


def record_of(
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
