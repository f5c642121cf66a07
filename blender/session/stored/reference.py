# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about the scene's reference, from stored results; a stored one follows when its owner is measured again."""

from __future__ import annotations

from contextlib import suppress

import bpy
from bpy.types import Collection, Object, Scene

from .... import core
from ....core.inertia.plain_body import PlainBody
from ....core.inertia.reference import ReferredInertia
from ....core.numerics.float32 import shortest_decimal
from ....core.verdict.finding import Finding, MeasureError, QueryError
from ...read.reference import ReferenceChoice
from ...write import properties
from ...write.findings import NO_STORED_RESULTS
from ..tracking import staleness


def referred(owner: Object | Collection, scene: Scene) -> ReferredInertia | Finding | None:
    """Return an owner's inertia about the scene's reference, from stored results; else the reason, or None if none."""
    choice = ReferenceChoice.from_settings(scene.body_moments_reference)
    body = _stored_body(owner, scene)
    if body is None:
        return None
    try:
        return choice.resolve(owner, scene, body.center).refer(body)
    except MeasureError as error:
        return error.finding


def store(owner: Object | Collection, scene: Scene, choice: ReferenceChoice | None = None) -> None:
    """Write the inertia about a reference, by default the scene's, beside stored results, or raise MeasureError."""
    choice = choice or ReferenceChoice.from_settings(scene.body_moments_reference)
    body = _stored_body(owner, scene)
    if body is None:
        raise QueryError(NO_STORED_RESULTS, subject=owner.name)
    properties.require_storable(owner)
    result = choice.resolve(owner, scene, body.center).refer(body)
    bounds = result.rounding_error, result.input_error
    values = {
        "body_reference": choice.text,
        "body_reference_origin": result.reference.origin,
        "body_reference_axes": core.numerics.quaternion(tuple(zip(*result.reference.axes))).tolist(),
        "body_reference_center": result.center,
        "body_reference_inertia": result.inertia,
        "body_reference_error_bound": [bound[name] for bound in bounds for name in ("center", "inertia")],
    }
    if choice.about == "AXIS":
        values["body_axis_inertia"] = result.about_z
    properties.store_reference(owner, values)
    if isinstance(owner, bpy.types.Object):
        staleness.pin(owner)


def stored_choice(owner: Object | Collection) -> ReferenceChoice | None:
    """Return the reference of the stored inertia; None if none is stored."""
    return ReferenceChoice.parse(owner["body_reference"]) if "body_reference" in owner else None


def follow(owner: Object | Collection, scene: Scene, choice: ReferenceChoice | None) -> None:
    """Store the inertia about the stored reference again after new results, unless the reference is gone."""
    if choice is not None:
        with suppress(MeasureError):
            store(owner, scene, choice)


def _stored_body(owner: Object | Collection, scene: Scene) -> PlainBody | None:
    """Return the stored results in world axes, or None if there are none."""
    stored = properties.stored(owner)
    if stored is None:
        return None
    if isinstance(owner, bpy.types.Object):
        stored = stored.in_world(owner.matrix_world, shortest_decimal(scene.unit_settings.scale_length))
    return stored
