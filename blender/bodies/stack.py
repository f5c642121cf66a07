# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements of many objects, each a solid of one shape in one place, computed together.

Small shapes that are closed or can be capped are measured together, all others are repaired and
measured alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.inertia import MassProperties, has_certain_total
from ...core.inertia.third_moment_frames import third_moment_frames
from ...core.measurement import (
    DENSITY_FROM_MASS,
    DENSITY_FROM_VALUE,
    Settings,
    build_measurement,
    find_large_bounds,
    fingerprint,
)
from ...core.measurement.measurement import Measurement
from ...core.mesh import Surface
from ...core.moments import Moments, are_similarities, are_singular, image, join_moments
from ...core.numerics import Array, Mask, rotation_matrix
from ...core.polyhedron import area_of_images
from ...core.solid import SolidStack, can_be_stacked, measure_stack
from ...core.solid.measure import SolidIntegrals, measure_left_over, measure_solid
from ...core.verdict import DefectiveElements, Finding, MeshHealth, Method, Procedure
from ..read.fingerprint import transform_key
from ..read.mesh import MAX_DIGESTED_FACES, surface_digest
from ..settings.accepted import accepted_codes, with_acceptance
from .measure_body import MeasuredBody

METHODS = {verdict: Method(verdict) for verdict in Procedure}


@dataclass(eq=False)
class MeshShape:
    """A mesh in its own coordinates, and its measurement; equal to others of the same `content`.

    `solids`: the stack in which the mesh was measured, at `row`. `alone`: the integrals of a mesh
    that was measured by itself.
    """

    surface: Surface
    face_count: int
    content: tuple
    row: int = -1
    solids: SolidStack | None = None
    alone: SolidIntegrals | None = None
    method: Method = METHODS[Procedure.EXACT]
    findings: tuple[Finding, ...] = ()

    def __hash__(self) -> int:
        return hash(self.content)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MeshShape) and self.content == other.content

    @property
    def health(self) -> MeshHealth:
        if self.solids is not None:
            return self.solids.health(self.row)
        assert self.alone is not None
        return self.alone.health

    @property
    def defects(self) -> DefectiveElements | None:
        """The elements with faults; None if there are none."""
        spotless = self.alone is None and self.method is METHODS[Procedure.EXACT]
        return None if spotless else self.health.defective_elements

    @cached_property
    def digest(self) -> bytes | None:
        """Digest of the surface, for staleness; None for a large one."""
        return surface_digest(self.surface) if self.face_count <= MAX_DIGESTED_FACES else None


@lru_cache(maxsize=4)  # Objects are often measured again with the same shapes.
def measure_shapes(
    shapes: tuple[MeshShape, ...],
) -> tuple[tuple[MeshShape, ...], Moments, Moments]:
    """Return measured shapes in their own coordinates, their volumes to third order and areas."""
    stackable = can_be_stacked([shape.surface for shape in shapes])
    small = [shape for shape, is_stackable in zip(shapes, stackable) if is_stackable]
    stacks: list[tuple[Moments, Moments]] = []
    if small:
        solids = measure_stack([shape.surface for shape in small])
        stacks.append((solids.volume, solids.area))
        for i, (shape, is_measured) in enumerate(zip(small, solids.is_measured.tolist())):
            shape.row = i
            if is_measured:
                shape.solids = solids
                shape.findings = solids.findings(i)
                shape.method = METHODS[
                    Procedure.CAPPED if solids.caps.is_capped[i] else Procedure.EXACT
                ]
            else:
                shape.alone = measure_left_over(solids, i, shape.surface)
    left_over = [shape for shape in shapes if shape.solids is None]
    for row, shape in enumerate(left_over, len(small)):
        solid = shape.alone = shape.alone or measure_solid(shape.surface)
        shape.row = row
        shape.method = METHODS[solid.method]
        shape.findings = solid.findings
        stacks.append((solid.volume.at(None), solid.area.at(None)))
    rows = [shape.row for shape in shapes]
    volume, area = (join_moments(parts).at(rows) for parts in zip(*stacks))
    return shapes, volume, area


