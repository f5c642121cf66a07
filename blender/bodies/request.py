# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The request for one measurement: its settings and density, and the reading that several kinds of
bodies share.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import cached_property

import bpy

from ...core import bodies, verdict
from ...core.measurement import Body, Measurement, Settings
from ..read import fingerprint, objects
from ..settings.accepted import accepted_codes, with_acceptance
from ..settings.density import DensityField, density_field
from ..settings.options import AS_SET, MeasureOptions, object_settings


@dataclass(frozen=True, eq=False)
class Request:
    """A request to measure an object.

    `settings`: the options `given`, completed by the object's own. `scene`: its defaults apply to
    the object. `opened`: closes opened resources at the end of the measurement. `findings`:
    reasons why a kind of body that fits the object did not read it.
    """

    settings: Settings
    given: MeasureOptions
    obj: bpy.types.Object
    depsgraph: bpy.types.Depsgraph
    scene: bpy.types.Scene
    opened: ExitStack
    findings: list[verdict.Finding] = field(default_factory=list)

    @classmethod
    def resolve(
        cls,
        obj: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph = None,
        given: MeasureOptions = AS_SET,
        *,
        opened: ExitStack | None = None,
    ) -> Request:
        """Return the request for an object; without a depsgraph, in the scene of the context."""
        scene = bpy.context.scene if depsgraph is None else depsgraph.scene
        settings = object_settings(obj, scene, given)
        return cls(settings, given, obj, depsgraph, scene, opened or ExitStack())

    @cached_property
    def density(self) -> DensityField | None:
        """The varying density, None for a uniform one; may raise MeasureError."""
        settings = self.settings
        properties = self.obj.body_moments
        is_given = self.given.density is not None or settings.mass is not None
        if is_given or settings.kind == "wire" or properties.density_from == "VALUE":
            return None
        return density_field(properties)

    @cached_property
    def surfaces(self) -> bodies.Reading:
        """The object's surfaces, polygons and patches, with the attributes for its density; may
        raise MeasureError.
        """
        density = self.density
        reading = objects.read_object(
            self.obj,
            self.depsgraph,
            materials=density is not None and density.kind == "materials",
            attribute=density.attribute
            if density is not None and self.settings.kind == "shell"
            else None,
        )
        reading.findings.extend(self.findings)
        return reading


def measurement_of(reading: bodies.Reading, body: Body, request: Request) -> Measurement:
    """Return the results of measuring a body, or raise MeasureError if it has no mass or unknown
    moments.
    """
    transform = fingerprint.transform_key(request.obj)
    measurement = bodies.measure_reading(reading, body, request.settings, transform)
    accepted = accepted_codes(request.obj)
    return replace(measurement, findings=with_acceptance(measurement.findings, accepted))
