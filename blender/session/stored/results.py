# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Storing of results on objects: measurements, with what the panel's sliders need, bones,
symmetries and sections.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np
from bpy.types import Context, Object, Scene

from .... import core
from ....core.measurement import Measurement
from ... import bodies, read, scale, settings, write
from .. import stored  # the sliders are imported when an object has them
from ..tracking import armatures, staleness, stamps
from . import density, faults, reference

MAX_STORED_ELEMENTS = 32  # elements of a symmetry: nobody reads more for a ball or a fine prism


def store_many(
    measured: Sequence[tuple[Object, bodies.stack.Measured]],
    scene: Scene,
    shapes: Mapping[Object, bytes | None] = staleness.NO_SHAPES,
) -> Iterator[tuple[Object, Exception | None]]:
    """Store the results of objects; yield each with None, or the error that prevented it. The
    caller marks them as up to date (`staleness.mark_up_to_date`).

    Objects that were measured together, as a stack of arrays, are converted together. shapes: the
    `Surface.digest` of objects that were read just now.
    """
    for stack, run in groupby(measured, key=lambda item: item[1].stack):
        items = list(run)
        for (obj, outcome), values in zip(
            items, write.properties.values_of(_noted(items, stack, scene))
        ):
            try:
                staleness.note_edits(obj, shapes.get(obj))
                about = reference.stored_choice(obj)
                write.properties.store_values(obj, values)
                faults.remember(obj, outcome)
                reference.follow(obj, scene, about)
                if outcome.index is None:  # no body of a stack has sliders
                    stored.sliders.remember(obj, outcome, scene)
            except Exception as error:
                yield obj, error
            else:
                yield obj, None


def _noted(
    items: Sequence[tuple[Object, bodies.stack.Measured]], stack: Measurement, scene: Scene
) -> Measurement:
    """Return the objects' rows of a stack, in their order, with notes on unset densities. A single
    measurement has no index, and is its own stack.
    """
    obj, first = items[0]
    if first.index is None:
        return density.noted(obj, stack, scene)
    part: Any = stack
    indices = [outcome.index for _, outcome in items if outcome.index is not None]
    if indices != [*range(len(part.findings))]:
        part = stack.at(indices)
    findings = [
        density.with_default_note(row_findings, "density")
        if source is core.measurement.DENSITY_FROM_VALUE
        and settings.density.is_density_unset(obj.body_moments, scene)
        else row_findings
        for (obj, _), row_findings, source in zip(items, part.findings, part.density_from)
    ]
    return replace(part, findings=findings)


def store_measured(
    context: Context, measured: Iterable[tuple[Object, bodies.stack.Measured]]
) -> dict[Object, Exception]:
    """Store measurements of the present scene; return the errors of objects that cannot hold their
    results.
    """
    measured = list(measured)
    shapes = {obj: read.mesh.read_digest(obj, outcome.surface) for obj, outcome in measured}
    outcomes = list(store_many(measured, context.scene, shapes))
    staleness.mark_up_to_date(
        context, [obj for obj, refusal in outcomes if refusal is None], shapes
    )
    return {obj: refusal for obj, refusal in outcomes if refusal is not None}


def store_symmetry(
    obj: Object,
    shape: bodies.Shape | bodies.FlatShape,
    confirmed: core.shape.Symmetry,
    allowed: core.shape.Symmetry,
    tolerance: float,
) -> None:
    """Store the symmetry that the surface confirms, and the group that the moments allow, on an
    object.
    """
    stored_symmetry = obj.body_moments_symmetry
    stored_symmetry.group = confirmed.group
    stored_symmetry.compatible = allowed.group
    stored_symmetry.tolerance = tolerance
    stored_symmetry.of_display_mesh = shape.is_display_mesh
    stored_symmetry.fingerprint = (
        stamps.Stamp.parse(shape.fingerprint)
        ._replace(transform=read.fingerprint.scale_hash(obj))
        .text
    )
    stored_symmetry.elements.clear()
    turn = shape.rotation.T
    for kind, order, direction in _elements(confirmed)[:MAX_STORED_ELEMENTS]:
        local = turn @ direction  # in the object's frame
        element = stored_symmetry.elements.add()
        element.kind = kind
        element.order = order
        # A line has two directions: the one with its largest component positive is stored.
        element.direction = local if local[np.argmax(np.abs(local))] > 0.0 else -local


def _elements(symmetry: core.shape.Symmetry) -> list[tuple[str, int, np.ndarray]]:
    axes = [("AXIS", order, axis) for axis, order in symmetry.axes]
    if len(symmetry.revolution_axes) == 1:
        axes = [("ROUND", 0, symmetry.revolution_axes[0])]
    return [*axes, *(("PLANE", 0, normal) for normal in symmetry.planes)]


def store_sections(
    context: Context, sections: Sequence[tuple[Object, bodies.MeasuredSection]]
) -> None:
    """Store sections on their objects."""
    unit = scale.meters_per_unit(context.scene)
    for obj, (section, description, findings) in sections:
        parts = (section.plane.origin, section.plane.axes.ravel(), section.second, section.centroid)
        mark = core.measurement.fingerprint(
            np.concatenate([*parts, [section.area, section.perimeter]]).tobytes(),
            read.fingerprint.matrix_hash(obj),
            read.fingerprint.settings_hash(obj, context.scene),
        )
        write.section.store(obj, section, description, findings, mark, unit)
    staleness.mark_stored(context, [obj for obj, _ in sections], stamps.Kind.SECTION)


def store_rig(rig: bodies.rig.Rig) -> list[tuple[str, core.verdict.Finding]]:
    """Store the results of all bones and of the whole, or raise EditRefusedError, and watch the
    meshes for edits; return the bones that could not be measured or stored, and the reasons.
    """
    armature = rig.armature
    write.properties.store(armature, rig.measurement)
    parts = {part.name: part for part in rig.parts}
    failures: list[tuple[str, core.verdict.Finding]] = []
    for bone in armature.pose.bones:
        part = parts.get(bone.name)
        if part is None or part.measurement is None:
            write.properties.clear(bone)
            if part is not None and part.refusal is not None:
                failures.append((bone.name, part.refusal))
            continue
        try:
            write.properties.store(bone, part.measurement)
        except Exception as error:
            failures.append((bone.name, core.verdict.internal_error.finding_of(error)))
    armatures.watch(armature, rig.objects)
    staleness.mark_object(armature)
    return failures


def clear_rig(armature: Object) -> bool:
    """Remove the results of all bones and of the whole, or raise EditRefusedError; return whether
    there were any.
    """
    write.properties.require_storable(armature)
    # A list, as all have to be cleared.
    return any([write.properties.clear(owner) for owner in (armature, *armature.pose.bones)])