@dataclass(frozen=True, eq=False)
class StackMember:
    """An object that may join a stack.

    `shape`: index of its shape. `digest`: digest of the settings.
    `matrix`: (4, 4) map from the mesh's coordinates to the world, Blender units.
    `location`, `quaternion`: the object's frame.
    """

    obj: bpy.types.Object
    shape: int
    settings: Settings
    digest: str
    matrix: Array
    location: tuple[float, ...]
    quaternion: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class MeasuredStack:
    """The measurements of many objects, in SI units and world axes; arrays have one row for each
    object.

    `from_mass`: true if the density, kg/m³, follows from a given mass.
    `stretch`: ratio of the object's volume to its shape's.
    `rotation`, `location`: (n, 3, 3) and (n, 3), the object frames.
    """

    members: list[StackMember]
    shapes: tuple[MeshShape, ...]
    from_mass: Mask
    density: Array
    volume: Moments
    area: Moments
    mass_properties: MassProperties
    stretch: Array
    rotation: Array
    location: Array
    fingerprints: list[str]
    findings: list[tuple[Finding, ...]]

    def shape(self, i: int) -> MeshShape:
        """Return the shape of one member."""
        return self.shapes[self.members[i].shape]

    def some(self, which: list[int]) -> MeasuredStack:
        """Return the stack of the members with these indices."""
        if len(which) == len(self.members):
            return self
        lists = "members", "fingerprints", "findings"
        arrays = "density", "from_mass", "stretch", "rotation", "location"
        return replace(
            self,
            **{name: [getattr(self, name)[i] for i in which] for name in lists},
            **{name: getattr(self, name)[which] for name in arrays},
            volume=self.volume.at(which),
            area=self.area.at(which),
            mass_properties=self.mass_properties.at(which),
        )

    @cached_property
    def error_bounds(self) -> Array:
        """(n, 2, 4) bounds by rounding, then by float32 coordinates, of volume, area, center and
        inertia.
        """
        volume = self.volume
        area = self.area
        properties = self.mass_properties
        rounding = properties.rounding_error
        moved = properties.input_error
        bounds = (
            (
                volume.rounding_error[:, 0],
                area.rounding_error[:, 0],
                rounding["center"],
                rounding["inertia"],
            ),
            (volume.input_error[:, 0], area.input_error[:, 0], moved["center"], moved["inertia"]),
        )
        return np.array(bounds).transpose(2, 0, 1)

    def measurement(self, i: int) -> Measurement:
        """Return the measurement of one member."""
        obj = self.members[i].obj
        shape = self.shape(i)
        volume = self.volume.at(i)
        density = self.density[i]
        return build_measurement(
            name=obj.name,
            type=obj.type,
            kind="solid",
            method=shape.method,
            density=float(density),
            volume=volume,
            area=self.area.at(i),
            mass_properties=self.mass_properties.at(i),
            mass_moments=(volume, float(density)),
            health=replace(
                shape.health, volume_spread=shape.health.volume_spread * float(self.stretch[i])
            ),
            findings=self.findings[i],
            rotation=self.rotation[i],
            location=self.location[i],
            fingerprint=self.fingerprints[i],
            density_from=DENSITY_FROM_MASS if self.from_mass[i] else DENSITY_FROM_VALUE,
        )


@dataclass(frozen=True, eq=False)
class Stacked:
    """One object's measurement in a stack."""

    stack: MeasuredStack
    index: int

    @property
    def measurement(self) -> Measurement:
        return self.stack.measurement(self.index)

    @property
    def findings(self) -> tuple[Finding, ...]:
        return self.stack.findings[self.index]

    @property
    def mass_properties(self) -> MassProperties:
        return self.stack.mass_properties.at(self.index)

    @property
    def method(self) -> Method:
        return self.stack.shape(self.index).method

    def shape_digest(self, _obj: bpy.types.Object) -> bytes | None:
        """Return the digest of the object's surface; None for a large one."""
        return self.stack.shape(self.index).digest


