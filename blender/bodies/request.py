# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is asked of one measurement, resolved once: options, unit, density, and what several kinds read alike."""

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

    Attributes
    ----------
    options : ResolvedOptions
        What was given, and the object's settings.
    unit : float
        Metres per Blender unit.
    given : MeasureOptions
        What overrides the object's settings.
    obj, depsgraph
        The object and where it is evaluated; None for what is in a file only.
    opened : ExitStack
        Closes what is open for as long as the measurement takes.
    findings : list of Finding
        Why kinds that might have read the object did not.
    """

    options: ResolvedOptions
    unit: float
    given: MeasureOptions = AS_SET
    obj: bpy.types.Object = None
    depsgraph: bpy.types.Depsgraph = None
    opened: ExitStack = field(default_factory=ExitStack)
    findings: list[Finding] = field(default_factory=list)

    @classmethod
    def of(
        cls,
        obj: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph = None,
        given: MeasureOptions = AS_SET,
        *,
        unit: float | None = None,
        opened: ExitStack | None = None,
    ) -> Request:
        """Return what is asked of an object. unit: meters per Blender unit, by default the scene's."""
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
        """The scene whose defaults count."""
        return _scene(self.depsgraph)

    @property
    def accepted(self) -> frozenset[str]:
        """The codes of findings that were accepted for the object."""
        return frozenset() if self.obj is None else accepted_codes(self.obj)

    @cached_property
    def density(self) -> DensityField | None:
        """Where the density comes from when it is not one number.

        Raises MeasureError where the settings name none that can be read.
        """
        options, settings = self.options, self.obj.body_moments
        is_given = self.given.density is not None or options.mass is not None
        if is_given or options.kind == "wire" or settings.density_from == "VALUE":
            return None
        return density_field(settings)

    @cached_property
    def surfaces(self) -> Reading:
        """The object's surfaces, polygons and patches, with what its density needs of them. Raises MeasureError."""
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
    """The options with every gap filled from the object's settings, and the density of one that has none from the
    scene's."""
    settings = obj.body_moments
    density, mass = options.density, options.mass
    kind = options.kind or ("solid" if obj.type == "VOLUME" else settings.kind.lower())  # which has no setting for it
    if density is None and mass is None:
        density, mass = (
            (shortest_decimal(settings.linear_density) if kind == "wire" else object_density(settings, scene), None)
            if settings.mass_from == "DENSITY"
            else (None, shortest_decimal(settings.mass))
        )
    return ResolvedOptions.of(
        options,
        kind=kind,
        density=density,
        mass=mass,
        thickness=shortest_decimal(settings.thickness) * unit if options.thickness is None else options.thickness,
        overlap=options.overlap or settings.overlap.lower(),
        wall=options.wall or settings.wall.lower(),
    )
