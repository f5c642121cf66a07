# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of inertia in the scene, and inertia about it, from stored results.

A stored one follows when its owner is measured again.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import bpy
from bpy.types import Collection, Object, PropertyGroup, Scene
from mathutils import Matrix

from ....core import inertia, numerics, verdict
from ... import read, scale, write
from ..tracking import staleness

Point = tuple[float, ...]


def referred(
    owner: Object | Collection, scene: Scene
) -> inertia.ReferredInertia | verdict.Finding | None:
    """Return an owner's inertia about the scene's reference, from stored results; the reason if it
    has none, or None without stored results.
    """
    choice = ReferenceChoice.from_settings(scene.body_moments_reference)
    body = _stored_body(owner, scene)
    if body is None:
        return None
    try:
        return choice.resolve(owner, scene, body.center).refer(body)
    except verdict.MeasureError as error:
        return error.finding


def store(owner: Object | Collection, scene: Scene, choice: ReferenceChoice | None = None) -> None:
    """Write the inertia about a reference, by default the scene's, beside stored results, or raise
    MeasureError. The results of an object then hold for its present place alone.
    """
    choice = choice or ReferenceChoice.from_settings(scene.body_moments_reference)
    body = _stored_body(owner, scene)
    if body is None:
        raise verdict.QueryError(write.findings.NO_STORED_RESULTS, subject=owner.name)
    write.properties.require_storable(owner)
    result = choice.resolve(owner, scene, body.center).refer(body)
    values = {
        "body_reference": choice.text,
        "body_reference_origin": result.reference.origin,
        # of the rotation whose columns are the axes
        "body_reference_axes": numerics.quaternion(tuple(zip(*result.reference.axes))).tolist(),
        "body_reference_center": result.center,
        "body_reference_inertia": result.inertia,
        "body_reference_error_bound": [
            bound[name]
            for bound in (result.rounding_error, result.input_error)
            for name in ("center", "inertia")
        ],
    }
    if choice.about == "AXIS":
        values["body_axis_inertia"] = result.about_z
    write.properties.store_reference(owner, values)
    if isinstance(owner, bpy.types.Object):
        staleness.pin(owner)


def stored_choice(owner: Object | Collection) -> ReferenceChoice | None:
    """Return the reference of the stored inertia; None if none is stored."""
    return ReferenceChoice.parse(owner["body_reference"]) if "body_reference" in owner else None


def follow(owner: Object | Collection, scene: Scene, choice: ReferenceChoice | None) -> None:
    """Store the inertia about the stored reference again after new results, unless the reference is
    gone.
    """
    if choice is not None:
        with suppress(verdict.MeasureError):
            store(owner, scene, choice)


def _stored_body(owner: Object | Collection, scene: Scene) -> inertia.PlainBody | None:
    """Return the stored results in world axes, or None if there are none."""
    stored = write.properties.stored(owner)
    if stored is None:
        return None
    if isinstance(owner, bpy.types.Object):
        stored = stored.in_world(owner.matrix_world, scale.meters_per_unit(scene))
    return stored


@dataclass(frozen=True)
class ReferenceChoice:
    """The choice of a reference, which can be resolved to a point and axes.

    `about`: "CENTER", "ORIGIN", "WORLD", "CURSOR", "OBJECT" or "AXIS".
    `object`: the other object's name. `points`: two points of the axis, Blender units.
    """

    about: str
    object: str = ""
    points: tuple[Point, ...] = ()

    @classmethod
    def from_settings(cls, settings: PropertyGroup) -> ReferenceChoice:
        """Return the choice in the scene's settings."""
        if settings.about == "OBJECT":
            return cls("OBJECT", settings.object.name if settings.object is not None else "")
        if settings.about == "AXIS":
            return cls(
                "AXIS",
                points=tuple(
                    tuple(map(numerics.shortest_decimal, point))
                    for point in (settings.first, settings.second)
                ),
            )
        return cls(settings.about)

    @property
    def text(self) -> str:
        """JSON, to be read by `parse`."""
        entry: dict = {"about": self.about.lower()}
        if self.object:
            entry["object"] = self.object
        if self.points:
            entry["points"] = self.points
        return json.dumps(entry, ensure_ascii=False)

    @classmethod
    def parse(cls, text: object) -> ReferenceChoice | None:
        """Return the choice that the property `text` has written, or None for any other text."""
        try:
            entry = json.loads(str(text))
            points = tuple(tuple(map(float, point)) for point in entry.get("points", ()))
            return cls(str(entry["about"]).upper(), str(entry.get("object", "")), points)
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            return None

    def resolve(
        self, owner: bpy.types.ID, scene: Scene, center: Sequence[float]
    ) -> inertia.Reference:
        """Return the reference frame (SI, world axes) for an owner with this center of mass, or
        raise QueryError.
        """
        unit = scale.meters_per_unit(scene)
        if self.about == "CENTER":
            return inertia.Reference(center)
        if self.about == "ORIGIN" and isinstance(owner, Object):
            return _frame(owner.matrix_world, unit)
        if self.about == "CURSOR":
            return _frame(scene.cursor.matrix, unit)
        if self.about == "OBJECT":
            reference_object = bpy.data.objects.get(self.object)
            if reference_object is None:
                raise verdict.QueryError(read.findings.REFERENCE_OBJECT_MISSING)
            return _frame(reference_object.matrix_world, unit)
        if self.about == "AXIS" and len(self.points) == 2:
            return inertia.Reference.through_points(
                *[[unit * coordinate for coordinate in point] for point in self.points]
            )
        # The world, also the origin of a collection, and an axis without its points.
        return inertia.Reference((0.0, 0.0, 0.0))


def _frame(matrix: Matrix, unit: float) -> inertia.Reference:
    """Return the reference at the origin and along the rotated axes of a matrix in the world."""
    location, turn, _scale = matrix.decompose()
    return inertia.Reference(
        [unit * coordinate for coordinate in location], inertia.rotation_axes(turn)
    )
