# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The request for one measurement, resolved once: options, unit, density, and readings that several kinds share."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property

import bpy

from ...core.numerics.float32 import shortest_decimal
from ...core.verdict.finding import Finding
from ..read.objects import read_object
from ..read.reading import Reading
from ..settings.accepted import accepted_codes
from ..settings.density import DensityField, density_field, object_density
from ..settings.options import AS_SET, MeasureOptions, ResolvedOptions


@dataclass(frozen=True, eq=False)
class Request:
    """One object's measurement before it is made.

    `options`: the given ones, completed by the object's settings; `given`: overrides of those settings.
    `unit`: meters per Blender unit. `obj`, `depsgraph`: None for the content of a file.
    `opened`: closes opened resources at the end of the measurement.
    `findings`: reasons why kinds that might have read the object did not.
    """

    options: ResolvedOptions
    unit: float
    given: MeasureOptions = AS_SET
    obj: bpy.types.Object = None
    depsgraph: bpy.types.Depsgraph = None
    opened: ExitStack = field(default_factory=ExitStack)
    findings: list[Finding] = field(default_factory=list)

    @classmethod
    def resolve(
        cls,
        obj: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph = None,
        given: MeasureOptions = AS_SET,
        *,
        unit: float | None = None,
        opened: ExitStack | None = None,
    ) -> Request:
        """Return the request for an object; `unit` is in meters per Blender unit, by default the scene's."""
        unit = unit or given.meters_per_unit(depsgraph.scene)
        return cls(
            with_object_settings(given, obj, unit, _scene(depsgraph)),
            unit,
            given,
            obj,
            depsgraph,
            opened or ExitStack(),
        )

    @property
    def scene(self) -> bpy.types.Scene:
        """The scene with the defaults."""
        return _scene(self.depsgraph)

    @property
    def accepted(self) -> frozenset[str]:
        """The codes of findings that were accepted for the object."""
        return frozenset() if self.obj is None else accepted_codes(self.obj)

    @cached_property
    def density(self) -> DensityField | None:
        """Source of a density that is not one number.

        Raises MeasureError if the settings name none that can be read.
        """
        options, settings = self.options, self.obj.body_moments
        is_given = self.given.density is not None or options.mass is not None
        if is_given or options.kind == "wire" or settings.density_from == "VALUE":
            return None
        return density_field(settings)

    @cached_property
    def surfaces(self) -> Reading:
        """The object's surfaces, polygons and patches, with the attributes for its density; may raise MeasureError."""
        density = self.density
        reading = read_object(
            self.obj,
            self.depsgraph,
            materials=density is not None and density.kind == "materials",
            attribute=density.attribute if density is not None and self.options.kind == "shell" else None,
        )
        reading.findings.extend(self.findings)
        return reading


def _scene(depsgraph: bpy.types.Depsgraph | None) -> bpy.types.Scene:
    return bpy.context.scene if depsgraph is None else depsgraph.scene


def with_object_settings(
    options: MeasureOptions, obj: bpy.types.Object, unit: float, scene: bpy.types.Scene
) -> ResolvedOptions:
    """Return the options with every gap filled from the object's settings, or a missing density from the scene's."""
    settings = obj.body_moments
    density, mass = options.density, options.mass
    # volumes have no setting for it
    kind = options.kind or ("solid" if obj.type == "VOLUME" else settings.kind.lower())
    if density is None and mass is None:
        density, mass = (
            (shortest_decimal(settings.linear_density) if kind == "wire" else object_density(settings, scene), None)
            if settings.mass_from == "DENSITY"
            else (None, shortest_decimal(settings.mass))
        )
    return ResolvedOptions.resolve(
        options,
        kind=kind,
        density=density,
        mass=mass,
        thickness=shortest_decimal(settings.thickness) * unit if options.thickness is None else options.thickness,
        overlap=options.overlap or settings.overlap.lower(),
        wall=options.wall or settings.wall.lower(),
    )