Measured = Stacked | MeasuredBody


def measure_members(members: list[StackMember], shapes: list[MeshShape]) -> MeasuredStack | None:
    """Return the stack of the members with certain volume and mass, or None; all members have the
    same unit.
    """
    unit = members[0].settings.unit
    measured, own, own_area = measure_shapes(tuple(shapes))
    which = np.array([member.shape for member in members])
    matrices = np.array([member.matrix for member in members], np.float64)
    usable = np.isfinite(matrices).all(axis=(1, 2))
    usable &= own.raw[which, 0] > own.rounding_error[which, 0]
    usable[usable] = ~are_singular(matrices[usable, :3, :3])
    members = _chosen(members, usable)
    matrices = matrices[usable]
    which = which[usable]
    if not members:
        return None
    matrices[:, :3] *= unit
    volume = image(own.at(which), matrices)
    area = _areas(own_area.at(which), matrices, [measured[row] for row in which])
    density, mass = np.array(
        [(member.settings.density, member.settings.mass) for member in members], np.float64
    ).T
    from_mass = ~np.isnan(mass)
    with np.errstate(divide="ignore", invalid="ignore"):
        density = np.where(from_mass, mass / volume.raw[:, 0], density)
    certain = has_certain_total(volume) & (density > 0.0) & (density < np.inf)
    rows = np.flatnonzero(certain)
    fixed = third_moment_frames(volume.at(rows))
    if not fixed.is_body.all():  # the others are refused by themselves
        rows = rows[fixed.is_body]
        fixed = third_moment_frames(volume.at(rows))
    if not len(rows):
        return None
    if len(rows) < len(members):  # the others are refused by themselves
        members = _chosen(members, rows)
        which = which[rows]
        matrices = matrices[rows]
        density = density[rows]
        from_mass = from_mass[rows]
        volume, area = volume.at(rows), area.at(rows)
    rotation = rotation_matrix([member.quaternion for member in members])

    properties = MassProperties.of_stack(volume, density, rotation, fixed)
    geometry = np.ascontiguousarray(np.concatenate([volume.raw, area.raw], axis=1))
    return MeasuredStack(
        members,
        measured,
        from_mass,
        density,
        volume,
        area,
        properties,
        volume.raw[:, 0] / own.raw[which, 0],
        rotation,
        np.array([member.location for member in members]) * unit,
        [
            fingerprint(numbers, transform_key(each.obj), each.digest)
            for numbers, each in zip(geometry, members)
        ],
        [
            _findings(member.obj, measured[member.shape].findings + bounds)
            for member, bounds in zip(members, find_large_bounds(volume, area, properties))
        ],
    )


def _findings(obj: bpy.types.Object, found: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the findings about an object, with its accepted ones marked."""
    return with_acceptance(found, accepted_codes(obj)) if found else ()


def _chosen(members: list[StackMember], which: NDArray) -> list[StackMember]:
    return [members[i] for i in (np.flatnonzero(which) if which.dtype == bool else which).tolist()]


def _areas(area: Moments, matrices: NDArray, shapes: list[MeshShape]) -> Moments:
    """Return the areas of shapes mapped by matrices; surfaces are measured again if a matrix is
    no similarity.
    """
    even = are_similarities(matrices[:, :3, :3])
    if even.all():
        return image(area, matrices)
    regular = matrices.copy()
    regular[~even, :3, :3] = np.eye(3)
    placed = image(area, regular)
    for i in np.flatnonzero(~even).tolist():
        shape = shapes[i]
        surface = shape.surface if shape.alone is None else shape.alone.given_surface
        found = area_of_images(surface, matrices[i : i + 1, :3, :3])
        for name in ("raw", "rounding_error", "input_error", "about"):
            getattr(placed, name)[i] = getattr(found, name)
    return placed
