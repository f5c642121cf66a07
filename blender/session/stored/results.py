# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Storing of measurements on objects; also caches what the panel's sliders need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

from bpy.types import Context, Object, Scene

from ...bodies.measure_object import Measured
from ...bodies.stacks.stack import MeasuredStack, Stacked
from ...settings.density import is_density_unset
from ...write import properties
from ..tracking import staleness
from . import density, faults, reference, sliders


def store(obj: Object, measured: Measured, scene: Scene) -> None:
    """Write a measurement on the object, and remember the data for its sliders, or raise EditRefusedError."""
    measured = replace(measured, measurement=density.noted(obj, measured.measurement, scene))
    staleness.note_edits(obj)
    about = reference.stored_choice(obj)
    properties.store(obj, measured.measurement)
    faults.remember(obj, measured)
    reference.follow(obj, scene, about)
    sliders.remember(obj, measured, scene)


def store_many(
    measured: Sequence[tuple[Object, Measured | Stacked]], scene: Scene
) -> Iterator[tuple[Object, Exception | None]]:
    """Store the results of many objects like `store`; yield each with None, or the error that prevented it."""
    for stack, run in groupby(measured, key=lambda item: getattr(item[1], "stack", None)):
        items: list[tuple[Object, Any]] = list(run)
        if stack is None:
            for obj, alone in items:
                try:
                    store(obj, alone, scene)
                except Exception as error:
                    yield obj, error
                else:
                    yield obj, None
        else:
            yield from _store_stack(stack, [each.index for _, each in items], scene)


def store_measured(context: Context, measured: Iterable[tuple[Object, Measured | Stacked]]) -> dict[Object, Exception]:
    """Store measurements of the present scene; return the errors of objects that cannot hold their results."""
    measured = list(measured)
    outcomes = list(store_many(measured, context.scene))
    shapes = {obj: found.shape_digest for obj, found in measured if isinstance(found, Stacked)}
    staleness.mark_up_to_date(context, [obj for obj, refusal in outcomes if refusal is None], shapes)
    return {obj: refusal for obj, refusal in outcomes if refusal is not None}


def _store_stack(stack: MeasuredStack, which: list[int], scene: Scene) -> Iterator[tuple[Object, Exception | None]]:
    part = stack.some(which)
    objects = [member.obj for member in part.members]
    about = {}
    for obj, member in zip(objects, part.members):
        staleness.note_edits(obj, member.shape.digest if obj.mode == "OBJECT" else None)
        if "body_reference" in obj:
            about[obj] = reference.stored_choice(obj)
    findings = list(part.findings)
    for i, (obj, from_mass) in enumerate(zip(objects, part.from_mass.tolist())):
        if not from_mass and is_density_unset(obj.body_moments, scene):
            findings[i] = density.with_default_note(findings[i], "density")
    refusals = properties.store_stack(
        objects,
        part.in_object_frames(),
        part.density,
        part.volume.raw[:, 0],
        part.area.raw[:, 0],
        part.error_bounds,
        zip([member.shape.method for member in part.members], findings, part.fingerprints),
    )
    for obj, member, refusal in zip(objects, part.members, refusals):
        if refusal is None:
            if (defects := member.shape.defects) is None:
                faults.forget(obj)
            else:
                faults.remember_surface(obj, member.shape.surface, defects)
            if obj in about:
                reference.follow(obj, scene, about[obj])
        yield obj, refusal
