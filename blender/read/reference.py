# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The current reference of inertia in the scene: a point and axes, SI."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from bpy.types import Object, PropertyGroup, Scene
from mathutils import Matrix

from ...core.inertia.plain_body import rotation_axes
from ...core.inertia.reference import Reference
from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import QueryError
from .findings import REFERENCE_OBJECT_MISSING

Point = tuple[float, ...]


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
            return cls("AXIS", points=tuple(tuple(map(shortest_decimal, p)) for p in (settings.first, settings.second)))
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

    def resolve(self, owner: bpy.types.ID, scene: Scene, center: Sequence[float]) -> Reference:
        """Return the reference frame (SI, world axes) for an owner with this center of mass, or raise QueryError."""
        unit = shortest_decimal(scene.unit_settings.scale_length)
        if self.about == "CENTER":
            return Reference(center)
        if self.about == "ORIGIN" and isinstance(owner, Object):
            return _frame(owner.matrix_world, unit)
        if self.about == "CURSOR":
            return _frame(scene.cursor.matrix, unit)
        if self.about == "OBJECT":
            other = bpy.data.objects.get(self.object)
            if other is None:
                raise QueryError(REFERENCE_OBJECT_MISSING)
            return _frame(other.matrix_world, unit)
        if self.about == "AXIS" and len(self.points) == 2:
            return Reference.through_points(*[[unit * along for along in point] for point in self.points])
        return Reference((0.0, 0.0, 0.0))


def _frame(matrix: Matrix, unit: float) -> Reference:
    location, turn, _scale = matrix.decompose()
    return Reference([unit * along for along in location], rotation_axes(turn))
