# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of objects, one or many: solids that show one mesh each are measured as stacks, all
others by `measure_body`.

Both ways give the same numbers. Large solids and varying densities join no stack.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace

import bpy
import numpy as np

from ...core.measurement import Measurement, Settings
from ...core.mesh import Surface
from ...core.solid import measure_again
from ...core.verdict import internal_error
from .. import bodies  # `measure_body` is imported when an object needs it
from ..read.mesh import mesh_surface, plain_mesh
from ..read.places import has_places, world_matrices
from ..settings.options import AS_SET, MeasureOptions, object_settings
from .stack import Measured, Member, measure_members

MAX_OBJECTS_PER_STACK = 512
MAX_STACKED_FACES = 20_000  # larger meshes are measured alone
MAX_FACES_PER_STACK = 40_000

Outcome = Measured | Exception


def measure_object(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, options: MeasureOptions = AS_SET
) -> Measurement:
    """Return the mass properties of one evaluated object, SI, world axes, or raise MeasureError."""
    return measured_in_turn([obj], depsgraph, options)(obj).measurement


def measure_many(
    objects: Sequence[bpy.types.Object],
    depsgraph: bpy.types.Depsgraph,
    options: MeasureOptions = AS_SET,
) -> Iterator[list[tuple[bpy.types.Object, Outcome]]]:
    """Measure original objects in batches; yield pairs of an object and its measurement or
    exception, in order.
    """
    collector = _Collector(depsgraph, options)
    for obj in objects:
        collector.add(obj)
        if (
            len(collector.objects) >= MAX_OBJECTS_PER_STACK
            or collector.faces >= MAX_FACES_PER_STACK
        ):
            yield from collector.outcomes()
            collector = _Collector(depsgraph, options)
    yield from collector.outcomes()


def measured_in_turn(
    objects: Sequence[bpy.types.Object],
    depsgraph: bpy.types.Depsgraph,
    options: MeasureOptions = AS_SET,
) -> Callable[[bpy.types.Object], Measured]:
    """Return a function from each object, in the given order, to its measurement; it measures ahead
    in batches.
    """
    waiting: dict[bpy.types.Object, Outcome] = {}
    batches = measure_many(objects, depsgraph, options)

    def measured(obj: bpy.types.Object) -> Measured:
        while obj not in waiting:
            waiting.update(next(batches))
        outcome = waiting.pop(obj)
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    return measured


class _Collector:
    """A collector of objects that are measured together."""

    def __init__(self, depsgraph: bpy.types.Depsgraph, options: MeasureOptions):
        self.depsgraph = depsgraph
        self.scene = depsgraph.scene
        # The scene's unit is read once for all objects.
        self.options = replace(options, unit_scale=options.meters_per_unit(self.scene))
        self.objects: list[bpy.types.Object] = []
        self.members: list[Member] = []
        self.surfaces: list[Surface] = []
        self.faces = 0
        self._by_mesh: dict[bpy.types.Mesh, int | None] = {}
        self._settings: dict[Settings, Settings] = {}
        self._by_content: dict[tuple, int] = {}

    def add(self, obj: bpy.types.Object) -> None:
        """Add an object, as a member of the stack if it can be stacked and read."""
        self.objects.append(obj)
        # An object that is no member is measured alone, which raises the same error again.
        with suppress(Exception):
            member = self._member(obj)
            if member is not None:
                self.members.append(member)

    def _member(self, obj: bpy.types.Object) -> Member | None:
        settings = self._settings_of(obj)
        mesh = None if settings is None else plain_mesh(obj, self.depsgraph)
        if settings is None or mesh is None:
            return None
        if mesh not in self._by_mesh:
            self._by_mesh[mesh] = self._read(mesh)
        shape = self._by_mesh[mesh]
        if shape is None:
            return None
        blender_matrix = obj.evaluated_get(self.depsgraph).matrix_world
        location, rotation, _scale = blender_matrix.decompose()
        if has_places(obj):  # kept in float64, unlike Blender's matrix
            matrix = world_matrices(obj)[0]
            location = matrix[:3, 3].tolist()
        else:
            matrix = np.array(blender_matrix, np.float64)
        return Member(obj, shape, settings, matrix, tuple(location), tuple(rotation))

    def _settings_of(self, obj: bpy.types.Object) -> Settings | None:
        """Return the settings of a solid of one density or mass, or None for other objects."""
        options = self.options
        if options.order is not None or not _is_uniform(obj.body_moments, options):
            return None
        settings = object_settings(obj, self.scene, options)
        if settings.kind != "solid" or settings.overlap != "signed":
            return None
        # Equal settings become one object, so that their digest is computed once.
        return self._settings.setdefault(settings, settings)

    def _read(self, mesh: bpy.types.Mesh) -> int | None:
        """Return the index of a mesh's surface, equal meshes having the same; None if the mesh has
        to be measured alone.
        """
        if not len(mesh.polygons) or len(mesh.polygons) > MAX_STACKED_FACES:
            return None
        surface = mesh_surface(mesh)
        content = surface.content
        if content not in self._by_content:
            self._by_content[content] = len(self.surfaces)
            self.surfaces.append(surface)
            self.faces += len(surface.triangles) + len(surface.quads)
        return self._by_content[content]

    def outcomes(self) -> Iterator[list[tuple[bpy.types.Object, Outcome]]]:
        """Yield lists of objects with their outcomes, in order: consecutive stacked objects in one
        list, each of the others in a list of its own.
        """
        stacked = self._measure()
        together: list[tuple[bpy.types.Object, Outcome]] = []
        for obj in self.objects:
            if obj in stacked:
                together.append((obj, stacked[obj]))
                continue
            if together:
                yield together
                together = []
            try:
                outcome: Outcome = bodies.measure_body.measure_body(
                    obj, self.depsgraph, self.options
                )
            except Exception as error:
                outcome = error
            yield [(obj, outcome)]
        if together:
            yield together

    def _measure(self) -> dict[bpy.types.Object, Measured]:
        """Return the stacked measurements; none if the stack fails and all must be measured
        alone.
        """
        if not self.members:
            return {}
        try:
            rows = measure_members(self.members, measure_again(self.surfaces))
        except Exception as error:
            internal_error.finding_of(error)  # prints the traceback of a fault of the program
            return {}
        return {row.member.obj: row for row in rows}


def _is_uniform(properties: bpy.types.PropertyGroup, options: MeasureOptions) -> bool:
    """Return whether a body has one density, or a mass whose center and inertia are not given."""
    if options.density is not None:
        return True
    if properties.mass_from == "MASS":
        return not (properties.use_center or properties.use_inertia)
    return options.mass is not None or properties.density_from == "VALUE"
